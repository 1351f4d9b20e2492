// Hinge: the anchors stay together and the x axes of the frames parallel; limits and motor act
// on the angle about them.
#include "engine/dynamics/joints/joint_rows.h"

#include <cmath>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

Real hinge_angle(const Joint &joint, const Motion &a, const Motion &b) {
    const Quat turn = relative_turn(joint, a, b);
    return Real(2) * std::atan2(turn.x, turn.w);
}

} // namespace

void emit_hinge(const Joint &joint, const Motion &a, const Motion &b, RowWriter &rows) {
    emit_point(joint, a, b, 0, rows);
    const Mat3 axes = frame_a(joint, a);
    const Vec3 axis_b = frame_b(joint, b)[0];
    RowBlock &block = rows.add(RowKind::angular, RowBounds::equal, 2, 3);
    block.axes = {axes[1], axes[2], Vec3{Real(0)}};
    // The sine of the angle between the axes, about the two perpendicular ones.
    const Vec3 lean = glm::cross(axes[0], axis_b);
    block.error = {glm::dot(lean, axes[1]), glm::dot(lean, axes[2]), Real(0)};
    block.frequency = joint.frequency;
    block.damping_ratio = joint.damping_ratio;

    RowBlock about;
    about.kind = RowKind::angular;
    about.axes[0] = axes[0];
    // A soft hinge that is bent by more than a quarter turn has hardly an angle any more, and none
    // at half a turn: its limits are open.
    const bool is_folded = joint.limits && glm::dot(axes[0], axis_b) < Real(0);
    const Real angle = is_folded ? Real(0.5) * (joint.limits->lower + joint.limits->upper)
                                 : hinge_angle(joint, a, b);
    emit_limits_and_motor(joint, about, angle, 5, rows);
}

JointPlace place_of_hinge(const Joint &joint, const Motion &a, const Motion &b) {
    return {hinge_angle(joint, a, b),
            glm::dot(frame_a(joint, a)[0], b.angular_velocity - a.angular_velocity)};
}

} // namespace plumb::inline PLUMB_PRECISION
