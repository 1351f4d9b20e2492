// The point of a shape that is closest to a given point.
//
// Solids are solid: a point that `contains` finds inside is its own closest point, to the bit. A
// shape that is not valid, an empty box, or a point that is not finite, fails a check with the
// value in its message.
//
// The result is off the true closest point by at most 16 epsilon times the size of the arguments
// (the largest coordinate of any of them, or size): the result itself is rounded at that size.
// It is in the shape within as much. Lengths whose squares overflow or underflow (in float, beyond
// 1e18 m or below 1e-18 m) are not covered.
#pragma once

#include "engine/geometry/shapes.h"

namespace plumb::inline PLUMB_PRECISION {

Vec3 closest_point(const Sphere &sphere, const Vec3 &point);
Vec3 closest_point(const Aabb &box, const Vec3 &point);
Vec3 closest_point(const Box &box, const Vec3 &point);
Vec3 closest_point(const Capsule &capsule, const Vec3 &point);
Vec3 closest_point(const Cylinder &cylinder, const Vec3 &point);
Vec3 closest_point(const HalfSpace &half_space, const Vec3 &point);
Vec3 closest_point(const Shape &shape, const Vec3 &point);
Vec3 closest_point(const Plane &plane, const Vec3 &point);
// An end is given to the bit.
Vec3 closest_point(const Segment &segment, const Vec3 &point);
// max_t must not be negative.
Vec3 closest_point(const Ray &ray, const Vec3 &point);

// The square of the distance (m^2) of a point; 0 inside. Of a box it is taken from differences, so
// it is true to 8 epsilon of itself for an Aabb however far from the origin; and for an Aabb or a
// Segment of small integers, exact but for one division.
Real squared_distance(const Aabb &box, const Vec3 &point);
Real squared_distance(const Box &box, const Vec3 &point);
Real squared_distance(const Segment &segment, const Vec3 &point);
Real squared_distance(const Ray &ray, const Vec3 &point);

} // namespace plumb::inline PLUMB_PRECISION
