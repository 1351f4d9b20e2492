// All keys and mouse gestures, from the one list of actions.
#include "app/sandbox/panels/panel.h"
#include "app/sandbox/panels/widgets.h"

#include <array>

#include <imgui/imgui.h>

namespace plumb {

namespace {

void row(std::string_view keys, std::string_view what, std::string_view about) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(what.data(), what.data() + what.size());
    tooltip(about);
    ImGui::TableNextColumn();
    ImGui::TextDisabled("%.*s", static_cast<int>(keys.size()), keys.data());
    tooltip(about);
}

void group(const PanelContext &context, Place place) {
    heading(context.fonts, title(place));
    if (ImGui::BeginTable(std::string(title(place)).c_str(), 2)) {
        for (const ActionInfo &action : actions())
            if (action.place == place)
                row(shortcuts(action), action.title, action.about);
        ImGui::EndTable();
    }
    ImGui::Spacing();
}

void mouse(const PanelContext &context) {
    heading(context.fonts, "Mouse");
    if (ImGui::BeginTable("mouse", 2)) {
        for (const MouseInfo &gesture : mouse_gestures())
            row(gesture.gesture, gesture.title, gesture.about);
        ImGui::EndTable();
    }
}

} // namespace

void help_panel(PanelContext &context) {
    // Two columns of about the same length.
    if (!ImGui::BeginTable("columns", 2))
        return;
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    group(context, Place::transport);
    group(context, Place::view);
    group(context, Place::settings);
    ImGui::TableNextColumn();
    group(context, Place::scenes);
    group(context, Place::general);
    mouse(context);
    ImGui::EndTable();
    small_text(context.fonts, "Esc to close. Point at a row for details.");
}

} // namespace plumb
