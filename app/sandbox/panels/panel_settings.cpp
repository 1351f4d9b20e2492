// The running scene's method and settings.
#include "app/sandbox/panels/panel.h"
#include "app/sandbox/panels/widgets.h"

#include "engine/dynamics/method_info.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>

#include <imgui/imgui.h>

namespace plumb {

namespace {

// "1/240 s", or milliseconds if it is not 1 over a whole number.
std::string step_text(double dt) {
    const double rate = 1 / dt;
    std::array<char, 32> text{};
    if (std::abs(rate - std::round(rate)) < 1e-6 * rate)
        std::snprintf(text.data(), text.size(), "1/%.0f s", rate);
    else
        std::snprintf(text.data(), text.size(), "%.4g ms", dt * 1e3);
    return text.data();
}

// Label on the left, control on the right.
struct Columns {
    float label, control; // em; control -1 takes the rest of the line
};
constexpr Columns panel_columns{5.4f, -1}, popup_columns{12, 8};
constexpr float least_vector_width = 9; // em

void label(const char *text, const Columns &columns) {
    const float em = ImGui::GetFontSize();
    ImGui::AlignTextToFramePadding();
    ImGui::TextDisabled("%s", text);
    ImGui::SameLine(em * columns.label);
    ImGui::SetNextItemWidth(columns.control < 0 ? -1 : em * columns.control);
}

void method_row(PanelContext &context, const Simulation &simulation) {
    const float arrow = ImGui::GetFrameHeight();
    const float spacing = ImGui::GetStyle().ItemSpacing.x;
    if (ImGui::Button(shortcut(Action::previous_method).c_str(), {arrow, 0}))
        context.actions.push_back(Action::previous_method);
    action_tooltip(Action::previous_method);
    ImGui::SameLine();
    ImGui::SetNextItemWidth(-arrow - spacing);
    const std::string title(simulation.method().title);
    if (ImGui::BeginCombo("##method", title.c_str(), ImGuiComboFlags_NoArrowButton)) {
        for (const MethodInfo &method : method_infos()) {
            const std::string why = why_not(method, context.session.scene());
            ImGui::BeginDisabled(!why.empty());
            if (ImGui::Selectable(std::string(method.title).c_str(),
                                  method.name == simulation.method().name))
                context.session.set_method(method.name);
            ImGui::EndDisabled();
            tooltip(why.empty() ? method.source : std::string_view(why));
        }
        ImGui::EndCombo();
    } else {
        tooltip(simulation.method().source);
    }
    ImGui::SameLine();
    if (ImGui::Button(shortcut(Action::next_method).c_str(), {arrow, 0}))
        context.actions.push_back(Action::next_method);
    action_tooltip(Action::next_method);
}

// Rows return true when the setting changed.
bool step_row(const SettingRow &row, StepSettings &settings, const Columns &columns) {
    label("Step", columns);
    bool changed = false;
    if (ImGui::BeginCombo("##dt", step_text(settings.dt).c_str())) {
        for (const int rate : {15, 30, 60, 120, 240, 480, 960, 1920}) {
            const double dt = 1.0 / rate;
            if (ImGui::Selectable(step_text(dt).c_str(), dt == settings.dt)) {
                settings.dt = dt;
                changed = true;
            }
        }
        ImGui::EndCombo();
    }
    tooltip(row.reason);
    return changed;
}

// "Push velocity"
std::string title_of(const SettingRow &row) {
    std::string title(row.name);
    std::ranges::replace(title, '_', ' ');
    title[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(title[0])));
    return title;
}

// "1 to 128" where islands choose their own substeps.
std::string whole_format(const SettingRow &row, const MethodInfo &method,
                         const StepSettings &settings) {
    const bool is_least = row.member == SettingMember(&StepSettings::substeps) &&
                          method.chooses_substeps() && settings.max_substeps > settings.substeps;
    return is_least ? "%d to " + std::to_string(settings.max_substeps) : "%d";
}

bool setting_row(const SettingRow &row, const MethodInfo &method, StepSettings &settings,
                 const Columns &columns) {
    if (row.member == SettingMember(&StepSettings::dt))
        return step_row(row, settings, columns);
    constexpr ImGuiSliderFlags flags =
        ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_NoRoundToFormat;
    label(title_of(row).c_str(), columns);
    const std::string id = "##" + std::string(row.name);
    bool changed = false;
    if (const auto *whole = std::get_if<int StepSettings::*>(&row.member)) {
        changed =
            ImGui::SliderInt(id.c_str(), &(settings.**whole), static_cast<int>(row.min),
                             static_cast<int>(row.max), whole_format(row, method, settings).c_str(),
                             ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_Logarithmic);
    } else if (const auto *vector = std::get_if<glm::dvec3 StepSettings::*>(&row.member)) {
        // If three numbers do not fit beside the label, they go below it.
        if (ImGui::GetContentRegionAvail().x < least_vector_width * ImGui::GetFontSize()) {
            ImGui::NewLine();
            ImGui::SetNextItemWidth(-1);
        }
        changed = ImGui::DragScalarN(id.c_str(), ImGuiDataType_Double, &(settings.**vector)[0], 3,
                                     0.05f, &row.min, &row.max, "%.4g", flags);
    } else {
        double &value = settings.*std::get<double StepSettings::*>(row.member);
        const auto speed = static_cast<float>(std::clamp(0.01 * value, 1e-5, 1e3));
        const std::string format = row.unit.empty() ? "%.4g" : "%.4g " + std::string(row.unit);
        changed = ImGui::DragScalar(id.c_str(), ImGuiDataType_Double, &value, speed, &row.min,
                                    &row.max, format.c_str(), flags);
    }
    tooltip(std::string(row.reason) + " " + title_of(row) + " is " + range_text(row) +
            ". Drag, or Ctrl+click to type.");
    return changed;
}

// Settings shown in the panel itself; the others are behind a button.
bool is_in_panel(const SettingRow &row) {
    return row.group == SettingGroup::world || row.group == SettingGroup::step ||
           row.member == SettingMember(&StepSettings::iterations);
}

bool rows_in_panel(const MethodInfo &method, StepSettings &settings) {
    bool changed = false;
    for (const SettingRow &row : setting_rows)
        if (is_in_panel(row)) {
            ImGui::BeginDisabled(!reads(method, row));
            changed |= setting_row(row, method, settings, panel_columns);
            ImGui::EndDisabled();
        }
    return changed;
}

bool more_rows(const MethodInfo &method, StepSettings &settings) {
    if (!ImGui::BeginPopup("settings"))
        return false;
    bool changed = false;
    for (const SettingRow &row : setting_rows)
        if (!is_in_panel(row) && reads(method, row))
            changed |= setting_row(row, method, settings, popup_columns);
    ImGui::EndPopup();
    return changed;
}

} // namespace

void settings_panel(PanelContext &context) {
    const Simulation *simulation = context.session.simulation();
    if (!title_bar(context, PanelId::settings, "Method",
                   simulation->precision() == Precision::f64 ? "double precision"
                                                             : "single precision"))
        return;
    method_row(context, *simulation);
    StepSettings settings = simulation->settings();
    const MethodInfo &method = simulation->method();
    bool changed = rows_in_panel(method, settings);

    const bool has_more = std::ranges::any_of(setting_rows, [&](const SettingRow &row) {
        return !is_in_panel(row) && reads(method, row);
    });
    const float spacing = ImGui::GetStyle().ItemSpacing.x;
    const float half = 0.5f * (ImGui::GetContentRegionAvail().x - spacing);
    if (ImGui::Button("As in scene", {half, 0}))
        context.restart_as_written = true;
    tooltip("Restarts with the method and settings from the file and the command line.");
    ImGui::SameLine();
    ImGui::BeginDisabled(!has_more);
    if (ImGui::Button("More", {half, 0}))
        ImGui::OpenPopup("settings");
    ImGui::EndDisabled();
    tooltip("The other settings of this method.");
    changed |= more_rows(method, settings);
    if (changed)
        context.session.set_settings(settings);
}

} // namespace plumb
