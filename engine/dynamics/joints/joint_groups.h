// Joints that are solved together in groups (JointSystem), the limits among them, and what is
// weighed with them.
#pragma once

#include "engine/dynamics/joints/joint_constraint.h"
#include "engine/dynamics/joints/joint_system.h"

#include <cstddef>
#include <functional>
#include <span>

namespace plumb::inline PLUMB_PRECISION {

inline constexpr std::size_t groups_a_part = 1; // for a thread
// Of joints that are solved together, as a share of what their own blocks give way: enough for
// joints that say the same twice, too little to be seen.
inline constexpr Real held_compliance = Real(1e-3);

// Of a joint's blocks: notes the limits of the one of two rows that leaves free what they stop.
void find_limits(std::span<JointConstraint> blocks);
// The lower and the upper limit of a block that has some.
std::span<JointConstraint, 2> limits_of(JointConstraint &joint);
// The row of the limit that bears as the third of the block.
void add_limit_row(JointConstraint &joint);
// Makes the limits that bear something rows of their group, as long as it is held. Says whether
// anything changed.
bool choose_limits(StepContext &context, const JointGroup &group);
// With other limits than before.
void factor_again(StepContext &context, JointGroup &group);

// All rows of a group at once, without limits that would pull. Returns whether their ends meet.
bool solve_group(StepContext &context, JointGroup &group, const JointPass &pass);
// Joints that are solved together give way a little (held_compliance), as springs that are the
// stiffer the finer the substep is: what they hold would come back as speed, many times as much
// where an island takes more substeps than before, and a bridge that is pulled straight would throw
// up what falls on it. So drift that the loads do not account for moves bodies in the holding
// pass, and is taken out of their velocities when they have moved.
void push_groups(StepContext &context, const JointPass &pass);
void take_back_pushes(StepContext &context);
// The groups that are held once more, where contacts were solved after them.
void hold_touched_groups(StepContext &context, const JointPass &pass);
// After limits were released: what the others bore with them would not be borne again in the rest
// of the substep. `share`: of the substep, so far.
void remember_anew(StepContext &context, const JointGroup &group, Real share);
// Leaves a group to Gauss-Seidel, without what it remembers: forces that nothing has stretched for
// would give more energy than they took.
void let_go(StepContext &context, JointGroup &group);

// Limits and motors against bodies whose joints are solved together: as heavy as those make them.
void weigh(StepContext &context, JointConstraint &joint);
bool any_has_changed(StepContext &context);
// Those that hang on groups that have changed since; calls use(joint) after each.
void weigh_again(StepContext &context, const std::function<void(JointConstraint &)> &use);
// Likewise, and notes that none has changed any more.
void weigh_again(StepContext &context);
// What the groups of a joint's bodies answer to an impulse along its rows, where it is not of them.
// At once, so that the next limit or motor of the same bodies knows of it: each is as heavy as the
// groups make it, and would overshoot against bodies that these have not held back yet.
void answer(StepContext &context, const JointConstraint &joint, const Vec3 &impulse);
// What the joints of a group answer to an impact: changes velocities so that the joints hold them.
// Nothing for JointSystem::none, or a group that is not held.
void answer_impact(StepContext &context, std::uint32_t group);

} // namespace plumb::inline PLUMB_PRECISION
