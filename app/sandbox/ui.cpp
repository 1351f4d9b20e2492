#include "app/sandbox/ui.h"

#include "app/sandbox/widgets.h"

#include <imgui/imgui.h>
#include <imgui/imgui_internal.h> // ClearActiveID: to leave a text field by Esc

namespace plumb {

Ui::Ui(float scale) : imgui_(ImGui::CreateContext()), scale_(scale) {
    ImGui::SetCurrentContext(imgui_);
    ImGuiIO &io = ImGui::GetIO();
    io.IniFilename = nullptr; // the layout is computed, so there is nothing to remember
    io.LogFilename = nullptr;
    apply_theme(scale);
    fonts_ = load_fonts(scale);
}

Ui::~Ui() {
    ImGui::DestroyContext(imgui_);
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
    LayoutWishes wishes;
    // Of a world that is stepped.
    const Simulation *simulation = context.session.simulation();
    wishes.diagnostics =
        context.view.diagnostics && (simulation == nullptr || simulation->has_world());
    // The width of the messages does not depend on their height.
    const float width = lay_out(window, scale_, wishes).messages.size.x;
    wishes.messages_height = messages_height(context.session.messages(), width);
    const Layout layout = lay_out(window, scale_, wishes);

    probe_labels(context);
    if (context.view.panels) {
        panel(context, "scenes", layout.scenes, scenes_panel);
        panel(context, "settings", layout.settings, settings_panel);
        panel(context, "view", layout.view, view_panel);
        panel(context, "transport", layout.transport, transport_panel);
        panel(context, "details", layout.details, nullptr);
        if (wishes.diagnostics)
            panel(context, "diagnostics", layout.diagnostics, [](PanelContext &c) {
                statistics_panel(c);
                measures_panel(c);
            });
    }
    // Errors and help are seen even when the panels are hidden.
    if (wishes.messages_height > 0)
        panel(context, "messages", layout.messages, messages_panel);
    if (context.view.help)
        panel(context, "help", layout.help, help_panel, true);
    ImGui::Render();
    return *ImGui::GetDrawData();
}

void Ui::panel(PanelContext &context, const char *name, const Rect &rect,
               void (*contents)(PanelContext &), bool fit_height) {
    ImGui::SetNextWindowPos({rect.min.x, rect.min.y});
    ImGui::SetNextWindowSizeConstraints({rect.size.x, fit_height ? 0 : rect.size.y},
                                        {rect.size.x, rect.size.y});
    ImGui::SetNextWindowSize({rect.size.x, fit_height ? 0 : rect.size.y});
    constexpr ImGuiWindowFlags flags = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove |
                                       ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse |
                                       ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoNav;
    ImGui::Begin(name, nullptr, flags);
    // Rows that are only read may stand closer than those that are clicked.
    const bool dense = contents != scenes_panel && contents != settings_panel &&
                       contents != view_panel && contents != transport_panel;
    if (dense)
        ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(8 * scale_, 4 * scale_));
    if (contents)
        contents(context);
    else
        details(context);
    if (dense)
        ImGui::PopStyleVar();
    const ImVec2 at = ImGui::GetWindowPos();
    const ImVec2 size = ImGui::GetWindowSize();
    panels_.push_back({name, {{at.x, at.y}, {size.x, size.y}}});
    ImGui::End();
}

void Ui::details(PanelContext &context) {
    // A body that has just been selected brings its tab to the front, and one let go the scene's.
    const bool changed = shown_body_ != context.view.selected;
    shown_body_ = context.view.selected;
    const auto flags = [&](bool wanted) {
        return changed && wanted ? ImGuiTabItemFlags_SetSelected : ImGuiTabItemFlags_None;
    };
    if (!ImGui::BeginTabBar("details"))
        return;
    if (ImGui::BeginTabItem("Scene", nullptr, flags(!shown_body_))) {
        expectations_panel(context);
        ImGui::EndTabItem();
    }
    if (ImGui::BeginTabItem("Body", nullptr, flags(shown_body_.has_value()))) {
        inspector_panel(context);
        ImGui::EndTabItem();
    }
    ImGui::EndTabBar();
}

bool Ui::over_panel() const {
    return ImGui::GetIO().WantCaptureMouse;
}

bool Ui::wants_text() const {
    return ImGui::GetIO().WantTextInput;
}

void Ui::release_keyboard() {
    ImGui::SetCurrentContext(imgui_);
    ImGui::ClearActiveID();
}

} // namespace plumb
