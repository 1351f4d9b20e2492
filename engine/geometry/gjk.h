// Distance between any two convex shapes, by GJK.
//
// Gilbert, Johnson, Keerthi 1988, "A fast procedure for computing the distance between complex
// objects in three-dimensional space", with the stopping rules of van den Bergen 1999, "A fast and
// robust GJK implementation for collision detection of convex objects", and the closest point of a
// simplex by signed areas and volumes after Montanari, Petrinic, Barbieri 2017, "Improving the GJK
// algorithm for faster and more reliable distance queries between convex objects".
#pragma once

#include "engine/geometry/gauss_map.h"
#include "engine/geometry/support.h"
#include "engine/math/vectors.h"

#include <array>
#include <concepts>
#include <limits>
#include <utility>

namespace plumb::inline PLUMB_PRECISION {

struct ClosestPoints {
    Real distance = Real(0); // 0 when the shapes overlap
    Vec3 on_a{Real(0)};
    Vec3 on_b{Real(0)};
    Vec3 normal{Real(0)}; // unit, from A to B; zero when the shapes overlap
    int iterations = 0;   // support points taken; 0 for a closed form
};

// Distance and a pair of closest points of two convex shapes; for overlapping shapes 0, and both
// points are the same common point.
//
// Accurate to a relative 16 epsilon (cylinders: 1e-5 in float, 1e-9 in double) plus 32 epsilon
// times the largest coordinate of either shape relative to A's position, which is the rounding of
// the shapes' own corners. Shapes closer than that may count as overlapping, and the normal is no
// better either. Axes with only small coordinates keep their own small rounding: a box on a 200 km
// ground has its distance to 1e-6 m. For the range of sizes and distances see shapes.h. Points,
// segments and shapes without thickness are allowed, but not point against point.
template <typename A, typename B>
requires ConvexPair<A, B> ClosestPoints distance(const A &a, const B &b);
ClosestPoints distance(const Sphere &a, const Box &b);
ClosestPoints distance(const Box &a, const Sphere &b);

// Whether the shapes overlap; touching counts. Pairs with an exact test in overlap.h or sat.h use
// that. True for shapes closer than the rounding given at `distance`.
template <typename A, typename B>
requires ConvexPair<A, B>
bool overlaps(const A &a, const B &b);

// --- The parts -----------------------------------------------------------------------------------

// A point of the Minkowski difference B - A, and the points of A and B it comes from. Left
// uninitialised because arrays of them are large.
struct SimplexVertex {
    Vec3 a;
    Vec3 b;
    Vec3 w; // b - a
};

// Up to four vertices; the point of their hull closest to the origin is the sum of weights[i] *
// vertices[i].w. All weights are positive once reduced. With four vertices the origin is inside,
// and the weights are left to `witnesses`, since few callers need them.
struct Simplex {
    std::array<SimplexVertex, 4> vertices;
    std::array<Real, 4> weights;
    int count = 0;
};

// The smallest sub-simplex containing the simplex's closest point to the origin.
struct SimplexPart {
    Vec3 closest{Real(0)};
    Real squared_distance = std::numeric_limits<Real>::infinity();
    std::array<Real, 4> weights{};
    std::array<int, 4> indices{};
    int count = 0; // 4: the origin is inside, and nothing else is set
};

// Rounding error along v, times |v|, for points with coordinates below `size`: each coordinate of a
// support point carries up to 4 half epsilons, and so does the dot product.
inline Real rounding_along(const Vec3 &v, const Vec3 &size) {
    constexpr Real roundings = Real(4) * std::numeric_limits<Real>::epsilon();
    return roundings * glm::dot(magnitudes(v), size);
}

// The same for a unit vector in any direction.
inline Real rounding_of(const Vec3 &size) {
    return Real(4) * std::numeric_limits<Real>::epsilon() * glm::length(size);
}

// The last vertex is the newest, and the closest point is assumed to need it. A tetrahedron thinner
// than the rounding of coordinates of the given size does not contain the origin. With a positive
// `slack` a triangle wins over its edges when the origin is beyond them by at most that many times
// the rounding: the triangle's normal is the better direction.
SimplexPart closest_part(const Simplex &simplex, const Vec3 &size, Real slack = Real(0));

// The normal of triangle p, q, r, with twice the area as its length, from the two shorter edges:
// for a needle the cross product of the two long edges would be mostly rounding. The remaining
// component along the longest edge is removed, since it would tilt the plane badly.
Vec3 triangle_normal(const Vec3 &pq, const Vec3 &pr, const Vec3 &qr);

// Keeps only the part.
void reduce(Simplex &simplex, const SimplexPart &part);

// Whether a vertex equals w bit for bit.
inline bool has(const Simplex &simplex, const Vec3 &w) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(simplex.count); ++i)
        if (simplex.vertices[i].w == w)
            return true;
    return false;
}

// The result of running GJK on two cores.
struct GjkResult {
    Simplex simplex;
    Vec3 difference{Real(0)}; // from the closest point of A's core to that of B's core
    Real squared_distance = std::numeric_limits<Real>::infinity();
    Vec3 size{Real(0)};          // of the coordinates summed up, for rounding_along
    bool is_overlapping = false; // or closer than rounding
    bool is_beyond = false;      // farther than `far`; `difference` still separates them
    int iterations = 0;
};

// More than any input needs. If the limit is hit, the oddity "gjk: iteration limit" is counted and
// the best pair so far is returned.
inline constexpr int gjk_iteration_limit = 200;

// Stops early once the cores are proven to be farther apart than `far`. `guess` is a direction from
// A to B, of any length; zero is allowed. Instantiated in gjk_pairs.cpp for each pair of the cores
// in support.h.
template <typename CoreA, typename CoreB>
GjkResult gjk(const CoreA &a, const CoreB &b, const Vec3 &guess, Real far);

// The closest points of two cores.
struct NearestPoints {
    Vec3 on_a{Real(0)};
    Vec3 on_b{Real(0)};
    Vec3 difference{Real(0)}; // from A's point to B's
    Real squared_distance = Real(0);
    bool is_overlapping = false; // or closer than rounding
    int iterations = 0;
};

// Closed forms for a point against a core. Relative to an origin near both they keep full
// precision, unlike closest_point (closest_point.h) in world space.
NearestPoints nearest_points(const PointCore &a, const PointCore &b);
NearestPoints nearest_points(const PointCore &a, const SegmentCore &b);
NearestPoints nearest_points(const PointCore &a, const AabbCore &b);
NearestPoints nearest_points(const PointCore &a, const BoxCore &b);
NearestPoints nearest_points(const PointCore &a, const CylinderCore &b);
template <typename CoreA>
requires(!std::same_as<CoreA, PointCore> && requires(const CoreA &a, const PointCore &b) {
    nearest_points(b, a);
}) NearestPoints nearest_points(const CoreA &a, const PointCore &b) {
    NearestPoints found = nearest_points(b, a);
    std::swap(found.on_a, found.on_b);
    found.difference = -found.difference;
    return found;
}

template <typename CoreA, typename CoreB>
concept HasNearestPoints = requires(const CoreA &a, const CoreB &b) {
    nearest_points(a, b);
};

// A type-erased pair of cores, for code that spends most of its time elsewhere. Borrows the cores.
class CorePair {
  public:
    template <typename CoreA, typename CoreB>
    CorePair(const CoreA &a, const CoreB &b)
        : a_(&a), b_(&b), gjk_(gjk_of<CoreA, CoreB>), support_(support_of<CoreA, CoreB>),
          moved_(moved_of<CoreA, CoreB>), maps_(maps_of<CoreA, CoreB>), radius_a_(a.radius),
          radius_b_(b.radius), between_middles_(b.middle() - a.middle()),
          is_curved_(std::same_as<CoreA, CylinderCore> || std::same_as<CoreB, CylinderCore>) {
        if constexpr (HasNearestPoints<CoreA, CoreB>)
            closed_form_ = [](const void *of_a, const void *of_b) {
                return nearest_points(*static_cast<const CoreA *>(of_a),
                                      *static_cast<const CoreB *>(of_b));
            };
    }

    GjkResult search(const Vec3 &guess, Real far) const { return gjk_(a_, b_, guess, far); }
    // With B translated by `by`.
    GjkResult search_moved(const Vec3 &by) const { return moved_(a_, b_, by); }
    // The Gauss maps of A and B.
    std::pair<GaussMap, GaussMap> gauss_maps() const { return maps_(a_, b_); }
    bool has_closed_form() const { return closed_form_ != nullptr; }
    NearestPoints closed_form() const { return closed_form_(a_, b_); }
    // The support point of the Minkowski difference B - A.
    SimplexVertex support(const Vec3 &direction) const { return support_(a_, b_, direction); }
    Real radius_a() const { return radius_a_; }
    Real radius_b() const { return radius_b_; }
    const Vec3 &between_middles() const { return between_middles_; } // from A's to B's
    bool is_curved() const { return is_curved_; }

  private:
    template <typename CoreA, typename CoreB>
    static GjkResult gjk_of(const void *a, const void *b, const Vec3 &guess, Real far) {
        return gjk(*static_cast<const CoreA *>(a), *static_cast<const CoreB *>(b), guess, far);
    }
    template <typename CoreA, typename CoreB>
    static GjkResult moved_of(const void *a, const void *b, const Vec3 &by) {
        CoreB moved = *static_cast<const CoreB *>(b);
        moved.move(by);
        return gjk(*static_cast<const CoreA *>(a), moved, by,
                   std::numeric_limits<Real>::infinity());
    }
    template <typename CoreA, typename CoreB>
    static std::pair<GaussMap, GaussMap> maps_of(const void *a, const void *b) {
        return {gauss_map(*static_cast<const CoreA *>(a)),
                gauss_map(*static_cast<const CoreB *>(b))};
    }
    template <typename CoreA, typename CoreB>
    static SimplexVertex support_of(const void *a, const void *b, const Vec3 &direction) {
        const Vec3 on_a = static_cast<const CoreA *>(a)->support(-direction);
        const Vec3 on_b = static_cast<const CoreB *>(b)->support(direction);
        return {on_a, on_b, on_b - on_a};
    }

    const void *a_;
    const void *b_;
    GjkResult (*gjk_)(const void *, const void *, const Vec3 &, Real);
    SimplexVertex (*support_)(const void *, const void *, const Vec3 &);
    GjkResult (*moved_)(const void *, const void *, const Vec3 &);
    std::pair<GaussMap, GaussMap> (*maps_)(const void *, const void *);
    NearestPoints (*closed_form_)(const void *, const void *) = nullptr;
    Real radius_a_;
    Real radius_b_;
    Vec3 between_middles_;
    bool is_curved_;
};

// The points on the cores behind the final simplex; they differ by `difference`.
struct Witnesses {
    Vec3 on_a{Real(0)};
    Vec3 on_b{Real(0)};
};
Witnesses witnesses(const GjkResult &result);

// Converts a result for cores, relative to `origin`, into that of `distance` for the shapes.
ClosestPoints closest_points(const NearestPoints &found, Real radius_a, Real radius_b,
                             const Vec3 &origin);
ClosestPoints closest_points(const GjkResult &found, Real radius_a, Real radius_b,
                             const Vec3 &origin);

template <typename A, typename B>
requires ConvexPair<A, B> ClosestPoints distance(const A &a, const B &b) {
    const Vec3 origin = place_of(a);
    const auto core_a = core_of(a, origin);
    const auto core_b = core_of(b, origin);
    if constexpr (HasNearestPoints<decltype(core_a), decltype(core_b)>)
        return closest_points(nearest_points(core_a, core_b), core_a.radius, core_b.radius, origin);
    else
        return closest_points(gjk(core_a, core_b, core_b.middle() - core_a.middle(),
                                  std::numeric_limits<Real>::infinity()),
                              core_a.radius, core_b.radius, origin);
}

template <typename A, typename B>
requires ConvexPair<A, B>
bool overlaps(const A &a, const B &b) {
    const Vec3 origin = place_of(a);
    const auto core_a = core_of(a, origin);
    const auto core_b = core_of(b, origin);
    const Real radii = core_a.radius + core_b.radius;
    if constexpr (HasNearestPoints<decltype(core_a), decltype(core_b)>) {
        const NearestPoints found = nearest_points(core_a, core_b);
        return found.is_overlapping || std::sqrt(found.squared_distance) <= radii;
    } else {
        const GjkResult found = gjk(core_a, core_b, core_b.middle() - core_a.middle(), radii);
        return found.is_overlapping ||
               (!found.is_beyond && std::sqrt(found.squared_distance) <= radii);
    }
}

} // namespace plumb::inline PLUMB_PRECISION
