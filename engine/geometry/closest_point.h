// The point of a shape closest to a given point.
//
// Solids are solid: a point that `contains` reports inside is its own closest point, bit for bit.
// An invalid shape, an empty box, or a non-finite point fails a check with the value in its
// message.
//
// The result is within 16 epsilon times the largest coordinate or size among the arguments of the
// true closest point (the result itself is rounded at that scale), and in the shape within the same
// bound. Lengths whose squares overflow or underflow (in float, beyond 1e18 m or below 1e-18 m) are
// not covered.
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
// An end is returned bit for bit.
Vec3 closest_point(const Segment &segment, const Vec3 &point);
// max_t must not be negative.
Vec3 closest_point(const Ray &ray, const Vec3 &point);

// Squared distance (m^2) to a point; 0 inside. For boxes it is computed from differences, so for an
// Aabb the relative error is at most 8 epsilon however far it is from the origin. For an Aabb or
// Segment of small integers it is exact except for one division.
Real squared_distance(const Aabb &box, const Vec3 &point);
Real squared_distance(const Box &box, const Vec3 &point);
Real squared_distance(const Segment &segment, const Vec3 &point);
Real squared_distance(const Ray &ray, const Vec3 &point);

} // namespace plumb::inline PLUMB_PRECISION
