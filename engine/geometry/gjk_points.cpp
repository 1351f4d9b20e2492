// The closest points of a point and a core in closed form.
#include "engine/geometry/closest.h"
#include "engine/geometry/gjk.h"

#include <algorithm>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// The vector without what rounding left of it along `side`.
Vec3 across(const Vec3 &v, const Vec3 &side, Real squared_side) {
    return v - side * (glm::dot(v, side) / squared_side);
}

// From the point to the core, whose coordinates are of that size. What is nearer than they round by
// overlaps, as for GJK: such a difference has no direction.
NearestPoints from_point(const PointCore &a, const Vec3 &difference, const Vec3 &size) {
    const Real squared = glm::dot(difference, difference);
    const bool is_overlapping = squared <= rounding_along(difference, glm::abs(a.point) + size) ||
                                squared < std::numeric_limits<Real>::min();
    return {a.point, a.point + difference, difference, squared, is_overlapping, 0};
}

Vec3 larger(const Vec3 &a, const Vec3 &b) {
    return glm::max(glm::abs(a), glm::abs(b));
}

} // namespace

NearestPoints nearest_points(const PointCore &a, const PointCore &b) {
    return from_point(a, b.point - a.point, glm::abs(b.point));
}

NearestPoints nearest_points(const PointCore &a, const SegmentCore &b) {
    const Vec3 along = b.b - b.a;
    const Vec3 size = larger(b.a, b.b);
    const Real s = closest_parameter(b.a, along, a.point);
    if (!(s > Real(0)))
        return from_point(a, b.a - a.point, size);
    if (!(s < Real(1)))
        return from_point(a, b.b - a.point, size);
    // From the nearer end, as GJK does.
    const Vec3 to_line =
        s < Real(0.5) ? (b.a - a.point) + s * along : (b.b - a.point) - (Real(1) - s) * along;
    return from_point(a, across(to_line, along, glm::dot(along, along)), size);
}

NearestPoints nearest_points(const PointCore &a, const AabbCore &b) {
    return from_point(a, glm::clamp(a.point, b.min, b.max) - a.point, larger(b.min, b.max));
}

NearestPoints nearest_points(const PointCore &a, const BoxCore &b) {
    const Vec3 local = (a.point - b.center) * b.axes; // transposed: into the box's frame
    const Vec3 beyond = local - glm::clamp(local, -b.half_extents, b.half_extents);
    const Vec3 reach =
        glm::abs(b.half_edges[0]) + glm::abs(b.half_edges[1]) + glm::abs(b.half_edges[2]);
    return from_point(a, -(b.axes * beyond), glm::abs(b.center) + reach);
}

NearestPoints nearest_points(const PointCore &a, const CylinderCore &b) {
    const Vec3 from_a = a.point - b.a;
    const Real along = glm::dot(from_a, b.axis);
    Vec3 outward = from_a - along * b.axis;
    outward -= glm::dot(b.axis, outward) * b.axis;
    const Real away = glm::length(outward);
    Vec3 difference{Real(0)};
    if (along < Real(0))
        difference -= along * b.axis;
    else if (const Real above = glm::dot(a.point - b.b, b.axis); above > Real(0))
        difference -= above * b.axis;
    if (away > b.side)
        difference -= outward * ((away - b.side) / away);
    return from_point(a, difference, larger(b.a, b.b) + b.side);
}

} // namespace plumb::inline PLUMB_PRECISION
