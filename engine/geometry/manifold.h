// Where two solids touch, or nearly touch: a normal and up to four points.
#pragma once

#include "engine/geometry/shapes.h"

#include <array>
#include <cstdint>

namespace plumb::inline PLUMB_PRECISION {

struct ManifoldPoint {
    Vec3 position{Real(0)};    // world, midway between the two surfaces
    Real separation = Real(0); // along the normal; negative in penetration
    std::uint32_t feature = 0; // names the pair of features that made it: the same while they last
};

struct Manifold {
    Vec3 normal{Real(0)}; // unit, from A to B
    std::array<ManifoldPoint, 4> points{};
    int count = 0; // 0: further apart than the margin
};

// Contact points of all places where A and B are closer than `margin` (>= 0, metres). A NaN, a
// negative size or margin fails a check.
//
// The least separation is the signed distance: for disjoint shapes the distance of their closest
// points, for overlapping ones minus the least translation along `normal` that parts them; features
// within 0.1 mm of the best may stand for it (manifold_pairs.h says which are preferred, and why).
//
// Deterministic; depends on nothing but the arguments. Swapped arguments give the same points with
// the normal negated, except where the choice between equals needs an order: two boxes of one size
// that touch face to face take the first as the reference, and concentric spheres push along +Y
// both ways. Other shapes with a common centre part along their axis of least depth. Half-space
// against half-space gives none.
//
// Box-box by SAT (Gottschalk, Lin, Manocha 1996) over 15 axes, parallel-edge axes dropped, then the
// incident face clipped against the reference face (Sutherland-Hodgman), at most four points kept;
// edge-edge gives one point, and so do boxes apart that are closest at a corner. Capsules that lie
// on a face, along an edge or along each other give two. A tilted capsule's points are the feet of
// points of its axis, so but for the deepest one they may lie up to r (1 - cos tilt) under its
// surface.
Manifold collide(const Shape &a, const Shape &b, Real margin);

} // namespace plumb::inline PLUMB_PRECISION
