// Convex shapes as GJK and EPA see them: a core with a support function, and a radius around it.
//
// A sphere is a point with a radius and a capsule a segment with one, so both are exact. Cores are
// placed relative to an origin near the pair, so that far from the world's origin only the inputs'
// own rounding is lost.
#pragma once

#include "engine/core/check.h"
#include "engine/geometry/hull_queries.h"
#include "engine/geometry/shapes.h"

#include <cmath>
#include <concepts>
#include <cstdint>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

// In all cores: `support` is the point farthest along a non-zero direction, `middle` some interior
// point (used only as the start of a search), `move` a translation.

struct PointCore {
    Vec3 point{Real(0)};
    Real radius = Real(0);

    Vec3 support(const Vec3 & /*direction*/) const { return point; }
    Vec3 middle() const { return point; }
    void move(const Vec3 &by) { point += by; }
};

struct SegmentCore {
    Vec3 a{Real(0)};
    Vec3 b{Real(0)};
    Real radius = Real(0);

    Vec3 support(const Vec3 &direction) const {
        return glm::dot(b - a, direction) > Real(0) ? b : a;
    }
    Vec3 middle() const { return Real(0.5) * (a + b); }
    void move(const Vec3 &by) {
        a += by;
        b += by;
    }
};

struct TriangleCore {
    Vec3 a{Real(0)};
    Vec3 b{Real(0)};
    Vec3 c{Real(0)};
    static constexpr Real radius = Real(0);

    Vec3 support(const Vec3 &direction) const {
        const Real at_a = glm::dot(a, direction);
        const Real at_b = glm::dot(b, direction);
        const Real at_c = glm::dot(c, direction);
        if (at_a >= at_b)
            return at_a >= at_c ? a : c;
        return at_b >= at_c ? b : c;
    }
    Vec3 middle() const { return (a + b + c) / Real(3); }
    void move(const Vec3 &by) {
        a += by;
        b += by;
        c += by;
    }
};

struct AabbCore {
    Vec3 min{Real(0)};
    Vec3 max{Real(0)};
    static constexpr Real radius = Real(0);

    Vec3 support(const Vec3 &direction) const {
        return {direction.x > Real(0) ? max.x : min.x, direction.y > Real(0) ? max.y : min.y,
                direction.z > Real(0) ? max.z : min.z};
    }
    Vec3 middle() const { return Real(0.5) * (min + max); }
    void move(const Vec3 &by) {
        min += by;
        max += by;
    }
};

struct BoxCore {
    Vec3 center{Real(0)};
    Mat3 axes{Real(0)};
    Vec3 half_extents{Real(0)};
    Mat3 half_edges{Real(0)}; // the axes scaled by the half extents
    static constexpr Real radius = Real(0);

    Vec3 support(const Vec3 &direction) const {
        const Vec3 &x = half_edges[0];
        const Vec3 &y = half_edges[1];
        const Vec3 &z = half_edges[2];
        const Real sign_x = std::copysign(Real(1), glm::dot(x, direction));
        const Real sign_y = std::copysign(Real(1), glm::dot(y, direction));
        const Real sign_z = std::copysign(Real(1), glm::dot(z, direction));
        return center + (sign_x * x + sign_y * y + sign_z * z);
    }
    Vec3 middle() const { return center; }
    void move(const Vec3 &by) { center += by; }
};

struct CylinderCore {
    Vec3 a{Real(0)};
    Vec3 b{Real(0)};
    Vec3 axis{Real(0)};  // unit, from a to b
    Real side = Real(0); // the cylinder's radius; `radius` (the rounding) is 0
    static constexpr Real radius = Real(0);

    Vec3 support(const Vec3 &direction) const {
        const Real along = glm::dot(axis, direction);
        const Vec3 end = along > Real(0) ? b : a;
        Vec3 outward = direction - along * axis;
        outward -= glm::dot(axis, outward) * axis; // rounding leaves eps |direction| along the axis
        const Real squared = glm::dot(outward, outward);
        // Along the axis every point of the disc is farthest, within rounding; its centre is
        // stable.
        constexpr Real rounding = std::numeric_limits<Real>::epsilon();
        if (!(squared > rounding * rounding * along * along))
            return end;
        return end + (side / std::sqrt(squared)) * outward;
    }
    Vec3 middle() const { return Real(0.5) * (a + b); }
    void move(const Vec3 &by) {
        a += by;
        b += by;
    }
};

struct HullCore {
    const HullMesh *mesh = nullptr;
    Vec3 position{Real(0)};
    Mat3 rotation{Real(1)};
    mutable std::uint32_t last = 0; // the last answer, where the next hill climb starts
    static constexpr Real radius = Real(0);

    Vec3 support(const Vec3 &direction) const {
        const Vec3 local = direction * rotation; // transposed: into the mesh's frame
        // Up to this size brute force is as fast as hill climbing.
        constexpr std::size_t few = 40;
        last = mesh->vertices.size() <= few ? support_vertex(*mesh, local)
                                            : support_vertex(*mesh, local, last);
        return position + rotation * mesh->vertices[last];
    }
    Vec3 middle() const { return position + rotation * mesh->center; }
    void move(const Vec3 &by) { position += by; }
};

// A shape's position: the origin that both cores of a pair are relative to.
template <typename Shape> Vec3 place_of(const Shape &shape) {
    if constexpr (std::same_as<Shape, Vec3>)
        return shape;
    else if constexpr (requires { shape.center; })
        return shape.center;
    else if constexpr (requires { shape.position; })
        return shape.position;
    else if constexpr (requires { shape.min; })
        return shape.min;
    else
        return shape.a;
}

// The core of a shape relative to an origin. An invalid shape (check_valid) or an empty Aabb fails
// a check.
PointCore core_of(const Vec3 &point, const Vec3 &origin);
SegmentCore core_of(const Segment &segment, const Vec3 &origin);
TriangleCore core_of(const Triangle &triangle, const Vec3 &origin);
PointCore core_of(const Sphere &sphere, const Vec3 &origin);
BoxCore core_of(const Box &box, const Vec3 &origin);
AabbCore core_of(const Aabb &box, const Vec3 &origin);
SegmentCore core_of(const Capsule &capsule, const Vec3 &origin);
CylinderCore core_of(const Cylinder &cylinder, const Vec3 &origin);
HullCore core_of(const ConvexHull &hull, const Vec3 &origin);

// A shape with a core: Vec3 (a point), Segment, Triangle, Sphere, Box, Aabb, Capsule, Cylinder,
// ConvexHull; not types that merely convert to one.
template <typename T>
concept Convex = std::same_as<T, Vec3> || std::same_as<T, Segment> || std::same_as<T, Triangle> ||
    std::same_as<T, Sphere> || std::same_as<T, Box> || std::same_as<T, Aabb> ||
    std::same_as<T, Capsule> || std::same_as<T, Cylinder> || std::same_as<T, ConvexHull>;

// Two convex shapes, not both points.
template <typename A, typename B>
concept ConvexPair = Convex<A> && Convex<B> && !(std::same_as<A, Vec3> && std::same_as<B, Vec3>);

} // namespace plumb::inline PLUMB_PRECISION
