// Triangles: containment, area, normal, barycentric coordinates and closest points.
//
// Collinear or coincident corners are allowed: such a triangle is flat, a segment or a point. A
// non-finite corner or point fails a check with the value in its message. For the range of
// exactness and of the bounds see shapes.h.
#pragma once

#include "engine/geometry/shapes.h"

#include <optional>

namespace plumb::inline PLUMB_PRECISION {

Aabb bounds(const Triangle &triangle);

Real area(const Triangle &triangle); // m^2, relative error at most 16 epsilon; 0 when flat

// Unit, towards the side from which the corners are counter-clockwise; off by at most 16 epsilon
// however narrow the triangle. Zero when it is flat (exactly: the corners are collinear).
Vec3 normal(const Triangle &triangle);

// Whether the point is in the triangle: in its plane, and between its edges or on them. Exact for
// the inputs as given, flat triangles included, so a computed point is hardly ever inside. To test
// whether a point is near, compare its distance to closest_point with a tolerance; to test whether
// it is over the triangle, use the signs of `barycentric`.
bool contains(const Triangle &triangle, const Vec3 &point);

// The weights (u, v, w) of a, b and c, with sum 1, that give the point's projection on the
// triangle's plane; all are >= 0 if the projection is in the triangle. None if the triangle is
// flat. A weight is off by at most 8 epsilon d / h, where d is the distance from a to the point and
// h the height over the longest edge; where d / h is far below 1, by 8 epsilon.
std::optional<Vec3> barycentric(const Triangle &triangle, const Vec3 &point);

// The closest point of the triangle. A point in the triangle is returned bit for bit, and so is a
// corner. The result is in the triangle, and as close as the true closest point, within 8 epsilon
// times the largest coordinate, however narrow or flat the triangle.
Vec3 closest_point(const Triangle &triangle, const Vec3 &point);

} // namespace plumb::inline PLUMB_PRECISION
