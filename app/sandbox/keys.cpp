#include "app/sandbox/keys.h"

#include "engine/core/check.h"

#include <algorithm>
#include <array>
#include <optional>

namespace plumb {

namespace {

using namespace special_key;

Chord plain(char32_t key) {
    return {key, false, false};
}
Chord ctrl(char32_t key) {
    return {key, true, false};
}
Chord shift(char32_t key) {
    return {key, false, true};
}

// Nothing past the last action.
std::optional<ActionInfo> row(Action action) {
    switch (action) {
        // clang-format off
    case Action::pause:
        return ActionInfo{action, "Pause",
                          "Pauses or resumes.",
                          Place::transport, false, {plain('p'), plain(' ')}};
    case Action::step:
        return ActionInfo{action, "Step",
                          "One step forward.",
                          Place::transport, true, {plain('.'), plain(right)}};
    case Action::step_5:
        return ActionInfo{action, "5 steps",
                          "Five steps forward.",
                          Place::transport, true, {shift(right)}};
    case Action::step_back:
        return ActionInfo{action, "Step back",
                          "One step back, to the exact state before it.",
                          Place::transport, true, {plain(','), plain(left)}};
    case Action::step_back_5:
        return ActionInfo{action, "5 back",
                          "Five steps back.",
                          Place::transport, true, {shift(left)}};
    case Action::restart:
        return ActionInfo{action, "Restart",
                          "From the start, with the current method and settings.",
                          Place::transport, false, {plain('r'), plain(backspace)}};
    case Action::slower:
        return ActionInfo{action, "Slower",
                          "Half the speed.",
                          Place::transport, true, {plain('-')}};
    case Action::faster:
        return ActionInfo{action, "Faster",
                          "Twice the speed.",
                          Place::transport, true, {plain('='), plain('+')}};
    case Action::find_scene:
        return ActionInfo{action, "Find scene",
                          "Type part of its name; Enter opens the first match.",
                          Place::scenes, false, {ctrl('o')}};
    case Action::previous_scene:
        return ActionInfo{action, "Previous scene",
                          "The one above in the list.",
                          Place::scenes, true, {plain('[')}};
    case Action::next_scene:
        return ActionInfo{action, "Next scene",
                          "The one below in the list.",
                          Place::scenes, true, {plain(']')}};
    case Action::reload:
        return ActionInfo{action, "Reload",
                          "Rereads the file; keeps camera and pause.",
                          Place::scenes, false, {ctrl('l')}};
    case Action::save_scene:
        return ActionInfo{action, "Save",
                          "Writes the current state as a scene file.",
                          Place::scenes, false, {ctrl('s')}};
    case Action::previous_method:
        return ActionInfo{action, "Previous method",
                          "Of those that can run the scene.",
                          Place::settings, true, {plain('<')}};
    case Action::next_method:
        return ActionInfo{action, "Next method",
                          "Of those that can run the scene.",
                          Place::settings, true, {plain('>')}};
    case Action::toggle_contacts:
        return ActionInfo{action, "Contacts",
                          "Contact points, normals and forces; impacts.",
                          Place::view, false, {plain('c')}};
    case Action::toggle_joints:
        return ActionInfo{action, "Joints",
                          "Joints, their anchors and forces.",
                          Place::view, false, {plain('j')}};
    case Action::toggle_wireframe:
        return ActionInfo{action, "Wireframe",
                          "Edges instead of surfaces.",
                          Place::view, false, {plain('w')}};
    case Action::toggle_bounds:
        return ActionInfo{action, "Bounds",
                          "The axis-aligned boxes around bodies.",
                          Place::view, false, {plain('b')}};
    case Action::toggle_velocities:
        return ActionInfo{action, "Velocities",
                          "How far each body moves in a quarter second.",
                          Place::view, false, {plain('v')}};
    case Action::frame:
        return ActionInfo{action, "Frame",
                          "Frames the selected body, or everything that moves.",
                          Place::view, false, {plain('f')}};
    case Action::home:
        return ActionInfo{action, "Home",
                          "The scene's own camera, which follows when everything that moves would leave the view.",
                          Place::view, false, {plain(home)}};
    case Action::toggle_help:
        return ActionInfo{action, "Help",
                          "This list.",
                          Place::general, false, {plain(f1), plain('?')}};
    case Action::toggle_panels:
        return ActionInfo{action, "Hide panels",
                          "Shows the scene alone.",
                          Place::general, false, {plain(tab)}};
    case Action::toggle_diagnostics:
        return ActionInfo{action, "Diagnostics",
                          "Times, energy and measures.",
                          Place::general, false, {plain('m')}};
    case Action::toggle_lab:
        return ActionInfo{action, "Lab",
                          "Plots, the trade-off and a stability map of the running scene.",
                          Place::general, false, {plain('l')}};
    case Action::toggle_ghost:
        return ActionInfo{action, "Ghost",
                          "The same scene by a second method, drawn translucent.",
                          Place::general, false, {plain('g')}};
    case Action::larger_panels:
        return ActionInfo{action, "Larger panels",
                          "Text and panels, by a tenth.",
                          Place::general, true, {ctrl('='), ctrl('+')}};
    case Action::smaller_panels:
        return ActionInfo{action, "Smaller panels",
                          "Text and panels, by a tenth.",
                          Place::general, true, {ctrl('-')}};
    case Action::screenshot:
        return ActionInfo{action, "Screenshot",
                          "Saves the view as a PNG.",
                          Place::general, false, {ctrl('p')}};
    case Action::dismiss:
        return ActionInfo{action, "Back",
                          "Closes a list, help, search or messages; then releases what is held; "
                          "then clears the selection.",
                          Place::general, false, {plain(escape)}};
    case Action::quit:
        return ActionInfo{action, "Quit",
                          "Closes the window.",
                          Place::general, false, {ctrl('q')}};
        // clang-format on
    }
    return {};
}

const std::vector<ActionInfo> &table() {
    static const std::vector<ActionInfo> rows = [] {
        std::vector<ActionInfo> all;
        for (int i = 0; const auto info = row(static_cast<Action>(i)); ++i)
            all.push_back(*info);
        return all;
    }();
    return rows;
}

// UTF-8 of the keys in the table, which are ASCII.
std::string spelled(char32_t key) {
    switch (key) {
    case escape:
        return "Esc";
    case tab:
        return "Tab";
    case backspace:
        return "Backspace";
    case left:
        return "Left";
    case right:
        return "Right";
    case special_key::home:
        return "Home";
    case f1:
        return "F1";
    case U' ':
        return "Space";
    default:
        break;
    }
    PLUMB_CHECK(key > 0x20 && key < 0x7F, "no name for key " << static_cast<unsigned>(key));
    const char upper = static_cast<char>(key >= 'a' && key <= 'z' ? key - 'a' + 'A' : key);
    return std::string(1, upper);
}

// A vertical bar would end the cell.
std::string cell(std::string_view text) {
    std::string escaped;
    for (const char c : text)
        escaped += c == '|' ? std::string("\\|") : std::string(1, c);
    return escaped;
}

} // namespace

std::span<const ActionInfo> actions() {
    return table();
}

const ActionInfo &info(Action action) {
    return table().at(static_cast<std::size_t>(action));
}

const ActionInfo *find_action(const Chord &chord) {
    for (const ActionInfo &row : table())
        if (std::ranges::find(row.chords, chord) != row.chords.end())
            return &row;
    return nullptr;
}

std::span<const MouseInfo> mouse_gestures() {
    static constexpr std::array rows = {
        MouseInfo{"Click", "Select",
                  "The body, particle or cloth under the pointer; empty space deselects."},
        MouseInfo{"Left drag on a disc", "Move a probe", "By one of its points; R puts it back."},
        MouseInfo{"Ctrl + left drag", "Grab",
                  "Pulls what is under the pointer by the point grabbed."},
        MouseInfo{"Shift + click", "Shoot", "A ball from the camera."},
        MouseInfo{"Left drag", "Orbit", "Turns the camera around its target."},
        MouseInfo{"Right drag", "Pan", "Moves the camera sideways."},
        MouseInfo{"Wheel", "Zoom", "In and out."},
    };
    return rows;
}

std::string_view title(Place place) {
    switch (place) {
    case Place::transport:
        return "Time";
    case Place::scenes:
        return "Scenes";
    case Place::settings:
        return "Method";
    case Place::view:
        return "View";
    case Place::general:
        return "General";
    }
    return "";
}

std::string name(const Chord &chord) {
    return (chord.ctrl ? std::string("Ctrl+") : std::string()) +
           (chord.shift ? std::string("Shift+") : std::string()) + spelled(chord.key);
}

std::string shortcut(Action action) {
    return name(info(action).chords.front());
}

std::string shortcuts(const ActionInfo &info) {
    std::string all;
    for (const Chord &chord : info.chords)
        all += (all.empty() ? "" : " or ") + name(chord);
    return all;
}

std::string keys_as_markdown() {
    std::string text = "| keys | action | |\n|---|---|---|\n";
    const auto add = [&](std::string_view keys, std::string_view what, std::string_view about) {
        text += "| " + cell(keys) + " | " + cell(what) + " | " + cell(about) + " |\n";
    };
    for (const ActionInfo &row : table()) {
        std::string keys;
        for (const Chord &chord : row.chords)
            keys += (keys.empty() ? "`" : ", `") + name(chord) + "`";
        add(keys, row.title, row.about);
    }
    for (const MouseInfo &row : mouse_gestures())
        add(row.gesture, row.title, row.about);
    return text;
}

} // namespace plumb
