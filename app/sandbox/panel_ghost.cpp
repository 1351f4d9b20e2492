// Another method beside the running one: which, and how far it is from it.
#include "app/sandbox/panel.h"
#include "app/sandbox/widgets.h"

#include <imgui/imgui.h>

namespace plumb {

namespace {

void method_box(PanelContext &context, const Ghost *ghost) {
    ImGui::SetNextItemWidth(16 * ImGui::GetFontSize());
    const std::string shown = ghost ? std::string(ghost->simulation().method().title) : "none";
    if (!ImGui::BeginCombo("##ghost", shown.c_str())) {
        tooltip("The method of the ghost, with the settings that the scene has for it.");
        return;
    }
    if (ImGui::Selectable("none", ghost == nullptr))
        context.session.set_ghost("");
    for (const MethodInfo &method : method_infos()) {
        const std::string why = why_not(method, context.session.scene());
        ImGui::BeginDisabled(!why.empty());
        if (ImGui::Selectable(std::string(method.title).c_str(),
                              ghost != nullptr &&
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
    const GhostDistance far =
        ghost->farthest(*context.session.simulation(), context.session.present());
    value_row("Largest distance",
              number(far.metres, "m") + (far.name.empty() ? "" : ", of " + far.name));
    value_row("Energy of the first", number(context.session.simulation()->energy(), "J", 6));
    value_row("Energy of the ghost", number(ghost->simulation().energy(), "J", 6));
}

} // namespace plumb
