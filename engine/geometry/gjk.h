// The distance of any two convex shapes, by GJK.
//
// Gilbert, Johnson, Keerthi 1988, "A fast procedure for computing the distance between complex
// objects in three-dimensional space", with the stopping rules of van den Bergen 1999, "A fast and
// robust GJK implementation for collision detection of convex objects", and the closest point of a
// simplex by signed areas and volumes after Montanari, Petrinic, Barbieri 2017, "Improving the GJK
// algorithm for faster and more reliable distance queries between convex objects".
#pragma once

#include "engine/geometry/support.h"

#include <array>
#include <limits>

namespace plumb::inline PLUMB_PRECISION {

struct ClosestPoints {
    Real distance = Real(0); // 0: the shapes overlap
    Vec3 on_a{Real(0)};
    Vec3 on_b{Real(0)};
    Vec3 normal{Real(0)}; // unit, from A to B; zero when the shapes overlap
    int iterations = 0;   // support points taken
};

// The distance of two convex shapes and a pair of closest points; for shapes that overlap 0 and a
// common point twice.
//
// Right within relative 16 epsilon (cylinders 1e-5 in float, 1e-9 in double) plus 32 epsilon times
// the largest coordinate of either shape, measured from A's place: what the shapes' own corners are
// rounded by. Shapes that are closer may count as overlapping, and their normal is then no better
// than that either. Axes along which all coordinates are small keep their own rounding: a box on a
// ground of 200 km has its distance to 1e-6 m. Points, segments and shapes without thickness are
// allowed, but not a point with a point.
template <typename A, typename B>
requires ConvexPair<A, B> ClosestPoints distance(const A &a, const B &b);

// Whether the shapes have a common point; touching ones do. Those for which overlap.h or sat.h has
// an exact answer use that. True for shapes closer than the rounding given at `distance`.
template <typename A, typename B>
requires ConvexPair<A, B>
bool overlaps(const A &a, const B &b);

// --- The parts -----------------------------------------------------------------------------------

// A point of the difference B - A, and the points of A and B that it comes from.
// Not initialised, for arrays of them are large.
struct SimplexVertex {
    Vec3 a;
    Vec3 b;
    Vec3 w; // b - a
};

// Up to four of them, and the point of their hull closest to the origin as the sum of
// weights[i] * vertices[i].w. All weights are positive once it is reduced.
struct Simplex {
    std::array<SimplexVertex, 4> vertices;
    std::array<Real, 4> weights;
    int count = 0;
};

// The smallest part of a simplex that has its point closest to the origin.
struct SimplexPart {
    Vec3 closest{Real(0)};
    Real squared_distance = std::numeric_limits<Real>::infinity();
    std::array<Real, 4> weights{};
    std::array<int, 4> indices{};
    int count = 0; // 4: the origin is inside
};

// Rounding along the direction v of points whose coordinates are below `size`, times |v|: each
// coordinate of a support point carries up to 4 half epsilons, and so does the product.
inline Real rounding_along(const Vec3 &v, const Vec3 &size) {
    constexpr Real roundings = Real(4) * std::numeric_limits<Real>::epsilon();
    return roundings * glm::dot(glm::abs(v), size);
}

// The same for a unit vector of any direction.
inline Real rounding_of(const Vec3 &size) {
    return Real(4) * std::numeric_limits<Real>::epsilon() * glm::length(size);
}

// The last vertex is the newest: the closest point is assumed to need it. A tetrahedron thinner
// than the rounding of coordinates of the given size does not contain the origin. With a positive
// `slack` a triangle is preferred to its sides when the origin is beyond them by no more than that
// many times the rounding: its normal is the better direction.
SimplexPart closest_part(const Simplex &simplex, const Vec3 &size, Real slack = Real(0));

// The normal of the triangle p, q, r with its double area as length, from its two shorter sides: of
// a needle seen from its tip the cross product would be mostly rounding. What is left of that along
// the longest side is taken out, for it would tilt the plane by much.
Vec3 triangle_normal(const Vec3 &pq, const Vec3 &pr, const Vec3 &qr);

// Keeps the part only.
void reduce(Simplex &simplex, const SimplexPart &part);

// Whether a vertex has that difference, bit for bit.
inline bool has(const Simplex &simplex, const Vec3 &w) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(simplex.count); ++i)
        if (simplex.vertices[i].w == w)
            return true;
    return false;
}

// How a run of GJK on two cores ended.
struct GjkResult {
    Simplex simplex;
    Vec3 difference{Real(0)}; // from the closest point of A's core to that of B's core
    Real squared_distance = std::numeric_limits<Real>::infinity();
    Vec3 size{Real(0)};          // of the coordinates that were added up, for rounding_along
    bool is_overlapping = false; // or closer than rounding
    bool is_beyond = false;      // farther than asked for; `difference` still separates them
    int iterations = 0;
};

// More than any input needs; when the limit is met the oddity "gjk: iteration limit" is counted and
// the best pair so far stands.
inline constexpr int gjk_iteration_limit = 200;

// Stops early when the cores are proved to be farther apart than `far`. `guess` is a direction from
// A to B, of any length; zero is allowed.
template <typename CoreA, typename CoreB>
GjkResult gjk(const CoreA &a, const CoreB &b, const Vec3 &guess, Real far) {
    // A pair of closest points is known to be right when the support point is no nearer than they
    // are (van den Bergen 1999, (3)), within this much of the squared distance.
    constexpr Real relative = Real(16) * std::numeric_limits<Real>::epsilon();
    constexpr int stall_limit = 6;
    const Real squared_far = far * far;
    int stalls = 0;
    GjkResult result;
    Simplex &simplex = result.simplex;
    Vec3 &v = result.difference;
    v = guess;
    if (!(glm::dot(v, v) >= std::numeric_limits<Real>::min()))
        v = Vec3{Real(1), Real(0), Real(0)};
    for (;;) {
        SimplexVertex &added = simplex.vertices[static_cast<std::size_t>(simplex.count)];
        added.a = a.support(v);
        added.b = b.support(-v);
        added.w = added.b - added.a;
        result.size = glm::max(result.size, glm::abs(added.a) + glm::abs(added.b));
        ++result.iterations;

        const Real along = glm::dot(v, added.w);
        const Real rounding = rounding_along(v, result.size);
        const Real apart = along - rounding;
        if (apart > Real(0) && apart * apart > squared_far * glm::dot(v, v)) {
            result.is_beyond = true;
            return result;
        }
        if (simplex.count > 0) {
            // Within rounding too, where v is the normal of a triangle or there is no new point:
            // the direction of an edge that is long and near is itself mostly rounding.
            const Real gap = result.squared_distance - along;
            const Real allowed = relative * result.squared_distance;
            if (gap <= allowed ||
                (gap <= allowed + rounding && (simplex.count == 3 || has(simplex, added.w)))) {
                result.is_overlapping = result.squared_distance <= rounding;
                return result;
            }
            if (result.iterations > gjk_iteration_limit) [[unlikely]] {
                (void)PLUMB_RARELY("gjk: iteration limit", true);
                return result;
            }
        }
        ++simplex.count;
        SimplexPart part = closest_part(simplex, result.size);
        if (part.count == 4) {
            reduce(simplex, part);
            v = Vec3{Real(0)};
            result.squared_distance = Real(0);
            result.is_overlapping = true;
            return result;
        }
        // Each step comes closer. Near the end it may not by as much as rounding: the distance is
        // then right, but the direction may still be the better one; a few such steps are taken.
        if (!(part.squared_distance < result.squared_distance)) {
            part =
                closest_part(simplex, result.size, Real(8) * std::numeric_limits<Real>::epsilon());
            if (++stalls > stall_limit ||
                part.squared_distance > result.squared_distance + Real(2) * rounding) {
                --simplex.count;
                // Nothing shows that they are apart, and they are hardly farther than rounding.
                result.is_overlapping =
                    result.squared_distance <= (along <= Real(0) ? Real(4) : Real(1)) * rounding;
                return result;
            }
        }
        reduce(simplex, part);
        v = part.closest;
        result.squared_distance = part.squared_distance;
        // Below the least normal number nothing is left of a direction.
        if (result.squared_distance < std::numeric_limits<Real>::min() ||
            (simplex.count == 3 && result.squared_distance <= rounding_along(v, result.size))) {
            result.is_overlapping = true;
            return result;
        }
    }
}

// The points of the cores that the simplex ended at; they differ by `difference`.
struct Witnesses {
    Vec3 on_a{Real(0)};
    Vec3 on_b{Real(0)};
};
Witnesses witnesses(const GjkResult &result);

template <typename A, typename B>
requires ConvexPair<A, B> ClosestPoints distance(const A &a, const B &b) {
    const Vec3 origin = place_of(a);
    const auto core_a = core_of(a, origin);
    const auto core_b = core_of(b, origin);
    const GjkResult found = gjk(core_a, core_b, core_b.middle() - core_a.middle(),
                                std::numeric_limits<Real>::infinity());
    const Witnesses on = witnesses(found);
    ClosestPoints result;
    result.iterations = found.iterations;
    const Real radii = core_a.radius + core_b.radius;
    const Real between = std::sqrt(found.squared_distance);
    if (found.is_overlapping || between <= radii) {
        // Between the surfaces there is at least one common point of the two.
        const Real share = radii > Real(0) ? core_a.radius / radii : Real(0);
        result.on_a = result.on_b = origin + (on.on_a + share * (on.on_b - on.on_a));
        return result;
    }
    result.distance = between - radii;
    result.normal = found.difference / between;
    result.on_a = origin + (on.on_a + core_a.radius * result.normal);
    result.on_b = origin + (on.on_b - core_b.radius * result.normal);
    return result;
}

template <typename A, typename B>
requires ConvexPair<A, B>
bool overlaps(const A &a, const B &b) {
    const Vec3 origin = place_of(a);
    const auto core_a = core_of(a, origin);
    const auto core_b = core_of(b, origin);
    const Real radii = core_a.radius + core_b.radius;
    const GjkResult found = gjk(core_a, core_b, core_b.middle() - core_a.middle(), radii);
    return found.is_overlapping || (!found.is_beyond && std::sqrt(found.squared_distance) <= radii);
}

} // namespace plumb::inline PLUMB_PRECISION
