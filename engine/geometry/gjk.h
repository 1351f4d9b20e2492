// The distance of any two convex shapes, by GJK.
//
// Gilbert, Johnson, Keerthi 1988, "A fast procedure for computing the distance between complex
// objects in three-dimensional space", with the stopping rules of van den Bergen 1999, "A fast and
// robust GJK implementation for collision detection of convex objects", and the closest point of a
// simplex by signed areas and volumes after Montanari, Petrinic, Barbieri 2017, "Improving the GJK
// algorithm for faster and more reliable distance queries between convex objects".
#pragma once

#include "engine/geometry/gauss_map.h"
#include "engine/geometry/support.h"

#include <array>
#include <concepts>
#include <limits>
#include <utility>

namespace plumb::inline PLUMB_PRECISION {

struct ClosestPoints {
    Real distance = Real(0); // 0: the shapes overlap
    Vec3 on_a{Real(0)};
    Vec3 on_b{Real(0)};
    Vec3 normal{Real(0)}; // unit, from A to B; zero when the shapes overlap
    int iterations = 0;   // support points taken; none where the answer is a closed form
};

// The distance of two convex shapes and a pair of closest points; for shapes that overlap 0 and a
// common point twice.
//
// Right within relative 16 epsilon (cylinders 1e-5 in float, 1e-9 in double) plus 32 epsilon times
// the largest coordinate of either shape, measured from A's place: what the shapes' own corners are
// rounded by. Shapes that are closer may count as overlapping, and their normal is then no better
// than that either. Axes along which all coordinates are small keep their own rounding: a box on a
// ground of 200 km has its distance to 1e-6 m. For the range of sizes and distances see shapes.h.
// Points, segments and shapes without thickness are allowed, but not a point with a point.
template <typename A, typename B>
requires ConvexPair<A, B> ClosestPoints distance(const A &a, const B &b);
ClosestPoints distance(const Sphere &a, const Box &b);
ClosestPoints distance(const Box &a, const Sphere &b);

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
// weights[i] * vertices[i].w. All weights are positive once it is reduced. Of four the origin is
// inside, and the weights are left to `witnesses`, for few ask.
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
    int count = 0; // 4: the origin is inside, and nothing else is said
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
// A to B, of any length; zero is allowed. There is one for each two cores of support.h, made in
// gjk_pairs.cpp.
template <typename CoreA, typename CoreB>
GjkResult gjk(const CoreA &a, const CoreB &b, const Vec3 &guess, Real far);

// Where two cores are closest.
struct NearestPoints {
    Vec3 on_a{Real(0)};
    Vec3 on_b{Real(0)};
    Vec3 difference{Real(0)}; // from A's point to B's
    Real squared_distance = Real(0);
    bool is_overlapping = false; // or closer than rounding
    int iterations = 0;
};

// A point and what has its closest point in closed form. Those relative to an origin near both keep
// their digits, as closest_point (closest_point.h) in the world does not.
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

// Two cores whatever their kinds, for what spends most of its time elsewhere. Borrows them.
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
    // With B moved by that much.
    GjkResult search_moved(const Vec3 &by) const { return moved_(a_, b_, by); }
    // What the faces and edges of the two cores look like from everywhere.
    std::pair<GaussMap, GaussMap> gauss_maps() const { return maps_(a_, b_); }
    bool has_closed_form() const { return closed_form_ != nullptr; }
    NearestPoints closed_form() const { return closed_form_(a_, b_); }
    // The point of the difference B - A farthest along a direction.
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

// The points of the cores that the simplex ended at; they differ by `difference`.
struct Witnesses {
    Vec3 on_a{Real(0)};
    Vec3 on_b{Real(0)};
};
Witnesses witnesses(const GjkResult &result);

// What `distance` says of shapes whose cores, relative to an origin, are so.
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
