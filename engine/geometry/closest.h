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
SegmentPair closest_between_segments(const Vec3 &start_a, const Vec3 &along_a, const Vec3 &start_b,
                                     const Vec3 &along_b);

} // namespace plumb::inline PLUMB_PRECISION
