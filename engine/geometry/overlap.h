// Whether two shapes overlap. Box with Box and Box with Aabb are in sat.h.
//
// All sets are closed: touching shapes overlap. An invalid shape fails a check with the value in
// its message; an empty Aabb overlaps nothing.
//
// Exact when all inputs are small integers (products of their sixth powers are representable for
// Capsule with Capsule and boxes, of their fourth powers otherwise) and no Box is rotated; always
// exact for Aabb with Aabb and Plane with Plane. Otherwise the answer may be wrong for shapes whose
// surfaces are closer to touching than 32 epsilon times the largest coordinate or size. Lengths
// beyond 1e6 m or below 1e-6 m may overflow or underflow in float and are not covered.
//
// For planes see also `classify` (plane.h), which gives a shape's side and distance.
#pragma once

#include "engine/geometry/sat.h"
#include "engine/geometry/shapes.h"

namespace plumb::inline PLUMB_PRECISION {

bool overlaps(const Sphere &a, const Sphere &b);
bool overlaps(const Sphere &sphere, const Aabb &box);
bool overlaps(const Sphere &sphere, const Box &box);
bool overlaps(const Sphere &sphere, const Plane &plane);

bool overlaps(const Aabb &a, const Aabb &b);
bool overlaps(const Aabb &box, const Plane &plane);
bool overlaps(const Box &box, const Plane &plane);
// Planes overlap unless they are exactly parallel, as given, and apart.
bool overlaps(const Plane &a, const Plane &b);

bool overlaps(const Capsule &a, const Capsule &b);
bool overlaps(const Capsule &capsule, const Sphere &sphere);
bool overlaps(const Capsule &capsule, const Aabb &box);
bool overlaps(const Capsule &capsule, const Box &box);
bool overlaps(const Capsule &capsule, const Plane &plane);

// The same with the arguments swapped.
inline bool overlaps(const Aabb &box, const Sphere &sphere) {
    return overlaps(sphere, box);
}
inline bool overlaps(const Box &box, const Sphere &sphere) {
    return overlaps(sphere, box);
}
inline bool overlaps(const Plane &plane, const Sphere &sphere) {
    return overlaps(sphere, plane);
}
inline bool overlaps(const Box &b, const Aabb &a) {
    return overlaps(a, b);
}
inline bool overlaps(const Plane &plane, const Aabb &box) {
    return overlaps(box, plane);
}
inline bool overlaps(const Plane &plane, const Box &box) {
    return overlaps(box, plane);
}
inline bool overlaps(const Sphere &sphere, const Capsule &c) {
    return overlaps(c, sphere);
}
inline bool overlaps(const Aabb &box, const Capsule &capsule) {
    return overlaps(capsule, box);
}
inline bool overlaps(const Box &box, const Capsule &capsule) {
    return overlaps(capsule, box);
}
inline bool overlaps(const Plane &plane, const Capsule &c) {
    return overlaps(c, plane);
}

} // namespace plumb::inline PLUMB_PRECISION
