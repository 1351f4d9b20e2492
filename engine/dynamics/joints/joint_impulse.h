// What a joint's rows do to its two bodies: effective masses, velocities, impulses.
#pragma once

#include "engine/dynamics/bodies/body.h"
#include "engine/dynamics/joints/joint_constraint.h"
#include "engine/dynamics/joints/wide_matrix.h"

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

// Whether both bodies, as far as they move, have locked axes.
bool may_be_locked(const SolverBody &a, const SolverBody &b);
// What to add to K, symmetric positive semidefinite, so that next to no impulse acts along a
// direction in which nothing can move (a locked axis): it would pull in vain, ever harder. 0 where
// there is no such direction. Only K of bodies that may_be_locked can need it.
glm::dmat3 locked_compliance(const glm::dmat3 &k);
// The least determinant of a K, as a share of its mean eigenvalue cubed, that is inverted in single
// precision.
inline constexpr Real least_determinant = Real(1e-3);
// K^-1 of the rows; 0 where nothing can move.
Mat3 mass_of(const RowBlock &rows, const SolverBody &a, const SolverBody &b);
// The anchors' relative velocity; over the chord to the end of pass.h if pass.at_the_end.
WideVec3 point_velocity(const RowBlock &rows, const SolverBody &a, const SolverBody &b,
                        const JointPass &pass);
// The same for rows along or about axes.
Vec3 axial_velocity(const RowBlock &rows, const SolverBody &a, const SolverBody &b,
                    const JointPass &pass);
// How fast the rows' errors grow.
inline Vec3 row_velocity(const RowBlock &rows, const SolverBody &a, const SolverBody &b,
                         const JointPass &pass) {
    return rows.kind == RowKind::point ? point_velocity(rows, a, b, pass).narrow()
                                       : axial_velocity(rows, a, b, pass);
}
// How much faster the errors grow on average over h than at its start, because the bodies turn: h /
// 2 times the second derivative of errors along lines, v^T H v (to first order in h).
Vec3 half_bend(const RowBlock &rows, const SolverBody &a, const SolverBody &b, Real h);
// The rows' impulse in world axes: linear, or angular.
inline Vec3 world_impulse(const RowBlock &rows, const Vec3 &impulse) {
    if (rows.kind == RowKind::point)
        return impulse;
    Vec3 sum = impulse.x * rows.axes[0];
    for (int i = 1; i < rows.count; ++i)
        sum += impulse[i] * rows.axes[static_cast<std::size_t>(i)];
    return sum;
}
// Applies it to a body at its lever arm, which is one of the rows'.
void apply(SolverBody &body, const RowBlock &rows, const Vec3 &arm, const Vec3 &impulse);
// Applies an impulse along a joint's rows. Bodies that do not move by forces are not written to:
// other joints solved at the same time may share them.
void apply(StepContext &context, const JointConstraint &joint, const Vec3 &impulse);
// Clamped to speed `most`.
Vec3 pushed(const Vec3 &bias, Real most);
// The change that a pass makes to the rows' impulse.
Vec3 impulse_change(StepContext &context, const JointConstraint &joint, const JointPass &pass);

} // namespace plumb::inline PLUMB_PRECISION
