// Every sandbox action and its keys: the single list behind the keyboard, the panels' labels, the
// help and the README's table.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace plumb {

// In help order.
enum class Action {
    pause,
    step,
    step_5,
    step_back,
    step_back_5,
    restart,
    slower,
    faster,
    find_scene,
    previous_scene,
    next_scene,
    reload,
    save_scene,
    previous_method,
    next_method,
    toggle_contacts,
    toggle_joints,
    toggle_wireframe,
    toggle_bounds,
    toggle_velocities,
    frame,
    home,
    toggle_help,
    toggle_panels,
    toggle_diagnostics,
    toggle_lab,
    toggle_ghost,
    larger_panels,
    smaller_panels,
    screenshot,
    dismiss,
    quit,
};

// A key as the character it types, in lower case ('p', '?', ' '), or one of these.
namespace special_key {
inline constexpr char32_t escape = 0x110000; // beyond Unicode
inline constexpr char32_t tab = 0x110001;
inline constexpr char32_t backspace = 0x110002;
inline constexpr char32_t left = 0x110003;
inline constexpr char32_t right = 0x110004;
inline constexpr char32_t home = 0x110005;
inline constexpr char32_t f1 = 0x110006;
} // namespace special_key

// A key with its modifiers. For symbols, Shift is already part of the character ('?'), so `shift`
// is only set for special keys.
struct Chord {
    char32_t key = 0;
    bool ctrl = false;
    bool shift = false;
    friend bool operator==(const Chord &, const Chord &) = default;
};

// Where an action's control is, and so where its keys are shown.
enum class Place { transport, scenes, settings, view, general };

struct ActionInfo {
    Action action;
    std::string_view title; // "Step back"
    std::string_view about; // a sentence for the tooltip and the help
    Place place = Place::general;
    bool repeats = false;      // acts repeatedly while the key is held
    std::vector<Chord> chords; // never empty; the control shows the first
};

// In help order; each action once.
[[nodiscard]] std::span<const ActionInfo> actions();
[[nodiscard]] const ActionInfo &info(Action action);
// Null if no action has this chord.
[[nodiscard]] const ActionInfo *find_action(const Chord &chord);

struct MouseInfo {
    std::string_view gesture; // "Ctrl + left drag"
    std::string_view title;
    std::string_view about;
};
[[nodiscard]] std::span<const MouseInfo> mouse_gestures();

[[nodiscard]] std::string_view title(Place place);
[[nodiscard]] std::string name(const Chord &chord);          // "Ctrl+L", "Shift+Right", "?"
[[nodiscard]] std::string shortcut(Action action);           // the first chord's name
[[nodiscard]] std::string shortcuts(const ActionInfo &info); // all of them: "P or Space"

// Both lists as a Markdown table, for the README.
[[nodiscard]] std::string keys_as_markdown();

} // namespace plumb
