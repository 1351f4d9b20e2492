// Whether a point of the plane lies in a shape.
//
// All sets are closed: a point on the border is inside. A shape that is not valid, or a point that
// is not finite, fails a check with the value in its message.
//
// Segment2, Ray2, Circle and Rectangle are answered exactly, for the numbers as they are given. The
// others are exact for small integers (up to 2^10 in float, 2^24 in double; an oriented rectangle
// turned by quarters). Elsewhere the answer may be wrong only for points nearer to the border than
//   OrientedRectangle   4 epsilon |half_extents|, when its axis is a rounding off unit length
//   Compound2           as its parts
// Lengths whose squares overflow or underflow (in float, beyond 1e18 m or below 1e-18 m) are not
// covered, here and in the other questions to shapes of the plane.
#pragma once

#include "engine/geometry/shapes_2d.h"

namespace plumb::inline PLUMB_PRECISION {

bool contains(const Segment2 &segment, const Vec2 &point);
bool contains(const Ray2 &ray, const Vec2 &point);
bool contains(const Circle &circle, const Vec2 &point);
bool contains(const Rectangle &rectangle, const Vec2 &point); // an empty one contains nothing
bool contains(const OrientedRectangle &rectangle, const Vec2 &point);
bool contains(const Compound2 &compound, const Vec2 &point);

} // namespace plumb::inline PLUMB_PRECISION
