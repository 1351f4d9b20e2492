// The slab test: a ray against an axis-aligned box (Kay and Kajiya 1986, "Ray tracing complex
// scenes").
#pragma once

#include "engine/geometry/shapes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/common.hpp>

namespace plumb::inline PLUMB_PRECISION {

// A ray for many boxes: its reciprocals are computed once.
struct SlabRay {
    Ray ray;
    Vec3 inverse{Real(0)}; // 1 / direction; usable if every component of both is a normal number
    bool has_inverse = true;

    explicit SlabRay(const Ray &given) : ray(given) {
        constexpr Real least = std::numeric_limits<Real>::min();
        for (int i = 0; i < 3; ++i) {
            const Real size = std::abs(ray.direction[i]);
            has_inverse = has_inverse && size >= least && size <= Real(1) / least;
            inverse[i] = Real(1) / ray.direction[i];
        }
    }
};

// Intersects three slabs, each crossed from `near` to `far`; -infinity to infinity for a ray inside
// a slab and parallel to it.
inline bool slab_interval(const Vec3 &near, const Vec3 &far, Real max_t, Real &enter, Real &exit,
                          int &enter_axis) {
    constexpr Real slack = Real(1) + Real(4) * std::numeric_limits<Real>::epsilon();
    constexpr Real least = std::numeric_limits<Real>::min();
    const Real latest = std::max(std::max(std::max(Real(0), near.x), near.y), near.z);
    const Real earliest = std::min(std::min(far.x, far.y), far.z);
    // Evaluated together: separate branches would be unpredictable.
    const bool is_missed = (static_cast<unsigned>(earliest < Real(0)) |
                            static_cast<unsigned>(latest > earliest * slack + least) |
                            static_cast<unsigned>(latest > max_t * slack)) != 0;
    enter_axis = near.x == latest ? 0 : (near.y == latest ? 1 : 2);
    enter_axis = latest > Real(0) ? enter_axis : -1;
    enter = std::min(latest, max_t);
    exit = std::min(std::max(earliest, enter), max_t);
    return !is_missed && exit >= enter;
}

// The interval [enter, exit] of the ray's parameter in a closed box, clipped to [0, max_t], and the
// axis of the face it enters through (-1 when it starts inside). Returns whether there is one.
//
// Where the direction is 0 or -0 the origin alone decides, so a ray lying in a face is inside. The
// signs of the quotients, and so the comparison with 0, are exact. The quotients carry at most two
// roundings each, three with SlabRay. Comparing enter with exit and with max_t allows for that and
// for underflow, so a ray through an edge or corner, or one that ends at a face, is never missed
// because of rounding. Every operation is monotonic, so a ray that hits a box also hits every box
// around it: pruning in trees loses nothing.
inline bool slab_interval(const Aabb &box, const Ray &ray, Real &enter, Real &exit,
                          int &enter_axis) {
    constexpr Real endless = std::numeric_limits<Real>::infinity();
    Vec3 near{-endless}, far{endless};
    for (int i = 0; i < 3; ++i) {
        const Real origin = ray.origin[i];
        const Real direction = ray.direction[i];
        if (direction == Real(0)) [[unlikely]] {
            if (origin < box.min[i] || origin > box.max[i])
                return false;
            continue;
        }
        // Min and max rather than a branch on the direction's sign, which would be unpredictable
        // for rays in all directions.
        const Real to_low = (box.min[i] - origin) / direction;
        const Real to_high = (box.max[i] - origin) / direction;
        near[i] = std::min(to_low, to_high);
        far[i] = std::max(to_low, to_high);
    }
    return slab_interval(near, far, ray.max_t, enter, exit, enter_axis);
}

inline bool slab_interval(const Aabb &box, const SlabRay &prepared, Real &enter, Real &exit,
                          int &enter_axis) {
    const Ray &ray = prepared.ray;
    if (!prepared.has_inverse) [[unlikely]]
        return slab_interval(box, ray, enter, exit, enter_axis);
    const Vec3 to_low = (box.min - ray.origin) * prepared.inverse;
    const Vec3 to_high = (box.max - ray.origin) * prepared.inverse;
    return slab_interval(glm::min(to_low, to_high), glm::max(to_low, to_high), ray.max_t, enter,
                         exit, enter_axis);
}

} // namespace plumb::inline PLUMB_PRECISION
