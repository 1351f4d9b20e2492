#include "engine/geometry/shapes.h"

#include "engine/core/check.h"
#include "engine/geometry/hull_queries.h"
#include "engine/math/printed.h"

#include <cmath>
#include <limits>

#include <glm/common.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

void check_radius(Real radius, const char *shape) {
    PLUMB_CHECK(radius >= Real(0) && are_finite(radius),
                shape << " radius must be finite and not negative, got " << radius);
}

void check_point(const Vec3 &point, const char *name) {
    PLUMB_CHECK(is_finite(point), name << " must be finite, got " << Printed{point});
}

void check_plane(const Vec3 &normal, Real offset, const char *shape) {
    PLUMB_CHECK(is_nearly_unit(glm::dot(normal, normal)),
                shape << " normal must have unit length, got " << Printed{normal});
    PLUMB_CHECK(are_finite(offset), shape << " offset must be finite, got " << offset);
}

// Checks the arguments of `placed`.
template <typename Solid> void check_placing(const Solid &local, const Transform &pose) {
    check_valid(local);
    const Vec3 &p = pose.position;
    const Quat &q = pose.rotation;
    if (are_finite(p.x, p.y, p.z) && is_unit(glm::dot(q, q))) [[likely]]
        return;
    check_point(p, "pose position");
    PLUMB_CHECK(false, "pose rotation must have unit length, got (w, x, y, z) = ("
                           << q.w << ", " << q.x << ", " << q.y << ", " << q.z << ')');
}

} // namespace

Sphere placed(const Sphere &local, const Transform &pose) {
    check_placing(local, pose);
    return {to_world_point(pose, local.center), local.radius};
}

// The product of two rotations that are each a rounding off unit length may be off by more than a
// box allows.
Box placed(const Box &local, const Transform &pose) {
    check_placing(local, pose);
    return {to_world_point(pose, local.center), unit(pose.rotation * local.rotation),
            local.half_extents};
}

Capsule placed(const Capsule &local, const Transform &pose) {
    check_placing(local, pose);
    return {to_world_point(pose, local.a), to_world_point(pose, local.b), local.radius};
}

Cylinder placed(const Cylinder &local, const Transform &pose) {
    check_placing(local, pose);
    Cylinder there{to_world_point(pose, local.a), to_world_point(pose, local.b), local.radius};
    if (there.a == there.b) {
        const Vec3 axis = pose.rotation * (local.b - local.a);
        const Vec3 size = glm::abs(axis);
        const int most = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        there.b[most] = std::nextafter(
            there.b[most], std::copysign(std::numeric_limits<Real>::infinity(), axis[most]));
    }
    return there;
}

Segment placed(const Segment &local, const Transform &pose) {
    check_placing(local, pose);
    return {to_world_point(pose, local.a), to_world_point(pose, local.b)};
}

Triangle placed(const Triangle &local, const Transform &pose) {
    check_placing(local, pose);
    return {to_world_point(pose, local.a), to_world_point(pose, local.b),
            to_world_point(pose, local.c)};
}

HalfSpace placed(const HalfSpace &local, const Transform &pose) {
    check_placing(local, pose);
    Vec3 normal = to_world_vector(pose, local.normal);
    if (!is_unit(glm::dot(normal, normal))) // as for a box
        normal = glm::normalize(normal);
    return {normal, local.offset + glm::dot(normal, pose.position)};
}

ConvexHull placed(const ConvexHull &local, const Transform &pose) {
    check_placing(local, pose);
    return {local.mesh, to_world_point(pose, local.position), unit(pose.rotation * local.rotation)};
}

Shape placed(const Shape &local, const Transform &pose) {
    return std::visit([&](const auto &shape) { return Shape{placed(shape, pose)}; }, local);
}

Aabb bounds(const Sphere &sphere) {
    check_valid(sphere);
    return {sphere.center - sphere.radius, sphere.center + sphere.radius};
}

Aabb bounds(const Box &box) {
    check_valid(box);
    // The extent along a world axis is the sum of the three half edges' projections (Ericson 2005,
    // "Real-Time Collision Detection", 4.2.6).
    const Mat3 rotation = glm::mat3_cast(box.rotation);
    const Vec3 extent = glm::abs(rotation[0]) * box.half_extents.x +
                        glm::abs(rotation[1]) * box.half_extents.y +
                        glm::abs(rotation[2]) * box.half_extents.z;
    return {box.center - extent, box.center + extent};
}

Aabb bounds(const Capsule &capsule) {
    check_valid(capsule);
    return {glm::min(capsule.a, capsule.b) - capsule.radius,
            glm::max(capsule.a, capsule.b) + capsule.radius};
}

Aabb bounds(const Cylinder &cylinder) {
    check_valid(cylinder);
    // A disc with unit normal n extends r sqrt(1 - n_i^2) along axis i; written without the
    // difference, which would cancel for a cylinder along an axis.
    const Vec3 axis = glm::normalize(cylinder.b - cylinder.a);
    const Vec3 reach =
        cylinder.radius *
        Vec3{std::hypot(axis.y, axis.z), std::hypot(axis.x, axis.z), std::hypot(axis.x, axis.y)};
    return {glm::min(cylinder.a, cylinder.b) - reach, glm::max(cylinder.a, cylinder.b) + reach};
}

Aabb bounds(const Segment &segment) {
    check_valid(segment);
    return {glm::min(segment.a, segment.b), glm::max(segment.a, segment.b)};
}

Aabb bounds(const HalfSpace &half_space) {
    PLUMB_CHECK(false, "a half-space has no finite bounds; its normal is "
                           << Printed{half_space.normal} << " and its offset "
                           << half_space.offset);
}

Aabb bounds(const Shape &shape) {
    return std::visit([](const auto &solid) { return bounds(solid); }, shape);
}

void refuse(const Sphere &sphere) {
    check_point(sphere.center, "sphere centre");
    check_radius(sphere.radius, "sphere");
}

void refuse(const Box &box) {
    check_point(box.center, "box centre");
    PLUMB_CHECK(is_unit(glm::dot(box.rotation, box.rotation)),
                "box rotation must have unit length, got (w, x, y, z) = ("
                    << box.rotation.w << ", " << box.rotation.x << ", " << box.rotation.y << ", "
                    << box.rotation.z << ')');
    PLUMB_CHECK(is_finite(box.half_extents) && box.half_extents.x >= Real(0) &&
                    box.half_extents.y >= Real(0) && box.half_extents.z >= Real(0),
                "box half extents must be finite and not negative, got "
                    << Printed{box.half_extents});
}

void refuse(const Capsule &capsule) {
    check_point(capsule.a, "capsule end a");
    check_point(capsule.b, "capsule end b");
    check_radius(capsule.radius, "capsule");
}

void refuse(const HalfSpace &half_space) {
    check_plane(half_space.normal, half_space.offset, "half-space");
}

void refuse(const Cylinder &cylinder) {
    check_point(cylinder.a, "cylinder end a");
    check_point(cylinder.b, "cylinder end b");
    PLUMB_CHECK(cylinder.a != cylinder.b,
                "cylinder ends must differ, got " << Printed{cylinder.a} << " twice");
    check_radius(cylinder.radius, "cylinder");
}

void refuse(const Segment &segment) {
    check_point(segment.a, "segment end a");
    check_point(segment.b, "segment end b");
}

void refuse(const Plane &plane) {
    check_plane(plane.normal, plane.offset, "plane");
}

void refuse(const Triangle &triangle) {
    check_point(triangle.a, "triangle corner a");
    check_point(triangle.b, "triangle corner b");
    check_point(triangle.c, "triangle corner c");
}

void refuse(const Aabb &box) {
    check_point(box.min, "box minimum");
    check_point(box.max, "box maximum");
}

void check_valid(const Shape &shape) {
    std::visit([](const auto &solid) { check_valid(solid); }, shape);
}

} // namespace plumb::inline PLUMB_PRECISION
