// The 15 candidate axes of two boxes, best of each kind.
#pragma once

#include "engine/geometry/shapes.h"

namespace plumb::inline PLUMB_PRECISION {

// Edges whose directions' cross product (the sine of their angle) is shorter than this count as
// parallel. Dropping the axis costs at most this angle times the edge length, which is within
// rounding.
inline constexpr Real parallel_sine = Real(16) * std::numeric_limits<Real>::epsilon();

// Box B relative to box A: `position` is B's centre and the columns of `axes` are B's axes, both in
// A's frame.
struct RelativeBox {
    Vec3 position{Real(0)};
    Mat3 axes{Real(1)};
};

inline RelativeBox relative_to(const Box &a, const Box &b) {
    const Quat to_a = glm::conjugate(a.rotation);
    return {to_a * (b.center - a.center), glm::mat3_cast(to_a * b.rotation)};
}

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

// The best axis of each kind.
BoxAxes best_axes(const RelativeBox &relative, const Vec3 &half_a, const Vec3 &half_b);

} // namespace plumb::inline PLUMB_PRECISION
