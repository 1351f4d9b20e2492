// The list of scenes, grouped by folder, with a search.
#include "app/sandbox/panel.h"
#include "app/sandbox/widgets.h"

#include <algorithm>
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
    // The open scene is brought into sight once, when it has changed.
    if (open && context.view.scene_in_sight != entry.path) {
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
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < scenes.size(); ++i) {
        const SceneEntry &entry = scenes[i];
        const std::string text = lower(entry.subject + "/" + entry.name + " " + entry.title);
        if (std::ranges::all_of(words, [&](const std::string &word) {
                return text.find(word) != std::string::npos;
            }))
            found.push_back(i);
    }
    return found;
}

void scenes_panel(PanelContext &context) {
    heading(context.fonts, "Scenes",
            shortcut(Action::previous_scene) + "  " + shortcut(Action::next_scene));
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

    const std::vector<std::size_t> found = matching(context.scenes, context.view.search);
    if (entered && !found.empty()) {
        context.open_scene = context.scenes[found.front()].path;
        context.view.search.clear();
    }
    const float buttons = ImGui::GetFrameHeightWithSpacing();
    ImGui::BeginChild("list", {0, -buttons});
    if (found.empty())
        ImGui::TextDisabled(context.scenes.empty() ? "No scenes found." : "No scene has that.");
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
