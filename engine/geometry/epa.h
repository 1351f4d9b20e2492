// Penetration depth of two convex shapes, by EPA.
//
// Van den Bergen 2001, "Proximity queries and penetration depth computation on 3D game objects": a
// polyhedron inside the Minkowski difference B - A is expanded where its surface is closest to the
// origin, until it cannot grow there. Rounded shapes whose cores are apart need only GJK.
#pragma once

#include "engine/geometry/gjk.h"
#include "engine/geometry/manifold_pairs.h"

#include <concepts>
#include <optional>

namespace plumb::inline PLUMB_PRECISION {

struct Penetration {
    Real depth = Real(0);  // >= 0
    Vec3 normal{Real(0)};  // unit, from A to B: B moved by depth * normal just touches A
    Vec3 on_a{Real(0)};    // the deepest point of A in B
    Vec3 on_b{Real(0)};    // the deepest point of B in A: on_a - depth * normal
    Real excess = Real(0); // how far `depth` may exceed the minimum; see below
    int iterations = 0;    // support points taken
};

// The minimum translation that separates two overlapping convex shapes; none if they do not overlap
// (touching shapes do, with depth 0).
//
// Moving B by `depth` along `normal` separates them, and no translation is shorter, within the
// rounding of `distance` (gjk.h) and a relative 1e-5 in float, 1e-10 in double. When the cores
// overlap and one is a cylinder (not when a cylinder only reaches into another shape's radius), the
// relative tolerance is 4e-3, and the points may be off the surface by as much. A cylinder against
// a hull with so many faces at about the same depth that the search hits its limit misses that by
// at most `excess` (metres), which is zero for all others. Ties are broken arbitrarily. Shapes that
// are flat together, such as coplanar triangles, separate across their plane with depth 0;
// concentric points separate along +Y.
template <typename A, typename B>
requires ConvexPair<A, B> std::optional<Penetration> penetration(const A &a, const B &b);

// `distance` and `penetration` in one: the closest points, or the deepest points of overlapping
// shapes.
struct Proximity {
    Real separation = Real(0); // negative in penetration
    Vec3 normal{Real(0)};      // unit, from A to B
    Vec3 on_a{Real(0)};
    Vec3 on_b{Real(0)};
    Real excess = Real(0); // of a penetration
    int iterations = 0;
    bool is_beyond = false; // farther apart than asked for; nothing else is known
};
template <typename A, typename B>
requires ConvexPair<A, B> Proximity proximity(const A &a, const B &b);

// --- The parts -----------------------------------------------------------------------------------

// The polyhedron EPA expands: triangles with adjacency.
class Polytope {
  public:
    static constexpr int vertex_limit = 128;

    // Left uninitialised: the array is large.
    struct Face {
        Vec3 normal;   // unit, outward
        Real height;   // of the plane above the origin
        Real distance; // of the triangle from the origin; a lower bound until it is measured
        std::array<std::uint8_t, 3> vertices;
        std::array<std::uint8_t, 3> neighbors;      // across the edge from vertex i to the next
        std::array<std::uint8_t, 3> neighbor_sides; // which of the neighbour's edges it is
        bool is_used;
        bool is_visible;
        bool is_measured;
    };

    // From a tetrahedron that is not flat.
    explicit Polytope(const Simplex &simplex);

    // The face closest to the origin, measured to the triangle rather than its plane: a ball around
    // the origin that does not reach this face stays inside the polyhedron, however bad the normals
    // are. In a convex polyhedron this is also the face with the lowest plane, but the normal of a
    // sliver far from the origin is mostly rounding, and so is the height of its plane. Van den
    // Bergen 2001 therefore skips faces that do not contain the origin's projection; measuring the
    // triangle instead does not lose a closest point that lies on an edge.
    int nearest(const Vec3 &size);
    const Face &face(int i) const { return faces_[static_cast<std::size_t>(i)]; }
    bool is_full() const { return vertex_count_ == vertex_limit; }
    // Sets the face's final height: no support point is farther along its normal.
    void finish(int i, Real height);

    // Expands to a point in front of the face. Returns false and changes nothing when, within
    // rounding, the point is in front of no face, or the horizon around the faces it sees is not a
    // single loop.
    bool grow(int i, const SimplexVertex &point, const Vec3 &size);

    // The points of the shapes behind the surface point closest to the origin, `normal` times
    // `height`. Several faces may share that plane, and only one of them contains the point.
    Witnesses nearest_points(const Vec3 &normal, Real height, const Vec3 &size) const;

  private:
    // A polyhedron of triangles with v vertices has 2 v - 4 of them.
    static constexpr int face_limit = 2 * vertex_limit - 4;

    int add_face(int p, int q, int r);
    void measure(Face &face, const Vec3 &size) const;
    void join(int f, int side, int g, int other_side);

    int vertex_count_ = 0;
    int face_end_ = 0;   // faces from here on were never used
    int first_free_ = 0; // no face before this one is free
    std::array<SimplexVertex, static_cast<std::size_t>(vertex_limit)> vertices_;
    std::array<Face, static_cast<std::size_t>(face_limit)> faces_;
};

// Drops redundant vertices from a simplex that contains the origin within rounding: vertices too
// close to another vertex, to the line through two, or to the plane through three.
void keep_independent(Simplex &simplex, const Vec3 &size);

// The penetration of two cores for which GJK found an overlap, without their radii and relative to
// their origin.
Penetration core_penetration(const CorePair &cores, const GjkResult &overlap);

// For two cores, relative to their origin; is_beyond if they are farther apart than `far`. `guess`
// is the direction from A to B to search first; zero: from A's middle to B's.
Proximity proximity(const CorePair &cores, Real far, const Vec3 &guess = Vec3{Real(0)});

template <typename A, typename B>
requires ConvexPair<A, B> Proximity proximity(const A &a, const B &b) {
    const Vec3 origin = place_of(a);
    const auto core_a = core_of(a, origin);
    const auto core_b = core_of(b, origin);
    Proximity found = proximity(CorePair(core_a, core_b), std::numeric_limits<Real>::infinity());
    found.on_a += origin;
    found.on_b += origin;
    return found;
}

template <typename A, typename B>
requires ConvexPair<A, B> std::optional<Penetration> penetration(const A &a, const B &b) {
    const Vec3 origin = place_of(a);
    const auto core_a = core_of(a, origin);
    const auto core_b = core_of(b, origin);
    const Proximity found = proximity(CorePair(core_a, core_b), Real(0));
    if (found.is_beyond || found.separation > Real(0))
        return std::nullopt;
    return Penetration{-found.separation,   found.normal, origin + found.on_a,
                       origin + found.on_b, found.excess, found.iterations};
}

} // namespace plumb::inline PLUMB_PRECISION
