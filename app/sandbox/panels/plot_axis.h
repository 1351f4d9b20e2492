// The ticks and numbers along a plot's axis.
#pragma once

#include <string>
#include <vector>

namespace plumb {

struct PlotTick {
    double value = 0;
    std::string label; // enough digits to tell it from its neighbours
};

struct PlotAxis {
    double low = 0, high = 1;    // low < high
    std::vector<PlotTick> ticks; // at multiples of 1, 2 or 5 times a power of ten, ascending
    // 0 at `low`, 1 at `high`.
    [[nodiscard]] double fraction(double value) const { return (value - low) / (high - low); }
};

// Where a label of length `extent` starts so that it is centred at `at`, or as near as it can be
// within the axis from `low` to `high`: so it touches no label of another axis.
[[nodiscard]] float label_begin(float at, float extent, float low, float high);

// An axis over both values (finite, low <= high), with some margin and at most `most` (>= 2) ticks.
// Values that differ by less than 1e-5 of their size are taken as rounding and drawn flat. A single
// value, low == high, is in the middle, with a tenth of its size on either side.
[[nodiscard]] PlotAxis plot_axis(double low, double high, int most);

// The same without margin, for time; 1 s long if low == high.
[[nodiscard]] PlotAxis tight_axis(double low, double high, int most);

} // namespace plumb
