#include "engine/geometry/plane.h"

#include "engine/core/check.h"
#include "engine/geometry/check_query.h"
#include "engine/math/constants.h"
#include "engine/math/predicates.h"
#include "engine/math/printed.h"
#include "engine/math/rigid.h"
#include "engine/math/vectors.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// Heights are normal . p - offset: metres times the length of the normal, which may be slightly off
// 1.
Real height_of(const Plane &plane, const Vec3 &point) {
    return glm::dot(plane.normal, point) - plane.offset;
}

// A shape that reaches from one height to another.
PlaneTest between(Real lowest, Real highest, Real normal_length) {
    if (lowest > Real(0))
        return {PlaneSide::in_front, lowest / normal_length};
    if (highest < Real(0))
        return {PlaneSide::behind, highest / normal_length};
    return {};
}

PlaneTest around(Real height, Real reach, Real normal_length) {
    return between(height - reach, height + reach, normal_length);
}

// Which side all `points` are on, or across; exact.
template <typename... Points> PlaneTest of_points(const Plane &plane, const Points &...points) {
    const int lowest = std::min({plane_sign(plane.normal, plane.offset, points)...});
    const int highest = std::max({plane_sign(plane.normal, plane.offset, points)...});
    const Real length = glm::length(plane.normal);
    if (lowest > 0)
        return {PlaneSide::in_front,
                std::max(Real(0), std::min({height_of(plane, points)...}) / length)};
    if (highest < 0)
        return {PlaneSide::behind,
                std::min(Real(0), std::max({height_of(plane, points)...}) / length)};
    return {};
}

} // namespace

PlaneTest classify(const Plane &plane, const Vec3 &point) {
    check_valid(plane);
    check_point(point);
    return of_points(plane, point);
}

PlaneTest classify(const Plane &plane, const Sphere &sphere) {
    check_valid(plane);
    check_valid(sphere);
    const Real length = glm::length(plane.normal);
    return around(height_of(plane, sphere.center), sphere.radius * length, length);
}

PlaneTest classify(const Plane &plane, const Aabb &box) {
    check_valid(plane);
    check_valid(box);
    PLUMB_CHECK(box.min.x <= box.max.x && box.min.y <= box.max.y && box.min.z <= box.max.z,
                "an empty box is on no side of a plane, got min " << Printed{box.min} << " and max "
                                                                  << Printed{box.max});
    const Vec3 to_min = plane.normal * box.min;
    const Vec3 to_max = plane.normal * box.max;
    const Vec3 low = glm::min(to_min, to_max);
    const Vec3 high = glm::max(to_min, to_max);
    return between((low.x + low.y + low.z) - plane.offset,
                   (high.x + high.y + high.z) - plane.offset, glm::length(plane.normal));
}

PlaneTest classify(const Plane &plane, const Box &box) {
    check_valid(plane);
    check_valid(box);
    const Mat3 axes = rotation_matrix(box.rotation);
    const Real reach = std::abs(glm::dot(plane.normal, axes[0])) * box.half_extents.x +
                       std::abs(glm::dot(plane.normal, axes[1])) * box.half_extents.y +
                       std::abs(glm::dot(plane.normal, axes[2])) * box.half_extents.z;
    return around(height_of(plane, box.center), reach, glm::length(plane.normal));
}

PlaneTest classify(const Plane &plane, const Capsule &capsule) {
    check_valid(plane);
    check_valid(capsule);
    const Real length = glm::length(plane.normal);
    const Real at_a = height_of(plane, capsule.a), at_b = height_of(plane, capsule.b);
    const Real reach = capsule.radius * length;
    return between(std::min(at_a, at_b) - reach, std::max(at_a, at_b) + reach, length);
}

PlaneTest classify(const Plane &plane, const Cylinder &cylinder) {
    check_valid(plane);
    check_valid(cylinder);
    // A flat end extends by its radius times the sine of the angle between axis and normal.
    const Vec3 along = cylinder.b - cylinder.a;
    const Real reach =
        cylinder.radius * glm::length(glm::cross(plane.normal, along)) / glm::length(along);
    const Real at_a = height_of(plane, cylinder.a), at_b = height_of(plane, cylinder.b);
    return between(std::min(at_a, at_b) - reach, std::max(at_a, at_b) + reach,
                   glm::length(plane.normal));
}

PlaneTest classify(const Plane &plane, const Segment &segment) {
    check_valid(plane);
    check_valid(segment);
    return of_points(plane, segment.a, segment.b);
}

PlaneTest classify(const Plane &plane, const Triangle &triangle) {
    check_valid(plane);
    check_valid(triangle);
    return of_points(plane, triangle.a, triangle.b, triangle.c);
}

std::optional<Line> intersection(const Plane &a, const Plane &b) {
    check_valid(a);
    check_valid(b);
    const Vec3 cross = accurate_cross(a.normal, b.normal);
    const Real squared = glm::dot(cross, cross);
    if (!(squared > epsilon * glm::dot(a.normal, a.normal) * glm::dot(b.normal, b.normal)))
        return std::nullopt;
    // Ericson 2005, "Real-Time Collision Detection", 5.4.4.
    const Vec3 point =
        (a.offset * glm::cross(b.normal, cross) + b.offset * glm::cross(cross, a.normal)) / squared;
    return Line{point, cross / std::sqrt(squared)};
}

std::optional<Vec3> intersection(const Plane &a, const Plane &b, const Plane &c) {
    check_valid(a);
    check_valid(b);
    check_valid(c);
    const Vec3 bc = accurate_cross(b.normal, c.normal);
    const Vec3 ca = accurate_cross(c.normal, a.normal);
    const Vec3 ab = accurate_cross(a.normal, b.normal);
    const Real volume = glm::dot(a.normal, bc);
    if (!(volume * volume > epsilon * glm::dot(a.normal, a.normal) * glm::dot(b.normal, b.normal) *
                                glm::dot(c.normal, c.normal)))
        return std::nullopt;
    // Cramer's rule (Goldman 1990, "Intersection of Three Planes", Graphics Gems).
    return (a.offset * bc + b.offset * ca + c.offset * ab) / volume;
}

} // namespace plumb::inline PLUMB_PRECISION
