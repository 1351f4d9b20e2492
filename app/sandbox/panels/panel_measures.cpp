// Measurements of the world as it is.
#include "app/sandbox/panels/panel.h"
#include "app/sandbox/panels/widgets.h"

#include <glm/geometric.hpp>
#include <imgui/imgui.h>

namespace plumb {

void measures_panel(PanelContext &context) {
    ImGui::Spacing();
    heading(context.fonts, "Measures");
    const Measures measures = context.session.simulation()->measure();
    value_row("Kinetic energy", number(measures.kinetic_energy, "J"));
    value_row("Potential energy", number(measures.potential_energy, "J"));
    value_row("Linear momentum", number(glm::length(measures.linear_momentum), "kg m/s"));
    value_row("Angular momentum", number(glm::length(measures.angular_momentum), "kg m²/s"));
    value_row("Deepest penetration", number(measures.max_penetration * 1e3, "mm"));
    value_row("Worst joint error", number(measures.max_joint_drift * 1e3, "mm"));
    const Ghost *ghost = context.session.ghost();
    if (ghost && ghost->lag(*context.session.simulation()) == 0)
        value_row(
            "Distance to ghost",
            number(ghost->farthest(*context.session.simulation(), context.session.present()).metres,
                   "m"));
}

} // namespace plumb
