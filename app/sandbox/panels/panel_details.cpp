// The title bar all panels share, and the details panel of the scene and the selected body.
#include "app/sandbox/panels/panel.h"
#include "app/sandbox/panels/widgets.h"

#include <imgui/imgui.h>

namespace plumb {

bool title_sign(PanelContext &context, PanelId panel) {
    const bool open = context.view.is_open(panel);
    if (fold_sign("##fold", open))
        context.view.opened[panel] = !open;
    tooltip(open ? "Collapse" : "Expand");
    return open;
}

bool title_bar(PanelContext &context, PanelId panel, std::string_view title,
               std::string_view at_right) {
    const bool open = context.view.is_open(panel);
    if (fold_title(context.fonts, title, at_right, open))
        context.view.opened[panel] = !open;
    return open;
}

void details_panel(PanelContext &context) {
    // A new selection brings its tab to the front, and deselecting the scene's.
    ViewState &view = context.view;
    const bool changed =
        view.detailed_body != view.selected || view.detailed_particle != view.selected_particle;
    view.detailed_body = view.selected;
    view.detailed_particle = view.selected_particle;
    const bool any = view.selected || view.selected_particle;
    const auto flags = [&](bool wanted) {
        return changed && wanted ? ImGuiTabItemFlags_SetSelected : ImGuiTabItemFlags_None;
    };
    const Simulation *simulation = context.session.simulation();
    if (simulation && !simulation->has_world()) { // and so no bodies
        if (title_bar(context, PanelId::details, "Scene"))
            expectations_panel(context);
        return;
    }
    const bool open = title_sign(context, PanelId::details);
    ImGui::SameLine();
    if (!ImGui::BeginTabBar("details"))
        return;
    const auto tab = [&](const char *title, bool wanted, void (*contents)(PanelContext &)) {
        const bool chosen = ImGui::BeginTabItem(title, nullptr, flags(wanted));
        if (!open && ImGui::IsItemClicked())
            context.view.opened[PanelId::details] = true;
        if (!chosen)
            return;
        if (open)
            contents(context);
        ImGui::EndTabItem();
    };
    tab("Scene", !any, expectations_panel);
    tab("Body", any, inspector_panel);
    ImGui::EndTabBar();
}

} // namespace plumb
