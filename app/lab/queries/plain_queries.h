// The queries as most engines write them: short, fast in the middle of their range, and not exact
// at its edges. Baselines between the book's and ours, for charts and tests only.
#pragma once

#include "engine/geometry/shapes.h"

namespace plumb::plain {

bool contains(const Sphere &sphere, const Vec3 &point);
// Within 1e-4 of the segment.
bool contains(const Segment &segment, const Vec3 &point);
// Within 1e-4 of the plane, and barycentric coordinates non-negative (Ericson 2005, 3.4).
bool contains(const Triangle &triangle, const Vec3 &point);

bool raycast(const Sphere &sphere, const Ray &ray); // the quadratic formula (Ericson 2005, 5.3.2)
bool raycast(const Aabb &box, const Ray &ray);      // IEEE slabs (Williams et al. 2005)
bool raycast(const Box &box, const Ray &ray);       // the same in the box's frame
bool raycast(const Triangle &triangle, const Ray &ray); // Moeller, Trumbore 1997, two-sided

bool linetest(const Aabb &box, const Vec3 &a, const Vec3 &b); // slabs, clipped to 0 <= t <= 1
bool linetest(const Box &box, const Vec3 &a, const Vec3 &b);
bool linetest(const Triangle &triangle, const Vec3 &a, const Vec3 &b);

bool overlaps(const Sphere &a, const Aabb &b); // Arvo 1990
bool overlaps(const Aabb &a, const Box &b);    // calls the next one
bool overlaps(const Box &a, const Box &b); // 15 axes (Gottschalk 1996) + 1e-6 for parallel edges
bool overlaps(const Triangle &a, const Aabb &b); // 13 axes (Akenine-Moeller 2001)
// Each edge of either triangle against the other one, by Moeller, Trumbore.
bool overlaps(const Triangle &a, const Triangle &b);

} // namespace plumb::plain
