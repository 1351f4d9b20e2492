// How deep two convex shapes are in each other, by EPA.
//
// Van den Bergen 2001, "Proximity queries and penetration depth computation on 3D game objects": a
// polyhedron inside of the difference B - A is grown where its surface is nearest to the origin,
// until it cannot grow there. Shapes with a radius whose cores are apart need GJK only.
#pragma once

#include "engine/geometry/gjk.h"
#include "engine/geometry/manifold_pairs.h"

#include <algorithm>
#include <optional>
#include <span>

namespace plumb::inline PLUMB_PRECISION {

struct Penetration {
    Real depth = Real(0); // >= 0
    Vec3 normal{Real(0)}; // unit, from A to B: B moved by depth * normal just touches A
    Vec3 on_a{Real(0)};   // the deepest point of A in B
    Vec3 on_b{Real(0)};   // the deepest point of B in A: on_a - depth * normal
    int iterations = 0;   // support points taken
};

// The least translation that parts two convex shapes that overlap; none for shapes that do not
// (touching ones do, with depth 0).
//
// `depth` along `normal` parts them, and is the shortest way to, within the rounding of `distance`
// (gjk.h) and relative 1e-5 in float, 1e-10 in double. Where cylinders are in each other (not where
// a cylinder is in the radius of another shape only) the shortest way is found within 4e-3, and the
// points may be as much off the surface. Where several ways are as short, one of them. Shapes that
// are flat together, such as triangles in one plane, part across the plane with depth 0; concentric
// points along +Y.
template <typename A, typename B>
requires ConvexPair<A, B> std::optional<Penetration> penetration(const A &a, const B &b);

// --- The parts -----------------------------------------------------------------------------------

// The polyhedron that EPA grows: triangles, each knowing its neighbours.
class Polytope {
  public:
    static constexpr int vertex_limit = 128;

    // Not initialised, for there is room for many.
    struct Face {
        Vec3 normal; // unit, outward
        Real height; // of the plane above the origin
        std::array<std::uint8_t, 3> vertices;
        std::array<std::uint8_t, 3> neighbors;      // across the side from vertex i to the next
        std::array<std::uint8_t, 3> neighbor_sides; // which of the neighbour's sides it is
        bool is_used;
        bool is_visible;
    };

    // A tetrahedron that is not flat.
    explicit Polytope(const Simplex &simplex);

    // The face with the least height.
    int nearest() const;
    const Face &face(int i) const { return faces_[static_cast<std::size_t>(i)]; }
    bool is_full() const { return vertex_count_ == vertex_limit; }
    // No support point is farther along the face's normal than this: its height, then.
    void finish(int i, Real height) { faces_[static_cast<std::size_t>(i)].height = height; }

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
    void join(int f, int side, int g, int other_side);

    int vertex_count_ = 0;
    int face_end_ = 0; // those from here on were never used
    std::array<SimplexVertex, static_cast<std::size_t>(vertex_limit)> vertices_;
    std::array<Face, static_cast<std::size_t>(face_limit)> faces_;
};

// Leaves out vertices of a simplex that contains the origin, within rounding, which others make
// superfluous: too near to another, to the line of two, to the plane of three.
void keep_independent(Simplex &simplex, const Vec3 &size);

// The penetration of two cores, relative to their origin, without their radii.
template <typename CoreA, typename CoreB>
Penetration core_penetration(const CoreA &a, const CoreB &b, const GjkResult &overlap) {
    // A curved surface takes more vertices the closer it is followed, and around an axis of
    // symmetry everywhere at once: with this, 64 around each rim.
    constexpr bool is_curved =
        std::same_as<CoreA, CylinderCore> || std::same_as<CoreB, CylinderCore>;
    constexpr Real relative =
        is_curved ? Real(4e-3) : (sizeof(Real) == 4 ? Real(1e-5) : Real(1e-10));
    Simplex simplex = overlap.simplex;
    Vec3 size = overlap.size;
    Penetration result;
    // The point of the difference farthest along a direction.
    const auto support = [&](const Vec3 &direction) {
        SimplexVertex vertex;
        vertex.a = a.support(-direction);
        vertex.b = b.support(direction);
        vertex.w = vertex.b - vertex.a;
        size = glm::max(size, glm::abs(vertex.a) + glm::abs(vertex.b));
        ++result.iterations;
        return vertex;
    };
    // Adds the support point, of those along the directions and against them, that is farthest off
    // the simplex; false when none is, by more than rounding.
    const auto widen = [&](std::span<const Vec3> directions, const auto &off) {
        Real most = Real(0);
        SimplexVertex farthest;
        for (const Vec3 &along : directions) {
            for (const Vec3 &direction : {along, -along}) {
                const SimplexVertex vertex = support(direction);
                const Real distance_off = off(vertex.w);
                if (distance_off > most) {
                    most = distance_off;
                    farthest = vertex;
                }
            }
        }
        // Off a plane only what rounds along its normal counts, so that large and thin is not flat.
        const Real rounding = Real(2) * (simplex.count == 3 ? rounding_along(directions[0], size)
                                                            : rounding_of(size));
        if (!(most > rounding))
            return false;
        simplex.vertices[static_cast<std::size_t>(simplex.count++)] = farthest;
        return true;
    };

    const auto flat = [&](const Vec3 &normal) {
        const Witnesses on = witnesses(overlap);
        const bool is_backward = glm::dot(normal, b.middle() - a.middle()) < Real(0);
        result.normal = is_backward ? -normal : normal;
        result.on_a = result.on_b = Real(0.5) * (on.on_a + on.on_b);
        return result;
    };
    keep_independent(simplex, size);
    const Vec3 &w0 = simplex.vertices[0].w;
    if (simplex.count == 1) {
        const std::array<Vec3, 3> axes = {Vec3{Real(1), Real(0), Real(0)},
                                          Vec3{Real(0), Real(1), Real(0)},
                                          Vec3{Real(0), Real(0), Real(1)}};
        if (!widen(axes, [&](const Vec3 &w) { return glm::length(w - w0); }))
            return flat(axes[1]);
    }
    if (simplex.count == 2) {
        const Vec3 along = glm::normalize(simplex.vertices[1].w - w0);
        const Vec3 across = any_perpendicular(along);
        const std::array<Vec3, 2> directions = {across, glm::cross(along, across)};
        if (!widen(directions,
                   [&](const Vec3 &w) { return glm::length(glm::cross(w - w0, along)); }))
            return flat(across);
    }
    if (simplex.count == 3) {
        const Vec3 &w1 = simplex.vertices[1].w;
        const Vec3 &w2 = simplex.vertices[2].w;
        const std::array<Vec3, 1> normal = {
            glm::normalize(triangle_normal(w1 - w0, w2 - w0, w2 - w1))};
        if (!widen(normal, [&](const Vec3 &w) { return std::abs(glm::dot(w - w0, normal[0])); }))
            return flat(normal[0]);
    }

    Polytope polytope(simplex);
    Vec3 best_normal = polytope.face(0).normal;
    Real least = std::numeric_limits<Real>::infinity();
    for (;;) {
        const int nearest = polytope.nearest();
        const Polytope::Face &face = polytope.face(nearest);
        const SimplexVertex vertex = support(face.normal);
        const Real height = glm::dot(vertex.w, face.normal);
        if (height < least) {
            least = height;
            best_normal = face.normal;
        }
        // Nothing of the difference is nearer than the nearest plane of a part of it, and a plane
        // that it is behind is a way out. Both are below zero by rounding where the shapes touch
        // within it only.
        if (least - face.height <= relative * std::abs(least) + rounding_along(face.normal, size))
            break;
        // A face that does not grow is finished once, and ends this when it is the nearest again;
        // the second limit is for coordinates beyond all sizes, whose products overflow.
        if (polytope.is_full() || result.iterations > 2 * Polytope::vertex_limit) {
            (void)PLUMB_RARELY("epa: vertex limit", true);
            break;
        }
        if (!polytope.grow(nearest, vertex, size))
            polytope.finish(nearest, height);
    }
    const Witnesses on = polytope.nearest_points(best_normal, least, size);
    result.depth = std::max(least, Real(0));
    result.normal = -best_normal;
    result.on_a = on.on_a;
    result.on_b = on.on_b;
    return result;
}

// Where two placed cores are closest or deepest, with their radii: what `distance` and
// `penetration` say, in one.
struct Proximity {
    Real separation = Real(0); // negative in penetration
    Vec3 normal{Real(0)};      // unit, from A to B
    Vec3 on_a{Real(0)};
    Vec3 on_b{Real(0)};
    int iterations = 0;
    bool is_beyond = false; // farther apart than asked for; nothing else is known
};
template <typename CoreA, typename CoreB>
Proximity proximity(const CoreA &a, const CoreB &b, Real far) {
    const Real radii = a.radius + b.radius;
    const GjkResult found = gjk(a, b, b.middle() - a.middle(), far + radii);
    Proximity result;
    result.iterations = found.iterations;
    if (found.is_beyond) {
        result.is_beyond = true;
        return result;
    }
    if (found.is_overlapping) {
        const Penetration deep = core_penetration(a, b, found);
        result.separation = -deep.depth - radii;
        result.normal = deep.normal;
        result.on_a = deep.on_a;
        result.on_b = deep.on_b;
        result.iterations += deep.iterations;
    } else {
        const Witnesses on = witnesses(found);
        const Real between = std::sqrt(found.squared_distance);
        result.separation = between - radii;
        result.normal = found.difference / between;
        result.on_a = on.on_a;
        result.on_b = on.on_b;
    }
    result.on_a += a.radius * result.normal;
    result.on_b -= b.radius * result.normal;
    return result;
}

template <typename A, typename B>
requires ConvexPair<A, B> std::optional<Penetration> penetration(const A &a, const B &b) {
    const Vec3 origin = place_of(a);
    const Proximity found = proximity(core_of(a, origin), core_of(b, origin), Real(0));
    if (found.is_beyond || found.separation > Real(0))
        return std::nullopt;
    return Penetration{-found.separation, found.normal, origin + found.on_a, origin + found.on_b,
                       found.iterations};
}

} // namespace plumb::inline PLUMB_PRECISION
