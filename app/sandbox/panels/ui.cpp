#include "app/sandbox/panels/ui.h"

#include "app/sandbox/panels/widgets.h"

#include <imgui/imgui.h>
#include <imgui/imgui_internal.h> // ClearActiveID, ClosePopupToLevel: what Esc does

namespace plumb {

namespace {

// A panel's height is unknown before it is first drawn: give it all there is.
constexpr float unknown_height = 1e6f;

bool has_world(const PanelContext &context) {
    const Simulation *simulation = context.session.simulation();
    return simulation != nullptr && simulation->has_world();
}

bool is_shown(const PanelRow &row, const PanelContext &context, bool roomy) {
    const ViewState &view = context.view;
    // In a small window help is shown alone.
    const bool beside_help = view.panels && (roomy || !view.help);
    switch (row.needs) {
    case PanelNeeds::nothing:
        return beside_help;
    case PanelNeeds::scene:
        return beside_help && context.session.running();
    case PanelNeeds::world:
        return beside_help && has_world(context);
    case PanelNeeds::diagnostics:
        return beside_help && has_world(context) && view.diagnostics;
    case PanelNeeds::lab:
        return view.panels && view.lab && !view.help && has_world(context);
    // Errors and help show even when the panels are hidden.
    case PanelNeeds::messages:
        return !context.session.messages().empty();
    case PanelNeeds::help:
        return view.help;
    }
    return false;
}

} // namespace

Ui::Ui(float scale) : imgui_(ImGui::CreateContext()) {
    ImGui::SetCurrentContext(imgui_);
    ImGuiIO &io = ImGui::GetIO();
    io.IniFilename = nullptr; // the layout is computed: nothing to save
    io.LogFilename = nullptr;
    set_scale(scale);
}

Ui::~Ui() {
    ImGui::DestroyContext(imgui_);
}

void Ui::set_scale(float scale) {
    ImGui::SetCurrentContext(imgui_);
    scale_ = scale;
    apply_theme(scale);
    ImGui::GetIO().Fonts->Clear();
    fonts_ = load_fonts(scale);
    heights_ = {};
}

void Ui::fill_input(glm::vec2 size, float seconds) {
    ImGui::SetCurrentContext(imgui_);
    ImGuiIO &io = ImGui::GetIO();
    io.DisplaySize = {size.x, size.y};
    io.DisplayFramebufferScale = {1, 1};
    io.DeltaTime = seconds;
    io.MousePos = {-FLT_MAX, -FLT_MAX};
}

void Ui::begin_frame() {
    ImGui::SetCurrentContext(imgui_);
    ImGui::NewFrame();
}

const ImDrawData &Ui::draw(PanelContext &context) {
    panels_.clear();
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    const glm::vec2 window(size.x, size.y);
    const bool roomy = is_roomy(window, scale_);
    // Once open they stay so, whether the window shrinks or the text grows.
    if (roomy)
        for (std::optional<bool> &open : context.view.opened)
            open = open.value_or(true);
    PerPanel<float> wished{};
    for (const PanelRow &row : panel_rows)
        if (is_shown(row, context, roomy))
            wished[row.id] = heights_[row.id] > 0 ? heights_[row.id] : unknown_height;
    const PerPanel<Rect> rects = lay_out(window, scale_, wished);
    for (const PanelRow &row : panel_rows)
        if (wished[row.id] > 0)
            panel(context, row, rects[row.id]);

    // Messages and help come and go, and must not move the scene.
    std::vector<Rect> taken;
    for (const Panel &panel : panels_)
        if (panel.id != PanelId::messages && panel.id != PanelId::help)
            taken.push_back(panel.rect);
    const Rect free = free_part(window, taken, context.view.aspect);
    context.view.camera.look_through(window, free.min, free.size, context.view.aspect);
    probe_labels(context);
    ImGui::Render();
    return *ImGui::GetDrawData();
}

void Ui::panel(PanelContext &context, const PanelRow &row, const Rect &rect) {
    ImGui::SetNextWindowPos({rect.min.x, rect.min.y});
    ImGui::SetNextWindowSizeConstraints({rect.size.x, rect.size.y}, {rect.size.x, rect.size.y});
    ImGui::SetNextWindowSize({rect.size.x, rect.size.y});
    constexpr ImGuiWindowFlags flags = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove |
                                       ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse |
                                       ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoNav;
    ImGui::Begin(row.name, nullptr, flags);
    if (!row.is_clicked)
        ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(8 * scale_, 4 * scale_));
    context.scrolled_height = 0;
    row.contents(context);
    const ImGuiStyle &style = ImGui::GetStyle();
    // Down to the border below the last item.
    heights_[row.id] = ImGui::GetCursorPosY() - style.ItemSpacing.y + style.WindowPadding.y +
                       context.scrolled_height;
    if (!row.is_clicked)
        ImGui::PopStyleVar();
    const ImVec2 at = ImGui::GetWindowPos();
    const ImVec2 size = ImGui::GetWindowSize();
    panels_.push_back({row.id, row.name, {{at.x, at.y}, {size.x, size.y}}});
    ImGui::End();
}

bool Ui::over_panel() const {
    return ImGui::GetIO().WantCaptureMouse;
}

bool Ui::wants_text() const {
    return ImGui::GetIO().WantTextInput;
}

bool Ui::close_list() {
    ImGui::SetCurrentContext(imgui_);
    const int open = imgui_->OpenPopupStack.Size;
    if (open == 0 || wants_text()) // typing in one of its fields
        return false;
    ImGui::ClosePopupToLevel(open - 1, true);
    return true;
}

void Ui::release_keyboard() {
    ImGui::SetCurrentContext(imgui_);
    ImGui::ClearActiveID();
}

} // namespace plumb
