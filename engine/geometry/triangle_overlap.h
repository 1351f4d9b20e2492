// Whether a triangle overlaps another shape.
//
// All sets are closed: touching shapes overlap. Flat triangles are allowed (triangle.h). An invalid
// shape fails a check with the value in its message; an empty Aabb overlaps nothing.
//
// Triangle with Triangle, Aabb and Plane is exact for the inputs as given (in the range of
// predicates.h); for Segment see linetest (raycast.h). Sphere and Capsule are exact if all inputs
// are integers of at most 63 in magnitude. Otherwise, and for a rotated Box, the answer may be
// wrong for shapes whose surfaces are closer to touching than 8 epsilon times the largest
// coordinate or size. Sizes whose sixth powers overflow or underflow a double are not covered.
#pragma once

#include "engine/geometry/shapes.h"

namespace plumb::inline PLUMB_PRECISION {

bool overlaps(const Triangle &a, const Triangle &b);
bool overlaps(const Triangle &triangle, const Sphere &sphere);
bool overlaps(const Triangle &triangle, const Capsule &capsule);
bool overlaps(const Triangle &triangle, const Aabb &box);
// Without rotation the faces are at center -+ half_extents, as rounded.
bool overlaps(const Triangle &triangle, const Box &box);
bool overlaps(const Triangle &triangle, const Plane &plane);

// The same with the arguments swapped.
inline bool overlaps(const Sphere &sphere, const Triangle &t) {
    return overlaps(t, sphere);
}
inline bool overlaps(const Capsule &capsule, const Triangle &t) {
    return overlaps(t, capsule);
}
inline bool overlaps(const Aabb &box, const Triangle &t) {
    return overlaps(t, box);
}
inline bool overlaps(const Box &box, const Triangle &t) {
    return overlaps(t, box);
}
inline bool overlaps(const Plane &plane, const Triangle &t) {
    return overlaps(t, plane);
}

} // namespace plumb::inline PLUMB_PRECISION
