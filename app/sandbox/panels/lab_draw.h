// What the lab's tabs draw with.
#pragma once

#include "app/sandbox/panels/panel.h"

#include <string>

namespace plumb {

[[nodiscard]] float small_width(const Fonts &fonts, const std::string &text);
// In the small font and a dim colour, over the current window.
void small_at(const Fonts &fonts, float x, float y, const std::string &text);
// So that it is legible over what lies below.
void small_on_ground(const Fonts &fonts, float x, float y, const std::string &text);

// Of curves and methods, distinct among neighbours.
[[nodiscard]] Colour curve_colour(std::size_t curve);
// 0xrrggbb
[[nodiscard]] Colour colour_of_code(unsigned code);

// "Start" or "Stop" (true when pressed), how far it is, and why it failed, in the current line.
// `ready` is false where it cannot start.
[[nodiscard]] bool study_button(const char *start, bool running, float width);
void study_state(const PanelContext &context, bool running, double done, const std::string &failure,
                 const std::string &hint);

} // namespace plumb
