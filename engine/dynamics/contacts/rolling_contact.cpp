#include "engine/dynamics/contacts/rolling_contact.h"

#include "engine/dynamics/bodies/motion.h"
#include "engine/dynamics/contacts/contact.h"
#include "engine/geometry/hull_queries.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// How far the geometry's points may be off a rim or a surface (m).
constexpr Real off = Real(2e-4);
// A point carries the load alone if all others are higher by this much (m).
constexpr Real clear = Real(1e-5);

struct Rim {
    Vec3 middle;
    Vec3 axis; // outward
    Real radius;

    bool has(const Vec3 &point) const {
        const Vec3 from = point - middle;
        const Real above = glm::dot(from, axis);
        return std::abs(above) <= off && std::abs(glm::length(from - above * axis) - radius) <= off;
    }
};

std::optional<Rim> rim_along(const Shape &solid, const Vec3 &along, Real least = least_rim_sine) {
    const auto *cylinder = std::get_if<Cylinder>(&solid);
    if (cylinder == nullptr)
        return std::nullopt;
    const Vec3 axis = glm::normalize(cylinder->b - cylinder->a);
    const Real sine = glm::dot(axis, along);
    if (!(std::abs(sine) > least))
        return std::nullopt;
    return sine > Real(0) ? Rim{cylinder->b, axis, cylinder->radius}
                          : Rim{cylinder->a, -axis, cylinder->radius};
}

// The direction from the axis to the rim's lowest point, and how steep the rim's plane is.
struct Lean {
    Vec3 way{Real(0)};
    Real slope = Real(0); // sine
};
Lean lean_of(const Vec3 &axis, const Vec3 &along) {
    const Vec3 outward = along - glm::dot(axis, along) * axis;
    const Real slope = glm::length(outward);
    if (!(slope > Real(8) * std::numeric_limits<Real>::epsilon()))
        return {};
    // Again, since at a small slope rounding leaves much along the axis.
    const Vec3 way = outward / slope;
    return {glm::normalize(way - glm::dot(axis, way) * axis), slope};
}

template <typename Which> auto points_of(Which &manifold) {
    return std::span(manifold.points).first(static_cast<std::size_t>(manifold.count));
}
// Whether the deepest point carries the load alone.
bool is_alone(const Manifold &manifold, const ManifoldPoint &deepest) {
    return std::ranges::none_of(points_of(manifold), [&](const ManifoldPoint &point) {
        return &point != &deepest && point.separation < deepest.separation + clear;
    });
}
template <typename Which> auto &deepest_of(Which &manifold) {
    return *std::ranges::min_element(points_of(manifold), {}, &ManifoldPoint::separation);
}

// Where a point is on the solid's surface.
Vec3 on_solid(const ManifoldPoint &point, const Vec3 &out) {
    return point.position - (Real(0.5) * point.separation) * out;
}

// Whether it has faces on which the four points of a contact leave long arcs.
bool has_wide_face(const ConvexHull &hull) {
    return hull.mesh->most_corners > 6;
}

// The normal once the solid has turned, in the solid's present frame.
Vec3 seen_after(const Vec3 &normal, const Vec3 &turn) {
    return turned(identity_rotation, -turn, Real(1)) * normal;
}

} // namespace

bool has_rim(const Collider &a, const Collider &b) {
    return std::holds_alternative<Cylinder>(a.shape) || std::holds_alternative<Cylinder>(b.shape);
}

Real rounding_along(const Collider &collider, const Quat &rotation, const Vec3 &normal) {
    const auto *cylinder = std::get_if<Cylinder>(&collider.shape);
    if (cylinder == nullptr || collider.surface)
        return collider.rounding;
    const Real sine = glm::dot(rotation * glm::normalize(cylinder->b - cylinder->a), normal);
    return std::abs(sine) <= least_rim_sine ? cylinder->radius / std::sqrt(Real(1) - sine * sine)
                                            : Real(0);
}

bool is_wide(const Collider &collider) {
    if (collider.surface)
        return false;
    const auto *hull = std::get_if<ConvexHull>(&collider.shape);
    return hull != nullptr ? has_wide_face(*hull)
                           : std::holds_alternative<Cylinder>(collider.shape);
}

Real rolled_depth(const Shape &local, const Quat &before, const Quat &now, const Vec3 &out,
                  const Vec3 &half_turn) {
    const std::optional<Rim> rim = rim_along(local, glm::conjugate(now) * out);
    if (!rim)
        return Real(0);
    const Lean then = lean_of(rim->axis, glm::conjugate(before) * out);
    const Lean ahead = lean_of(rim->axis, glm::conjugate(now) * seen_after(out, half_turn));
    // Flat, it stands on all of the rim.
    constexpr Real between = Real(0.29); // 1 - cos of 45 degrees, to the next point of a manifold
    if (!(between * rim->radius * ahead.slope > clear))
        return Real(0);
    const Vec3 apart = ahead.way - then.way;
    return Real(0.5) * rim->radius * ahead.slope * glm::dot(apart, apart);
}

std::optional<std::uint32_t> lead_along_rim(Manifold &manifold, const Shape &solid,
                                            const FloorPiece &other, const Vec3 &out,
                                            const Vec3 &half_turn, Real least_sine) {
    const std::optional<Rim> rim = rim_along(solid, out, least_sine);
    if (!rim || manifold.count == 0)
        return std::nullopt;
    ManifoldPoint &deepest = deepest_of(manifold);
    const Vec3 at = on_solid(deepest, out);
    const Lean lean = lean_of(rim->axis, out);
    const Lean ahead = lean_of(rim->axis, seen_after(out, half_turn));
    const Vec3 apart = ahead.way - lean.way;
    // The nearest of a manifold's eight points on a rim is no farther away.
    constexpr Real beside = Real(0.4);
    if (!rim->has(at) || !is_alone(manifold, deepest) ||
        glm::distance(at, rim->middle + rim->radius * lean.way) > beside * rim->radius ||
        glm::dot(apart, apart) > Real(1) ||
        !(glm::dot(rim->axis, seen_after(out, Real(2) * half_turn)) > Real(0.5) * least_sine))
        return std::nullopt;
    const Vec3 leading = rim->middle + rim->radius * ahead.way;
    const Real separation = deepest.separation + glm::dot(at - leading, out);
    if (distance_to(other, leading + separation * out) > off)
        return std::nullopt;
    deepest.separation = separation;
    deepest.position = leading + (Real(0.5) * separation) * out;
    const Vec3 last =
        rim->middle + rim->radius * lean_of(rim->axis, seen_after(out, Real(2) * half_turn)).way;
    if (!(glm::dot(apart, apart) > rolling_far * rolling_far) ||
        distance_to(other, last + (separation + glm::dot(leading - last, out)) * out) > off)
        return std::nullopt;
    return deepest.feature;
}

int follow_rim(Manifold &manifold, std::uint32_t feature, Real radius) {
    const std::span points = points_of(manifold);
    const auto followed = std::ranges::find(points, feature, &ManifoldPoint::feature);
    if (followed == points.end())
        return -1;
    const ManifoldPoint point = *followed;
    const auto end = std::remove_if(points.begin(), points.end(), [&](const ManifoldPoint &other) {
        return glm::distance(other.position, point.position) < radius;
    });
    manifold.count = static_cast<int>(end - points.begin()) + 1;
    manifold.points[static_cast<std::size_t>(manifold.count - 1)] = point;
    return manifold.count - 1;
}

std::optional<Vec3> lowest_on_rim(const Shape &solid, const Vec3 &out) {
    const std::optional<Rim> rim = rim_along(solid, out, Real(0));
    if (!rim)
        return std::nullopt;
    return rim->middle + rim->radius * lean_of(rim->axis, out).way;
}

namespace {

constexpr std::uint32_t next_corner_feature = 0xFFFE0000U; // and its number

struct Corner {
    std::uint32_t vertex;
    Vec3 place;
};
Corner lowest_corner(const ConvexHull &hull, const Vec3 &along) {
    const std::uint32_t vertex = support_vertex(*hull.mesh, glm::conjugate(hull.rotation) * along);
    return {vertex, hull.position + hull.rotation * hull.mesh->vertices[vertex]};
}

} // namespace

Real missed_depth(const Manifold &manifold, const ConvexHull &hull, const Vec3 &out,
                  const Vec3 &turn) {
    if (!has_wide_face(hull) || !is_alone(manifold, deepest_of(manifold)))
        return Real(0);
    const Vec3 then = seen_after(out, turn);
    const Vec3 lowest = lowest_corner(hull, then).place;
    Real depth = std::numeric_limits<Real>::infinity();
    for (const ManifoldPoint &point : points_of(manifold))
        depth = std::min(depth, glm::dot(lowest - on_solid(point, out), then));
    return depth;
}

void add_next_corner(Manifold &manifold, const ConvexHull &hull, const FloorPiece &other,
                     const Vec3 &out, const Vec3 &turn) {
    const ManifoldPoint &deepest = deepest_of(manifold);
    if (!has_wide_face(hull) || !is_alone(manifold, deepest))
        return;
    const Corner next = lowest_corner(hull, seen_after(out, turn));
    const std::span points = points_of(manifold);
    const Vec3 at = on_solid(deepest, out);
    const Real separation = deepest.separation + glm::dot(at - next.place, out);
    const bool is_there = std::ranges::any_of(points, [&](const ManifoldPoint &point) {
        return glm::distance(on_solid(point, out), next.place) <= off;
    });
    if (is_there || separation > glm::length(turn) * glm::distance(at, next.place) ||
        distance_to(other, next.place + separation * out) > off)
        return;
    const ManifoldPoint added{next.place + (Real(0.5) * separation) * out, separation,
                              next_corner_feature | next.vertex};
    if (points.size() < manifold.points.size()) {
        manifold.points[static_cast<std::size_t>(manifold.count++)] = added;
        return;
    }
    ManifoldPoint &farthest = *std::ranges::max_element(points, {}, &ManifoldPoint::separation);
    if (farthest.separation > separation)
        farthest = added;
}

} // namespace plumb::inline PLUMB_PRECISION
