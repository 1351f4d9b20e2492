// Limits that theory knows of, for the scenes where one applies.
#pragma once

#include "app/lab/map/map_layout.h"

namespace plumb {

// A body that is struck towards a wall.
struct StruckBody {
    double speed_ratio = 0; // of the struck body to the striker before, who hits it without rebound
    double way = 0;         // m, until the struck body's centre is in the middle of the wall
};

// Of a striker that flies along one of the world's axes (0 to 2) at one body at rest, straight in
// line with it, with one static body behind that. Nothing for scenes that are not so, or in which
// striker and struck rebound.
[[nodiscard]] std::optional<StruckBody> struck_before_wall(const SceneDesc &scene,
                                                           const std::string &striker, int axis);

// Of the only spring of a scene, undamped, between the world and what nothing else holds: a map's
// axis "spring.NAME.frequency", over dt or substeps.
[[nodiscard]] bool swings_by_itself(const SceneDesc &scene, const std::string &spring);

// The limits that can be read from a scene so far.
//
// Over dt and the speed of such a striker: where the struck body's way in a step ends in the middle
// of the wall. A method that makes its contacts at the start of a step, for bodies that move as
// they do then, sees what approaches a wall, but not what is struck towards it during the step;
// beyond the middle it pushes that out behind. With a gap of half the wall's thickness and half the
// body's size this is v dt = thickness + size. The striker, who follows, may press the body through
// from less if the solver does not converge.
//
// Over dt and the frequency of such a spring, of the explicit methods that are stable up to some
// omega h, h the substep: 2 of the symplectic ones, 2 sqrt(2) of RK4 (Hairer, Lubich, Wanner 2006,
// sec. I.5.2 and Hairer, Wanner 1996, sec. IV.2).
[[nodiscard]] std::vector<TheoryCurve> theory_of(const StabilityMap &map,
                                                 const RunOptions &base = {});

} // namespace plumb
