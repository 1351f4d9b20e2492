// A convex shape that moves along a line until it touches another.
//
// Conservative advancement (Mirtich 1996, "Impulse-based dynamic simulation of rigid body systems",
// 2.3): it is moved as far as the slab between the closest points lets it, again and again. For a
// straight motion the distance is a convex function of time and the slab its tangent, so this is
// Newton's method from the side from which it never passes the root: nothing is tunnelled through,
// however thin.
#pragma once

#include "engine/geometry/epa.h"

#include <optional>

namespace plumb::inline PLUMB_PRECISION {

struct CastHit {
    Real t = Real(0);     // in [0, 1], of the translation
    Vec3 point{Real(0)};  // where they touch, on B
    Vec3 normal{Real(0)}; // unit, from A to B
    bool starts_overlapping = false;
};

// The first touch of A, moved by t * translation, with B. Both are solid: when they overlap (or
// touch, within cast_target) at t = 0 that is the hit, whichever way A goes, with the normal that
// `penetration` gives. A translation of zero
// asks only that. One that is not finite fails a check.
//
// At `t` the shapes are within cast_target of each other, and not in each other: the true hit is no
// earlier, but for the rounding of `distance` (gjk.h), with the translation as one of the
// coordinates. A pass closer than the target is a hit, one farther is not.
template <typename A, typename B>
requires ConvexPair<A, B> std::optional<CastHit> cast(const A &a, const Vec3 &translation,
                                                      const B &b);

// How close is a touch, in metres, for coordinates of that size, from the start of the motion: 32
// times what they are rounded by, so that the direction between the closest points means something.
inline Real cast_target(Real size) {
    return Real(32) * std::numeric_limits<Real>::epsilon() * size;
}

template <typename A, typename B>
requires ConvexPair<A, B> std::optional<CastHit> cast(const A &a, const Vec3 &translation,
                                                      const B &b) {
    PLUMB_CHECK(is_finite(translation), "cast translation must be finite, got ("
                                            << translation.x << ", " << translation.y << ", "
                                            << translation.z << ')');
    const Vec3 origin = place_of(a);
    const auto core_a = core_of(a, origin);
    const auto start_b = core_of(b, origin);
    const Real radii = core_a.radius + start_b.radius;
    const Vec3 steps = glm::abs(translation);
    const Real reach = std::max({steps.x, steps.y, steps.z});

    CastHit hit;
    Vec3 guess = start_b.middle() - core_a.middle();
    constexpr int step_limit = 100;
    for (int step = 0;; ++step) {
        // B comes towards A, which stays near the origin.
        auto core_b = start_b;
        core_b.move(-hit.t * translation);
        const GjkResult found = gjk(core_a, core_b, guess, std::numeric_limits<Real>::infinity());
        const Real between = std::sqrt(found.squared_distance);
        const Real gap = found.is_overlapping ? -radii : between - radii;
        const Real size = std::max({found.size.x, found.size.y, found.size.z}) + radii + reach;
        if (step == 0 && gap <= cast_target(size)) {
            const Proximity at_start =
                proximity(core_a, core_b, std::numeric_limits<Real>::infinity());
            hit.normal = at_start.normal;
            hit.point = origin + at_start.on_b;
            hit.starts_overlapping = true;
            return hit;
        }
        const bool is_limit = step == step_limit;
        if (is_limit) [[unlikely]]
            (void)PLUMB_RARELY("cast: step limit", true);
        const Vec3 normal = found.is_overlapping ? hit.normal : found.difference / between;
        const Real speed = glm::dot(normal, translation);
        const bool is_touch = gap <= cast_target(size) || is_limit;
        if (!is_touch) {
            // Of a convex function that does not fall, and is positive, nothing later is zero.
            if (!(speed > Real(0)) || gap > speed * (Real(1) - hit.t) + cast_target(size))
                return std::nullopt;
        }
        // Between touching cores the direction is rounding, and one that A moves away along is,
        // too; that of the step before is not.
        if (!is_touch || (between > Real(32) * cast_target(size) && speed > Real(0)))
            hit.normal = normal;
        const Real next = std::min(hit.t + gap / speed, Real(1));
        if (is_touch || !(next > hit.t)) {
            const Witnesses on = witnesses(found);
            // Between cores that are apart the point is where they say, whatever the normal.
            const Vec3 &inward = between > Real(32) * cast_target(size) ? normal : hit.normal;
            hit.point = origin + (on.on_b - core_b.radius * inward) + hit.t * translation;
            return hit;
        }
        hit.t = next;
        guess = found.difference;
    }
}

} // namespace plumb::inline PLUMB_PRECISION
