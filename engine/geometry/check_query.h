// Refuses points and rays that no query can answer. A single combined test when all is well.
#pragma once

#include "engine/geometry/shapes.h"

namespace plumb::inline PLUMB_PRECISION {

// Fails the check that names the problem, if there is one.
[[gnu::cold]] void refuse(const Vec3 &point);
[[gnu::cold]] void refuse(const Ray &ray);

inline void check_point(const Vec3 &point) {
    if (!is_finite(point)) [[unlikely]]
        refuse(point);
}

// max_t may be infinite.
inline void check_ray(const Ray &ray) {
    const Vec3 &o = ray.origin, &d = ray.direction;
    if (!are_finite(o.x, o.y, o.z, d.x, d.y, d.z) || d == Vec3{Real(0)} || ray.max_t != ray.max_t)
        [[unlikely]]
        refuse(ray);
}

} // namespace plumb::inline PLUMB_PRECISION
