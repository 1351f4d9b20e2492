// Small parts that several panels are made of.
#pragma once

#include "app/sandbox/keys.h"
#include "app/sandbox/theme.h"

#include <string>
#include <string_view>

namespace plumb {

enum class Icon { pause, play, step, step_back, restart, slower, faster };

// A panel's title, dim, with a key at the right end if there is one.
void heading(const Fonts &fonts, std::string_view text, std::string_view key = {});

// What the action does and all its keys, over the last item.
void action_tooltip(Action action);
// Wrapped, over the last item.
void tooltip(std::string_view text);

// A button with a drawn sign; the key stands under it. True when pressed.
[[nodiscard]] bool icon_button(const Fonts &fonts, Icon icon, Action action, float width);
// A button with the action's title, and its key in small.
[[nodiscard]] bool action_button(const Fonts &fonts, Action action, float width);
// A check box with the action's title, and its key in small. True when clicked.
[[nodiscard]] bool action_check_box(const Fonts &fonts, Action action, bool checked, float width);

// A line of two columns: what, and its value at the right end, in the current window.
void value_row(std::string_view what, const std::string &value);
void value_row(std::string_view what, const std::string &value, const Colour &colour);

// Text in the small font and a dim colour.
void small_text(const Fonts &fonts, std::string_view text);

// With so many significant digits; "-" if it is not finite.
[[nodiscard]] std::string number(double value, std::string_view unit = {}, int digits = 4);
[[nodiscard]] std::string milliseconds(double seconds); // "1.25"

[[nodiscard]] ImU32 packed(const Colour &colour, float alpha = 1);

} // namespace plumb
