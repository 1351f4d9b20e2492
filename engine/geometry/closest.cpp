#include "engine/geometry/closest.h"

namespace plumb::inline PLUMB_PRECISION {

SegmentPair closest_between_segments(const Vec3 &start_a, const Vec3 &along_a, const Vec3 &start_b,
                                     const Vec3 &along_b) {
    const Vec3 offset = start_b - start_a;
    SegmentPair best;
    const auto consider = [&](Real s, Real t, bool first) {
        const Vec3 difference = (offset + t * along_b) - s * along_a;
        const Real squared_distance = glm::dot(difference, difference);
        if (first || squared_distance < best.squared_distance)
            best = {s, t, difference, squared_distance};
    };

    // Each end against the other segment: exact for any angle between them.
    const Vec3 zero{Real(0)};
    consider(Real(0), closest_parameter(offset, along_b, zero), true);
    consider(Real(1), closest_parameter(offset, along_b, along_a), false);
    consider(closest_parameter(zero, along_a, offset), Real(0), false);
    consider(closest_parameter(zero, along_a, offset + along_b), Real(1), false);

    // Both points interior: offset + t b - s a is parallel to c = a x b, so crossing with b and
    // projecting on c gives s |c|^2 = ((offset x b) . c). In this form the error of s is of order
    // eps |offset| / sin(angle), which changes the distance only by order eps |offset|, even for
    // nearly parallel segments; the usual form a.a b.b - (a.b)^2 has eps / sin^2.
    const Vec3 cross = glm::cross(along_a, along_b);
    const Real squared_cross = glm::dot(cross, cross);
    if (squared_cross > Real(0)) {
        const Real s = glm::dot(glm::cross(offset, along_b), cross) / squared_cross;
        const Real t = glm::dot(glm::cross(offset, along_a), cross) / squared_cross;
        if (s > Real(0) && s < Real(1) && t > Real(0) && t < Real(1))
            consider(s, closest_parameter(offset, along_b, s * along_a), false);
    }
    return best;
}

} // namespace plumb::inline PLUMB_PRECISION
