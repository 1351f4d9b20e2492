#include "engine/dynamics/joint_constraint.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// K of a point-to-point constraint: (1/ma + 1/mb) 1 - [ra] Ia^-1 [ra] - [rb] Ib^-1 [rb]
// (Catto 2009, "Modeling and Solving Constraints", slide 52, in 3D).
Mat3 point_matrix(const Motion &a, const Motion &b, const Vec3 &r_a, const Vec3 &r_b) {
    const Mat3 ra = cross_matrix(r_a);
    const Mat3 rb = cross_matrix(r_b);
    return Mat3{a.inv_mass + b.inv_mass} - ra * a.inv_inertia * ra - rb * b.inv_inertia * rb;
}

Vec3 centripetal(const Vec3 &angular_velocity, const Vec3 &r) {
    return glm::cross(angular_velocity, glm::cross(angular_velocity, r));
}

void apply(StepContext &context, const JointConstraint &joint, const Vec3 &impulse) {
    context.motion(joint.a).apply_impulse(-impulse, joint.r_a);
    context.motion(joint.b).apply_impulse(impulse, joint.r_b);
}

} // namespace

std::vector<JointConstraint> prepare_joints(StepContext &context) {
    std::vector<JointConstraint> constraints;
    for (std::size_t i = 0; i < context.joints.size(); ++i) {
        const Joint &joint = context.joints[i];
        if (!joint.alive)
            continue;
        JointConstraint &out = constraints.emplace_back();
        out.joint = static_cast<std::uint32_t>(i);
        out.a = joint.a;
        out.b = joint.b;
        out.type = joint.type;
        out.impulse = joint.impulse;
    }
    return constraints;
}

void refresh_joints(StepContext &context, std::span<JointConstraint> joints) {
    for (JointConstraint &constraint : joints) {
        const Joint &joint = context.joints[constraint.joint];
        const Motion &a = context.motion(constraint.a);
        const Motion &b = context.motion(constraint.b);
        constraint.r_a = a.rotation * joint.anchor_a_local;
        constraint.r_b = b.rotation * joint.anchor_b_local;
        const Vec3 gap = (b.position - a.position) + (constraint.r_b - constraint.r_a);
        switch (constraint.type) {
        case JointType::ball: {
            constraint.error = gap;
            const Mat3 k = point_matrix(a, b, constraint.r_a, constraint.r_b);
            constraint.mass = a.inv_mass + b.inv_mass > Real(0) ? glm::inverse(k) : Mat3{Real(0)};
            break;
        }
        case JointType::distance: {
            const Real distance = glm::length(gap);
            // Anchors on top of each other: any direction parts them.
            constraint.axis = distance > Real(0) ? gap / distance : Vec3{Real(0), Real(1), Real(0)};
            constraint.error = Vec3{distance - joint.length, Real(0), Real(0)};
            const Real k =
                inverse_effective_mass(a, b, constraint.r_a, constraint.r_b, constraint.axis);
            constraint.mass[0][0] = k > Real(0) ? Real(1) / k : Real(0);
            break;
        }
        case JointType::hinge:
        case JointType::slider:
        case JointType::fixed:
            break; // the world takes none
        }
    }
}

void remember_joints(std::span<JointConstraint> joints) {
    for (JointConstraint &joint : joints) {
        joint.remembered = joint.impulse;
        joint.impulse = Vec3{Real(0)};
    }
}

void recall_joints(StepContext &context, std::span<JointConstraint> joints, Real share) {
    for (JointConstraint &joint : joints) {
        const Vec3 recalled = share * joint.remembered;
        joint.impulse += recalled;
        apply(context, joint, joint.type == JointType::ball ? recalled : recalled.x * joint.axis);
    }
}

void solve_joints(StepContext &context, std::span<JointConstraint> joints, const Softness &softness,
                  Real h) {
    for (JointConstraint &joint : joints) {
        const Motion &a = context.motion(joint.a);
        const Motion &b = context.motion(joint.b);
        const Vec3 curving =
            centripetal(b.angular_velocity, joint.r_b) - centripetal(a.angular_velocity, joint.r_a);
        // The anchors' mean relative velocity over h.
        const Vec3 relative =
            b.velocity_at(joint.r_b) - a.velocity_at(joint.r_a) + (Real(0.5) * h) * curving;
        switch (joint.type) {
        case JointType::ball: {
            const Vec3 change = -softness.mass_scale *
                                    (joint.mass * (relative + softness.bias_rate * joint.error)) -
                                softness.impulse_scale * joint.impulse;
            joint.impulse += change;
            apply(context, joint, change);
            break;
        }
        case JointType::distance: {
            // How much shorter the rod must become along its old axis while it swings aside.
            const Real distance = context.joints[joint.joint].length + joint.error.x;
            const Real along = glm::dot(relative, joint.axis);
            const Vec3 aside = h * (relative - along * joint.axis);
            const Real aside_squared = std::min(glm::dot(aside, aside), distance * distance);
            const Real shortening =
                h > Real(0) && distance > Real(0)
                    ? aside_squared / (distance + std::sqrt(distance * distance - aside_squared)) /
                          h
                    : Real(0);
            const Real speed = along + shortening;
            const Real change = -softness.mass_scale * joint.mass[0][0] *
                                    (speed + softness.bias_rate * joint.error.x) -
                                softness.impulse_scale * joint.impulse.x;
            joint.impulse.x += change;
            apply(context, joint, change * joint.axis);
            break;
        }
        case JointType::hinge:
        case JointType::slider:
        case JointType::fixed:
            break; // the world takes none
        }
    }
}

void store_joints(StepContext &context, std::span<const JointConstraint> joints) {
    for (const JointConstraint &joint : joints)
        context.joints[joint.joint].impulse = joint.impulse;
}

} // namespace plumb::inline PLUMB_PRECISION
