// The point of a shape of the plane that is closest to a given point.
//
// A point that `contains` finds inside is its own closest point, to the bit. A shape that is not
// valid, an empty rectangle, or a point that is not finite, fails a check with the value in its
// message.
//
// Of a Rectangle the result is exact. Elsewhere it is off the true closest point by at most
// 8 epsilon times the largest coordinate or size among the arguments: the result itself is rounded
// at that size.
#pragma once

#include "engine/geometry/shapes_2d.h"

namespace plumb::inline PLUMB_PRECISION {

// An end is given to the bit.
Vec2 closest_point(const Segment2 &segment, const Vec2 &point);
Vec2 closest_point(const Ray2 &ray, const Vec2 &point); // max_t must not be negative
Vec2 closest_point(const Circle &circle, const Vec2 &point);
Vec2 closest_point(const Rectangle &rectangle, const Vec2 &point);
Vec2 closest_point(const OrientedRectangle &rectangle, const Vec2 &point);
// Of parts that are equally close, the first.
Vec2 closest_point(const Compound2 &compound, const Vec2 &point);

} // namespace plumb::inline PLUMB_PRECISION
