#include "engine/dynamics/joints/joint_rows.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

void emit_rows(const Joint &joint, const Motion &a, const Motion &b, RowWriter &rows) {
    switch (joint.type) {
#define PLUMB_EMIT(name)                                                                           \
    case JointType::name:                                                                          \
        return emit_##name(joint, a, b, rows);
        PLUMB_JOINT_TYPES(PLUMB_EMIT)
#undef PLUMB_EMIT
    }
}

JointPlace place_of(const Joint &joint, const Motion &a, const Motion &b) {
    switch (joint.type) {
#define PLUMB_PLACE(name)                                                                          \
    case JointType::name:                                                                          \
        return place_of_##name(joint, a, b);
        PLUMB_JOINT_TYPES(PLUMB_PLACE)
#undef PLUMB_PLACE
    }
    return {};
}

Mat3 frame_a(const Joint &joint, const Motion &a) {
    return glm::mat3_cast(a.rotation * joint.frame_a_local);
}

Mat3 frame_b(const Joint &joint, const Motion &b) {
    return glm::mat3_cast(b.rotation * joint.frame_b_local);
}

Quat relative_turn(const Joint &joint, const Motion &a, const Motion &b) {
    const Quat turn =
        glm::conjugate(a.rotation * joint.frame_a_local) * (b.rotation * joint.frame_b_local);
    return turn.w < Real(0) ? -turn : turn;
}

Vec3 anchor_velocity(const Joint &joint, const Motion &a, const Motion &b) {
    const Vec3 arm_b = b.rotation * joint.anchor_b_local;
    const Vec3 arm_a = b.position + arm_b - a.position;
    return b.velocity + glm::cross(b.angular_velocity, arm_b) - a.velocity -
           glm::cross(a.angular_velocity, arm_a);
}

void emit_point(const Joint &joint, const Motion &a, const Motion &b, std::size_t first_memory,
                RowWriter &rows) {
    RowBlock &block = rows.add(RowKind::point, RowBounds::equal, 3, first_memory);
    block.r_a = a.rotation * joint.anchor_a_local;
    block.r_b = b.rotation * joint.anchor_b_local;
    block.error = (b.position - a.position) + (block.r_b - block.r_a);
    // A soft joint acts at a single point, b's anchor, as if its spring were mounted on a: forces
    // at two points that are not along the stretch, as the damper's are not, would change the
    // angular momentum.
    if (joint.frequency > Real(0))
        block.r_a += block.error;
    block.frequency = joint.frequency;
    block.damping_ratio = joint.damping_ratio;
}

void emit_same_turn(const Joint &joint, const Motion &a, const Motion &b, std::size_t first_memory,
                    RowWriter &rows) {
    RowBlock &block = rows.add(RowKind::angular, RowBounds::equal, 3, first_memory);
    const Mat3 axes = frame_a(joint, a);
    block.axes = {axes[0], axes[1], axes[2]};
    // The rotation axis times twice the sine of half the angle: the angle itself to third order.
    const Quat turn = relative_turn(joint, a, b);
    block.error = Real(2) * Vec3{turn.x, turn.y, turn.z};
    block.frequency = joint.frequency;
    block.damping_ratio = joint.damping_ratio;
}

void emit_limits_and_motor(const Joint &joint, const RowBlock &row, Real place,
                           std::size_t first_memory, RowWriter &rows) {
    const auto add = [&](RowBounds bounds, std::size_t memory) -> RowBlock & {
        RowBlock &block = rows.add(row.kind, bounds, 1, memory);
        block.axes[0] = row.axes[0];
        block.r_a = row.r_a;
        block.r_b = row.r_b;
        block.turns_with_a = row.turns_with_a;
        return block;
    };
    if (joint.limits) {
        add(RowBounds::at_least, first_memory).error.x = place - joint.limits->lower;
        add(RowBounds::at_most, first_memory + 1).error.x = place - joint.limits->upper;
    }
    if (joint.motor) {
        RowBlock &motor = add(RowBounds::motor, first_memory + 2);
        motor.speed = joint.motor->speed;
        motor.max_force = joint.motor->max_force;
    }
}

JointError joint_error(const Joint &joint, const Motion &a, const Motion &b) {
    std::vector<RowBlock> blocks;
    NewRows writer(blocks);
    emit_rows(joint, a, b, writer);
    JointError squared;
    for (const RowBlock &block : blocks) {
        Real &sum = block.kind == RowKind::angular ? squared.angular : squared.linear;
        switch (block.bounds) {
        case RowBounds::equal:
            for (int i = 0; i < block.count; ++i)
                sum += block.error[i] * block.error[i];
            break;
        case RowBounds::at_least:
            sum += std::min(block.error.x, Real(0)) * std::min(block.error.x, Real(0));
            break;
        case RowBounds::at_most:
            sum += std::max(block.error.x, Real(0)) * std::max(block.error.x, Real(0));
            break;
        case RowBounds::motor:
        case RowBounds::pull:
            break;
        }
    }
    return {std::sqrt(squared.linear), std::sqrt(squared.angular)};
}

} // namespace plumb::inline PLUMB_PRECISION
