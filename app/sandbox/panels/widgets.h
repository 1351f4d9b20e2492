// Small parts that several panels are made of.
#pragma once

#include "app/sandbox/keys.h"
#include "app/sandbox/panels/theme.h"

#include <optional>
#include <string>
#include <string_view>

namespace plumb {

enum class Icon { pause, play, step, step_back, restart, slower, faster };

// A panel's title, dim, with a key at the right end if there is one.
void heading(const Fonts &fonts, std::string_view text, std::string_view key = {});

// A sign that points down when something is open, and right when it is closed. True when pressed.
[[nodiscard]] bool fold_sign(const char *id, bool open);
// The same with a title after it, all of which can be pressed, and some small text at the right
// end.
[[nodiscard]] bool fold_title(const Fonts &fonts, std::string_view text, std::string_view at_right,
                              bool open);

// In lines of this width, or as wide as the rest of the line. ImGui's own wrapping would break
// numbers at their points; this breaks at spaces, at non-breaking ones where nothing else helps.
void wrapped(std::string_view text, std::optional<float> width = {});
// All its spaces non-breaking.
[[nodiscard]] std::string unbroken(std::string_view text);

// What the action does and all its keys, over the last item.
void action_tooltip(Action action);
// Wrapped, over the last item.
void tooltip(std::string_view text);

// A button with a drawn sign; the key stands under it. True when pressed.
[[nodiscard]] bool icon_button(const Fonts &fonts, Icon icon, Action action, float width);
// A button with the action's title, and its key in small where there is room for it.
[[nodiscard]] bool action_button(const Fonts &fonts, Action action, float width);
// A check box with the action's title, and its key in small if wanted. True when clicked.
[[nodiscard]] bool action_check_box(const Fonts &fonts, Action action, bool checked, float width,
                                    bool with_key);
// The width that it needs.
[[nodiscard]] float check_box_width(const Fonts &fonts, Action action, bool with_key);

// A line of two columns: what, and its value at the right end, in the current window; two lines
// where it is too narrow.
void value_row(std::string_view what, const std::string &value);
void value_row(std::string_view what, const std::string &value, const Colour &colour);

// A disc of this colour as high as a line of text, in which the eye finds trouble.
void light(const Colour &colour);

// Text in the small font and a dim colour.
void small_text(const Fonts &fonts, std::string_view text);

// With so many significant digits; "-" if it is not finite.
[[nodiscard]] std::string number(double value, std::string_view unit = {}, int digits = 4);
// Three significant digits, in the unit that suits: "1.25 ms", "340 µs", "85 ns".
[[nodiscard]] std::string duration(double seconds);

[[nodiscard]] ImU32 packed(const Colour &colour, float alpha = 1);

} // namespace plumb
