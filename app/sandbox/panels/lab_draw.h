// Drawing helpers for the lab's tabs.
#pragma once

#include "app/sandbox/panels/panel.h"

#include <string>

namespace plumb {

[[nodiscard]] float small_width(const Fonts &fonts, const std::string &text);
// Dim text in the small font, over the current window.
void small_at(const Fonts &fonts, float x, float y, const std::string &text);

// Colours of curves and methods, distinct among neighbours.
[[nodiscard]] Colour curve_colour(std::size_t curve);
// 0xrrggbb
[[nodiscard]] Colour colour_of_code(unsigned code);

// A "Start" or "Stop" button (true when pressed); then, on the same line, its progress and why it
// failed.
[[nodiscard]] bool study_button(const char *start, bool running, float width);
void study_state(const PanelContext &context, bool running, double done, const std::string &failure,
                 const std::string &hint);

} // namespace plumb
