// Joints that are solved together in groups (JointSystem), with their limits and motors, and the
// other joints whose effective mass depends on a group.
#pragma once

#include "engine/dynamics/joints/joint_constraint.h"
#include "engine/dynamics/joints/joint_system.h"

#include <cstddef>
#include <functional>
#include <span>

namespace plumb::inline PLUMB_PRECISION {

inline constexpr std::size_t groups_a_part = 1; // per thread

// Factors a group again after its active limits or motors changed.
void factor_again(StepContext &context, JointGroup &group);

// Solves all rows of a group together, releasing limits that would pull and motors that would need
// more than their greatest force. Returns whether the ends of its joints meet.
bool solve_group(StepContext &context, JointGroup &group, const JointPass &pass);
// Joints in a group give a little (held_compliance), like springs that stiffen as the substep gets
// finer. Taken back as drift, that stretch would turn into speed, amplified where an island takes
// more substeps than before, and a bridge pulled taut would launch whatever falls on it. So drift
// that the loads do not account for is corrected by moving bodies in the holding pass, and the
// correction is removed from their velocities once they have moved.
void push_groups(StepContext &context, const JointPass &pass);
void take_back_pushes(StepContext &context);
// Solves held groups once more where contacts were solved after them.
void hold_touched_groups(StepContext &context, const JointPass &pass);
// After limits were released: without this, loads that the other rows shared with those limits
// would not be carried in the rest of the substep. `share`: of the substep, so far.
void remember_anew(StepContext &context, const JointGroup &group, Real share);
// Leaves a group to Gauss-Seidel and drops its accumulated impulses: forces that no stretch has
// built up would return more energy than they took.
void let_go(StepContext &context, JointGroup &group);

// Effective mass of a limit or motor on bodies held by a group: as heavy as the group makes them.
void weigh(StepContext &context, JointConstraint &joint);
bool any_has_changed(StepContext &context);
// Recomputes it for joints on groups that changed; calls use(joint) after each.
void weigh_again(StepContext &context, const std::function<void(JointConstraint &)> &use);
// The same, then clears the groups' change flags.
void weigh_again(StepContext &context);
// Applies the response of the groups of a joint's bodies to an impulse along its rows, if the joint
// is not in the group itself. Must come immediately, so that the next limit or motor on the same
// bodies sees it: each has the mass that the groups give it, and would overshoot against bodies
// that the groups have not held back yet.
void answer(StepContext &context, const JointConstraint &joint, const Vec3 &impulse);
// A group's response to an impact: changes velocities so that its joints hold. Does nothing for
// JointSystem::none, or a group that is not held.
void answer_impact(StepContext &context, std::uint32_t group);

} // namespace plumb::inline PLUMB_PRECISION
