// The slab test: a ray against an axis-aligned box (Kay and Kajiya 1986, "Ray tracing complex
// scenes").
#pragma once

#include "engine/geometry/shapes.h"

#include <algorithm>

namespace plumb::inline PLUMB_PRECISION {

// The interval [enter, exit] of the ray's parameter in a closed box, cut to [0, max_t], and the
// axis of the face it enters by (-1 when it starts inside). Returns whether there is one.
//
// A component of the direction that is 0 or -0 decides by the origin alone, so a ray that lies in a
// face is inside. The signs of the quotients, so the comparison with 0, are exact. The quotients
// carry at most two roundings each, and are allowed that much, and what underflow takes, where
// enter is compared with exit and with max_t: a ray through an edge or corner, or one that ends at
// a face, is never missed because of them. And as every operation is monotonic, a box that holds
// another is met by every ray that meets the other: trees prune without loss.
inline bool slab_interval(const Aabb &box, const Ray &ray, Real &enter, Real &exit,
                          int &enter_axis) {
    enter = Real(0);
    exit = std::numeric_limits<Real>::infinity();
    enter_axis = -1;
    for (int i = 0; i < 3; ++i) {
        const Real origin = ray.origin[i];
        const Real direction = ray.direction[i];
        const Real low = box.min[i];
        const Real high = box.max[i];
        if (direction == Real(0)) [[unlikely]] {
            if (origin < low || origin > high)
                return false;
            continue;
        }
        // The lesser and the greater, not a choice by the sign of the direction, which for rays of
        // all directions would be a guess.
        const Real to_low = (low - origin) / direction;
        const Real to_high = (high - origin) / direction;
        const Real near = std::min(to_low, to_high);
        enter_axis = near > enter ? i : enter_axis;
        enter = std::max(enter, near);
        exit = std::min(exit, std::max(to_low, to_high));
    }
    constexpr Real slack = Real(1) + Real(4) * std::numeric_limits<Real>::epsilon();
    constexpr Real least = std::numeric_limits<Real>::min();
    if (exit < Real(0) || enter > exit * slack + least || enter > ray.max_t * slack)
        return false;
    enter = std::min(enter, ray.max_t);
    exit = std::min(std::max(exit, enter), ray.max_t);
    return exit >= enter;
}

} // namespace plumb::inline PLUMB_PRECISION
