// Curves over time in the current ImGui window: those of one unit in one plot, with axes.
#pragma once

#include "app/sandbox/panels/panel.h"

#include <string_view>

namespace plumb {

// How many plots there are, one below the other.
[[nodiscard]] std::size_t plot_count(const Plots &plots);
[[nodiscard]] std::string_view shown_unit(const QuantityInfo &quantity); // empty for a ratio

// All of them in this size, pixels, over the time that the view asks for; there is one at least.
void draw_plots(const PanelContext &context, ImVec2 size);

} // namespace plumb
