// The engine's shapes, and the ray, as plain values.
//
// All sets are closed: a point on the surface is inside. Lengths in metres.
//
// Range, here and in the other geometry headers unless they give their own: "exact" holds for all
// finite floats, and for doubles that are 0 or of magnitude 1e-60 to 1e70, as for the signs of
// predicates.h. Bounds in epsilon hold if sizes and non-zero distances are from 2^-20 to 2^28 m in
// float (1e-6 to 2.6e8), from 2^-160 to 2^160 m in double: beyond that, products of lengths
// underflow or overflow.
#pragma once

#include "engine/math/rigid.h"

#include <cmath>
#include <limits>
#include <variant>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

struct Sphere {
    Vec3 center{Real(0)};
    Real radius = Real(0); // > 0; zero is a point and allowed in queries
};

// A box of any orientation (OBB).
struct Box {
    Vec3 center{Real(0)};
    Quat rotation = identity_rotation;
    Vec3 half_extents{Real(0)}; // >= 0 in each component
};

// All points within `radius` of the segment from a to b. a == b gives a sphere.
struct Capsule {
    Vec3 a{Real(0)};
    Vec3 b{Real(0)};
    Real radius = Real(0);
};

// The solid half-space dot(normal, p) <= offset below a plane. `normal` has unit length.
struct HalfSpace {
    Vec3 normal{Real(0), Real(1), Real(0)};
    Real offset = Real(0);
};

// All points within `radius` of the segment from a to b, cut off flat at both ends. a == b would be
// a disc without a direction and is invalid.
struct Cylinder {
    Vec3 a{Real(0)};
    Vec3 b{Real(0), Real(1), Real(0)};
    Real radius = Real(0);
};

// All points a + s (b - a), 0 <= s <= 1. a == b is a point.
struct Segment {
    Vec3 a{Real(0)};
    Vec3 b{Real(0)};
};

// The points dot(normal, p) == offset. `normal` has unit length and points to the front.
struct Plane {
    Vec3 normal{Real(0), Real(1), Real(0)};
    Real offset = Real(0);
};

// A flat piece of surface, counter-clockwise seen from its front. Collinear or coincident corners
// make it a segment or a point, which is allowed.
struct Triangle {
    Vec3 a{Real(0)};
    Vec3 b{Real(0)};
    Vec3 c{Real(0)};
};

// A solid convex polyhedron. `mesh` is borrowed: it must outlive the value (hull_mesh.h).
struct HullMesh;
struct ConvexHull {
    const HullMesh *mesh = nullptr;
    Vec3 position{Real(0)};
    Quat rotation = identity_rotation;
};

// The shapes of bodies. Pairs are collided in this order (manifold_pairs.h).
using Shape = std::variant<Sphere, Box, Capsule, Cylinder, ConvexHull, HalfSpace>;

// An axis-aligned box; empty when min > max in any component.
struct Aabb {
    Vec3 min{std::numeric_limits<Real>::max()};
    Vec3 max{std::numeric_limits<Real>::lowest()};
};

// The points origin + t * direction for 0 <= t <= max_t. `direction` may have any non-zero length,
// and t is in units of it, so the segment from a to b is Ray{a, b - a, 1}.
struct Ray {
    Vec3 origin{Real(0)};
    Vec3 direction{Real(0), Real(0), Real(1)};
    Real max_t = std::numeric_limits<Real>::infinity();
};

// The shape moved by `pose`. An invalid shape or pose fails a check, here and in everything below.
// A cylinder so far off that its ends would coincide keeps one rounding of its length.
Sphere placed(const Sphere &local, const Transform &pose);
Box placed(const Box &local, const Transform &pose);
Capsule placed(const Capsule &local, const Transform &pose);
HalfSpace placed(const HalfSpace &local, const Transform &pose);
ConvexHull placed(const ConvexHull &local, const Transform &pose);
Cylinder placed(const Cylinder &local, const Transform &pose);
Segment placed(const Segment &local, const Transform &pose);
Triangle placed(const Triangle &local, const Transform &pose);
Shape placed(const Shape &local, const Transform &pose);

// The smallest axis-aligned box around a shape. A half-space has no finite one (at most one side is
// bounded, if it is axis-aligned), so callers handle half-spaces separately; asking for one fails a
// check.
Aabb bounds(const Sphere &sphere);
Aabb bounds(const Box &box);
Aabb bounds(const Capsule &capsule);
Aabb bounds(const Cylinder &cylinder);
Aabb bounds(const Segment &segment);
[[noreturn]] Aabb bounds(const HalfSpace &half_space);
Aabb bounds(const Shape &shape);

// Whether no argument is NaN or infinite: only for finite x is 0 * x zero. Faster than testing one
// by one, and overflow cannot break it.
template <typename... Numbers> bool are_finite(Numbers... numbers) {
    return ((numbers * Real(0)) + ...) == Real(0);
}
inline bool is_finite(const Vec3 &v) {
    return are_finite(v.x, v.y, v.z);
}

// A plane's normal may be off unit length by up to 1e-3, so that it can have few digits and points
// can lie exactly on the plane.
inline bool is_nearly_unit(Real squared_length) {
    return std::abs(squared_length - Real(1)) <= Real(2e-3);
}

// Whether no member is NaN or infinite, no size is negative, and rotations and normals have unit
// length (is_unit: within roundings, so that all queries see the same solid). An empty Aabb is
// valid.
inline bool is_valid(const Sphere &sphere) {
    return sphere.radius >= Real(0) &&
           are_finite(sphere.center.x, sphere.center.y, sphere.center.z, sphere.radius);
}
inline bool is_valid(const Box &box) {
    const Vec3 &half = box.half_extents;
    return is_unit(glm::dot(box.rotation, box.rotation)) && half.x >= Real(0) &&
           half.y >= Real(0) && half.z >= Real(0) &&
           are_finite(box.center.x, box.center.y, box.center.z, half.x, half.y, half.z);
}
inline bool is_valid(const Capsule &capsule) {
    const Vec3 &a = capsule.a, &b = capsule.b;
    return capsule.radius >= Real(0) && are_finite(a.x, a.y, a.z, b.x, b.y, b.z, capsule.radius);
}
inline bool is_valid(const Cylinder &cylinder) {
    const Vec3 &a = cylinder.a, &b = cylinder.b;
    return cylinder.radius >= Real(0) && a != b &&
           are_finite(a.x, a.y, a.z, b.x, b.y, b.z, cylinder.radius);
}
inline bool is_valid(const HalfSpace &half_space) {
    return is_nearly_unit(glm::dot(half_space.normal, half_space.normal)) &&
           are_finite(half_space.offset);
}
inline bool is_valid(const Plane &plane) {
    return is_nearly_unit(glm::dot(plane.normal, plane.normal)) && are_finite(plane.offset);
}
inline bool is_valid(const Segment &segment) {
    const Vec3 &a = segment.a, &b = segment.b;
    return are_finite(a.x, a.y, a.z, b.x, b.y, b.z);
}
inline bool is_valid(const Triangle &triangle) {
    const Vec3 &a = triangle.a, &b = triangle.b, &c = triangle.c;
    return are_finite(a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z);
}
inline bool is_valid(const Aabb &box) {
    const Vec3 &a = box.min, &b = box.max;
    return are_finite(a.x, a.y, a.z, b.x, b.y, b.z);
}

// Fails a check that names what is invalid about the shape.
[[gnu::cold]] void refuse(const Sphere &sphere);
[[gnu::cold]] void refuse(const Box &box);
[[gnu::cold]] void refuse(const Capsule &capsule);
[[gnu::cold]] void refuse(const Cylinder &cylinder);
[[gnu::cold]] void refuse(const HalfSpace &half_space);
[[gnu::cold]] void refuse(const Plane &plane);
[[gnu::cold]] void refuse(const Segment &segment);
[[gnu::cold]] void refuse(const Triangle &triangle);
[[gnu::cold]] void refuse(const Aabb &box);

// Fails a check, naming the value, if a shape is invalid.
inline void check_valid(const Sphere &sphere) {
    if (!is_valid(sphere)) [[unlikely]]
        refuse(sphere);
}
inline void check_valid(const Box &box) {
    if (!is_valid(box)) [[unlikely]]
        refuse(box);
}
inline void check_valid(const Capsule &capsule) {
    if (!is_valid(capsule)) [[unlikely]]
        refuse(capsule);
}
inline void check_valid(const Cylinder &cylinder) {
    if (!is_valid(cylinder)) [[unlikely]]
        refuse(cylinder);
}
inline void check_valid(const HalfSpace &half_space) {
    if (!is_valid(half_space)) [[unlikely]]
        refuse(half_space);
}
inline void check_valid(const Plane &plane) {
    if (!is_valid(plane)) [[unlikely]]
        refuse(plane);
}
inline void check_valid(const Segment &segment) {
    if (!is_valid(segment)) [[unlikely]]
        refuse(segment);
}
inline void check_valid(const Triangle &triangle) {
    if (!is_valid(triangle)) [[unlikely]]
        refuse(triangle);
}
inline void check_valid(const Aabb &box) {
    if (!is_valid(box)) [[unlikely]]
        refuse(box);
}
void check_valid(const Shape &shape);

} // namespace plumb::inline PLUMB_PRECISION
