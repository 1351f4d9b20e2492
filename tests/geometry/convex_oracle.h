// Convex shapes in double as a reference for GJK, EPA and casts: closed-form support values and
// distances to points, and hulls and pairs of shapes to test with.
#pragma once

#include "engine/geometry/support.h"
#include "tests/geometry/oracle.h"

#include <ostream>
#include <string>

namespace plumb::inline PLUMB_PRECISION {
namespace oracle {

// The hull of given vertices and faces (counter-clockwise from outside), all fields filled.
inline HullMesh mesh_of(const std::vector<V> &vertices,
                        const std::vector<std::vector<std::uint32_t>> &faces) {
    HullMesh mesh;
    std::vector<std::vector<std::uint32_t>> neighbors(vertices.size());
    for (const V &v : vertices) {
        const Vec3 p{Real(v.x), Real(v.y), Real(v.z)};
        mesh.vertices.push_back(p);
        mesh.box.min = glm::min(mesh.box.min, p);
        mesh.box.max = glm::max(mesh.box.max, p);
        mesh.center += p / Real(vertices.size());
    }
    for (std::uint32_t f = 0; f < faces.size(); ++f) {
        const auto &face = faces[f];
        mesh.faces.push_back(
            {std::uint32_t(mesh.vertex_indices.size()), std::uint32_t(face.size())});
        V normal{0.0};
        for (std::size_t i = 0; i < face.size(); ++i) {
            const std::uint32_t p = face[i], q = face[(i + 1) % face.size()];
            mesh.vertex_indices.push_back(p);
            normal += glm::cross(vertices[p], vertices[q]);
            if (p < q)
                mesh.edges.push_back({p, q, f, 0});
            neighbors[p].push_back(q);
        }
        normal = glm::normalize(normal);
        double offset = -1e300;
        for (const std::uint32_t i : face)
            offset = std::max(offset, glm::dot(normal, vertices[i]));
        mesh.planes.push_back({Vec3{Real(normal.x), Real(normal.y), Real(normal.z)}, Real(offset)});
    }
    for (std::uint32_t f = 0; f < faces.size(); ++f)
        for (std::size_t i = 0; i < faces[f].size(); ++i)
            for (auto &edge : mesh.edges)
                if (edge.a == faces[f][(i + 1) % faces[f].size()] && edge.b == faces[f][i])
                    edge.right_face = f;
    mesh.first_neighbor.push_back(0);
    for (const auto &list : neighbors) {
        mesh.neighbors.insert(mesh.neighbors.end(), list.begin(), list.end());
        mesh.first_neighbor.push_back(std::uint32_t(mesh.neighbors.size()));
    }
    const Vec3 extent = glm::max(glm::abs(mesh.box.min), glm::abs(mesh.box.max));
    mesh.slack = Real(8) * std::numeric_limits<Real>::epsilon() * (extent.x + extent.y + extent.z);
    return mesh;
}

// A prism over a `sides`-gon inscribed in an ellipse, tapered to `top` of its width at the top
// (1: straight).
inline HullMesh prism(int sides, const V &half, double top) {
    std::vector<V> vertices;
    std::vector<std::vector<std::uint32_t>> faces(2);
    const auto n = std::uint32_t(sides);
    for (std::uint32_t i = 0; i < 2 * n; ++i) {
        const double angle = 2.0 * 3.14159265358979323846 * double(i % n) / double(n);
        const double shrink = i < n ? 1.0 : top;
        vertices.push_back({half.x * std::cos(angle) * shrink, i < n ? -half.y : half.y,
                            -half.z * std::sin(angle) * shrink});
    }
    for (std::uint32_t i = 0; i < n; ++i) {
        faces[0].push_back(n - 1 - i);
        faces[1].push_back(n + i);
        faces.push_back({i, (i + 1) % n, n + (i + 1) % n, n + i});
    }
    return mesh_of(vertices, faces);
}

inline HullMesh tetrahedron(const std::array<V, 4> &corners) {
    const std::vector<V> vertices(corners.begin(), corners.end());
    if (glm::dot(glm::cross(corners[1] - corners[0], corners[2] - corners[0]),
                 corners[3] - corners[0]) > 0.0)
        return mesh_of(vertices, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}});
    return mesh_of(vertices, {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}});
}

// Wider than Real, so that the oracle's own rounding does not show.
using Wide = std::conditional_t<sizeof(Real) == 4, double, long double>;
using W = glm::vec<3, Wide>;
using WideMat = glm::mat<3, 3, Wide>;
using WideQuat = glm::qua<Wide>;

inline W to_wide(const Vec3 &v) {
    return {Wide(v.x), Wide(v.y), Wide(v.z)};
}

// Any convex shape as the corners of a polytope or core plus a radius, or as a cylinder.
struct Body {
    std::vector<W> corners;
    std::vector<std::array<W, 2>> planes; // of the faces: outward unit normal and a point
    std::vector<std::array<W, 2>> edges;  // of a polytope
    bool is_solid = false;                // the planes bound its inside
    bool is_cylinder = false;             // around the segment between its two corners
    Wide radius = 0.0;

    Wide support(const W &u) const { // along a unit vector
        Wide most = -1e300;
        for (const W &c : corners)
            most = std::max(most, glm::dot(c, u));
        if (!is_cylinder)
            return most + radius;
        const W axis = glm::normalize(corners[1] - corners[0]);
        return most + radius * glm::length(u - axis * glm::dot(axis, u));
    }
    // How far a point is outside. For hulls, its height over the farthest plane, a lower bound.
    Wide outside(const W &p) const {
        if (is_solid) {
            Wide most = -1e300;
            for (const auto &[normal, at] : planes)
                most = std::max(most, glm::dot(normal, p - at));
            return most;
        }
        if (is_cylinder) {
            const W axis = glm::normalize(corners[1] - corners[0]);
            const Wide along = glm::dot(p - corners[0], axis);
            const Wide length = glm::length(corners[1] - corners[0]);
            return std::max(
                {-along, along - length, glm::length(p - corners[0] - along * axis) - radius});
        }
        if (corners.size() == 1)
            return glm::length(p - corners[0]) - radius;
        if (corners.size() == 2)
            return to_segment(p, corners[0], corners[1]) - radius;
        // A triangle.
        Wide least = 1e300;
        for (std::size_t i = 0; i < 3; ++i)
            least = std::min(least, to_segment(p, corners[i], corners[(i + 1) % 3]));
        const W normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
        const Wide area = glm::length(normal);
        if (area > 0.0) {
            bool is_above = true;
            for (std::size_t i = 0; i < 3; ++i)
                is_above = is_above &&
                           glm::dot(glm::cross(corners[(i + 1) % 3] - corners[i], p - corners[i]),
                                    normal) >= 0.0;
            if (is_above)
                least = std::min(least, std::abs(glm::dot(p - corners[0], normal)) / area);
        }
        return least;
    }
    void move(const W &by) {
        for (W &c : corners)
            c += by;
        for (auto &plane : planes)
            plane[1] += by;
        for (auto &edge : edges)
            edge = {edge[0] + by, edge[1] + by};
    }

  private:
    static Wide to_segment(const W &p, const W &a, const W &b) {
        const W d = b - a;
        const Wide dd = glm::dot(d, d);
        return glm::length(
            p - (dd > 0.0 ? a + d * std::clamp(glm::dot(p - a, d) / dd, Wide(0), Wide(1)) : a));
    }
};

inline WideMat wide_rotation(const Quat &q) {
    return glm::mat3_cast(glm::normalize(WideQuat(Wide(q.w), Wide(q.x), Wide(q.y), Wide(q.z))));
}

inline Wide largest_coordinate(const Body &body) {
    Wide largest = 0.0;
    for (const W &c : body.corners)
        largest = std::max({largest, std::abs(c.x), std::abs(c.y), std::abs(c.z)});
    return largest + body.radius;
}
inline Body points_body(std::vector<W> corners, Wide radius) {
    Body body;
    body.radius = radius;
    for (std::size_t i = 0; i < corners.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            body.edges.push_back({corners[j], corners[i]});
    if (corners.size() == 3) {
        const W normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
        if (glm::length(normal) > 0.0) {
            body.planes.push_back({glm::normalize(normal), corners[0]});
            body.planes.push_back({-glm::normalize(normal), corners[0]});
        }
    }
    body.corners = std::move(corners);
    return body;
}
// Relative to `o`, subtracted first so that the oracle is as exact far out as near the origin.
inline Body body_of(const Vec3 &p, const W &o) {
    return points_body({to_wide(p) - o}, 0.0);
}
inline Body body_of(const Segment &s, const W &o) {
    return points_body({to_wide(s.a) - o, to_wide(s.b) - o}, 0.0);
}
inline Body body_of(const Triangle &t, const W &o) {
    return points_body({to_wide(t.a) - o, to_wide(t.b) - o, to_wide(t.c) - o}, 0.0);
}
inline Body body_of(const Sphere &s, const W &o) {
    return points_body({to_wide(s.center) - o}, Wide(s.radius));
}
inline Body body_of(const Capsule &c, const W &o) {
    return points_body({to_wide(c.a) - o, to_wide(c.b) - o}, Wide(c.radius));
}
inline Body body_of(const Cylinder &c, const W &o) {
    Body body = points_body({to_wide(c.a) - o, to_wide(c.b) - o}, Wide(c.radius));
    body.is_cylinder = true;
    return body;
}
inline Body box_body(const W &center, const WideMat &axes, const W &half) {
    Body body;
    body.is_solid = true;
    for (int k = 0; k < 8; ++k) {
        W c = center;
        for (int i = 0; i < 3; ++i)
            c += axes[i] * ((k >> i & 1) != 0 ? half[i] : -half[i]);
        body.corners.push_back(c);
    }
    for (int i = 0; i < 3; ++i) {
        body.planes.push_back({axes[i], center + axes[i] * half[i]});
        body.planes.push_back({-axes[i], center - axes[i] * half[i]});
        body.edges.push_back({W{0.0}, axes[i]});
    }
    return body;
}
inline Body body_of(const Box &b, const W &o) {
    return box_body(to_wide(b.center) - o, wide_rotation(b.rotation), to_wide(b.half_extents));
}
inline Body body_of(const Aabb &b, const W &o) {
    const W low = to_wide(b.min) - o, high = to_wide(b.max) - o;
    return box_body(Wide(0.5) * (low + high), WideMat(1.0), Wide(0.5) * (high - low));
}
inline Body body_of(const ConvexHull &hull, const W &o) {
    Body body;
    body.is_solid = true;
    const WideMat rotation = wide_rotation(hull.rotation);
    for (const Vec3 &v : hull.mesh->vertices)
        body.corners.push_back((to_wide(hull.position) - o) + rotation * to_wide(v));
    for (const auto &face : hull.mesh->faces) {
        W normal{0.0};
        const auto corner = [&](std::uint32_t i) {
            return body.corners[hull.mesh->vertex_indices[face.first + i % face.count]];
        };
        for (std::uint32_t i = 1; i + 1 < face.count; ++i)
            normal += glm::cross(corner(i) - corner(0), corner(i + 1) - corner(0));
        normal = glm::normalize(normal);
        W at = corner(0);
        for (std::uint32_t i = 1; i < face.count; ++i)
            if (glm::dot(normal, corner(i) - at) > 0.0)
                at = corner(i);
        body.planes.push_back({normal, at});
    }
    for (const auto &edge : hull.mesh->edges)
        body.edges.push_back({body.corners[edge.a], body.corners[edge.b]});
    return body;
}

// How far B must move along u to be clear of A; negative when they are separated along u.
inline Wide overlap_along(const Body &a, const Body &b, const W &u) {
    return a.support(u) + b.support(-u);
}

// Visits every direction from A to B that can be a face normal of the Minkowski difference of two
// polytopes: all face normals, and the cross products of all edges with both signs.
template <typename Visit> void for_all_axes(const Body &a, const Body &b, const Visit &visit) {
    for (const auto &plane : a.planes)
        visit(plane[0]);
    for (const auto &plane : b.planes)
        visit(-plane[0]);
    for (const auto &p : a.edges)
        for (const auto &q : b.edges) {
            const W d = p[1] - p[0], e = q[1] - q[0];
            const W cross = glm::cross(d, e);
            const Wide length = glm::length(cross);
            if (length > Wide(1e-9) * glm::length(d) * glm::length(e)) {
                visit(cross / length);
                visit(-cross / length);
            }
        }
}

// The separation of two polytopes: the greatest over these directions. It is the signed distance
// when they overlap.
inline Wide polytope_separation(const Body &a, const Body &b) {
    Wide most = -1e300;
    for_all_axes(a, b, [&](const W &u) { most = std::max(most, -overlap_along(a, b, u)); });
    return most;
}

inline std::string text(const Vec3 &v) {
    std::ostringstream out;
    out.precision(17);
    out << '{' << v.x << ", " << v.y << ", " << v.z << '}';
    return out.str();
}

// --- Pairs to test with --------------------------------------------------------------------------

// Every pair of kinds once, in mixed order: check.operator()<A, B>().
inline constexpr int kinds_of_pairs = 44;

template <typename... Kinds> struct KindList {};

template <typename Check> void for_all_pairs(const Check &check) {
    const auto with = [&]<typename A, typename... Bs>(KindList<A, Bs...>) {
        (check.template operator()<A, Bs>(), ...);
    };
    with(KindList<Vec3, Segment, Sphere, Box, Capsule>{});
    with(KindList<Segment, Segment, Sphere, Aabb, Cylinder, ConvexHull>{});
    with(KindList<Triangle, Vec3, Segment, Triangle, Sphere, Aabb, Cylinder>{});
    with(KindList<Sphere, Sphere, Aabb, Capsule, ConvexHull>{});
    with(KindList<Box, Segment, Triangle, Sphere, Box, Capsule, ConvexHull>{});
    with(KindList<Aabb, Vec3, Box, Aabb, Capsule, ConvexHull>{});
    with(KindList<Capsule, Segment, Triangle, Capsule, Cylinder>{});
    with(KindList<Cylinder, Vec3, Sphere, Box, Aabb, Cylinder, ConvexHull>{});
    with(KindList<ConvexHull, Vec3, Triangle, Capsule, ConvexHull>{});
}

// The sizes in one pair: similar and ordinary, or anything from 1e-3 to 1e5.
struct Scale {
    double size_a = 1.0, size_b = 1.0;
    double reach = 1.0;      // of positions
    bool is_awkward = false; // quarter turns, coordinates on a grid, equal extents
};

inline Scale any_scale(Random &random) {
    Scale scale;
    const std::uint32_t kind = random.next_index(8);
    scale.is_awkward = random.next_index(2) == 0;
    if (kind == 0) {
        scale.size_a = std::pow(10.0, random.next_in(-3.0, 5.0));
        scale.size_b = std::pow(10.0, random.next_in(-3.0, 5.0));
    } else if (kind == 1) {
        scale.size_a = scale.size_b = std::pow(10.0, random.next_in(-3.0, 5.0));
    }
    if (random.next_index(8) == 0)
        scale.reach = std::pow(10.0, random.next_in(1.0, 5.0));
    return scale;
}

inline Vec3 any_place(Random &random, const Scale &scale) {
    const Vec3 at = any_vector(random, scale.reach);
    return scale.is_awkward ? glm::round(at * Real(4)) / Real(4) : at;
}
inline Quat any_turn(Random &random, const Scale &scale) {
    return scale.is_awkward ? awkward_rotation(random) : any_rotation(random);
}
// Sometimes zero, sometimes a needle or a plate, sometimes round numbers.
inline Vec3 any_half(Random &random, double size, bool is_awkward, bool may_be_flat) {
    Vec3 half{any_real(random, 0.1, 1.0), any_real(random, 0.1, 1.0), any_real(random, 0.1, 1.0)};
    if (is_awkward) {
        half = glm::ceil(half * Real(4)) / Real(4);
        const std::uint32_t i = random.next_index(3);
        const std::uint32_t kind = random.next_index(8);
        if (kind == 0)
            half[int(i)] *= Real(1e-3);
        else if (kind == 1 && may_be_flat)
            half[int(i)] = Real(0);
        else if (kind == 2)
            half[int(i)] *= Real(100);
    }
    return half * Real(size);
}

template <typename Shape> struct Any;
template <> struct Any<Vec3> {
    static Vec3 make(Random &, const Vec3 &at, double, const Scale &) { return at; }
};
template <> struct Any<Segment> {
    static Segment make(Random &random, const Vec3 &at, double size, const Scale &s) {
        const Vec3 d = any_turn(random, s) * any_half(random, size, s.is_awkward, true);
        const Vec3 axis = random.next_index(2) == 0 ? d : Vec3{d.x, Real(0), Real(0)};
        return {at - axis, at + axis};
    }
};
template <> struct Any<Capsule> {
    static Capsule make(Random &random, const Vec3 &at, double size, const Scale &s) {
        const Segment axis = Any<Segment>::make(random, at, size, s);
        return {axis.a, axis.b, Real(0.5) * any_half(random, size, s.is_awkward, true).x};
    }
};
template <> struct Any<Cylinder> {
    static Cylinder make(Random &random, const Vec3 &at, double size, const Scale &s) {
        const Vec3 half = any_half(random, size, s.is_awkward, false);
        const Vec3 axis = any_turn(random, s) * Vec3{Real(0), half.y, Real(0)};
        return {at - axis, at + axis == at - axis ? at + Vec3{Real(1)} : at + axis, half.x};
    }
};
template <> struct Any<Triangle> {
    static Triangle make(Random &random, const Vec3 &at, double size, const Scale &s) {
        const Quat q = any_turn(random, s);
        const Vec3 h = any_half(random, size, s.is_awkward, true);
        const Vec3 g = any_half(random, size, s.is_awkward, true);
        return {at + q * Vec3{-h.x, Real(0), -h.z}, at + q * Vec3{g.x, Real(0), -g.y},
                at + q * Vec3{Real(0), Real(0), g.z}};
    }
};
template <> struct Any<Sphere> {
    static Sphere make(Random &random, const Vec3 &at, double size, const Scale &s) {
        return {at, any_half(random, size, s.is_awkward, true).x};
    }
};
template <> struct Any<Box> {
    static Box make(Random &random, const Vec3 &at, double size, const Scale &s) {
        return {at, any_turn(random, s), any_half(random, size, s.is_awkward, true)};
    }
};
template <> struct Any<Aabb> {
    static Aabb make(Random &random, const Vec3 &at, double size, const Scale &s) {
        const Vec3 half = any_half(random, size, s.is_awkward, true);
        return {at - half, at + half};
    }
};
template <> struct Any<ConvexHull> {
    static ConvexHull make(Random &random, const Vec3 &at, double size, const Scale &s) {
        // Unit-size meshes are shared; each decade has its own.
        static const std::vector<HullMesh> meshes = [] {
            Random shapes(5);
            std::vector<HullMesh> result;
            for (int decade = -3; decade <= 5; ++decade) {
                const double size_of = std::pow(10.0, decade);
                for (int i = 0; i < 8; ++i) {
                    const V half{shapes.next_in(0.1, 1.0), shapes.next_in(0.1, 1.0),
                                 shapes.next_in(0.1, 1.0)};
                    result.push_back(prism(3 + i, half * size_of, i % 2 == 0 ? 1.0 : 0.6));
                    const auto corner = [&] {
                        return V{shapes.next_in(-1, 1), shapes.next_in(-1, 1),
                                 shapes.next_in(-1, 1)} *
                               size_of;
                    };
                    result.push_back(tetrahedron({corner(), corner(), corner(), corner()}));
                }
                result.push_back(prism(4, V{1.0, 1e-3, 0.5} * size_of, 1.0));
                result.push_back(prism(16, V{1.0, 0.5, 1.0} * size_of, 1.0));
                result.push_back(prism(24, V{1.0, 0.5, 1.0} * size_of, 0.5));
            }
            return result;
        }();
        const std::size_t each = meshes.size() / 9;
        const auto decade = std::size_t(std::clamp(std::lround(std::log10(size)) + 3L, 0L, 8L));
        const HullMesh &mesh = meshes[decade * each + random.next_index(std::uint32_t(each))];
        return {&mesh, at, any_turn(random, s)};
    }
};

template <typename Shape> Shape moved(Shape shape, const Vec3 &by) {
    if constexpr (std::same_as<Shape, Vec3>) {
        shape += by;
    } else if constexpr (requires { shape.center; }) {
        shape.center += by;
    } else if constexpr (requires { shape.position; }) {
        shape.position += by;
    } else if constexpr (requires { shape.min; }) {
        shape.min += by;
        shape.max += by;
    } else {
        shape.a += by;
        shape.b += by;
        if constexpr (requires { shape.c; })
            shape.c += by;
        if constexpr (std::same_as<Shape, Cylinder>)
            if (shape.a == shape.b) // lost far from the origin
                shape.b += Vec3{Real(1)};
    }
    return shape;
}

// What the proofs need to know about a pair of any kinds.
struct WidePair {
    Body wide_a, wide_b; // relative to A's place
    W place;             // A's place
    double size = 0.0;   // largest coordinate, relative to A's place
    double far = 0.0;    // largest in the world
    bool is_curved;      // one is a cylinder, which EPA follows to 4e-3 only

    WidePair(Body a, Body b, const W &place_)
        : wide_a(std::move(a)), wide_b(std::move(b)), place(place_),
          is_curved(wide_a.is_cylinder || wide_b.is_cylinder) {
        for (const Body *body : {&wide_a, &wide_b})
            size = std::max(size, double(largest_coordinate(*body)));
        far = size + double(std::max({std::abs(place.x), std::abs(place.y), std::abs(place.z)}));
    }
};

template <typename A, typename B> struct Pair : WidePair {
    A a;
    B b;

    Pair(const A &a_, const B &b_)
        : WidePair(body_of(a_, to_wide(place_of(a_))), body_of(b_, to_wide(place_of(a_))),
                   to_wide(place_of(a_))),
          a(a_), b(b_) {}
};

// How B is moved from being concentric with A.
struct Displacement {
    Vec3 apart{Real(0)};
    Vec3 across{Real(0)}; // zero every other time: keeps faces coplanar and edges parallel
};
inline Displacement any_displacement(Random &random, const Scale &scale, const Body &a,
                                     const Body &b) {
    V u = any_direction(random);
    if (scale.is_awkward && random.next_index(2) == 0) {
        u = V{0.0};
        u[int(random.next_index(3))] = random.next_index(2) == 0 ? 1.0 : -1.0;
    }
    const double both = double(overlap_along(a, b, W(u)));
    const double smaller = std::min(scale.size_a, scale.size_b);
    double move = 0.0;
    switch (random.next_index(6)) {
    case 0:
        move = 0.0;
        break; // concentric
    case 1:
        move = both * random.next_in(0.0, 1.0);
        break; // deep
    case 2:
        move = both;
        break; // touching
    case 3:
        move = both + smaller * random.next_in(-0.1, 0.1);
        break; // shallow
    case 4:
        move = both + smaller * std::pow(10.0, random.next_in(-7.0, 1.0));
        break; // apart
    default:
        move = both * random.next_in(1.0, 4.0);
        break; // far
    }
    Displacement result;
    result.apart = Vec3{Real(u.x * move), Real(u.y * move), Real(u.z * move)};
    if (random.next_index(2) == 0) {
        V across = any_direction(random);
        across -= u * glm::dot(across, u);
        across *= std::max(scale.size_a, scale.size_b);
        result.across = Vec3{Real(across.x), Real(across.y), Real(across.z)};
    }
    return result;
}

// Two shapes apart, near each other, touching as closely as rounding allows, or one inside the
// other.
template <typename A, typename B> Pair<A, B> any_pair_of(Random &random) {
    const Scale scale = any_scale(random);
    const Vec3 at = any_place(random, scale);
    const A a = Any<A>::make(random, at, scale.size_a, scale);
    B b = Any<B>::make(random, at, scale.size_b, scale);
    const Displacement by =
        any_displacement(random, scale, body_of(a, to_wide(at)), body_of(b, to_wide(at)));
    b = moved(b, by.apart);
    if (by.across != Vec3{Real(0)})
        b = moved(b, by.across);
    return {a, b};
}

} // namespace oracle
} // namespace plumb::inline PLUMB_PRECISION
