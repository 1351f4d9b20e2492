#include "engine/dynamics/bodies/solid.h"

#include "engine/geometry/hull_queries.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

constexpr Real infinite = std::numeric_limits<Real>::infinity();

struct Rounding {
    Real operator()(const Sphere &sphere) const { return sphere.radius; }
    Real operator()(const Box &) const { return Real(0); }
    Real operator()(const Capsule &capsule) const { return capsule.radius; }
    Real operator()(const Cylinder &) const { return Real(0); }
    Real operator()(const ConvexHull &) const { return Real(0); }
    Real operator()(const HalfSpace &) const { return Real(0); }
};

struct CoreExtent {
    Real operator()(const Sphere &sphere) const { return glm::length(sphere.center); }
    Real operator()(const Box &box) const {
        return glm::length(box.center) + glm::length(box.half_extents);
    }
    Real operator()(const Capsule &capsule) const {
        return std::max(glm::length(capsule.a), glm::length(capsule.b));
    }
    Real operator()(const Cylinder &cylinder) const {
        return std::max(glm::length(cylinder.a), glm::length(cylinder.b)) + cylinder.radius;
    }
    Real operator()(const ConvexHull &hull) const {
        Real farthest = Real(0);
        for (const Vec3 &vertex : hull.mesh->vertices)
            farthest = std::max(farthest, glm::dot(vertex, vertex));
        return glm::length(hull.position) + std::sqrt(farthest);
    }
    Real operator()(const HalfSpace &) const { return Real(0); }
};

struct CoreReach {
    const Vec3 &along;

    Real operator()(const Sphere &sphere) const { return glm::dot(sphere.center, along); }
    Real operator()(const Box &box) const {
        return glm::dot(box.center, along) +
               glm::dot(box.half_extents, glm::abs(glm::conjugate(box.rotation) * along));
    }
    Real operator()(const Capsule &capsule) const {
        return std::max(glm::dot(capsule.a, along), glm::dot(capsule.b, along));
    }
    Real operator()(const Cylinder &cylinder) const {
        const Vec3 axis = cylinder.b - cylinder.a;
        const Vec3 outward = along - (glm::dot(axis, along) / glm::dot(axis, axis)) * axis;
        return std::max(glm::dot(cylinder.a, along), glm::dot(cylinder.b, along)) +
               cylinder.radius * glm::length(outward);
    }
    Real operator()(const ConvexHull &hull) const {
        const Vec3 inside = glm::conjugate(hull.rotation) * along;
        const std::uint32_t farthest = support_vertex(*hull.mesh, inside);
        return glm::dot(hull.position, along) + glm::dot(hull.mesh->vertices[farthest], inside);
    }
    Real operator()(const HalfSpace &) const { return infinite; }
};

struct HalfWidth {
    Real operator()(const Sphere &sphere) const { return sphere.radius; }
    Real operator()(const Box &box) const {
        return std::min({box.half_extents.x, box.half_extents.y, box.half_extents.z});
    }
    Real operator()(const Capsule &capsule) const { return capsule.radius; }
    Real operator()(const Cylinder &cylinder) const {
        return std::min(cylinder.radius, Real(0.5) * glm::distance(cylinder.a, cylinder.b));
    }
    // The least distance across the hull from one of its face planes.
    Real operator()(const ConvexHull &hull) const {
        Real least = infinite;
        for (const Plane &plane : hull.mesh->planes) {
            Real lowest = plane.offset;
            for (const Vec3 &vertex : hull.mesh->vertices)
                lowest = std::min(lowest, glm::dot(plane.normal, vertex));
            least = std::min(least, plane.offset - lowest);
        }
        return Real(0.5) * least;
    }
    Real operator()(const HalfSpace &) const { return infinite; }
};

struct Axis {
    std::optional<Vec3> operator()(const Sphere &) const { return std::nullopt; }
    std::optional<Vec3> operator()(const Box &) const { return std::nullopt; }
    std::optional<Vec3> operator()(const Capsule &capsule) const { return capsule.b - capsule.a; }
    std::optional<Vec3> operator()(const Cylinder &cylinder) const {
        return cylinder.b - cylinder.a;
    }
    std::optional<Vec3> operator()(const ConvexHull &) const { return std::nullopt; }
    std::optional<Vec3> operator()(const HalfSpace &) const { return std::nullopt; }
};

struct Middle {
    std::optional<Vec3> operator()(const Sphere &) const { return std::nullopt; }
    std::optional<Vec3> operator()(const Box &box) const { return box.center; }
    std::optional<Vec3> operator()(const Capsule &capsule) const {
        return Real(0.5) * (capsule.a + capsule.b);
    }
    std::optional<Vec3> operator()(const Cylinder &cylinder) const {
        return Real(0.5) * (cylinder.a + cylinder.b);
    }
    std::optional<Vec3> operator()(const ConvexHull &hull) const {
        return hull.position + hull.rotation * hull.mesh->center;
    }
    std::optional<Vec3> operator()(const HalfSpace &) const { return std::nullopt; }
};

struct IsRoundAbout {
    Vec3 axis;
    bool is_on_axis(const Vec3 &point, Real radius) const {
        constexpr Real off = Real(1e-3);
        return glm::length(glm::cross(point, axis)) <= off * radius * glm::length(axis);
    }
    bool operator()(const Sphere &sphere) const { return is_on_axis(sphere.center, sphere.radius); }
    bool operator()(const Capsule &capsule) const {
        return is_on_axis(capsule.a, capsule.radius) && is_on_axis(capsule.b, capsule.radius);
    }
    bool operator()(const Cylinder &cylinder) const {
        return is_on_axis(cylinder.a, cylinder.radius) && is_on_axis(cylinder.b, cylinder.radius);
    }
    bool operator()(const Box &) const { return false; }
    bool operator()(const ConvexHull &) const { return false; }
    bool operator()(const HalfSpace &) const { return false; }
};

template <typename Round> bool is_upright(const Round &round) {
    return round.a == -round.b && round.b.x == Real(0) && round.b.z == Real(0);
}
struct IsPrincipal {
    bool operator()(const Sphere &sphere) const { return sphere.center == Vec3{Real(0)}; }
    bool operator()(const Box &box) const {
        return box.center == Vec3{Real(0)} && box.rotation == identity_rotation;
    }
    bool operator()(const Capsule &capsule) const { return is_upright(capsule); }
    bool operator()(const Cylinder &cylinder) const { return is_upright(cylinder); }
    bool operator()(const ConvexHull &) const { return false; }
    bool operator()(const HalfSpace &) const { return false; }
};

struct WithUnitRotation {
    Shape operator()(const Sphere &sphere) const { return sphere; }
    Shape operator()(const Box &box) const {
        return Box{box.center, glm::normalize(box.rotation), box.half_extents};
    }
    Shape operator()(const Capsule &capsule) const { return capsule; }
    Shape operator()(const Cylinder &cylinder) const { return cylinder; }
    Shape operator()(const ConvexHull &hull) const {
        return ConvexHull{hull.mesh, hull.position, glm::normalize(hull.rotation)};
    }
    Shape operator()(const HalfSpace &half_space) const { return half_space; }
};

} // namespace

Real rounding_of(const Shape &solid) {
    return std::visit(Rounding{}, solid);
}

Real core_extent(const Shape &solid) {
    return std::visit(CoreExtent{}, solid);
}

Real core_reach(const Shape &solid, const Vec3 &along) {
    return std::visit(CoreReach{along}, solid);
}

Real half_width(const Shape &solid) {
    return std::visit(HalfWidth{}, solid);
}

std::optional<Vec3> axis_of(const Shape &solid) {
    return std::visit(Axis{}, solid);
}

bool is_round_about(const Shape &solid, const Vec3 &axis) {
    return std::visit(IsRoundAbout{axis}, solid);
}

std::optional<Vec3> middle_if_turning_shows(const Shape &solid) {
    return std::visit(Middle{}, solid);
}

bool has_principal_frame(const Shape &solid) {
    return std::visit(IsPrincipal{}, solid);
}

Shape with_unit_rotation(const Shape &solid) {
    return std::visit(WithUnitRotation{}, solid);
}

} // namespace plumb::inline PLUMB_PRECISION
