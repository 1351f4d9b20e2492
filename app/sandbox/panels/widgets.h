// Small widgets shared by several panels.
#pragma once

#include "app/sandbox/keys.h"
#include "app/sandbox/panels/theme.h"

#include <optional>
#include <string>
#include <string_view>

namespace plumb {

enum class Icon { pause, play, step, step_back, restart, slower, faster };

// A dim heading, with a key at the right end if there is one.
void heading(const Fonts &fonts, std::string_view text, std::string_view key = {});

// An arrow that points down when open and right when closed. True when pressed.
[[nodiscard]] bool fold_sign(const char *id, bool open);
// The same followed by a title, the whole of which can be pressed, and some small text at the right
// end.
[[nodiscard]] bool fold_title(const Fonts &fonts, std::string_view text, std::string_view at_right,
                              bool open);

// Wraps to this width, or to the rest of the line. ImGui's own wrapping would break numbers at
// decimal points; this breaks at spaces, and at non-breaking ones only if nothing else helps.
void wrapped(std::string_view text, std::optional<float> width = {});
// Makes all spaces non-breaking.
[[nodiscard]] std::string unbroken(std::string_view text);

// A tooltip on the last item: what the action does and all its keys.
void action_tooltip(Action action);
// A wrapped tooltip on the last item.
void tooltip(std::string_view text);

// A button with a drawn icon and its key below. True when pressed.
[[nodiscard]] bool icon_button(const Fonts &fonts, Icon icon, Action action, float width);
// A button with the action's title, and its key in small if there is room.
[[nodiscard]] bool action_button(const Fonts &fonts, Action action, float width);
// A check box with the action's title, and its key in small if wanted. True when clicked.
[[nodiscard]] bool action_check_box(const Fonts &fonts, Action action, bool checked, float width,
                                    bool with_key);
// The width such a check box needs.
[[nodiscard]] float check_box_width(const Fonts &fonts, Action action, bool with_key);

// A row in the current window: a label, and its value at the right end; two lines if too narrow.
void value_row(std::string_view what, const std::string &value);
void value_row(std::string_view what, const std::string &value, const Colour &colour);

// A disc of this colour, as high as a line of text, that draws the eye to trouble.
void light(const Colour &colour);

// Dim text in the small font.
void small_text(const Fonts &fonts, std::string_view text);

// With this many significant digits; "-" if not finite.
[[nodiscard]] std::string number(double value, std::string_view unit = {}, int digits = 4);
// Three significant digits in a suitable unit: "1.25 ms", "340 µs", "85 ns".
[[nodiscard]] std::string duration(double seconds);

[[nodiscard]] ImU32 packed(const Colour &colour, float alpha = 1);

} // namespace plumb
