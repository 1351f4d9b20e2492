// Draws curves over time in the current ImGui window: one plot per unit, with axes.
#pragma once

#include "app/sandbox/panels/panel.h"

#include <string_view>

namespace plumb {

// The number of plots, stacked vertically.
[[nodiscard]] std::size_t plot_count(const Plots &plots);
[[nodiscard]] std::string_view shown_unit(const QuantityInfo &quantity); // empty for a ratio

// Draws all plots within this size (pixels), over the time the view asks for. There must be at
// least one.
void draw_plots(const PanelContext &context, ImVec2 size);

} // namespace plumb
