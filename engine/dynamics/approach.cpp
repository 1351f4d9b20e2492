#include "engine/dynamics/approach.h"

#include "engine/dynamics/motion.h"
#include "engine/geometry/half_space.h"

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// How far apart two solids are, and along which unit normal from A to B; a distance of 0 has none.
struct Gap {
    Real distance = Real(0);
    Vec3 normal{Real(0)};
};

Transform pose_of(const Motion &motion) {
    return {motion.position, motion.rotation};
}

template <typename A, typename B> Gap gap_between(const A &a, const B &b) {
    if constexpr (std::same_as<A, HalfSpace> && std::same_as<B, HalfSpace>) {
        return {std::numeric_limits<Real>::infinity(), Vec3{Real(0), Real(1), Real(0)}};
    } else {
        const ClosestPoints found = distance(a, b);
        return {found.distance, found.normal};
    }
}

Gap gap_between(const Shape &a, const Shape &b) {
    return std::visit(
        [](const auto &first, const auto &second) { return gap_between(first, second); }, a, b);
}

// The pair on its way. `gap(t)` gives the gap after t seconds.
template <typename GapAfter>
Approach advance(const GapAfter &gap_after, const Motion &a, Real extent_a, const Motion &b,
                 Real extent_b, Real duration, Real margin) {
    const Vec3 velocity = b.velocity - a.velocity;
    const auto straight = [&](const Gap &gap) { return -glm::dot(velocity, gap.normal); };
    // A point of a turning body at distance r moves along n with at most |n x w| r.
    const auto turning = [&](const Gap &gap) {
        return glm::length(glm::cross(gap.normal, a.angular_velocity)) * extent_a +
               glm::length(glm::cross(gap.normal, b.angular_velocity)) * extent_b;
    };
    constexpr int step_limit = 32;
    constexpr Real near = Real(1e-3); // of the margin: as good as a touch
    Approach best{Real(0), std::numeric_limits<Real>::infinity()};
    Real t = Real(0);
    Real before = Real(0);        // the time of the step before,
    bool was_approaching = false; // and whether they came nearer then
    for (int step = 0; step < step_limit; ++step) {
        const Gap gap = gap_after(t);
        if (gap.distance <= near * margin)
            return {t, Real(0)};
        const Real closing = straight(gap);
        if (gap.distance < best.distance)
            best = {t, gap.distance};
        if (was_approaching && !(closing > Real(0))) {
            // The closest point lies between: there the distance stops falling.
            Real low = before;
            Real high = t;
            // So near that what is left of the approach does not count over the whole time.
            constexpr int most_cuts = 30;
            for (int cut = 0; cut < most_cuts; ++cut) {
                const Real middle = Real(0.5) * (low + high);
                const Gap between = gap_after(middle);
                if (between.distance < best.distance)
                    best = {middle, between.distance};
                if (between.distance <= near * margin)
                    return {middle, Real(0)};
                const Real rest = straight(between);
                if (std::abs(rest) * duration < Real(0.1) * between.distance)
                    return {middle, between.distance};
                (rest > Real(0) ? low : high) = middle;
            }
        }
        const Real fastest = closing + turning(gap);
        const Real left = duration - t;
        if (!(left > Real(0)) || !(fastest > Real(0)) || gap.distance - fastest * left >= margin)
            return best;
        was_approaching = closing > Real(0);
        before = t;
        t = std::min(t + gap.distance / fastest, duration);
    }
    return best.distance <= margin ? Approach{best.time, Real(0)} : best;
}

} // namespace

Motion ahead(const Motion &motion, Real t) {
    return {motion.position + t * motion.velocity,
            turned(motion.rotation, motion.angular_velocity, t), motion.velocity,
            motion.angular_velocity};
}

Approach approach(const MovingSolid &a, const MovingSolid &b, Real duration, Real margin) {
    const auto gap_after = [&](Real t) {
        return gap_between(placed(*a.shape, pose_of(ahead(a.motion, t))),
                           placed(*b.shape, pose_of(ahead(b.motion, t))));
    };
    return advance(gap_after, a.motion, a.extent, b.motion, b.extent, duration, margin);
}

Approach approach(const MovingSolid &a, const Triangle &b, const Motion &motion_b, Real extent_b,
                  Real duration, Real margin) {
    const auto gap_after = [&](Real t) {
        const Triangle triangle = placed(b, pose_of(ahead(motion_b, t)));
        return std::visit([&](const auto &solid) { return gap_between(solid, triangle); },
                          placed(*a.shape, pose_of(ahead(a.motion, t))));
    };
    return advance(gap_after, a.motion, a.extent, motion_b, extent_b, duration, margin);
}

Real core_extent(const Shape &local) {
    return std::visit(
        []<typename Solid>(const Solid &solid) -> Real {
            if constexpr (std::same_as<Solid, Sphere>)
                return glm::length(solid.center);
            else if constexpr (std::same_as<Solid, Box>)
                return glm::length(solid.center) + glm::length(solid.half_extents);
            else if constexpr (std::same_as<Solid, Capsule>)
                return std::max(glm::length(solid.a), glm::length(solid.b));
            else if constexpr (std::same_as<Solid, Cylinder>)
                return std::max(glm::length(solid.a), glm::length(solid.b)) + solid.radius;
            else if constexpr (std::same_as<Solid, ConvexHull>) {
                Real farthest = Real(0);
                for (const Vec3 &vertex : solid.mesh->vertices)
                    farthest = std::max(farthest, glm::dot(vertex, vertex));
                return glm::length(solid.position) + std::sqrt(farthest);
            } else {
                return Real(0);
            }
        },
        local);
}

Real half_width(const Shape &local) {
    return std::visit(
        []<typename Solid>(const Solid &solid) -> Real {
            if constexpr (std::same_as<Solid, Sphere> || std::same_as<Solid, Capsule>)
                return solid.radius;
            else if constexpr (std::same_as<Solid, Box>)
                return std::min({solid.half_extents.x, solid.half_extents.y, solid.half_extents.z});
            else if constexpr (std::same_as<Solid, Cylinder>)
                return std::min(solid.radius, Real(0.5) * glm::distance(solid.a, solid.b));
            else if constexpr (std::same_as<Solid, ConvexHull>) {
                // From the face planes: the least distance across one of them.
                Real least = std::numeric_limits<Real>::infinity();
                for (const Plane &plane : solid.mesh->planes) {
                    Real lowest = plane.offset;
                    for (const Vec3 &vertex : solid.mesh->vertices)
                        lowest = std::min(lowest, glm::dot(plane.normal, vertex));
                    least = std::min(least, plane.offset - lowest);
                }
                return Real(0.5) * least;
            } else {
                return std::numeric_limits<Real>::infinity();
            }
        },
        local);
}

} // namespace plumb::inline PLUMB_PRECISION
