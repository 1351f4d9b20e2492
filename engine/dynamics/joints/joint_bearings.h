// The limits and motors of joints that are solved with their group (JointSystem): each as the third
// row of the two-row block that leaves its direction free.
#pragma once

#include "engine/dynamics/joints/joint_constraint.h"
#include "engine/dynamics/joints/wide_matrix.h"

#include <span>

namespace plumb::inline PLUMB_PRECISION {

// Links a joint's limits and motor to the two-row block that leaves their direction free.
void find_bearings(std::span<JointConstraint> blocks);
// The lower and upper limit of a block that has limits, and the motor of one that has a motor.
std::span<JointConstraint, 2> limits_of(JointConstraint &joint);
JointConstraint &motor_of(JointConstraint &joint);
inline bool is_limit(Bearing bearing) {
    return bearing != Bearing::none && bearing != Bearing::motor;
}

// Adds the row of the active limit or motor as the block's third.
void add_bearing_row(JointConstraint &joint);
// A limit begins, and ends, with no impulse; a motor takes its own along.
void set_bearing(JointConstraint &joint, Bearing bearing);

// These choose and release for a whole group; all but the first factor it again. Each returns
// whether anything changed.
//
// Moves loaded limits, and else motors that have force to spare and their speed, into their group
// as rows, while the group is held. `share`: of the substep, that impulses stand for.
bool choose_bearings(StepContext &context, const JointGroup &group, Real share);
// Releases limits that pull and motors that are too weak.
bool release_bearings(StepContext &context, JointGroup &group, const JointPass &pass);
// Opens limits that an impact, whose response is in the right-hand sides, would make pull by more
// than they carried in the last substep, and motors that would need too much force.
bool open_bearings(StepContext &context, JointGroup &group, std::span<const WideVec3> sides);
// Releases motors that contacts have thrown off their speed.
bool release_thrown_motors(StepContext &context, JointGroup &group);

} // namespace plumb::inline PLUMB_PRECISION
