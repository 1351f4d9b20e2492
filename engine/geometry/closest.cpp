#include "engine/geometry/closest.h"

#include <array>

namespace plumb::inline PLUMB_PRECISION {

SegmentPair closest_between_segments(const Vec3 &start_a, const Vec3 &along_a, const Vec3 &start_b,
                                     const Vec3 &along_b) {
    const Vec3 offset = start_b - start_a;
    std::array<SegmentPair, 4> pairs;
    const auto set = [&](std::size_t i, Real s, Real t) {
        const Vec3 difference = (offset + t * along_b) - s * along_a;
        pairs[i] = {s, t, difference, glm::dot(difference, difference)};
    };

    // Each end against the other segment: exact for any angle between them. The first of the
    // nearest.
    const Vec3 zero{Real(0)};
    set(0, Real(0), closest_parameter(offset, along_b, zero));
    set(1, Real(1), closest_parameter(offset, along_b, along_a));
    set(2, closest_parameter(zero, along_a, offset), Real(0));
    set(3, closest_parameter(zero, along_a, offset + along_b), Real(1));
    std::size_t nearest = 0;
    Real least = pairs[0].squared_distance;
    for (std::size_t i = 1; i < 4; ++i) {
        const Real squared_distance = pairs[i].squared_distance;
        nearest = squared_distance < least ? i : nearest;
        least = squared_distance < least ? squared_distance : least;
    }

    // Both points interior: offset + t b - s a is parallel to c = a x b, so crossing with b and
    // projecting on c gives s |c|^2 = ((offset x b) . c). In this form the error of s is of order
    // eps |offset| / sin(angle), which changes the distance only by order eps |offset|, even for
    // nearly parallel segments; the usual form a.a b.b - (a.b)^2 has eps / sin^2.
    const Vec3 cross = glm::cross(along_a, along_b);
    const Real squared_cross = glm::dot(cross, cross);
    if (squared_cross > Real(0)) {
        const Real s = glm::dot(glm::cross(offset, along_b), cross) / squared_cross;
        const Real t = glm::dot(glm::cross(offset, along_a), cross) / squared_cross;
        if (s > Real(0) && s < Real(1) && t > Real(0) && t < Real(1)) {
            const Real t_of_s = closest_parameter(offset, along_b, s * along_a);
            const Vec3 difference = (offset + t_of_s * along_b) - s * along_a;
            const Real squared_distance = glm::dot(difference, difference);
            if (squared_distance < least)
                return {s, t_of_s, difference, squared_distance};
        }
    }
    return pairs[nearest];
}

} // namespace plumb::inline PLUMB_PRECISION
