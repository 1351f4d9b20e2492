#include "engine/geometry/shape_cast.h"

#include "engine/core/check.h"
#include "engine/math/printed.h"

#include <algorithm>
#include <cmath>

namespace plumb::inline PLUMB_PRECISION {

void check_translation(const Vec3 &translation) {
    PLUMB_CHECK(is_finite(translation),
                "cast translation must be finite, got " << Printed{translation});
}

std::optional<CastHit> cast_cores(const CorePair &cores, const MovingCore &core_b,
                                  const Vec3 &translation) {
    check_translation(translation);
    const Real radii = cores.radius_a() + cores.radius_b();
    const Vec3 steps = glm::abs(translation);
    const Real reach = std::max({steps.x, steps.y, steps.z});

    CastHit hit;
    Vec3 guess = cores.between_middles();
    constexpr int step_limit = 100;
    for (int step = 0;; ++step) {
        // Move B towards A, so that A stays near the origin.
        core_b.place(-hit.t * translation);
        const GjkResult found = cores.search(guess, std::numeric_limits<Real>::infinity());
        const Real between = std::sqrt(found.squared_distance);
        const Real gap = found.is_overlapping ? -radii : between - radii;
        const Real size = std::max({found.size.x, found.size.y, found.size.z}) + radii + reach;
        if (step == 0 && gap <= cast_target(size)) {
            const Proximity at_start = proximity(cores, std::numeric_limits<Real>::infinity());
            hit.normal = at_start.normal;
            hit.point = at_start.on_b;
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
            // The distance is convex: if positive and not decreasing, it never reaches zero later.
            if (!(speed > Real(0)) || gap > speed * (Real(1) - hit.t) + cast_target(size))
                return std::nullopt;
        }
        // Between touching cores the direction is only rounding, and so is a direction along which
        // A moves away. Then keep the previous step's normal.
        if (!is_touch || (between > Real(32) * cast_target(size) && speed > Real(0)))
            hit.normal = normal;
        const Real next = std::min(hit.t + gap / speed, Real(1));
        if (is_touch || !(next > hit.t)) {
            const Witnesses on = witnesses(found);
            // If the cores are apart, their direction locates the point, whatever the hit normal.
            const Vec3 &inward = between > Real(32) * cast_target(size) ? normal : hit.normal;
            hit.point = (on.on_b - cores.radius_b() * inward) + hit.t * translation;
            return hit;
        }
        hit.t = next;
        guess = found.difference;
    }
}

} // namespace plumb::inline PLUMB_PRECISION
