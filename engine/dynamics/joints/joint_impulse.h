// What the rows of a joint do to its two bodies: masses, speeds, impulses.
#pragma once

#include "engine/dynamics/bodies/body.h"
#include "engine/dynamics/joints/joint_constraint.h"

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

// So much to add to K, a symmetric matrix that is not negative, that next to no impulse goes along
// what nothing can move (a locked axis): it would pull in vain, the harder the longer. 0 where
// there is no such direction.
Mat3 locked_compliance(const Mat3 &k);
// K^-1 of the rows. What nothing can move has none: 0.
Mat3 mass_of(const RowBlock &rows, const SolverBody &a, const SolverBody &b);
// The mean velocity over h, because it turns, of the end of an arm that starts as r.
Vec3 chord_velocity(const Vec3 &angular_velocity, const Vec3 &r, Real h);
// How fast the anchors part; at the end of pass.h where the pass says so.
inline Vec3 point_velocity(const RowBlock &rows, const SolverBody &a, const SolverBody &b,
                           const JointPass &pass) {
    if (!pass.at_the_end)
        return b.velocity_at(rows.r_b) - a.velocity_at(rows.r_a);
    return (b.velocity - a.velocity) + (chord_velocity(b.angular_velocity, rows.r_b, pass.h) -
                                        chord_velocity(a.angular_velocity, rows.r_a, pass.h));
}
// The same of rows along or about axes.
Vec3 axial_velocity(const RowBlock &rows, const SolverBody &a, const SolverBody &b,
                    const JointPass &pass);
// How fast the rows' errors grow.
inline Vec3 row_velocity(const RowBlock &rows, const SolverBody &a, const SolverBody &b,
                         const JointPass &pass) {
    return rows.kind == RowKind::point ? point_velocity(rows, a, b, pass)
                                       : axial_velocity(rows, a, b, pass);
}
// How much faster they grow in the mean of h than at its start, because the bodies turn: half of h
// times the second derivative of errors along lines, v^T H v (to first order in h).
Vec3 half_bend(const RowBlock &rows, const SolverBody &a, const SolverBody &b, Real h);
// What an impulse along the rows is in the world: a force's, or an angular one.
inline Vec3 world_impulse(const RowBlock &rows, const Vec3 &impulse) {
    if (rows.kind == RowKind::point)
        return impulse;
    Vec3 sum = impulse.x * rows.axes[0];
    for (int i = 1; i < rows.count; ++i)
        sum += impulse[i] * rows.axes[static_cast<std::size_t>(i)];
    return sum;
}
// Such an impulse, at an arm of the body's.
inline void apply(SolverBody &body, const RowBlock &rows, const Vec3 &arm, const Vec3 &impulse) {
    if (rows.kind == RowKind::angular)
        body.apply_angular_impulse(impulse);
    else
        body.apply_impulse(impulse, arm);
}
// An impulse along a joint's rows. What does not move by forces is not written to: joints of other
// bodies, that are solved at the same time, hang on it, too.
void apply(StepContext &context, const JointConstraint &joint, const Vec3 &impulse);
// No faster than `most`.
Vec3 pushed(const Vec3 &bias, Real most);
// What a pass adds to the rows' impulse.
Vec3 impulse_change(StepContext &context, const JointConstraint &joint, const JointPass &pass);

} // namespace plumb::inline PLUMB_PRECISION
