#include "engine/scene/expect.h"

#include "engine/core/check.h"
#include "engine/scene/joint_type.h"
#include "engine/scene/simulation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

namespace plumb {

namespace {

// The angle between two directions, in [0, pi]. Uses atan2 because acos loses half its digits near
// 0 and pi.
double angle_between(const glm::dvec3 &a, const glm::dvec3 &b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

glm::dvec3 up(const BodyState &body) {
    return body.orientation * glm::dvec3(0, 1, 0);
}

glm::dvec3 local_spin(const BodyState &body) {
    return glm::conjugate(body.orientation) * body.angular_velocity;
}

double kinetic_energy(const BodyState &now, const BodyInertia &mass) {
    const glm::dvec3 spin = glm::conjugate(mass.axes) * local_spin(now);
    return 0.5 * mass.mass * glm::dot(now.velocity, now.velocity) +
           0.5 * glm::dot(mass.moments * spin, spin);
}

constexpr std::array all_quantities{
    QuantityInfo{"position.x", "m",
                 [](const BodyState &now, const BodyState &) { return now.position.x; },
                 "centre of mass, world", false, true},
    QuantityInfo{"position.y", "m",
                 [](const BodyState &now, const BodyState &) { return now.position.y; },
                 "centre of mass, world", false, true},
    QuantityInfo{"position.z", "m",
                 [](const BodyState &now, const BodyState &) { return now.position.z; },
                 "centre of mass, world", false, true},
    QuantityInfo{"velocity.x", "m/s",
                 [](const BodyState &now, const BodyState &) { return now.velocity.x; },
                 "of the centre of mass, world", false, true},
    QuantityInfo{"velocity.y", "m/s",
                 [](const BodyState &now, const BodyState &) { return now.velocity.y; },
                 "of the centre of mass, world", false, true},
    QuantityInfo{"velocity.z", "m/s",
                 [](const BodyState &now, const BodyState &) { return now.velocity.z; },
                 "of the centre of mass, world", false, true},
    QuantityInfo{"speed", "m/s",
                 [](const BodyState &now, const BodyState &) { return glm::length(now.velocity); },
                 "length of the velocity", false, true},
    QuantityInfo{"angular_velocity.x", "rad/s",
                 [](const BodyState &now, const BodyState &) { return now.angular_velocity.x; },
                 "world frame"},
    QuantityInfo{"angular_velocity.y", "rad/s",
                 [](const BodyState &now, const BodyState &) { return now.angular_velocity.y; },
                 "world frame"},
    QuantityInfo{"angular_velocity.z", "rad/s",
                 [](const BodyState &now, const BodyState &) { return now.angular_velocity.z; },
                 "world frame"},
    QuantityInfo{
        "angular_speed", "rad/s",
        [](const BodyState &now, const BodyState &) { return glm::length(now.angular_velocity); },
        "length of the angular velocity"},
    QuantityInfo{"angular_velocity_local.x", "rad/s",
                 [](const BodyState &now, const BodyState &) { return local_spin(now).x; },
                 "body's frame"},
    QuantityInfo{"angular_velocity_local.y", "rad/s",
                 [](const BodyState &now, const BodyState &) { return local_spin(now).y; },
                 "body's frame"},
    QuantityInfo{"angular_velocity_local.z", "rad/s",
                 [](const BodyState &now, const BodyState &) { return local_spin(now).z; },
                 "body's frame"},
    QuantityInfo{"displacement", "m",
                 [](const BodyState &now, const BodyState &start) {
                     return glm::length(now.position - start.position);
                 },
                 "distance of the centre of mass from where it was at t = 0", true, true},
    QuantityInfo{"tilt", "rad",
                 [](const BodyState &now, const BodyState &start) {
                     return angle_between(up(now), up(start));
                 },
                 "angle between the body's y axis and where it pointed at t = 0, 0..pi", true},
    QuantityInfo{"body_kinetic_energy", "J", kinetic_energy,
                 "of this one: m v.v / 2 + w.I w / 2; 0 unless it is dynamic", false, true},
    QuantityInfo{"joint_force", "N", [](const JointView &now) { return glm::length(now.force); },
                 "length of the force on `body_b` at its anchor, mean over the last substep"},
    QuantityInfo{"joint_force.x", "N", [](const JointView &now) { return now.force.x; },
                 "that force, world"},
    QuantityInfo{"joint_force.y", "N", [](const JointView &now) { return now.force.y; },
                 "that force, world"},
    QuantityInfo{"joint_force.z", "N", [](const JointView &now) { return now.force.z; },
                 "that force, world"},
    QuantityInfo{"joint_torque", "N m",
                 [](const JointView &now) { return glm::length(now.torque); },
                 "length of the torque on `body_b` about its anchor, mean over the last substep"},
    QuantityInfo{"joint_torque.x", "N m", [](const JointView &now) { return now.torque.x; },
                 "that torque, world"},
    QuantityInfo{"joint_torque.y", "N m", [](const JointView &now) { return now.torque.y; },
                 "that torque, world"},
    QuantityInfo{"joint_torque.z", "N m", [](const JointView &now) { return now.torque.z; },
                 "that torque, world"},
    QuantityInfo{.name = "joint_angle",
                 .unit = "rad",
                 .value = [](const JointView &now) { return now.position; },
                 .description = "angle of a hinge, -pi..pi",
                 .joints = QuantityInfo::Joints::turning},
    QuantityInfo{.name = "joint_angle_rate",
                 .unit = "rad/s",
                 .value = [](const JointView &now) { return now.speed; },
                 .description = "how fast that angle grows",
                 .joints = QuantityInfo::Joints::turning},
    QuantityInfo{.name = "joint_extension",
                 .unit = "m",
                 .value = [](const JointView &now) { return now.position; },
                 .description = "position of a slider; distance between the anchors of a distance "
                                "joint",
                 .joints = QuantityInfo::Joints::sliding},
    QuantityInfo{.name = "joint_extension_rate",
                 .unit = "m/s",
                 .value = [](const JointView &now) { return now.speed; },
                 .description = "how fast that position or distance grows",
                 .joints = QuantityInfo::Joints::sliding},
    QuantityInfo{"joint_error", "m",
                 [](const JointView &now) { return std::hypot(now.drift, now.angle_drift); },
                 "`joint_drift` of this one"},
    QuantityInfo{"length", "m", [](const SpringState &now) { return now.length; },
                 "distance between the spring's ends"},
    QuantityInfo{"strain", "1",
                 [](const SpringState &now) { return now.length / now.rest_length - 1; },
                 "length / rest_length - 1 of the spring, negative when compressed"},
    QuantityInfo{
        "kinetic_energy", "J",
        [](const Measures &now, const SceneStart &) { return now.kinetic_energy; },
        "of all dynamic bodies and particles, translation and rotation: sum of m v.v / 2 + w.I w / "
        "2"},
    QuantityInfo{"potential_energy", "J",
                 [](const Measures &now, const SceneStart &) { return now.potential_energy; },
                 "of all dynamic bodies and particles in gravity: sum of -m g.r, r from the "
                 "world's origin; due to attractors: sum of -m mu / |r|, r from the attractor; of "
                 "constant forces: sum of -F.r, but constant torques have none; and of springs "
                 "that are not torn: sum of k (l - l0)^2 / 2"},
    QuantityInfo{"energy", "J",
                 [](const Measures &now, const SceneStart &) { return now.energy(); },
                 "kinetic_energy + potential_energy"},
    QuantityInfo{"energy_error", "1",
                 [](const Measures &now, const SceneStart &start) {
                     return relative_change(now.energy() - start.measures.energy(),
                                            start.measures.kinetic_energy +
                                                std::abs(start.measures.potential_energy));
                 },
                 "(E - E0) / (K0 + |U0|); 0 marks t = 0; the difference in J when the divisor is 0",
                 true},
    QuantityInfo{"linear_momentum_error", "1",
                 [](const Measures &now, const SceneStart &start) {
                     return relative_change(
                         glm::length(now.linear_momentum - start.measures.linear_momentum),
                         start.momentum_scale);
                 },
                 "|p - p0| / (sum of m |v| at t = 0); the difference in N s when the divisor is 0",
                 true},
    QuantityInfo{"angular_momentum_error", "1",
                 [](const Measures &now, const SceneStart &start) {
                     return relative_change(
                         glm::length(now.angular_momentum - start.measures.angular_momentum),
                         start.angular_momentum_scale);
                 },
                 "|L - L0| / (sum of |r x m v| + |I w| at t = 0), about the world's origin; the "
                 "difference in N m s when the divisor is 0",
                 true},
    QuantityInfo{"penetration", "m",
                 [](const Measures &now, const SceneStart &) { return now.max_penetration; },
                 "depth of the deepest contact point in the scene; 0 when nothing overlaps", false,
                 false, true},
    QuantityInfo{"mean_penetration", "m",
                 [](const Measures &now, const SceneStart &) { return now.mean_penetration; },
                 "mean depth of the contact points that penetrate; 0 without any", false, false,
                 true},
    QuantityInfo{"joint_drift", "m",
                 [](const Measures &now, const SceneStart &) { return now.max_joint_drift; },
                 "largest error of any joint: the distance between the anchors (slider: across its "
                 "axis) or beyond the minimum or maximum length (distance), root-sum-square with "
                 "the tilt of a hinge, the rotation of a slider or fixed joint, and the excess "
                 "beyond a limit; 1 rad counts as 1 m"},
    QuantityInfo{"signorini_residual", "W",
                 [](const Measures &now, const SceneStart &) { return now.signorini_residual; },
                 "Signorini's law: largest |n v| of a contact point's normal force n and normal "
                 "velocity v; 0 if separating points are not pushed",
                 false, false, true},
    QuantityInfo{"cone_residual", "N",
                 [](const Measures &now, const SceneStart &) { return now.cone_residual; },
                 "Coulomb's cone: largest |t| - mu n by which friction exceeds it", false, false,
                 true},
    QuantityInfo{"dissipation_residual", "W",
                 [](const Measures &now, const SceneStart &) { return now.dissipation_residual; },
                 "maximal dissipation: largest mu n |w| + t.w of a point's friction t and sliding "
                 "velocity w; 0 if friction fully opposes sliding",
                 false, false, true},
    QuantityInfo{"contact_power", "W",
                 [](const Measures &now, const SceneStart &) { return now.contact_power; },
                 "sum of n v + t.w over all contact points: negative where friction dissipates, "
                 "positive where contacts add energy",
                 false, false, true},
    QuantityInfo{"max_strain", "1",
                 [](const Measures &now, const SceneStart &) { return now.max_strain; },
                 "largest |length / rest_length - 1| of all springs that are not torn, including "
                 "those of cloth; 0 without any"},
};

constexpr std::array all_reductions{
    ReductionInfo{"last", Reduction::last, false, "the value at the end of the window"},
    ReductionInfo{"min", Reduction::min, false, "smallest value", false, true},
    ReductionInfo{"max", Reduction::max, false, "largest value", true, false, true},
    ReductionInfo{"mean", Reduction::mean, false, "mean over time (trapezoidal rule)", false, false,
                  true},
    ReductionInfo{"max_abs", Reduction::max_abs, false, "largest magnitude", true},
    ReductionInfo{"drift", Reduction::drift, false,
                  "largest distance from the value at the start of the window", true},
    ReductionInfo{"period", Reduction::period, true,
                  "mean time (s) between successive upward crossings of `level`"},
    ReductionInfo{"crossings", Reduction::crossings, true,
                  "how often the value crosses `level`, up or down", true},
    ReductionInfo{"first_crossing", Reduction::first_crossing, true,
                  "time (s) from the start of the window to the first crossing of `level`, up or "
                  "down; the window's length if there is none",
                  true},
};

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

double time_mean(std::span<const double> times, std::span<const double> values) {
    if (values.size() == 1)
        return values.front();
    double area = 0;
    for (std::size_t i = 1; i < values.size(); ++i)
        area += 0.5 * (values[i - 1] + values[i]) * (times[i] - times[i - 1]);
    return area / (times.back() - times.front());
}

double mean_period(std::span<const double> times, std::span<const double> values, double level) {
    double first = 0;
    double last = 0;
    std::size_t count = 0;
    for (std::size_t i = 1; i < values.size(); ++i) {
        const double below = values[i - 1] - level;
        const double above = values[i] - level;
        if (!(below < 0 && above >= 0))
            continue;
        // Where the chord between the samples crosses the level.
        const double fraction = below / (below - above);
        last = times[i - 1] + fraction * (times[i] - times[i - 1]);
        if (count == 0)
            first = last;
        ++count;
    }
    return count < 2 ? nan : (last - first) / static_cast<double>(count - 1);
}

double sign_changes(std::span<const double> values, double level) {
    int side = 0;
    std::size_t changes = 0;
    for (const double value : values) {
        const int now = value > level ? 1 : value < level ? -1 : 0;
        if (now == 0)
            continue;
        if (side != 0 && now != side)
            ++changes;
        side = now;
    }
    return static_cast<double>(changes);
}

// Where the chord from the last sample on the first side crosses the level, once there is a sample
// on the other side.
double first_crossing(std::span<const double> times, std::span<const double> values, double level) {
    const auto side_of = [&](double value) { return value > level ? 1 : value < level ? -1 : 0; };
    int side = 0;
    std::size_t last = 0; // on that side
    for (std::size_t i = 0; i < values.size(); ++i) {
        const int now = side_of(values[i]);
        if (now == 0)
            continue;
        if (side != 0 && now != side) {
            const double fraction = (values[last] - level) / (values[last] - values[last + 1]);
            return times[last] + fraction * (times[last + 1] - times[last]) - times.front();
        }
        side = now;
        last = i;
    }
    return times.back() - times.front();
}

} // namespace

std::span<const QuantityInfo> quantities() {
    return all_quantities;
}

const QuantityInfo *find_quantity(std::string_view name) {
    const auto found = std::find_if(all_quantities.begin(), all_quantities.end(),
                                    [&](const QuantityInfo &info) { return info.name == name; });
    return found == all_quantities.end() ? nullptr : &*found;
}

bool has_quantity(JointType type, const QuantityInfo &quantity) {
    const JointTypeInfo &info = joint_type(type);
    return quantity.needs_joint() &&
           (quantity.joints == QuantityInfo::Joints::all ||
            (!info.place.empty() &&
             info.turns == (quantity.joints == QuantityInfo::Joints::turning)));
}

double relative_change(double change, double scale_at_start) {
    return scale_at_start > 0 ? change / scale_at_start : change;
}

std::span<const ReductionInfo> reductions() {
    return all_reductions;
}

const ReductionInfo *find_reduction(std::string_view name) {
    const auto found = std::find_if(all_reductions.begin(), all_reductions.end(),
                                    [&](const ReductionInfo &info) { return info.name == name; });
    return found == all_reductions.end() ? nullptr : &*found;
}

double reduce(std::span<const double> times, std::span<const double> values, Reduction reduction,
              std::optional<double> level) {
    PLUMB_CHECK(times.size() == values.size(),
                "got " << times.size() << " times for " << values.size() << " values");
    if (values.empty() ||
        std::any_of(values.begin(), values.end(), [](double value) { return std::isnan(value); }))
        return nan;
    const auto [min, max] = std::minmax_element(values.begin(), values.end());
    // Halve first: the sum of two finite values may overflow.
    const double middle = level.value_or(0.5 * *min + 0.5 * *max);
    switch (reduction) {
    case Reduction::last:
        return values.back();
    case Reduction::min:
        return *min;
    case Reduction::max:
        return *max;
    case Reduction::mean:
        return time_mean(times, values);
    case Reduction::max_abs:
        return std::max(std::abs(*min), std::abs(*max));
    case Reduction::drift:
        return std::max(*max - values.front(), values.front() - *min);
    case Reduction::period:
        return mean_period(times, values, middle);
    case Reduction::crossings:
        return sign_changes(values, middle);
    case Reduction::first_crossing:
        return first_crossing(times, values, middle);
    }
    return nan;
}

double curve_at(std::span<const double> values, double from, double to, double time) {
    PLUMB_CHECK(values.size() >= least_curve && from < to,
                values.size() << " values over " << from << " to " << to);
    const double last = static_cast<double>(values.size() - 1);
    const double place = std::clamp((time - from) / (to - from), 0.0, 1.0) * last;
    const double first = std::clamp(std::floor(place) - 1, 0.0, last - 3);
    const std::size_t i = static_cast<std::size_t>(first);
    // Lagrange's polynomial through the values at s = 0, 1, 2, 3.
    const double s = place - first;
    return -values[i] * (s - 1) * (s - 2) * (s - 3) / 6 +
           values[i + 1] * s * (s - 2) * (s - 3) / 2 - values[i + 2] * s * (s - 1) * (s - 3) / 2 +
           values[i + 3] * s * (s - 1) * (s - 2) / 6;
}

} // namespace plumb
