// The ghost: which method runs beside the current one, and how far apart they are.
#include "app/sandbox/panels/panel.h"
#include "app/sandbox/panels/widgets.h"

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
        tooltip("The ghost's method, with the scene's settings for it.");
        return;
    }
    if (ImGui::Selectable("none", ghost == nullptr))
        context.session.set_ghost("");
    if (ImGui::Selectable("Reference", ghost != nullptr && ghost->is_reference()) &&
        context.session.set_ghost(reference_ghost))
        context.view.ghost_method = reference_ghost;
    tooltip("The most accurate run of the scene: in double precision, with a quarter of the step "
            "and 16 substeps. If it is too slow, it lags behind and catches up later.");
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
    const Ghost *ghost = context.session.ghost(); // read after the choice
    if (!ghost) {
        ImGui::PushTextWrapPos(0);
        ImGui::TextDisabled("Also runs the scene with another method, from now on, and draws it "
                            "translucent over the first. What you do to one happens to both. "
                            "Every step takes longer.");
        ImGui::PopTextWrapPos();
        return;
    }
    if (!ghost->failure().empty()) {
        ImGui::TextColored(theme::error, "Stopped: %s.", ghost->failure().c_str());
        return;
    }
    if (const double lag = ghost->lag(*context.session.simulation()); lag > 0) {
        value_row("Lags by", number(lag, "s"));
        ImGui::PushTextWrapPos(0);
        ImGui::TextDisabled(
            "Too slow to keep up. Pause to let it catch up and see how far apart the two are.");
        ImGui::PopTextWrapPos();
        return;
    }
    const GhostDistance far =
        ghost->farthest(*context.session.simulation(), context.session.present());
    value_row("Largest distance",
              number(far.metres, "m") + (far.name.empty() ? "" : ", " + far.name));
    value_row("Energy", number(context.session.simulation()->energy(), "J", 6));
    value_row("Ghost's energy", number(ghost->simulation().energy(), "J", 6));
}

} // namespace plumb
