// Triangles: their points, their size, and where other points are seen from them.
//
// Corners on one line, or in one point, are allowed: such a triangle is flat, a segment or a point.
// A corner or point that is not finite fails a check with the value in its message. For the range
// of what is exact, and of the bounds, see shapes.h.
#pragma once

#include "engine/geometry/shapes.h"

#include <optional>

namespace plumb::inline PLUMB_PRECISION {

Aabb bounds(const Triangle &triangle);

Real area(const Triangle &triangle); // m^2, off by at most 16 epsilon of itself; 0 when flat

// Unit, towards the side from which the corners are counter-clockwise, and off by at most
// 16 epsilon however narrow the triangle; zero when it is flat (exactly: the corners are on one
// line).
Vec3 normal(const Triangle &triangle);

// Whether the point is in the triangle: in its plane and between its edges, or on them. Exact for
// the numbers as they are given, flat triangles included. So a computed point is hardly ever in; to
// ask whether one is near, compare its distance from closest_point with a tolerance, and to ask
// whether it is over the triangle, look at the signs of `barycentric`.
bool contains(const Triangle &triangle, const Vec3 &point);

// The weights (u, v, w), of sum 1, with which a, b and c give the foot of the point on the
// triangle's plane; all are >= 0 when the foot is in the triangle. None when the triangle is flat.
// With d the distance of a from the point, a weight is off by at most 8 epsilon d / h, h being the
// height over the longest edge, and where that is far below 1, 1.
std::optional<Vec3> barycentric(const Triangle &triangle, const Vec3 &point);

// The point of the triangle that is closest. A point that the triangle contains is its own answer,
// to the bit, and a corner is given to the bit. The answer is in the triangle, and as close as the
// closest, to within 8 epsilon times the largest coordinate, however narrow or flat the triangle.
Vec3 closest_point(const Triangle &triangle, const Vec3 &point);

} // namespace plumb::inline PLUMB_PRECISION
