// The separating axis test for two oriented boxes.
#pragma once

#include "engine/geometry/shapes.h"

namespace plumb::inline PLUMB_PRECISION {

enum class SatAxis { face_a, face_b, edges };

// The axis of largest separation among the 15 candidates. separation <= 0: the boxes overlap
// (closed sets: touching counts), and it is minus the penetration depth. separation > 0: they are
// disjoint, and it is a lower bound on their distance.
struct SatResult {
    Real separation = Real(0);
    Vec3 normal{Real(0)}; // unit, from A to B
    SatAxis axis = SatAxis::face_a;
    int index_a = 0; // which face axis or edge direction of A (0..2)
    int index_b = 0;
};

SatResult separating_axis(const Box &a, const Box &b);

// Whether the boxes overlap, by the same 15 axes: up to roundings, the sign of the separation.
// Reliable for parallel, nearly parallel and edge-edge separated boxes alike; wrong only for boxes
// closer to touching than 32 epsilon times their largest coordinate or size, and never for boxes of
// small integers that are unrotated or turned by a half or a third of a turn (those quaternions are
// exact). An empty Aabb overlaps nothing. An invalid box fails a check.
bool overlaps(const Box &a, const Box &b);
bool overlaps(const Aabb &a, const Box &b);

} // namespace plumb::inline PLUMB_PRECISION
