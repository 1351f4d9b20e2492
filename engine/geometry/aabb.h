// Axis-aligned box helpers for the queries and the trees.
#pragma once

#include "engine/geometry/shapes.h"

#include <glm/common.hpp>

namespace plumb::inline PLUMB_PRECISION {

inline bool is_empty(const Aabb &box) {
    return box.min.x > box.max.x || box.min.y > box.max.y || box.min.z > box.max.z;
}

// Whether two non-empty boxes overlap; touching counts.
inline bool touch(const Aabb &a, const Aabb &b) {
    return a.min.x <= b.max.x && b.min.x <= a.max.x && a.min.y <= b.max.y && b.min.y <= a.max.y &&
           a.min.z <= b.max.z && b.min.z <= a.max.z;
}

// The smallest box around both.
inline Aabb joined(const Aabb &a, const Aabb &b) {
    return {glm::min(a.min, b.min), glm::max(a.max, b.max)};
}

inline Vec3 middle_of(const Aabb &box) {
    return Real(0.5) * (box.min + box.max);
}

// Half the surface area, m^2: the measure of tree cost (Goldsmith and Salmon 1987).
inline Real half_area(const Aabb &box) {
    const Vec3 size = box.max - box.min;
    return size.x * size.y + size.y * size.z + size.z * size.x;
}

} // namespace plumb::inline PLUMB_PRECISION
