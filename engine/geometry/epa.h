// How deep two convex shapes are in each other, by EPA.
//
// Van den Bergen 2001, "Proximity queries and penetration depth computation on 3D game objects": a
// polyhedron inside of the difference B - A is grown where its surface is nearest to the origin,
// until it cannot grow there. Shapes with a radius whose cores are apart need GJK only.
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
    Real excess = Real(0); // by which `depth` may be more than the least; see below
    int iterations = 0;    // support points taken
};

// The least translation that parts two convex shapes that overlap; none for shapes that do not
// (touching ones do, with depth 0).
//
// `depth` along `normal` parts them, and is the shortest way to, within the rounding of `distance`
// (gjk.h) and relative 1e-5 in float, 1e-10 in double. Where cylinders are in each other (not where
// a cylinder is in the radius of another shape only) the shortest way is found within 4e-3, and the
// points may be as much off the surface. A cylinder and a hull with so many faces about as far out
// that the search meets its limit miss that by at most `excess` (metres), zero for all others.
// Where several ways are as short, one of them. Shapes that are flat together, such as triangles in
// one plane, part across the plane with depth 0; concentric points along +Y.
template <typename A, typename B>
requires ConvexPair<A, B> std::optional<Penetration> penetration(const A &a, const B &b);

// `distance` and `penetration` in one: where two shapes are closest, or deepest in each other.
struct Proximity {
    Real separation = Real(0); // negative in penetration
    Vec3 normal{Real(0)};      // unit, from A to B
    Vec3 on_a{Real(0)};
    Vec3 on_b{Real(0)};
    Real excess = Real(0); // of a penetration
    int iterations = 0;
    bool is_beyond = false; // farther apart than was asked for; nothing else is known
};
template <typename A, typename B>
requires ConvexPair<A, B> Proximity proximity(const A &a, const B &b);

// --- The parts -----------------------------------------------------------------------------------

// The polyhedron that EPA grows: triangles, each knowing its neighbours.
class Polytope {
  public:
    static constexpr int vertex_limit = 128;

    // Not initialised, for there is room for many.
    struct Face {
        Vec3 normal;   // unit, outward
        Real height;   // of the plane above the origin
        Real distance; // of the triangle from the origin; no less, while it is not measured
        std::array<std::uint8_t, 3> vertices;
        std::array<std::uint8_t, 3> neighbors;      // across the side from vertex i to the next
        std::array<std::uint8_t, 3> neighbor_sides; // which of the neighbour's sides it is
        bool is_used;
        bool is_visible;
        bool is_measured;
    };

    // A tetrahedron that is not flat.
    explicit Polytope(const Simplex &simplex);

    // The face that is nearest to the origin as a triangle: no ball around the origin that it does
    // not meet leaves the polyhedron, whatever the normals are worth. In a convex polyhedron it is
    // also the face with the lowest plane; but the normal of a sliver far from the origin is mostly
    // rounding, and so is then the height of its plane. Van den Bergen 2001 leaves out faces that
    // the foot of the origin is not in, for that reason; this does not lose the nearest point where
    // it is on an edge.
    int nearest(const Vec3 &size);
    const Face &face(int i) const { return faces_[static_cast<std::size_t>(i)]; }
    bool is_full() const { return vertex_count_ == vertex_limit; }
    // No support point is farther along the face's normal than this: its height, then.
    void finish(int i, Real height);

    // Grows to a point in front of the face; false, and nothing changed, when it is in front of no
    // face, within rounding, or the border of those it is in front of is not one loop.
    bool grow(int i, const SimplexVertex &point, const Vec3 &size);

    // The points of the shapes where the surface is nearest to the origin, which is at `normal`
    // times `height`: in the plane of a face there may be others, and only one of them is there.
    Witnesses nearest_points(const Vec3 &normal, Real height, const Vec3 &size) const;

  private:
    // A polyhedron of triangles has 2 v - 4 of them.
    static constexpr int face_limit = 2 * vertex_limit - 4;

    int add_face(int p, int q, int r);
    void measure(Face &face, const Vec3 &size) const;
    void join(int f, int side, int g, int other_side);

    int vertex_count_ = 0;
    int face_end_ = 0;   // those from here on were never used
    int first_free_ = 0; // none before is free
    std::array<SimplexVertex, static_cast<std::size_t>(vertex_limit)> vertices_;
    std::array<Face, static_cast<std::size_t>(face_limit)> faces_;
};

// Leaves out vertices of a simplex that contains the origin, within rounding, which others make
// superfluous: too near to another, to the line of two, to the plane of three.
void keep_independent(Simplex &simplex, const Vec3 &size);

// The penetration of two cores, relative to their origin, without their radii, where GJK ended with
// an overlap.
Penetration core_penetration(const CorePair &cores, const GjkResult &overlap);

// For two cores, relative to their origin; is_beyond when they are farther apart than `far`.
// `guess` is a direction from A to B to look along first; zero: from middle to middle.
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
