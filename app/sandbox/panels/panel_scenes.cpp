// The list of scenes, grouped by folder, with a search box.
#include "app/sandbox/panels/panel.h"
#include "app/sandbox/panels/widgets.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <sstream>
#include <string>

#include <imgui/imgui.h>
#include <imgui/imgui_stdlib.h>

namespace plumb {

namespace {

std::string lower(std::string text) {
    std::ranges::transform(text, text.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

void scene_row(PanelContext &context, const SceneEntry &entry) {
    const bool open = entry.path == context.session.path();
    const std::string label = entry.name + "##" + entry.path.string();
    if (ImGui::Selectable(label.c_str(), open))
        context.open_scene = entry.path;
    if (!entry.title.empty())
        tooltip(entry.title);
    // Scroll to the open scene once, when it changes or the search is cleared.
    if (open && context.view.search.empty() && context.view.scene_in_sight != entry.path) {
        ImGui::SetScrollHereY();
        context.view.scene_in_sight = entry.path;
    }
}

} // namespace

std::vector<std::size_t> matching(std::span<const SceneEntry> scenes, const std::string &search) {
    std::vector<std::string> words;
    std::istringstream stream(lower(search));
    for (std::string word; stream >> word;)
        words.push_back(word);
    const auto has_all = [&](const std::string &text) {
        return std::ranges::all_of(words, [text = lower(text)](const std::string &word) {
            return text.find(word) != std::string::npos;
        });
    };
    std::array<std::vector<std::size_t>, 3> found; // best matches first
    for (std::size_t i = 0; i < scenes.size(); ++i) {
        const SceneEntry &entry = scenes[i];
        const std::string about = entry.name + " " + entry.title;
        if (has_all(entry.name))
            found[0].push_back(i);
        else if (has_all(about))
            found[1].push_back(i);
        else if (has_all(entry.subject + "/" + about))
            found[2].push_back(i);
    }
    for (const std::size_t farther : {1u, 2u})
        found[0].insert(found[0].end(), found[farther].begin(), found[farther].end());
    return found[0];
}

void scenes_panel(PanelContext &context) {
    if (context.view.focus_search)
        context.view.opened[PanelId::scenes] = true;
    if (!title_bar(context, PanelId::scenes, "Scenes",
                   shortcut(Action::previous_scene) + "  " + shortcut(Action::next_scene)))
        return;
    if (context.view.focus_search) {
        ImGui::SetKeyboardFocusHere();
        context.view.focus_search = false;
    }
    ImGui::SetNextItemWidth(-1);
    const std::string hint =
        std::string(info(Action::find_scene).title) + "  " + shortcut(Action::find_scene);
    const bool entered = ImGui::InputTextWithHint("##search", hint.c_str(), &context.view.search,
                                                  ImGuiInputTextFlags_EnterReturnsTrue);
    action_tooltip(Action::find_scene);

    if (!context.view.search.empty())
        context.view.scene_in_sight.clear();
    const std::vector<std::size_t> found = matching(context.scenes, context.view.search);
    if (entered && !found.empty()) {
        context.open_scene = context.scenes[found.front()].path;
        context.view.search.clear();
    }
    const float buttons = ImGui::GetFrameHeightWithSpacing();
    ImGui::BeginChild("list", {0, -buttons});
    if (found.empty())
        ImGui::TextDisabled(context.scenes.empty() ? "No scenes found." : "No match.");
    const std::string *subject = nullptr;
    for (const std::size_t i : found) {
        const SceneEntry &entry = context.scenes[i];
        if (!subject || *subject != entry.subject) {
            subject = &entry.subject;
            if (!entry.subject.empty())
                small_text(context.fonts, entry.subject);
        }
        ImGui::Indent();
        scene_row(context, entry);
        ImGui::Unindent();
    }
    // The list takes all the height the panel allows.
    context.scrolled_height =
        ImGui::GetCursorPosY() - ImGui::GetStyle().ItemSpacing.y - ImGui::GetWindowHeight();
    ImGui::EndChild();

    const float width = (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x) / 2;
    ImGui::BeginDisabled(!context.session.running());
    if (action_button(context.fonts, Action::reload, width))
        context.actions.push_back(Action::reload);
    ImGui::SameLine();
    if (action_button(context.fonts, Action::save_scene, width))
        context.actions.push_back(Action::save_scene);
    ImGui::EndDisabled();
}

} // namespace plumb
