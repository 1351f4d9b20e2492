// Closest points of a point and a core, in closed form.
#include "engine/geometry/closest.h"
#include "engine/geometry/gjk.h"
#include "engine/math/rigid.h"

#include <optional>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// Removes what rounding left of v along `side`.
Vec3 across(const Vec3 &v, const Vec3 &side, Real squared_side) {
    return v - side * (glm::dot(v, side) / squared_side);
}

// `difference` is from the point to the core. If the size of the core's coordinates is given,
// distances below their rounding count as overlapping, as in GJK: such a difference has no
// direction.
NearestPoints from_point(const PointCore &a, const Vec3 &difference,
                         const std::optional<Vec3> &size) {
    const Real squared = glm::dot(difference, difference);
    const bool is_overlapping =
        squared < std::numeric_limits<Real>::min() ||
        (size && squared <= rounding_along(difference, magnitudes(a.point) + *size));
    return {a.point, a.point + difference, difference, squared, is_overlapping, 0};
}

// The difference is exactly how far the point is beyond the faces, and zero if it is beyond none.
// So its direction is good however short it is, and no rounding needs to count as overlap.
NearestPoints to_box(const PointCore &a, const Vec3 &center, const Mat3 &axes,
                     const Vec3 &half_extents) {
    const Vec3 local = (a.point - center) * axes; // transposed: into the box's frame
    const Vec3 beyond = local - glm::clamp(local, -half_extents, half_extents);
    return from_point(a, -(axes * beyond), std::nullopt);
}

Vec3 larger(const Vec3 &a, const Vec3 &b) {
    return glm::max(magnitudes(a), magnitudes(b));
}

} // namespace

NearestPoints nearest_points(const PointCore &a, const PointCore &b) {
    return from_point(a, b.point - a.point, magnitudes(b.point));
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
    return from_point(a, glm::clamp(a.point, b.min, b.max) - a.point, std::nullopt);
}

NearestPoints nearest_points(const PointCore &a, const BoxCore &b) {
    return to_box(a, b.center, b.axes, b.half_extents);
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

// Sphere against box without the half edges of BoxCore, which only a search needs.
ClosestPoints distance(const Sphere &a, const Box &b) {
    check_valid(b);
    const PointCore point = core_of(a, a.center);
    return closest_points(
        to_box(point, b.center - a.center, rotation_matrix(b.rotation), b.half_extents),
        point.radius, Real(0), a.center);
}

ClosestPoints distance(const Box &a, const Sphere &b) {
    ClosestPoints found = distance(b, a);
    std::swap(found.on_a, found.on_b);
    found.normal = -found.normal;
    return found;
}

} // namespace plumb::inline PLUMB_PRECISION
