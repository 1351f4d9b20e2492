#include "engine/dynamics/joints/joint_bearings.h"

#include "engine/dynamics/joints/joint_groups.h"
#include "engine/dynamics/joints/joint_impulse.h"
#include "engine/dynamics/method.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace plumb::inline PLUMB_PRECISION {

namespace {

void set_held(JointConstraint &joint, bool is_held) {
    joint.is_held = is_held;
    joint.is_weighed = !is_held; // again: weigh_again
}

// N s or N m s, in a pass that stands for `share` of the substep.
Real greatest_motor_impulse(const StepContext &context, const JointConstraint &motor, Real share) {
    return motor.rows.max_force * context.substep() * share;
}

// Whether a motor has its speed, but for what moves its joint by little within a substep.
bool is_at_speed(StepContext &context, const JointConstraint &motor) {
    constexpr Real little = Real(1e-3); // of its size
    const Real speed =
        row_velocity(motor.rows, context.body(motor.a), context.body(motor.b), JointPass{}).x;
    return std::abs(speed - motor.rows.speed) * context.substep() <= little * motor.size;
}

// Limits push and never pull; motors have a greatest force.
bool is_beyond(const StepContext &context, JointConstraint &joint, Real impulse, Real share) {
    switch (joint.bearing) {
    case Bearing::lower:
        return impulse < Real(0);
    case Bearing::upper:
        return impulse > Real(0);
    case Bearing::motor:
        return std::abs(impulse) > greatest_motor_impulse(context, motor_of(joint), share);
    case Bearing::none:
    case Bearing::shut:
        break;
    }
    return false;
}

// Removes a limit's impulse, or what is too much of a motor's, and leaves it to Gauss-Seidel.
void release_bearing(StepContext &context, JointConstraint &joint, Real share) {
    Real left = Real(0);
    if (joint.bearing == Bearing::motor) {
        const Real most = greatest_motor_impulse(context, motor_of(joint), share);
        left = std::clamp(joint.impulse.z - joint.push.z, -most, most);
        joint.remembered.z = left / share;
    }
    apply(context, joint, {Real(0), Real(0), left - joint.impulse.z});
    joint.impulse.z = left;
    set_bearing(joint, Bearing::none);
}

// The limit that a joint rests on, or is shut between, and its load.
std::pair<Bearing, Real> bearing_limit(JointConstraint &joint) {
    if (joint.limits == 0)
        return {Bearing::none, Real(0)};
    const std::span<JointConstraint, 2> limits = limits_of(joint);
    const Real load =
        is_limit(joint.bearing) ? joint.impulse.z : limits[0].impulse.x + limits[1].impulse.x;
    if (limits[0].rows.error.x == limits[1].rows.error.x)
        return {Bearing::shut, load};
    if (load == Real(0))
        return {Bearing::none, load};
    if (is_limit(joint.bearing))
        return {joint.bearing, load};
    return {load > Real(0) ? Bearing::lower : Bearing::upper, load};
}

// A motor is solved with its group while it has force to spare and its speed. Until then contacts
// come after it: what it starts or drives against would else be run into.
bool is_motor_held(StepContext &context, JointConstraint &joint, Real share) {
    if (joint.motor == 0)
        return false;
    constexpr Real nearly = Real(0.999); // a motor at its greatest force stays there
    const JointConstraint &motor = motor_of(joint);
    const Real impulse = joint.bearing == Bearing::motor ? joint.impulse.z : motor.impulse.x;
    return std::abs(impulse) < nearly * greatest_motor_impulse(context, motor, share) &&
           is_at_speed(context, motor);
}

// Calls change(joint, place) for each block of a group, and factors the group again if any returns
// true. Returns whether any does.
template <typename Change>
bool change_bearings(StepContext &context, JointGroup &group, Change &&change) {
    bool any = false;
    for (std::uint32_t place = group.first; place < group.last; ++place)
        if (change(context.scratch.joints[context.scratch.joint_system->block(place)], place))
            any = true;
    if (any)
        factor_again(context, group);
    return any;
}

} // namespace

void find_bearings(std::span<JointConstraint> blocks) {
    for (JointConstraint &joint : blocks) {
        if (joint.rows.bounds != RowBounds::equal || joint.rows.count != 2)
            continue;
        const auto offset_to = [&](RowBounds bounds) {
            const auto found = std::ranges::find_if(blocks, [&](const JointConstraint &other) {
                return other.rows.bounds == bounds && other.rows.kind == joint.rows.kind;
            });
            return static_cast<std::uint8_t>(found == blocks.end() ? 0 : &*found - &joint);
        };
        joint.limits = offset_to(RowBounds::at_least);
        joint.motor = offset_to(RowBounds::motor);
    }
}

std::span<JointConstraint, 2> limits_of(JointConstraint &joint) {
    return std::span<JointConstraint, 2>(&joint + joint.limits, 2);
}

JointConstraint &motor_of(JointConstraint &joint) {
    return *(&joint + joint.motor);
}

void add_bearing_row(JointConstraint &joint) {
    const RowBlock &row = joint.bearing == Bearing::motor
                              ? motor_of(joint).rows
                              : limits_of(joint)[joint.bearing == Bearing::upper ? 1 : 0].rows;
    joint.rows.count = 3;
    joint.rows.axes[2] = row.axes[0];
    joint.rows.error.z = row.error.x;
    joint.rows.speed = row.speed;
}

void set_bearing(JointConstraint &joint, Bearing bearing) {
    const bool was_motor = joint.bearing == Bearing::motor;
    const Real impulse = joint.impulse.z;
    const Real remembered = joint.remembered.z;
    joint.bearing = bearing;
    joint.rows.count = 2;
    joint.rows.axes[2] = Vec3{Real(0)};
    joint.rows.speed = Real(0);
    joint.rows.error.z = joint.impulse.z = joint.remembered.z = Real(0);
    joint.push.z = joint.closing.z = Real(0);
    if (joint.limits != 0)
        for (JointConstraint &limit : limits_of(joint)) {
            limit.impulse = limit.remembered = Vec3{Real(0)};
            set_held(limit, is_limit(bearing));
        }
    if (joint.motor != 0) {
        JointConstraint &motor = motor_of(joint);
        set_held(motor, bearing == Bearing::motor);
        if (was_motor) {
            motor.impulse.x = impulse;
            motor.remembered.x = remembered;
        } else if (motor.is_held) {
            joint.impulse.z = std::exchange(motor.impulse.x, Real(0));
            joint.remembered.z = std::exchange(motor.remembered.x, Real(0));
        }
    }
    if (bearing != Bearing::none)
        add_bearing_row(joint);
}

bool choose_bearings(StepContext &context, const JointGroup &group, Real share) {
    bool any = false;
    for (std::uint32_t place = group.first; place < group.last; ++place) {
        JointConstraint &joint = context.scratch.joints[context.scratch.joint_system->block(place)];
        if (joint.limits == 0 && joint.motor == 0)
            continue;
        auto [bearing, load] = bearing_limit(joint);
        if (bearing == Bearing::none && is_motor_held(context, joint, share))
            bearing = Bearing::motor;
        if (!group.is_held)
            bearing = Bearing::none;
        if (bearing == joint.bearing)
            continue;
        set_bearing(joint, bearing);
        if (is_limit(bearing))
            joint.impulse.z = load;
        any = true;
    }
    return any;
}

bool release_bearings(StepContext &context, JointGroup &group, const JointPass &pass) {
    return change_bearings(context, group, [&](JointConstraint &joint, std::uint32_t) {
        if (!is_beyond(context, joint, joint.impulse.z - joint.push.z, pass.force_share))
            return false;
        release_bearing(context, joint, pass.force_share);
        return true;
    });
}

bool open_bearings(StepContext &context, JointGroup &group, std::span<const WideVec3> sides) {
    return change_bearings(context, group, [&](JointConstraint &joint, std::uint32_t place) {
        const Real impulse = joint.impulse.z + sides[place - group.first][2];
        if (!is_beyond(context, joint, impulse, Real(1)))
            return false;
        set_bearing(joint, Bearing::none);
        return true;
    });
}

bool release_thrown_motors(StepContext &context, JointGroup &group) {
    return change_bearings(context, group, [&](JointConstraint &joint, std::uint32_t) {
        if (joint.bearing != Bearing::motor || is_at_speed(context, motor_of(joint)))
            return false;
        set_bearing(joint, Bearing::none);
        return true;
    });
}

} // namespace plumb::inline PLUMB_PRECISION
