#include "app/lab/chart/log_axis.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>

namespace plumb {

namespace {

std::string plain(double value, int digits = 3) {
    char text[48];
    std::snprintf(text, sizeof text, "%.*g", digits, value);
    std::string all = text;
    if (!all.empty() && all.front() == '-')
        all.replace(0, 1, "−");
    return all;
}

// m and n with value = m * 10^n and 1 <= |m| < 10 after rounding to three digits.
std::pair<double, int> scientific(double value) {
    char text[48];
    std::snprintf(text, sizeof text, "%.2e", value);
    const std::string all = text;
    const std::size_t e = all.find('e');
    return {std::strtod(all.substr(0, e).c_str(), nullptr), std::atoi(all.c_str() + e + 1)};
}

} // namespace

bool takes_prefix(std::string_view unit) {
    // Not kg, which has one already, and not "1".
    constexpr std::array<std::string_view, 9> units{"m",     "s", "J",   "N",  "rad",
                                                    "rad/s", "W", "m/s", "N s"};
    return std::find(units.begin(), units.end(), unit) != units.end();
}

LogRange log_range(const std::vector<double> &values) {
    double low = std::numeric_limits<double>::infinity(), high = 0;
    for (const double value : values)
        if (value > 0 && std::isfinite(value)) {
            low = std::min(low, value);
            high = std::max(high, value);
        }
    if (high == 0)
        return {};
    double a = std::log10(low), b = std::log10(high);
    const double lack = 1 - (b - a);
    if (lack > 0) {
        a -= lack / 2;
        b += lack / 2;
    }
    const double air = 0.07 * (b - a);
    // Clamped to the range of a double, so ticks stay finite and above zero.
    return {std::pow(10, std::max(a - air, -300.0)), std::pow(10, std::min(b + air, 300.0))};
}

double log_position(const LogRange &range, double value) {
    return std::log10(value / range.low) / std::log10(range.high / range.low);
}

std::vector<Tick> log_ticks(const LogRange &range, std::string_view unit, int most_labels) {
    const double decades = std::log10(range.high / range.low);
    const int first = static_cast<int>(std::floor(std::log10(range.low))) - 1;
    const int last = static_cast<int>(std::ceil(std::log10(range.high))) + 1;
    const int stride = std::max(1, static_cast<int>(std::ceil(decades / std::max(1, most_labels))));
    const bool fine_labels = 3 * decades <= most_labels;
    std::vector<Tick> ticks;
    for (int exponent = first; exponent <= last; ++exponent)
        for (int digit = 1; digit <= 9; ++digit) {
            if (digit > 1 && decades > 8)
                break;
            // Via text, to get exactly the double nearest to digit * 10^exponent.
            char text[24];
            std::snprintf(text, sizeof text, "%de%d", digit, exponent);
            const double value = std::strtod(text, nullptr);
            if (value < range.low || value > range.high)
                continue;
            Tick tick{value, digit == 1, ""};
            const bool labelled = digit == 1 ? ((exponent % stride) + stride) % stride == 0
                                             : fine_labels && (digit == 2 || digit == 5);
            if (labelled)
                tick.label = short_quantity(value, unit);
            ticks.push_back(std::move(tick));
        }
    return ticks;
}

std::string short_quantity(double value, std::string_view unit) {
    if (value == 0)
        return unit == "1" || unit.empty() ? "0" : "0 " + std::string(unit);
    if (!std::isfinite(value))
        return std::isnan(value) ? "nan" : "∞";
    const auto [mantissa, exponent] = scientific(value);
    if (takes_prefix(unit)) {
        constexpr std::array<std::string_view, 9> prefixes{"p", "n", "µ", "m", "",
                                                           "k", "M", "G", "T"};
        const int group =
            static_cast<int>(std::floor(static_cast<double>(exponent) / 3)); // rounds down
        if (group >= -4 && group <= 4)
            return plain(mantissa * std::pow(10, exponent - 3 * group)) + " " +
                   std::string(prefixes[static_cast<std::size_t>(group + 4)]) + std::string(unit);
    }
    const std::string suffix = unit == "1" || unit.empty() ? "" : " " + std::string(unit);
    if (exponent >= -3 && exponent <= 3)
        return plain(value, 4) + suffix;
    const std::string power = std::string("10") + raised_from +
                              std::string(exponent < 0 ? "−" : "") +
                              std::to_string(std::abs(exponent));
    // No unit: it would have to follow the superscript.
    const std::string head = mantissa == 1 ? "" : plain(mantissa) + "×";
    return head + power;
}

} // namespace plumb
