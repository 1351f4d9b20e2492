// Logarithmic axes: their range, their ticks, and the numbers at them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace plumb {

struct LogRange {
    double low = 1; // > 0
    double high = 10;
};

// Holds all values that are positive and finite, with some air; at least a decade, so that small
// differences are not blown up. Without such values: 1..10.
[[nodiscard]] LogRange log_range(const std::vector<double> &values);

struct Tick {
    double value = 0;
    bool decade = false; // a whole power of ten: a stronger line
    std::string label;   // empty: a line without a number
};

// Ascending, all within the range. Labels at whole powers of ten, thinned to about `most_labels`;
// where that leaves room also at 2 and 5 times such. Ranges above eight decades have lines at
// powers of ten only.
[[nodiscard]] std::vector<Tick> log_ticks(const LogRange &range, std::string_view unit,
                                          int most_labels = 10);

// Whether short_quantity puts metric prefixes before the unit.
[[nodiscard]] bool takes_prefix(std::string_view unit);

// In a label: what follows is to be raised.
inline constexpr char raised_from = '\x1f';

// A short label. With a unit that takes prefixes (m, s, J, m/s, rad, ...): "20 µm", "1 s", "5 kJ".
// Without ("1"): "0.02", "300", and below 1e-3 and from 1e4 on a power of ten, as "2×10",
// raised_from, "−5".
[[nodiscard]] std::string short_quantity(double value, std::string_view unit);

// 0 at range.low, 1 at range.high.
[[nodiscard]] double log_position(const LogRange &range, double value);

} // namespace plumb
