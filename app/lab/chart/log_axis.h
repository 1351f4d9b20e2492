// Logarithmic axes: range, ticks and tick labels.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace plumb {

struct LogRange {
    double low = 1; // > 0
    double high = 10;
};

// Covers all positive finite values with some margin; at least a decade, so small differences are
// not blown up. 1..10 if there are none.
[[nodiscard]] LogRange log_range(const std::vector<double> &values);

struct Tick {
    double value = 0;
    bool decade = false; // a power of ten, drawn stronger
    std::string label;   // empty: unlabelled line
};

// Ascending, all within the range. Labels at powers of ten, thinned to about `most_labels`; also at
// 2 and 5 times these if there is room. Ranges above eight decades have lines at powers of ten
// only.
[[nodiscard]] std::vector<Tick> log_ticks(const LogRange &range, std::string_view unit,
                                          int most_labels = 10);

// Whether short_quantity puts metric prefixes before the unit.
[[nodiscard]] bool takes_prefix(std::string_view unit);

// In a label: the rest is superscript.
inline constexpr char raised_from = '\x1f';

// A short label. With a unit that takes prefixes (m, s, J, m/s, rad, ...): "20 µm", "1 s", "5 kJ".
// Without ("1"): "0.02", "300", and below 1e-3 or from 1e4 up a power of ten: "2×10", raised_from,
// "−5".
[[nodiscard]] std::string short_quantity(double value, std::string_view unit);

// 0 at range.low, 1 at range.high.
[[nodiscard]] double log_position(const LogRange &range, double value);

} // namespace plumb
