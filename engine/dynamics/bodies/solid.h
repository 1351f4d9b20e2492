// What bodies and contacts ask of a solid, whatever its kind: each function has an answer for each
// kind of Shape, and a kind without one does not compile. Solids are in a frame of their body.
#pragma once

#include "engine/geometry/shapes.h"

#include <optional>

namespace plumb::inline PLUMB_PRECISION {

// The radius around the shape's core (support.h), which rolling does not move (m): that of a ball
// or capsule, else 0.
Real rounding_of(const Shape &solid);

// The distance from the origin to the farthest point of the core, the part that turning moves (m);
// 0 for a half-space, whose body does not turn.
Real core_extent(const Shape &solid);

// How far the core reaches along a vector of any length, from the origin (m times that length);
// infinite for a half-space.
Real core_reach(const Shape &solid, const Vec3 &along);

// Half of the least width (m); infinite for a half-space.
Real half_width(const Shape &solid);

// From end to end along the straight sides of a capsule or cylinder, else none (m).
std::optional<Vec3> axis_of(const Shape &solid);

// Whether a turn about an axis through the origin leaves the surface where it is.
bool is_round_about(const Shape &solid, const Vec3 &axis);

// The middle, if turning about it moves the surface: not of a ball, nor of a half-space.
std::optional<Vec3> middle_if_turning_shows(const Shape &solid);

// Whether the frame is the one of the shape's centre and principal axes, with a capsule's or
// cylinder's along y. Never so for a hull, whose axes must be found.
bool has_principal_frame(const Shape &solid);

// Products of rotations round off; normalising keeps the error from passing on to the next one.
Shape with_unit_rotation(const Shape &solid);

} // namespace plumb::inline PLUMB_PRECISION
