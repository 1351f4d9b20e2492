#include "engine/dynamics/contacts/approach.h"

#include "engine/dynamics/bodies/motion.h"
#include "engine/dynamics/bodies/solid.h"
#include "engine/geometry/edge_gap.h"
#include "engine/geometry/gjk.h"
#include "engine/geometry/half_space.h"
#include "engine/geometry/hull_queries.h"

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// `guess`: a direction from A to B to look along first, of any length; zero: from middle to middle.
template <typename A, typename B> ClosestPoints closest(const A &a, const B &b, const Vec3 &guess) {
    if constexpr (requires {
                      core_of(a, Vec3{});
                      core_of(b, Vec3{});
                  }) {
        const Vec3 origin = place_of(a);
        const auto core_a = core_of(a, origin);
        const auto core_b = core_of(b, origin);
        if constexpr (HaveFaceGap<decltype(core_a), decltype(core_b)>)
            if (guess != Vec3{Real(0)}) {
                const auto known =
                    feature_gap(core_a, core_b, guess, std::numeric_limits<Real>::infinity());
                if (known && known->separation > Real(0))
                    return {known->separation, origin + known->on_a, origin + known->on_b,
                            known->normal};
            }
        if constexpr (!HasNearestPoints<decltype(core_a), decltype(core_b)>)
            return closest_points(
                gjk(core_a, core_b,
                    guess == Vec3{Real(0)} ? core_b.middle() - core_a.middle() : guess,
                    std::numeric_limits<Real>::infinity()),
                core_a.radius, core_b.radius, origin);
    }
    return distance(a, b);
}

template <typename A, typename B> Gap gap_between(const A &a, const B &b, const Vec3 &guess) {
    if constexpr (std::same_as<A, HalfSpace> && std::same_as<B, HalfSpace>) {
        return {std::numeric_limits<Real>::infinity(), Vec3{Real(0), Real(1), Real(0)}};
    } else {
        const ClosestPoints found = closest(a, b, guess);
        return {found.distance, found.normal};
    }
}

Gap gap_between(const Shape &a, const Shape &b, const Vec3 &guess) {
    return std::visit(
        [&](const auto &first, const auto &second) { return gap_between(first, second, guess); }, a,
        b);
}

Real core_reach(const Triangle &local, const Vec3 &along) {
    return std::max({glm::dot(local.a, along), glm::dot(local.b, along), glm::dot(local.c, along)});
}

Real rounding_of(const Triangle & /*triangle*/) {
    return Real(0);
}

// How far a turning solid reaches along a unit vector n, to first order in its turn, plus a bound
// on what that leaves out: a core point p moves to n . (p + t w x p) = (n + t n x w) . p, and at
// most (w t)^2 / 2 of its distance from the middle farther.
template <typename Solid> struct TurningReach {
    const Solid &solid;
    Vec3 along;   // n, in the solid's frame
    Vec3 turning; // n x w, in the solid's frame
    Real rounding;
    Real bend;

    TurningReach(const Solid &what, const Motion &motion, Real extent, const Vec3 &n, Real t)
        : solid(what), rounding(rounding_of(what)),
          bend(Real(0.5) * glm::dot(motion.angular_velocity, motion.angular_velocity) * extent) {
        const Quat back = glm::conjugate(turned(motion.rotation, motion.angular_velocity, t));
        along = back * n;
        turning = back * glm::cross(n, motion.angular_velocity);
    }
    Real operator()(Real later) const {
        return core_reach(solid, along + later * turning) + rounding + bend * later * later;
    }
};

// A lower bound on how long two solids stay apart along the normal of their gap at t: their
// distance less the reaches above is concave in time, so its chord never says too much. `left` if
// they do not come as near as `least` until then; `stays` is set if they also stay `enough` apart.
template <typename B>
Real time_apart(const Vec3 &normal, const Shape &a, const Motion &motion_a, Real extent_a,
                const B &b, const Motion &motion_b, Real extent_b, Real t, Real left, Real least,
                Real enough, bool &stays) {
    const Vec3 velocity = motion_b.velocity - motion_a.velocity;
    const Vec3 between = (motion_b.position - motion_a.position) + t * velocity;
    const TurningReach reach_a(a, motion_a, extent_a, normal, t);
    const TurningReach reach_b(b, motion_b, extent_b, -normal, t);
    const auto apart = [&](Real later) {
        return glm::dot(between + later * velocity, normal) - reach_a(later) - reach_b(later);
    };
    const Real at_end = apart(left);
    stays = at_end >= enough;
    if (at_end > least)
        return left;
    Real time = Real(0);
    Real now = apart(Real(0));
    constexpr int most_chords = 5;
    for (int i = 0; i < most_chords && now > Real(2) * least && std::isfinite(at_end); ++i) {
        time += (now - least) / (now - at_end) * (left - time);
        now = apart(time);
    }
    return time;
}

// The pair on its way, from their first gap. `gap_after(t, guess)` gives the gap after t seconds,
// looking along the guess first; `apart_for(n, t, left, least, enough, stays)` is time_apart.
template <typename GapAfter, typename ApartFor>
Approach advance(const GapAfter &gap_after, const ApartFor &apart_for, const Motion &a,
                 Real extent_a, const Motion &b, Real extent_b, Real duration, Real margin,
                 const Gap &first) {
    const Vec3 velocity = b.velocity - a.velocity;
    const auto straight = [&](const Gap &gap) { return -glm::dot(velocity, gap.normal); };
    // A point of a turning body at distance r moves along n with at most |n x w| r.
    const auto turning = [&](const Gap &gap) {
        return glm::length(glm::cross(gap.normal, a.angular_velocity)) * extent_a +
               glm::length(glm::cross(gap.normal, b.angular_velocity)) * extent_b;
    };
    constexpr int step_limit = 32;
    constexpr Real near = Real(1e-3); // of the margin: as good as a touch
    constexpr Real close = Real(0.05);
    Real gap_before = Real(0);
    Approach best{Real(0), std::numeric_limits<Real>::infinity()};
    Vec3 guess = first.normal;
    Real t = Real(0);
    Real before = Real(0);        // time of the previous iteration,
    bool was_approaching = false; // and whether they were approaching then
    for (int step = 0; step < step_limit; ++step) {
        const Gap gap = step == 0 ? first : gap_after(t, guess);
        guess = gap.normal;
        if (gap.distance <= near * margin)
            return {t, Real(0)};
        // Hardly nearer than an iteration ago: they slide or roll along each other, and the bounds,
        // which include the whole body's turn, would creep to the touch.
        if (step > 0 && gap.distance <= close * margin && gap.distance > Real(0.5) * gap_before)
            return {t, Real(0)};
        gap_before = gap.distance;
        const Real closing = straight(gap);
        if (gap.distance < best.distance)
            best = {t, gap.distance};
        if (was_approaching && !(closing > Real(0))) {
            // The closest point lies between: there the distance stops falling.
            Real low = before;
            Real high = t;
            // Bisect until what is left of the approach no longer matters over the whole time.
            constexpr int most_cuts = 30;
            for (int cut = 0; cut < most_cuts; ++cut) {
                const Real middle = Real(0.5) * (low + high);
                const Gap between = gap_after(middle, guess);
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
        bool stays = false;
        // Outside the margin, or about as far apart as now all along this normal: a contact made
        // from it would not push.
        const Real enough = std::min(margin, Real(0.5) * gap.distance);
        const Real apart = apart_for(gap.normal, t, left, Real(0.5) * near * margin, enough, stays);
        if (stays)
            return best;
        t = std::min(t + std::max(apart, gap.distance / fastest), duration);
    }
    return best.distance <= margin ? Approach{best.time, Real(0)} : best;
}

} // namespace

Motion ahead(const Motion &motion, Real t) {
    if (t == Real(0))
        return motion;
    return {motion.position + t * motion.velocity,
            turned(motion.rotation, motion.angular_velocity, t), motion.velocity,
            motion.angular_velocity};
}

Approach approach(const MovingSolid &a, const MovingSolid &b, Real duration, Real margin,
                  const Vec3 &guess, const std::optional<Gap> &first) {
    const auto gap_after = [&](Real t, const Vec3 &along) {
        return gap_between(placed(*a.shape, mass_pose(ahead(a.motion, t))),
                           placed(*b.shape, mass_pose(ahead(b.motion, t))), along);
    };
    const auto apart_for = [&](const Vec3 &normal, Real t, Real left, Real least, Real enough,
                               bool &stays) {
        return time_apart(normal, *a.shape, a.motion, a.extent, *b.shape, b.motion, b.extent, t,
                          left, least, enough, stays);
    };
    return advance(gap_after, apart_for, a.motion, a.extent, b.motion, b.extent, duration, margin,
                   first ? *first : gap_after(Real(0), guess));
}

Approach approach(const MovingSolid &a, const Triangle &b, const Motion &motion_b, Real extent_b,
                  Real duration, Real margin, const Vec3 &guess) {
    const auto gap_after = [&](Real t, const Vec3 &along) {
        const Triangle triangle = placed(b, mass_pose(ahead(motion_b, t)));
        return std::visit([&](const auto &solid) { return gap_between(solid, triangle, along); },
                          placed(*a.shape, mass_pose(ahead(a.motion, t))));
    };
    const auto apart_for = [&](const Vec3 &normal, Real t, Real left, Real least, Real enough,
                               bool &stays) {
        return time_apart(normal, *a.shape, a.motion, a.extent, b, motion_b, extent_b, t, left,
                          least, enough, stays);
    };
    return advance(gap_after, apart_for, a.motion, a.extent, motion_b, extent_b, duration, margin,
                   gap_after(Real(0), guess));
}

} // namespace plumb::inline PLUMB_PRECISION
