// The lab's view of the running scene.
#include "app/sandbox/panels/panel.h"
#include "app/sandbox/panels/widgets.h"

#include <imgui/imgui.h>

namespace plumb {

void lab_panel(PanelContext &context) {
    if (!ImGui::BeginTabBar("lab"))
        return;
    const auto tab = [&](const char *title, void (*contents)(PanelContext &)) {
        if (!ImGui::BeginTabItem(title))
            return;
        ImGui::BeginChild("contents"); // scrolls under the tabs
        contents(context);
        ImGui::EndChild();
        ImGui::EndTabItem();
    };
    tab("Plots", plots_tab);
    tab("Trade-off", tradeoff_tab);
    tab("Map", map_tab);
    tab("Ghost", ghost_tab);
    ImGui::EndTabBar();
}

} // namespace plumb
