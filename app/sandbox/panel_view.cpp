// What is drawn besides the bodies, and the camera.
#include "app/sandbox/panel.h"
#include "app/sandbox/widgets.h"

#include <imgui/imgui.h>

namespace plumb {

void view_panel(PanelContext &context) {
    if (!title_bar(context, PanelId::view, "View",
                   "Help " + shortcut(Action::toggle_help) + "   Hide " +
                       shortcut(Action::toggle_panels)))
        return;
    const ViewState &view = context.view;
    const float spacing = ImGui::GetStyle().ItemSpacing.x;
    const float width = ImGui::GetContentRegionAvail().x - spacing;
    const float half = width / 2;
    const auto box = [&](Action action, bool checked, float share) {
        if (action_check_box(context.fonts, action, checked, width * share))
            context.actions.push_back(action);
    };
    const Simulation *simulation = context.session.simulation();
    const bool has_world = simulation != nullptr && simulation->has_world();
    if (has_world) {
        // The longer titles stand on the left.
        constexpr float left = 0.54f;
        box(Action::toggle_contacts, view.contacts, left);
        ImGui::SameLine(0, spacing);
        box(Action::toggle_joints, view.joints, 1 - left);
        box(Action::toggle_velocities, view.velocities, left);
        ImGui::SameLine(0, spacing);
        box(Action::toggle_bounds, view.bounds, 1 - left);
    }
    box(Action::toggle_wireframe, view.wireframe, 0.6f);
    if (has_world) {
        ImGui::SameLine(0, spacing);
        box(Action::toggle_ghost, context.session.ghost() != nullptr, 0.4f);
    }
    if (has_world) {
        box(Action::toggle_diagnostics, view.diagnostics, 0.6f);
        ImGui::SameLine(0, spacing);
        box(Action::toggle_lab, view.lab, 0.4f);
    }
    if (action_button(context.fonts, Action::frame, half))
        context.actions.push_back(Action::frame);
    ImGui::SameLine(0, spacing);
    if (action_button(context.fonts, Action::home, half))
        context.actions.push_back(Action::home);
    // Without the transport bar, which has it otherwise.
    if (!has_world && action_button(context.fonts, Action::restart, width + spacing))
        context.actions.push_back(Action::restart);
}

} // namespace plumb
