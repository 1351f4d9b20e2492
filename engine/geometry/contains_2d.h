// Whether a point lies in a 2D shape.
//
// All sets are closed: a point on the border is inside. An invalid shape or a non-finite point
// fails a check with the value in its message.
//
// Segment2, Ray2, Circle and Rectangle are exact for the inputs as given. The others are exact for
// small integers (up to 2^10 in float, 2^24 in double; oriented rectangles turned by multiples of
// 90 degrees). Otherwise the answer may be wrong only for points closer to the border than
// OrientedRectangle 4 epsilon |half_extents|, when its axis is one rounding off unit length
//   Compound2           as its parts
// Lengths whose squares overflow or underflow (in float, beyond 1e18 m or below 1e-18 m) are not
// covered, here or in the other 2D queries.
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
