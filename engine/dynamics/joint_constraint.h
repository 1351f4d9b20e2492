// Joints as velocity constraints.
#pragma once

#include "engine/dynamics/contact_constraint.h"

namespace plumb::inline PLUMB_PRECISION {

// One joint at the present poses. A ball joint is a 3x3 block; a distance joint one row along
// `axis`.
struct JointConstraint {
    std::uint32_t joint = 0; // index in the context
    std::uint32_t a = 0;
    std::uint32_t b = 0;
    JointType type = JointType::ball;
    Vec3 r_a{Real(0)}; // world, from the centre of mass
    Vec3 r_b{Real(0)};
    Vec3 error{Real(0)};      // anchor b - anchor a; distance: x alone, the length's excess
    Vec3 axis{Real(0)};       // distance: unit, from a to b
    Mat3 mass{Real(0)};       // inverse of K; distance: [0][0] alone
    Vec3 impulse{Real(0)};    // accumulated in this substep, on b (N s)
    Vec3 remembered{Real(0)}; // of the substep before
};

// Joints that are alive, in order; poses are read by refresh_joints.
std::vector<JointConstraint> prepare_joints(StepContext &context);
// Anchors, errors and masses at the present poses: to be called in each substep, since a joint that
// turns far within a step is only as true as its lever arms.
void refresh_joints(StepContext &context, std::span<JointConstraint> joints);
// Warm starting, as for contacts.
void remember_joints(std::span<JointConstraint> joints);
void recall_joints(StepContext &context, std::span<JointConstraint> joints, Real share);
// One Gauss-Seidel pass; softness.bias_rate 0 leaves the drift alone. With h > 0 the joint is to
// hold at the poses that the velocities lead to after h, to second order: the anchors' centripetal
// way, w x (w x r) h^2 / 2, is part of the constraint, as in SHAKE (Ryckaert, Ciccotti, Berendsen
// 1977). With h == 0 the velocities alone shall agree.
void solve_joints(StepContext &context, std::span<JointConstraint> joints, const Softness &softness,
                  Real h);
void store_joints(StepContext &context, std::span<const JointConstraint> joints);

} // namespace plumb::inline PLUMB_PRECISION
