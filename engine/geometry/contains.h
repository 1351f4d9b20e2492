// Whether a point lies in a shape.
//
// All sets are closed: a point on the surface is inside. An invalid shape or a non-finite point
// fails a check with the value in its message.
//
// Sphere, HalfSpace, Plane, Segment, Ray and Aabb are exact for the inputs as given. The others are
// exact when all inputs are small integers (products of their fourth powers are representable) and
// a box is not rotated; otherwise the answer may be wrong only for points closer to the surface
// than 8 epsilon times the size of the shape (its radius, length or diagonal), or, for a box
// without rotation, epsilon times its largest coordinate. Lengths whose fourth powers overflow or
// underflow (in float, beyond 1e9 m or below 1e-9 m) are not covered.
#pragma once

#include "engine/geometry/shapes.h"

namespace plumb::inline PLUMB_PRECISION {

bool contains(const Sphere &sphere, const Vec3 &point);
bool contains(const Aabb &box, const Vec3 &point); // an empty box contains nothing
bool contains(const Box &box, const Vec3 &point);
bool contains(const Capsule &capsule, const Vec3 &point);
bool contains(const Cylinder &cylinder, const Vec3 &point);
bool contains(const HalfSpace &half_space, const Vec3 &point);
bool contains(const Shape &shape, const Vec3 &point);

// These have no thickness, so a computed point is hardly ever on one. For a test with a tolerance,
// compare squared_distance (closest_point.h) with the tolerance squared.
bool contains(const Plane &plane, const Vec3 &point);
bool contains(const Segment &segment, const Vec3 &point);
bool contains(const Ray &ray, const Vec3 &point); // a negative max_t contains nothing

} // namespace plumb::inline PLUMB_PRECISION
