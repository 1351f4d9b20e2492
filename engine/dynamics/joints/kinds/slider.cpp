// Slider: anchor b stays on the x axis of frame a and nothing turns; limits and motor act along
// the axis.
#include "engine/dynamics/joints/joint_rows.h"

#include <cmath>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

void emit_slider(const Joint &joint, const Motion &a, const Motion &b, RowWriter &rows) {
    const Mat3 axes = frame_a(joint, a);
    const Vec3 r_a = a.rotation * joint.anchor_a_local;
    const Vec3 r_b = b.rotation * joint.anchor_b_local;
    const Vec3 gap = (b.position - a.position) + (r_b - r_a);
    // The axes turn with a, so a's lever arm ends at anchor b.
    const Vec3 arm = r_a + gap;

    RowBlock &block = rows.add(RowKind::linear, RowBounds::equal, 2, 0);
    block.axes = {axes[1], axes[2], Vec3{Real(0)}};
    block.r_a = arm;
    block.r_b = r_b;
    block.error = {glm::dot(gap, axes[1]), glm::dot(gap, axes[2]), Real(0)};
    block.frequency = joint.frequency;
    block.damping_ratio = joint.damping_ratio;
    block.turns_with_a = true;
    emit_same_turn(joint, a, b, 2, rows);

    RowBlock along;
    along.kind = RowKind::linear;
    along.axes[0] = axes[0];
    along.r_a = arm;
    along.r_b = r_b;
    along.turns_with_a = true;
    emit_limits_and_motor(joint, along, glm::dot(gap, axes[0]), 5, rows);
}

JointPlace place_of_slider(const Joint &joint, const Motion &a, const Motion &b) {
    const Vec3 from = a.position + a.rotation * joint.anchor_a_local;
    const Vec3 to = b.position + b.rotation * joint.anchor_b_local;
    const Vec3 axis = frame_a(joint, a)[0];
    return {glm::dot(to - from, axis), glm::dot(anchor_velocity(joint, a, b), axis)};
}

} // namespace plumb::inline PLUMB_PRECISION
