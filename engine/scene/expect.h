// The quantities of motion that a scene can be held to, and how a quantity's course over time is
// boiled down to one number.
#pragma once

#include "engine/dynamics/measures.h"

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <variant>

namespace plumb {

struct BodyState;

// A spring as it is now.
struct SpringState {
    double length = 0;      // m
    double rest_length = 1; // m
};

// A scene at the start, which its relative errors count from.
struct SceneStart {
    Measures measures;
    double momentum_scale = 0;         // kg m/s, sum of m |v|
    double angular_momentum_scale = 0; // kg m^2/s, sum of |r x m v| + |I w|
};

struct QuantityInfo {
    using OfBody = double (*)(const BodyState &now, const BodyState &start);
    using OfSpring = double (*)(const SpringState &now);
    using OfScene = double (*)(const Measures &now, const SceneStart &start);

    std::string_view name;
    std::string_view unit;
    std::variant<OfBody, OfSpring, OfScene> value;
    std::string_view description;
    bool since_start = false;  // counted from t = 0
    bool of_particles = false; // a particle has it as well as a body
    bool of_contacts = false;  // 0 where there are none

    constexpr bool needs_body() const { return std::holds_alternative<OfBody>(value); }
    constexpr bool needs_spring() const { return std::holds_alternative<OfSpring>(value); }
};

// All quantities, in the order in which they are to be listed.
std::span<const QuantityInfo> quantities();

const QuantityInfo *find_quantity(std::string_view name); // null when there is none

// The change of a conserved quantity, made dimensionless by a scale taken at the start. A scale of
// zero (a scene at rest, say) leaves the change as it is, in its own unit.
//
// The scales are sums of magnitudes, so that terms that cancel at the start (two bodies flying
// apart) do not make the error infinite:
//   energy_error             change E - E0,      scale K0 + |U0|
//   linear_momentum_error    change |p - p0|,    scale sum of m |v| at the start
//   angular_momentum_error   change |L - L0|,    scale sum of |r x m v| + |I w| at the start
// with E = K + U; K the kinetic energy and U = sum of -m g.r the potential energy of all dynamic
// bodies and particles, springs' and attractors' added; r from the world's origin; p, L their
// momenta, L about the world's origin; 0 marks t = 0.
double relative_change(double change, double scale_at_start);

enum class Reduction { last, min, max, mean, max_abs, drift, period, crossings, first_crossing };

struct ReductionInfo {
    std::string_view name;
    Reduction reduction;
    bool uses_level;
    std::string_view description;
    // Its value never falls (rises) as the window grows; not where `level` is left to min and max.
    bool only_rises = false, only_falls = false;
    bool of_distance = false; // it also reduces how far a quantity is from a curve
};

std::span<const ReductionInfo> reductions();

const ReductionInfo *find_reduction(std::string_view name); // null when there is none

// Boils samples down to one number. `times` (s) ascend strictly and are as many as `values`.
//   last, min, max    as named
//   mean              over time, by the trapezoidal rule
//   max_abs           largest |x|
//   drift             largest |x - x_first|
//   period            mean time (s) between successive upward crossings of `level`, each placed by
//                     linear interpolation between two samples; NaN with fewer than two crossings
//   crossings         how often x - level changes sign; samples that lie exactly on the level count
//                     for neither side
//   first_crossing    when it first does so, in s from the first sample, placed as for `period`;
//                     the last sample's time where it never does
// `level` is by default midway between the smallest and the largest value. No samples give NaN, and
// so does any value that is NaN.
double reduce(std::span<const double> times, std::span<const double> values, Reduction reduction,
              std::optional<double> level = std::nullopt);

// A curve has at least so many values: those that a cubic goes through.
inline constexpr std::size_t least_curve = 4;

// Of the curve whose values stand evenly over [from, to], from < to: at `time`, which is clamped to
// that, by the cubic through the four nearest values. Of a function f it is off by at most
// h^4 max|f''''| / 24 in the first and the last of the intervals h, and by 3/128 of h^4 max|f''''|
// in all others: of fourth order up to its ends, where a natural spline is of second order, and
// Catmull-Rom of third throughout.
double curve_at(std::span<const double> values, double from, double to, double time);

} // namespace plumb
