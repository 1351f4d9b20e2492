// Method, step, substeps, iterations and gravity of the running scene.
#include "app/sandbox/panel.h"
#include "app/sandbox/widgets.h"

#include "engine/dynamics/method_info.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include <imgui/imgui.h>

namespace plumb {

namespace {

// "1/240 s", or in milliseconds where that is no whole fraction.
std::string step_text(double dt) {
    const double rate = 1 / dt;
    std::array<char, 32> text{};
    if (std::abs(rate - std::round(rate)) < 1e-6 * rate)
        std::snprintf(text.data(), text.size(), "1/%.0f s", rate);
    else
        std::snprintf(text.data(), text.size(), "%.4g ms", dt * 1e3);
    return text.data();
}

// The label in the left third, the control in the rest.
void label(const char *text) {
    ImGui::AlignTextToFramePadding();
    ImGui::TextDisabled("%s", text);
    ImGui::SameLine(ImGui::GetFontSize() * 5.4f);
    ImGui::SetNextItemWidth(-1);
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

// True when changed.
bool step_row(StepSettings &settings) {
    label("Step");
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
    tooltip("Time that one step takes in the world.");
    return changed;
}

} // namespace

void settings_panel(PanelContext &context) {
    const Simulation *simulation = context.session.simulation();
    heading(context.fonts, "Method",
            !simulation                                  ? ""
            : simulation->precision() == Precision::dual ? "double precision"
                                                         : "single precision");
    if (!simulation) {
        ImGui::TextDisabled("No scene is running.");
        return;
    }
    if (!simulation->has_world()) {
        ImGui::TextDisabled("There is no world to step.");
        return;
    }
    method_row(context, *simulation);
    StepSettings settings = simulation->settings();
    bool changed = step_row(settings);
    label("Substeps");
    changed |= ImGui::SliderInt("##substeps", &settings.substeps, 1, 64, "%d",
                                ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
    tooltip("Into how many parts a step is cut. Ctrl+click to type.");
    label("Iterations");
    changed |= ImGui::SliderInt("##iterations", &settings.iterations, 1, 64, "%d",
                                ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
    tooltip("Passes over all constraints in each substep. Ctrl+click to type.");
    label("Gravity");
    std::array gravity{static_cast<float>(settings.gravity.x),
                       static_cast<float>(settings.gravity.y),
                       static_cast<float>(settings.gravity.z)};
    if (ImGui::DragFloat3("##gravity", gravity.data(), 0.05f, -100, 100, "%.2f",
                          ImGuiSliderFlags_AlwaysClamp)) {
        // The components that were not touched keep their bits.
        for (int i = 0; i < 3; ++i) {
            const float now = gravity[static_cast<std::size_t>(i)];
            if (now != static_cast<float>(settings.gravity[i]))
                settings.gravity[i] = static_cast<double>(now);
        }
        changed = true;
    }
    tooltip("x, y, z in m/s². Drag, or Ctrl+click to type.");
    if (changed)
        context.session.set_settings(settings);

    if (ImGui::Button("As the scene says", {-1, 0}))
        context.restart_as_written = true;
    tooltip("Starts again with the method and settings of the file and the command line.");
}

} // namespace plumb
