// Closest points of segments. A building block for hot code, so nothing is checked.
#pragma once

#include "engine/math/types.h"

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
    const Vec3 offset = start_b - start_a;
    const auto difference = [&](Real s, Real t) { return (offset + t * along_b) - s * along_a; };
    const auto squared_distance = [&](Real s, Real t) {
        const Vec3 between = difference(s, t);
        return glm::dot(between, between);
    };

    // Each end against the other segment: exact for any angle between them. The first of the
    // nearest is hard to foresee, so that branches would cost more.
    const Vec3 zero{Real(0)};
    Real s = Real(0);
    Real t = closest_parameter(offset, along_b, zero);
    Real least = squared_distance(s, t);
    const auto consider = [&](Real other_s, Real other_t) {
        const Real other = squared_distance(other_s, other_t);
        const bool is_nearer = other < least;
        s = is_nearer ? other_s : s;
        t = is_nearer ? other_t : t;
        least = is_nearer ? other : least;
    };
    consider(Real(1), closest_parameter(offset, along_b, along_a));
    consider(closest_parameter(zero, along_a, offset), Real(0));
    consider(closest_parameter(zero, along_a, offset + along_b), Real(1));

    // Both points interior: offset + t b - s a is parallel to c = a x b, so crossing with b and
    // projecting on c gives s |c|^2 = ((offset x b) . c). In this form the error of s is of order
    // eps |offset| / sin(angle), which changes the distance only by order eps |offset|, even for
    // nearly parallel segments; the usual form a.a b.b - (a.b)^2 has eps / sin^2.
    const Vec3 cross = glm::cross(along_a, along_b);
    const Real squared_cross = glm::dot(cross, cross);
    if (squared_cross > Real(0)) {
        const Real inner_s = glm::dot(glm::cross(offset, along_b), cross) / squared_cross;
        const Real inner_t = glm::dot(glm::cross(offset, along_a), cross) / squared_cross;
        if (inner_s > Real(0) && inner_s < Real(1) && inner_t > Real(0) && inner_t < Real(1))
            consider(inner_s, closest_parameter(offset, along_b, inner_s * along_a));
    }
    return {s, t, difference(s, t), least};
}

} // namespace plumb::inline PLUMB_PRECISION
