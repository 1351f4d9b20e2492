// Where two solids touch, or nearly touch: a normal and up to four points.
#pragma once

#include "engine/geometry/hull_mesh.h"
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

// The contacts of one pair of solids, in one order: behind `collide`, which checks what these do
// not. Shapes are valid and `margin` >= 0. `guess`: about the normal from A to B, of any length;
// zero: unknown.
namespace unchecked {

Manifold collide(const Sphere &a, const Sphere &b, Real margin);
Manifold collide(const Sphere &a, const Box &b, Real margin);
Manifold collide(const Sphere &a, const Capsule &b, Real margin);
Manifold collide(const Sphere &a, const Cylinder &b, Real margin);
Manifold collide(const Sphere &a, const ConvexHull &b, Real margin);
Manifold collide(const Sphere &a, const Triangle &b, Real margin);
Manifold collide(const Sphere &a, const HalfSpace &b, Real margin);
Manifold collide(const Box &a, const Box &b, Real margin);
Manifold collide(const Box &a, const Capsule &b, Real margin);
Manifold collide(const Box &a, const Cylinder &b, Real margin);
Manifold collide(const Box &a, const ConvexHull &b, Real margin, const Vec3 &guess = Vec3{Real(0)});
Manifold collide(const Box &a, const Triangle &b, Real margin);
Manifold collide(const Box &a, const HalfSpace &b, Real margin);
Manifold collide(const Capsule &a, const Capsule &b, Real margin);
Manifold collide(const Capsule &a, const Cylinder &b, Real margin);
Manifold collide(const Capsule &a, const ConvexHull &b, Real margin);
Manifold collide(const Capsule &a, const Triangle &b, Real margin);
Manifold collide(const Capsule &a, const HalfSpace &b, Real margin);
Manifold collide(const Cylinder &a, const Cylinder &b, Real margin);
Manifold collide(const Cylinder &a, const ConvexHull &b, Real margin);
Manifold collide(const Cylinder &a, const Triangle &b, Real margin);
Manifold collide(const Cylinder &a, const HalfSpace &b, Real margin);
Manifold collide(const ConvexHull &a, const ConvexHull &b, Real margin,
                 const Vec3 &guess = Vec3{Real(0)});
Manifold collide(const ConvexHull &a, const Triangle &b, Real margin);
Manifold collide(const ConvexHull &a, const HalfSpace &b, Real margin);
Manifold collide(const Triangle &a, const Triangle &b, Real margin);
Manifold collide(const Triangle &a, const HalfSpace &b, Real margin);
inline Manifold collide(const HalfSpace &, const HalfSpace &, Real) {
    return {}; // nothing that moves has endless contact
}

} // namespace unchecked

// The same contact seen from the other shape.
inline Manifold mirrored(Manifold manifold) {
    manifold.normal = -manifold.normal;
    return manifold;
}

template <typename A, typename B>
concept CollidesInOrder = requires(const A &a, const B &b) {
    unchecked::collide(a, b, Real(0));
};
template <typename A, typename B>
concept CollidesFromGuess = requires(const A &a, const B &b) {
    unchecked::collide(a, b, Real(0), Vec3{Real(0)});
};

// Any two of Sphere, Box, Capsule, Cylinder, ConvexHull, Triangle and HalfSpace. Another one in a
// Shape does not compile until all its pairs are above.
template <typename A, typename B>
concept Collidable = CollidesInOrder<A, B> || CollidesInOrder<B, A>;

void check_margin(Real margin);

// Contact points of all places where A and B are closer than `margin` (>= 0, metres). A NaN, a
// negative size or margin fails a check.
//
// The least separation is the signed distance: for disjoint shapes the distance of their closest
// points, for overlapping ones minus the least translation along `normal` that parts them; where
// a feature nearly as good stands for the best, for it wavers less, it is up to 0.2 mm off.
// Cylinders, hulls and triangles in each other add what EPA is off by (epa.h).
//
// Deterministic; depends on nothing but the arguments. Swapped arguments give the same points with
// the normal negated, except where the choice between equals needs an order: two boxes of one size
// that touch face to face take the first as the reference, and concentric spheres push along +Y
// both ways. Other shapes with a common centre part along their axis of least depth. Half-space
// against half-space gives none. A triangle is a thin solid with two sides: what is behind it is
// pushed out to the back.
//
// Box-box by SAT (Gottschalk, Lin, Manocha 1996) over 15 axes, parallel-edge axes dropped, then the
// incident face clipped against the reference face (Sutherland-Hodgman), at most four points kept;
// edge-edge gives one point, and so do boxes apart that are closest at a corner. Capsules that lie
// on a face, along an edge or along each other give two. A tilted capsule's points are the feet of
// points of its axis, so but for the deepest one they may lie up to r (1 - cos tilt) under its
// surface.
//
// Cylinders, hulls and triangles take the separation and the normal from GJK and EPA (epa.h says
// how exact they are), unless the normal of a face that the contact is on is as good within
// 0.1 mm: then that is taken, so that what rests on a face does not waver. The face or side of the
// other shape that looks most against the normal is clipped by it, and of the points within the
// margin four are kept: the deepest, and those that span the largest area with it. Two sides along
// each other give two points. Everything else gives one. The end of a cylinder is clipped as the
// octagon in its rim, whose corners are points of it: the area of contact is up to 10 % smaller,
// but the deepest point of the rim is always there. Of a hull face with more than 16 corners, 16
// are taken, evenly.
//
// With a `guess`, about the normal from A to B, such as that of the step before, it is the same to
// rounding, and sooner where hulls are in it; zero: unknown.
template <typename A, typename B>
requires Collidable<A, B> Manifold collide(const A &a, const B &b, Real margin,
                                           const Vec3 &guess = Vec3{Real(0)}) {
    check_margin(margin);
    check_valid(a);
    check_valid(b);
    if constexpr (CollidesFromGuess<A, B>)
        return unchecked::collide(a, b, margin, guess);
    else if constexpr (CollidesFromGuess<B, A>)
        return mirrored(unchecked::collide(b, a, margin, -guess));
    else if constexpr (CollidesInOrder<A, B>)
        return unchecked::collide(a, b, margin);
    else
        return mirrored(unchecked::collide(b, a, margin));
}
Manifold collide(const Shape &a, const Shape &b, Real margin, const Vec3 &guess = Vec3{Real(0)});

} // namespace plumb::inline PLUMB_PRECISION
