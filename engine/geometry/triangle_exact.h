// Exact overlap tests of points, segments, triangles and axis-aligned boxes, for the inputs as
// given.
//
// Closed sets; triangles may be flat, segments may have zero length. Nothing is checked here:
// coordinates must be finite and boxes not empty.
#pragma once

#include "engine/geometry/shapes.h"

namespace plumb::inline PLUMB_PRECISION {

bool point_meets_triangle(const Vec3 &point, const Triangle &triangle);
bool segment_meets_triangle(const Segment &segment, const Triangle &triangle);
bool triangle_meets_triangle(const Triangle &a, const Triangle &b);
bool segment_meets_box(const Segment &segment, const Aabb &box);
bool triangle_meets_box(const Triangle &triangle, const Aabb &box);

// Projection along an axis; a signed area keeps the sign of that component of the normal.
inline Vec2 seen_along(int axis, const Vec3 &v) {
    return {v[(axis + 1) % 3], v[(axis + 2) % 3]};
}

} // namespace plumb::inline PLUMB_PRECISION
