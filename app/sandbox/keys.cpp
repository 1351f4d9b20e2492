#include "app/sandbox/keys.h"

#include "engine/core/check.h"

#include <algorithm>
#include <array>

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

const std::vector<ActionInfo> &table() {
    static const std::vector<ActionInfo> rows = {
        // clang-format off
        {Action::pause, "Pause",
         "Stops and goes on.",
         Place::transport, false, {plain('p'), plain(' ')}},
        {Action::step, "Step",
         "One step on.",
         Place::transport, true, {plain('.'), plain(right)}},
        {Action::step_5, "5 steps",
         "Five steps on.",
         Place::transport, true, {shift(right)}},
        {Action::step_back, "Step back",
         "One step back, to the very state before it.",
         Place::transport, true, {plain(','), plain(left)}},
        {Action::step_back_5, "5 back",
         "Five steps back.",
         Place::transport, true, {shift(left)}},
        {Action::restart, "Restart",
         "From the start, with the method and settings chosen.",
         Place::transport, false, {plain('r'), plain(backspace)}},
        {Action::slower, "Slower",
         "Half the speed.",
         Place::transport, true, {plain('-')}},
        {Action::faster, "Faster",
         "Twice the speed.",
         Place::transport, true, {plain('='), plain('+')}},
        {Action::find_scene, "Find scene",
         "Type a part of its name; Enter opens the first.",
         Place::scenes, false, {ctrl('o')}},
        {Action::previous_scene, "Previous scene",
         "The one above in the list.",
         Place::scenes, true, {plain('[')}},
        {Action::next_scene, "Next scene",
         "The one below in the list.",
         Place::scenes, true, {plain(']')}},
        {Action::reload, "Reload",
         "Reads the file again; camera and pause stay.",
         Place::scenes, false, {ctrl('l')}},
        {Action::save_scene, "Save",
         "Writes the present state as a scene file.",
         Place::scenes, false, {ctrl('s')}},
        {Action::previous_method, "Previous method",
         "Of those that can run the scene.",
         Place::settings, true, {plain('<')}},
        {Action::next_method, "Next method",
         "Of those that can run the scene.",
         Place::settings, true, {plain('>')}},
        {Action::toggle_contacts, "Contacts",
         "Contact points, normals and forces; impacts.",
         Place::view, false, {plain('c')}},
        {Action::toggle_joints, "Joints",
         "Joints and their anchors.",
         Place::view, false, {plain('j')}},
        {Action::toggle_wireframe, "Wireframe",
         "Edges instead of surfaces.",
         Place::view, false, {plain('w')}},
        {Action::toggle_bounds, "Bounds",
         "The axis-aligned boxes around bodies.",
         Place::view, false, {plain('b')}},
        {Action::toggle_velocities, "Velocities",
         "How far each body goes in a quarter second.",
         Place::view, false, {plain('v')}},
        {Action::frame, "Frame",
         "Shows the selected body, or all that moves.",
         Place::view, false, {plain('f')}},
        {Action::home, "Home",
         "The scene's own camera, which goes along when all that moves would leave the picture.",
         Place::view, false, {plain(home)}},
        {Action::toggle_help, "Help",
         "This list.",
         Place::general, false, {plain(f1), plain('?')}},
        {Action::toggle_panels, "Hide panels",
         "Shows the scene alone.",
         Place::general, false, {plain(tab)}},
        {Action::toggle_diagnostics, "Diagnostics",
         "Times, energy and measures.",
         Place::general, false, {plain('m')}},
        {Action::larger_panels, "Larger panels",
         "Text and panels, by a tenth.",
         Place::general, true, {ctrl('='), ctrl('+')}},
        {Action::smaller_panels, "Smaller panels",
         "Text and panels, by a tenth.",
         Place::general, true, {ctrl('-')}},
        {Action::screenshot, "Screenshot",
         "Writes what is seen as a PNG.",
         Place::general, false, {ctrl('p')}},
        {Action::dismiss, "Back",
         "Closes help, search or messages; then lets go the selection.",
         Place::general, false, {plain(escape)}},
        {Action::quit, "Quit",
         "Closes the window.",
         Place::general, false, {ctrl('q')}},
        // clang-format on
    };
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
    const auto found = std::ranges::find(table(), action, &ActionInfo::action);
    PLUMB_CHECK(found != table().end(), "action " << static_cast<int>(action) << " has no row");
    return *found;
}

const ActionInfo *find_action(const Chord &chord) {
    for (const ActionInfo &row : table())
        if (std::ranges::find(row.chords, chord) != row.chords.end())
            return &row;
    return nullptr;
}

std::span<const MouseInfo> mouse_gestures() {
    static constexpr std::array rows = {
        MouseInfo{"Click", "Select", "The body under the pointer; beside all, none."},
        MouseInfo{"Left drag on a disc", "Move a probe", "By one of its points; R puts it back."},
        MouseInfo{"Ctrl + left drag", "Grab", "Pulls the body by the point that was grabbed."},
        MouseInfo{"Shift + click", "Shoot", "A ball from the camera."},
        MouseInfo{"Left drag", "Orbit", "Turns the camera around its target."},
        MouseInfo{"Right drag", "Pan", "Moves the camera sideways."},
        MouseInfo{"Wheel", "Zoom", "Nearer and farther."},
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
