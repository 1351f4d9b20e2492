// Whether a point lies in a shape.
//
// All sets are closed: a point on the surface is inside. A shape that is not valid, or a point that
// is not finite, fails a check with the value in its message.
//
// Sphere, HalfSpace, Plane, Segment, Ray and Aabb are answered exactly, for the numbers as they are
// given. The others are exact when everything is a small integer (products of their fourth powers
// can be represented) and a box is not rotated; elsewhere the answer may be wrong for points nearer
// to the surface than 8 epsilon times the size of the shape (its radius, its length, its diagonal)
// only, for a box without rotation epsilon times its largest coordinate. Lengths whose fourth
// powers overflow or underflow (in float, beyond 1e9 m or below 1e-9 m) are not covered.
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

// These have no thickness, and a computed point is hardly ever on one: to ask within a tolerance,
// compare the squared_distance (closest_point.h) with its square.
bool contains(const Plane &plane, const Vec3 &point);
bool contains(const Segment &segment, const Vec3 &point);
bool contains(const Ray &ray, const Vec3 &point); // a negative max_t contains nothing

} // namespace plumb::inline PLUMB_PRECISION
