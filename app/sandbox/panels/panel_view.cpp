// What to draw besides the bodies, and the camera.
#include "app/sandbox/panels/panel.h"
#include "app/sandbox/panels/widgets.h"

#include <algorithm>
#include <optional>
#include <vector>

#include <imgui/imgui.h>

namespace plumb {

namespace {

struct Box {
    Action action;
    bool checked;
};

struct BoxRow {
    Box left;
    std::optional<Box> right;
};

// Two columns, without keys if those do not fit; one column if even the titles do not.
void check_boxes(PanelContext &context, const std::vector<BoxRow> &rows) {
    const float spacing = ImGui::GetStyle().ItemSpacing.x;
    const float width = ImGui::GetContentRegionAvail().x;
    const auto fits = [&](bool with_key) {
        return std::ranges::all_of(rows, [&](const BoxRow &row) {
            const float left = check_box_width(context.fonts, row.left.action, with_key);
            return left + (row.right ? spacing + check_box_width(context.fonts, row.right->action,
                                                                 with_key)
                                     : 0) <=
                   width;
        });
    };
    const bool with_key = fits(true);
    const bool side_by_side = with_key || fits(false);
    const auto width_of = [&](const Box &box) {
        return check_box_width(context.fonts, box.action, with_key);
    };
    // Where the right column begins; in a narrow panel a long title on the left shifts only its
    // row.
    float column = (width + spacing) / 2;
    for (const BoxRow &row : rows)
        column = std::max(column, width_of(row.left) + spacing);
    for (const BoxRow &row : rows)
        if (row.right)
            column = std::min(column, width - width_of(*row.right));
    const auto draw = [&](const Box &box, float box_width) {
        if (action_check_box(context.fonts, box.action, box.checked, box_width, with_key))
            context.actions.push_back(box.action);
    };
    for (const BoxRow &row : rows) {
        const float start =
            side_by_side && row.right ? std::max(column, width_of(row.left) + spacing) : 0;
        draw(row.left, start > 0 ? start - spacing : width);
        if (!row.right)
            continue;
        if (start > 0)
            ImGui::SameLine(0, spacing);
        draw(*row.right, width - start);
    }
}

} // namespace

void view_panel(PanelContext &context) {
    if (!title_bar(context, PanelId::view, "View",
                   "Help " + shortcut(Action::toggle_help) + "   Hide " +
                       shortcut(Action::toggle_panels)))
        return;
    const ViewState &view = context.view;
    const float spacing = ImGui::GetStyle().ItemSpacing.x;
    const float width = ImGui::GetContentRegionAvail().x - spacing;
    const float half = width / 2;
    const Simulation *simulation = context.session.simulation();
    const bool has_world = simulation != nullptr && simulation->has_world();
    const Box wireframe{Action::toggle_wireframe, view.wireframe};
    if (has_world) // longer titles on the left
        check_boxes(
            context,
            {{{Action::toggle_contacts, view.contacts}, Box{Action::toggle_joints, view.joints}},
             {{Action::toggle_velocities, view.velocities},
              Box{Action::toggle_bounds, view.bounds}},
             {wireframe, Box{Action::toggle_ghost, context.session.ghost() != nullptr}},
             {{Action::toggle_diagnostics, view.diagnostics}, Box{Action::toggle_lab, view.lab}}});
    else
        check_boxes(context, {{wireframe, {}}});
    if (action_button(context.fonts, Action::frame, half))
        context.actions.push_back(Action::frame);
    ImGui::SameLine(0, spacing);
    if (action_button(context.fonts, Action::home, half))
        context.actions.push_back(Action::home);
    // Normally the transport bar has the restart button; without it, show it here.
    if (!has_world && action_button(context.fonts, Action::restart, width + spacing))
        context.actions.push_back(Action::restart);
}

} // namespace plumb
