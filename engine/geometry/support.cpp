#include "engine/geometry/support.h"

#include "engine/math/printed.h"
#include "engine/math/rigid.h"

namespace plumb::inline PLUMB_PRECISION {

namespace {

// Each core is checked by one combined test: a sum is finite if all its terms are (sizes are far
// from overflow). Only if that fails does the full check report what is wrong.
bool has_finite_sum(const Vec3 &v) {
    return std::isfinite(v.x + v.y + v.z);
}

} // namespace

PointCore core_of(const Vec3 &point, const Vec3 &origin) {
    PLUMB_CHECK(has_finite_sum(point), "point must be finite, got " << Printed{point});
    return {point - origin, Real(0)};
}

SegmentCore core_of(const Segment &segment, const Vec3 &origin) {
    if (!has_finite_sum(segment.a + segment.b)) [[unlikely]]
        check_valid(segment);
    return {segment.a - origin, segment.b - origin, Real(0)};
}

TriangleCore core_of(const Triangle &triangle, const Vec3 &origin) {
    if (!has_finite_sum(triangle.a + triangle.b + triangle.c)) [[unlikely]]
        check_valid(triangle);
    return {triangle.a - origin, triangle.b - origin, triangle.c - origin};
}

PointCore core_of(const Sphere &sphere, const Vec3 &origin) {
    if (!(has_finite_sum(sphere.center + sphere.radius) && sphere.radius >= Real(0))) [[unlikely]]
        check_valid(sphere);
    return {sphere.center - origin, sphere.radius};
}

BoxCore core_of(const Box &box, const Vec3 &origin) {
    check_valid(box);
    const Mat3 axes = rotation_matrix(box.rotation);
    return {box.center - origin, axes, box.half_extents,
            Mat3{axes[0] * box.half_extents.x, axes[1] * box.half_extents.y,
                 axes[2] * box.half_extents.z}};
}

AabbCore core_of(const Aabb &box, const Vec3 &origin) {
    if (!(has_finite_sum(box.min + box.max) && box.min.x <= box.max.x && box.min.y <= box.max.y &&
          box.min.z <= box.max.z)) [[unlikely]] {
        check_valid(box);
        PLUMB_CHECK(false, "an empty Aabb has no points; its min is "
                               << Printed{box.min} << " and its max " << Printed{box.max});
    }
    return {box.min - origin, box.max - origin};
}

SegmentCore core_of(const Capsule &capsule, const Vec3 &origin) {
    if (!(has_finite_sum(capsule.a + capsule.b + capsule.radius) && capsule.radius >= Real(0)))
        [[unlikely]]
        check_valid(capsule);
    return {capsule.a - origin, capsule.b - origin, capsule.radius};
}

CylinderCore core_of(const Cylinder &cylinder, const Vec3 &origin) {
    check_valid(cylinder);
    return {cylinder.a - origin, cylinder.b - origin, glm::normalize(cylinder.b - cylinder.a),
            cylinder.radius};
}

HullCore core_of(const ConvexHull &hull, const Vec3 &origin) {
    if (!(hull.mesh != nullptr && !hull.mesh->vertices.empty() && has_finite_sum(hull.position) &&
          is_unit(glm::dot(hull.rotation, hull.rotation)))) [[unlikely]]
        check_valid(hull);
    return {hull.mesh, hull.position - origin, glm::mat3_cast(hull.rotation)};
}

} // namespace plumb::inline PLUMB_PRECISION
