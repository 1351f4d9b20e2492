// What the rows of a joint do to its two bodies: masses, speeds, impulses.
#pragma once

#include "engine/dynamics/body.h"
#include "engine/dynamics/joint_constraint.h"

namespace plumb::inline PLUMB_PRECISION {

// So much to add to K, a symmetric matrix that is not negative, that next to no impulse goes along
// what nothing can move (a locked axis): it would pull in vain, the harder the longer. 0 where
// there is no such direction.
Mat3 locked_compliance(const Mat3 &k);
// K^-1 of the rows. What nothing can move has none: 0.
Mat3 mass_of(const RowBlock &rows, const SolverBody &a, const SolverBody &b);
// How fast the rows' errors grow; at the end of pass.h where the pass says so.
Vec3 row_velocity(const RowBlock &rows, const SolverBody &a, const SolverBody &b,
                  const JointPass &pass);
// What an impulse along the rows is in the world: a force's, or an angular one.
Vec3 world_impulse(const RowBlock &rows, const Vec3 &impulse);
// Of an impulse along the rows, at an arm of the body's.
void apply(SolverBody &body, const RowBlock &rows, const Vec3 &arm, const Vec3 &impulse);
// No faster than `most`.
Vec3 pushed(const Vec3 &bias, Real most);
// What a pass adds to the rows' impulse.
Vec3 impulse_change(const JointConstraint &joint, const SolverBody &a, const SolverBody &b,
                    const JointPass &pass);

} // namespace plumb::inline PLUMB_PRECISION
