// The 15 candidate axes of two boxes, best of each kind: shared by the overlap test and the contact
// manifold.
#pragma once

#include "engine/geometry/shapes.h"

namespace plumb::inline PLUMB_PRECISION {

// Box B relative to box A: `position` is B's centre and the columns of `axes` are B's axes, both in
// A's frame.
struct RelativeBox {
    Vec3 position{Real(0)};
    Mat3 axes{Real(1)};
};

RelativeBox relative_to(const Box &a, const Box &b);

struct BoxAxis {
    Real separation = -std::numeric_limits<Real>::infinity();
    Vec3 normal{Real(0)}; // unit, from A to B, in A's frame
    int index_a = 0;
    int index_b = 0;
};

struct BoxAxes {
    BoxAxis face_a;
    BoxAxis face_b;
    BoxAxis edges; // separation -infinity when all edges of A are parallel to edges of B
};

// The best axis of each kind. Stops at the first axis with a separation above `margin`, with the
// best axes so far.
BoxAxes best_axes(const RelativeBox &relative, const Vec3 &half_a, const Vec3 &half_b, Real margin);

} // namespace plumb::inline PLUMB_PRECISION
