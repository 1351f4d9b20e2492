// Another method beside the running one: which, and how far it is from it.
#include "app/sandbox/panel.h"
#include "app/sandbox/widgets.h"

#include <imgui/imgui.h>

namespace plumb {

namespace {

std::string title_of(const Ghost &ghost) {
    const std::string method(ghost.simulation().method().title);
    return ghost.is_reference() ? "Reference (" + method + ")" : method;
}

void method_box(PanelContext &context, const Ghost *ghost) {
    ImGui::SetNextItemWidth(16 * ImGui::GetFontSize());
    const std::string shown = ghost ? title_of(*ghost) : "none";
    if (!ImGui::BeginCombo("##ghost", shown.c_str())) {
        tooltip("The method of the ghost, with the settings that the scene has for it.");
        return;
    }
    if (ImGui::Selectable("none", ghost == nullptr))
        context.session.set_ghost("");
    if (ImGui::Selectable("Reference", ghost != nullptr && ghost->is_reference()) &&
        context.session.set_ghost(reference_ghost))
        context.view.ghost_method = reference_ghost;
    tooltip("As accurate as the scene can be run: in double, with a quarter of the step and 16 "
            "substeps. What it cannot keep pace with it follows later.");
    for (const MethodInfo &method : method_infos()) {
        const std::string why = why_not(method, context.session.scene());
        ImGui::BeginDisabled(!why.empty());
        if (ImGui::Selectable(std::string(method.title).c_str(),
                              ghost != nullptr && !ghost->is_reference() &&
                                  ghost->simulation().method().name == method.name) &&
            context.session.set_ghost(std::string(method.name)))
            context.view.ghost_method = method.name;
        ImGui::EndDisabled();
        tooltip(why.empty() ? method.source : std::string_view(why));
    }
    ImGui::EndCombo();
}

} // namespace

void ghost_tab(PanelContext &context) {
    method_box(context, context.session.ghost());
    const Ghost *ghost = context.session.ghost(); // after the choice
    if (!ghost) {
        ImGui::PushTextWrapPos(0);
        ImGui::TextDisabled("A second simulation of the scene by another method, from here on, "
                            "drawn translucent over the first. What is done to the one is done to "
                            "the other. It costs its own time at every step.");
        ImGui::PopTextWrapPos();
        return;
    }
    if (!ghost->failure().empty()) {
        ImGui::TextColored(theme::error, "It stopped: %s.", ghost->failure().c_str());
        return;
    }
    if (const double lag = ghost->lag(*context.session.simulation()); lag > 0) {
        value_row("Lags by", number(lag, "s"));
        ImGui::PushTextWrapPos(0);
        ImGui::TextDisabled(
            "It is too slow to keep pace. Paused, it comes even, and then tells how "
            "far apart the two are.");
        ImGui::PopTextWrapPos();
        return;
    }
    const GhostDistance far =
        ghost->farthest(*context.session.simulation(), context.session.present());
    value_row("Largest distance",
              number(far.metres, "m") + (far.name.empty() ? "" : ", of " + far.name));
    value_row("Energy of the first", number(context.session.simulation()->energy(), "J", 6));
    value_row("Energy of the ghost", number(ghost->simulation().energy(), "J", 6));
}

} // namespace plumb
