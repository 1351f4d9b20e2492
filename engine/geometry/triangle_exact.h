// Whether points, segments, triangles and axis-aligned boxes have common points: exactly, for the
// numbers as they are given.
//
// Closed sets; triangles may be flat, segments without length. Nothing is checked here: coordinates
// are finite, boxes not empty.
#pragma once

#include "engine/geometry/shapes.h"

namespace plumb::inline PLUMB_PRECISION {

bool point_meets_triangle(const Vec3 &point, const Triangle &triangle);
bool segment_meets_triangle(const Segment &segment, const Triangle &triangle);
bool triangle_meets_triangle(const Triangle &a, const Triangle &b);
bool segment_meets_box(const Segment &segment, const Aabb &box);
bool triangle_meets_box(const Triangle &triangle, const Aabb &box);

// Seen along an axis, so that areas keep the sign they have in that component of a normal.
inline Vec2 seen_along(int axis, const Vec3 &v) {
    return {v[(axis + 1) % 3], v[(axis + 2) % 3]};
}

} // namespace plumb::inline PLUMB_PRECISION
