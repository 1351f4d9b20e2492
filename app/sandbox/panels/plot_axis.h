// The numbers along a plot's axis.
#pragma once

#include <string>
#include <vector>

namespace plumb {

struct PlotTick {
    double value = 0;
    std::string label; // as many digits as tell it from its neighbours
};

struct PlotAxis {
    double low = 0, high = 1;    // low < high
    std::vector<PlotTick> ticks; // at multiples of 1, 2 or 5 times a power of ten, ascending
    // 0 at `low`, 1 at `high`.
    [[nodiscard]] double fraction(double value) const { return (value - low) / (high - low); }
};

// Where a label begins that is as long as `extent` and has its middle at `at`, or as near as it can
// be within the axis from `low` to `high`: so that it touches no label of another axis.
[[nodiscard]] float label_begin(float at, float extent, float low, float high);

// An axis that holds both values, finite and low <= high, with air around them and at most `most`
// (>= 2) ticks. What differs by less than a hundred-thousandth of its size is rounding, and drawn
// flat.
[[nodiscard]] PlotAxis plot_axis(double low, double high, int most);

// The same from end to end, without air: of time.
[[nodiscard]] PlotAxis tight_axis(double low, double high, int most);

} // namespace plumb
