#include "app/sandbox/panels/plot_axis.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace plumb {

namespace {

// The smallest 1, 2 or 5 times a power of ten that fits into the span at most `most` - 1 times.
double tick_distance(double span, int most) {
    const double least = span / (most - 1);
    const double power = std::pow(10.0, std::floor(std::log10(least)));
    for (const double step : {1.0, 2.0, 5.0})
        if (step * power >= least)
            return step * power;
    return 10 * power;
}

std::string tick_label(double value, double distance, double largest) {
    std::array<char, 48> text{};
    if (value == 0)
        return "0";
    if (largest < 1e5 && distance >= 1e-4) {
        const int decimals =
            std::max(0, -static_cast<int>(std::floor(std::log10(distance) + 1e-9)));
        std::snprintf(text.data(), text.size(), "%.*f", decimals, value);
        return text.data();
    }
    const int digits = 1 + static_cast<int>(std::ceil(std::log10(largest / distance) - 1e-9));
    std::snprintf(text.data(), text.size(), "%.*g", std::clamp(digits, 1, 15), value);
    return text.data();
}

} // namespace

float label_begin(float at, float extent, float low, float high) {
    return std::clamp(at - extent / 2, low, std::max(low, high - extent));
}

PlotAxis tight_axis(double low, double high, int most) {
    PlotAxis axis{low, high > low ? high : low + 1, {}};
    const double distance = tick_distance(axis.high - axis.low, most);
    const double largest = std::max(std::abs(axis.low), std::abs(axis.high));
    const double slack = 1e-9 * distance;
    for (double count = std::ceil((axis.low - slack) / distance);
         count * distance <= axis.high + slack; ++count)
        axis.ticks.push_back({count * distance, tick_label(count * distance, distance, largest)});
    return axis;
}

PlotAxis plot_axis(double low, double high, int most) {
    constexpr double rounding = 1e-5;
    constexpr double air = 0.06; // margin on either side, of the span
    const double middle = low / 2 + high / 2;
    const double size = std::max(std::abs(low), std::abs(high));
    const double least = high > low ? std::max(rounding * size, 1e-12) : size > 0 ? 0.2 * size : 2;
    const double half = std::max((high - low) / 2, least / 2) * (1 + 2 * air);
    return tight_axis(middle - half, middle + half, most);
}

} // namespace plumb
