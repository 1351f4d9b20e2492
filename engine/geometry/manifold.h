// Contact manifold of two solids that touch or nearly touch: a normal and up to four points.
#pragma once

#include "engine/geometry/hull_mesh.h"
#include "engine/geometry/shapes.h"

#include <array>
#include <cstdint>

namespace plumb::inline PLUMB_PRECISION {

struct ManifoldPoint {
    Vec3 position{Real(0)};    // world, midway between the two surfaces
    Real separation = Real(0); // along the normal; negative in penetration
    std::uint32_t feature = 0; // id of the feature pair that made it, stable while the pair lasts
};

struct Manifold {
    Vec3 normal{Real(0)}; // unit, from A to B
    std::array<ManifoldPoint, 4> points{};
    int count = 0; // 0: farther apart than the margin
};

// The implementations behind `collide`, each for one argument order. The checks are in `collide`:
// here shapes must be valid and `margin` >= 0. `guess`: an approximate normal from A to B, of any
// length; zero: unknown.
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
Manifold collide(const Capsule &one, const Capsule &two, Real margin);
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
    return {}; // a dynamic body is never a half-space
}

// For the pairs in CollidesUnderLoad; as below.
template <typename A, typename B>
Manifold collide_under(const A &a, const B &b, Real margin, const Vec3 &guess, const Vec3 &load);

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
// Cylinders and hulls with whatever has faces, in the order of `collide`.
template <typename A, typename B>
concept CollidesUnderLoad = CollidesInOrder<A, B> &&
    (std::same_as<A, Cylinder> || std::same_as<A, ConvexHull> ||
     (std::same_as<A, Box> && (std::same_as<B, Cylinder> || std::same_as<B, ConvexHull>)));
template <typename A, typename B>
concept CollidesFromGuess = requires(const A &a, const B &b) {
    unchecked::collide(a, b, Real(0), Vec3{Real(0)});
};

// Any two of Sphere, Box, Capsule, Cylinder, ConvexHull, Triangle and HalfSpace. Adding a type to
// Shape does not compile until all its pairs are above.
template <typename A, typename B>
concept Collidable = CollidesInOrder<A, B> || CollidesInOrder<B, A>;

void check_margin(Real margin);

// Contact points wherever A and B are closer than `margin` (>= 0, metres). A NaN, a negative size
// or a negative margin fails a check.
//
// The least separation is the signed distance: for disjoint shapes the distance of their closest
// points, for overlapping ones minus the least translation along `normal` that separates them. It
// is up to 0.2 mm off when a nearly as good feature is preferred because it is more stable.
// Overlapping cylinders, hulls and triangles add the error of EPA (epa.h).
//
// Deterministic; depends only on the arguments. Swapping the arguments gives the same points with
// the normal negated, except where a tie needs an order: for two boxes of equal size touching face
// to face the first is the reference, and concentric spheres push along +Y both ways. Other
// concentric shapes separate along their axis of least depth. Half-space against half-space gives
// no contacts. A triangle is a thin two-sided solid: a shape behind it is pushed out to the back.
//
// Box-box by SAT (Gottschalk, Lin, Manocha 1996) over 15 axes, parallel-edge axes dropped, then the
// incident face clipped against the reference face (Sutherland-Hodgman), keeping at most four
// points. Edge-edge gives one point, and so do disjoint boxes that are closest at a corner. A
// capsule on a face, along an edge or along another capsule gives two. A tilted capsule's points
// are projected from its axis, so all but the deepest may lie up to r (1 - cos tilt) under its
// surface.
//
// Cylinders, hulls and triangles take separation and normal from GJK and EPA (accuracy: epa.h),
// unless the normal of a face under the contact is as good within 0.1 mm: then the face normal is
// used, so that a body resting on a face does not jitter. The other shape's most anti-parallel face
// or side is clipped against it, and four of the points within the margin are kept: the deepest,
// and those that span the largest area with it. Two parallel sides give two points, everything else
// one. A cylinder's end is clipped as the octagon inscribed in its rim: the contact area is up to
// 10 % smaller, but the deepest point of the rim is always included. Of a hull face with more than
// 16 corners, 16 evenly spaced ones are used.
//
// `guess` is an approximate normal from A to B, such as the previous step's; zero: unknown. It
// changes the result only by rounding, but speeds up pairs with hulls.
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

// The same, but of the points of a wide contact keeps those four that leave the most room around
// `load`: the place (world, m) where one body presses on the other, as far as it is known. Usually
// the four span the largest area; but of a round face that is a square, whose sides are 30 % nearer
// to the middle than the rim. There is a point of a cylinder's rim 8 degrees either side of the
// load, and of a face with more than 16 corners the two nearest to it. The deepest point may be
// missing, so this is for bodies that stand flat.
Manifold collide_under(const Shape &a, const Shape &b, Real margin, const Vec3 &guess,
                       const Vec3 &load);

// How far inside the polygon of a manifold's points a place is, seen along the normal: its distance
// from the nearest side (m), negative outside; -infinity if they span no area.
Real room_around(const Manifold &manifold, const Vec3 &place);

} // namespace plumb::inline PLUMB_PRECISION
