// The point of a 2D shape closest to a given point.
//
// A point that `contains` reports inside is its own closest point, bit for bit. An invalid shape,
// an empty rectangle, or a non-finite point fails a check with the value in its message.
//
// Exact for a Rectangle. Otherwise within 8 epsilon times the largest coordinate or size among the
// arguments of the true closest point: the result itself is rounded at that scale.
#pragma once

#include "engine/geometry/shapes_2d.h"

namespace plumb::inline PLUMB_PRECISION {

// An end is returned bit for bit.
Vec2 closest_point(const Segment2 &segment, const Vec2 &point);
Vec2 closest_point(const Ray2 &ray, const Vec2 &point); // max_t must not be negative
Vec2 closest_point(const Circle &circle, const Vec2 &point);
Vec2 closest_point(const Rectangle &rectangle, const Vec2 &point);
Vec2 closest_point(const OrientedRectangle &rectangle, const Vec2 &point);
// Among equally close parts the first wins.
Vec2 closest_point(const Compound2 &compound, const Vec2 &point);

} // namespace plumb::inline PLUMB_PRECISION
