// Closest points of segments. A building block for hot code, so nothing is checked.
#pragma once

#include "engine/math/types.h"

#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

// The parameter s in [0, 1] at which `start + s * along` is closest to `point`; 0 for a segment of
// zero length.
inline Real closest_parameter(const Vec3 &start, const Vec3 &along, const Vec3 &point) {
    const Real squared = glm::dot(along, along);
    if (!(squared > Real(0)))
        return Real(0);
    return glm::clamp(glm::dot(point - start, along) / squared, Real(0), Real(1));
}

// The closest points `start_a + s * along_a` and `start_b + t * along_b` of two segments.
struct SegmentPair {
    Real s = Real(0);
    Real t = Real(0);
    Vec3 difference{Real(0)}; // from the point of A to the point of B
    Real squared_distance = Real(0);
};

// Parallel segments have many closest pairs; returns one that includes an end. Segments of zero
// length are points.
inline SegmentPair closest_between_segments(const Vec3 &start_a, const Vec3 &along_a,
                                            const Vec3 &start_b, const Vec3 &along_b) {
    const Vec3 zero{Real(0)};
    const Vec3 offset = start_b - start_a;
    const auto difference = [&](Real s, Real t) { return (offset + t * along_b) - s * along_a; };
    const auto nearest_t = [&](Real s) { return closest_parameter(offset, along_b, s * along_a); };
    const auto nearest_s = [&](Real t) {
        return closest_parameter(zero, along_a, offset + t * along_b);
    };
    Real s = Real(0);
    Real t = Real(0);
    Real least = std::numeric_limits<Real>::infinity();
    // Which is the nearest is hard to foresee, so that branches would cost more.
    const auto consider = [&](Real other_s, Real other_t) {
        const Vec3 between = difference(other_s, other_t);
        const Real other = glm::dot(between, between);
        const bool is_nearer = other < least;
        s = is_nearer ? other_s : s;
        t = is_nearer ? other_t : t;
        least = is_nearer ? other : least;
    };

    // On the lines offset + t b - s a is parallel to c = a x b, so crossing with b and projecting
    // on c gives s |c|^2 = ((offset x b) . c). In this form the error of s is of order eps |offset|
    // / sin(angle), which changes the distance only by order eps |offset|, even for nearly parallel
    // segments; the usual form a.a b.b - (a.b)^2 has eps / sin^2.
    const Vec3 cross = glm::cross(along_a, along_b);
    const Real squared_cross = glm::dot(cross, cross);
    const Real share = Real(1) / squared_cross;
    const Real line_s = glm::dot(glm::cross(offset, along_b), cross) * share;
    const Real line_t = glm::dot(glm::cross(offset, along_a), cross) * share;
    constexpr Real squared_sine = Real(1e-4);
    if (squared_cross > squared_sine * glm::dot(along_a, along_a) * glm::dot(along_b, along_b)) {
        // The squared distance is convex in s and t: if the lines' pair is not on both segments,
        // the nearest is at an end that it is beyond, and opposite that end.
        const Real near_s = glm::clamp(line_s, Real(0), Real(1));
        const Real near_t = glm::clamp(line_t, Real(0), Real(1));
        consider(near_s, nearest_t(near_s));
        consider(nearest_s(near_t), near_t);
    } else {
        // Each end against the other segment, which is exact for any angle.
        consider(Real(0), nearest_t(Real(0)));
        consider(Real(1), nearest_t(Real(1)));
        consider(nearest_s(Real(0)), Real(0));
        consider(nearest_s(Real(1)), Real(1));
        if (line_s > Real(0) && line_s < Real(1) && line_t > Real(0) && line_t < Real(1))
            consider(line_s, nearest_t(line_s));
    }
    return {s, t, difference(s, t), least};
}

} // namespace plumb::inline PLUMB_PRECISION
