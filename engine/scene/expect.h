// The quantities of motion that a scene can be held to, and how a quantity's time series is reduced
// to one number.
#pragma once

#include "engine/dynamics/kinds.h"
#include "engine/dynamics/measures.h"

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <variant>

#include <glm/gtc/quaternion.hpp>

namespace plumb {

struct BodyState;
struct JointView;

// What a body's energy depends on besides its motion. A particle has no moments.
struct BodyInertia {
    double mass = 0;             // kg; 0: static or kinematic
    glm::dvec3 moments{0};       // kg m^2, principal
    glm::dquat axes{1, 0, 0, 0}; // the principal axes, in the body's frame
};

// A spring as it is now.
struct SpringState {
    double length = 0;      // m
    double rest_length = 1; // m
};

// The scene's initial state, the reference for relative errors.
struct SceneStart {
    Measures measures;
    double momentum_scale = 0;         // kg m/s, sum of m |v|
    double angular_momentum_scale = 0; // kg m^2/s, sum of |r x m v| + |I w|
};

struct QuantityInfo {
    using OfBody = double (*)(const BodyState &now, const BodyState &start);
    using OfMass = double (*)(const BodyState &now, const BodyInertia &mass);
    using OfSpring = double (*)(const SpringState &now);
    using OfJoint = double (*)(const JointView &now);
    using OfScene = double (*)(const Measures &now, const SceneStart &start);

    std::string_view name;
    std::string_view unit;
    std::variant<OfBody, OfMass, OfSpring, OfJoint, OfScene> value;
    std::string_view description;
    bool since_start = false;  // counted from t = 0
    bool of_particles = false; // particles have it as well as bodies
    bool of_contacts = false;  // 0 where there are none
    // Which joints have it: all, or those that turn or move along a free coordinate.
    enum class Joints { all, turning, sliding } joints = Joints::all;

    constexpr bool needs_body() const {
        return std::holds_alternative<OfBody>(value) || std::holds_alternative<OfMass>(value);
    }
    constexpr bool needs_spring() const { return std::holds_alternative<OfSpring>(value); }
    constexpr bool needs_joint() const { return std::holds_alternative<OfJoint>(value); }
    // The key in scene files that names what it is measured on; empty: the whole scene.
    constexpr std::string_view subject() const {
        return needs_body() ? "body" : needs_spring() ? "spring" : needs_joint() ? "joint" : "";
    }
};

// Whether joints of this type have a quantity of joints.
bool has_quantity(JointType type, const QuantityInfo &quantity);

// All quantities, in listing order.
std::span<const QuantityInfo> quantities();

const QuantityInfo *find_quantity(std::string_view name); // null when there is none

// The change of a conserved quantity, made dimensionless by a scale taken at the start. A scale of
// zero (a scene at rest, say) leaves the change in its own unit.
//
// The scales are sums of magnitudes, so that terms that cancel at the start (two bodies flying
// apart) do not make the error infinite:
//   energy_error             change E - E0,      scale K0 + |U0|
//   linear_momentum_error    change |p - p0|,    scale sum of m |v| at the start
//   angular_momentum_error   change |L - L0|,    scale sum of |r x m v| + |I w| at the start
// with E = K + U; K the kinetic energy and U = sum of -m g.r the potential energy of all dynamic
// bodies and particles, plus that of springs and attractors; r from the world origin; p and L their
// momenta, L about the world origin; 0 marks t = 0.
double relative_change(double change, double scale_at_start);

enum class Reduction { last, min, max, mean, max_abs, drift, period, crossings, first_crossing };

struct ReductionInfo {
    std::string_view name;
    Reduction reduction;
    bool uses_level;
    std::string_view description;
    // Its value never falls (rises) as the window grows; not with the default `level`.
    bool only_rises = false, only_falls = false;
    bool of_distance = false; // also reduces a quantity's distance from a curve
};

std::span<const ReductionInfo> reductions();

const ReductionInfo *find_reduction(std::string_view name); // null when there is none

// Reduces samples to one number. `times` (s) ascend strictly, one per value.
//   last, min, max    as named
//   mean              over time, by the trapezoidal rule
//   max_abs           largest |x|
//   drift             largest |x - x_first|
//   period            mean time (s) between successive upward crossings of `level`, each placed by
//                     linear interpolation between two samples; NaN with fewer than two crossings
//   crossings         how often x - level changes sign; samples exactly on the level count for
//                     neither side
//   first_crossing    when it first changes sign, in s from the first sample, placed as for
//                     `period`; the last sample's time if it never does
// `level` defaults to midway between the smallest and the largest value. No samples, or any NaN
// value, give NaN.
double reduce(std::span<const double> times, std::span<const double> values, Reduction reduction,
              std::optional<double> level = std::nullopt);

// A curve has at least this many values: enough for a cubic.
inline constexpr std::size_t least_curve = 4;

// Interpolates a curve, sampled evenly over [from, to] with from < to, at `time` (clamped to that)
// by the cubic through the four nearest values. For a function f sampled at intervals h the error
// is at most h^4 max|f''''| / 24 in the first and last interval and 3/128 h^4 max|f''''| in the
// others: fourth order up to the ends, where a natural spline is second order; Catmull-Rom is third
// order throughout.
double curve_at(std::span<const double> values, double from, double to, double time);

} // namespace plumb
