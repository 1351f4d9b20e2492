#include "engine/geometry/shapes.h"

#include "engine/core/check.h"

#include <cmath>
#include <ostream>

namespace plumb::inline PLUMB_PRECISION {

namespace {

struct Printed {
    const Vec3 &v;
};

std::ostream &operator<<(std::ostream &out, const Printed &p) {
    return out << '(' << p.v.x << ", " << p.v.y << ", " << p.v.z << ')';
}

bool is_finite(Real x) {
    return std::isfinite(x);
}

bool is_finite(const Vec3 &v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// How far the squared length of a unit vector or quaternion may be from 1: twice the 1e-3 by which
// the length itself may be off.
constexpr Real unit_tolerance = Real(2e-3);

bool is_unit(Real squared_length) {
    return std::abs(squared_length - Real(1)) <= unit_tolerance;
}

void check_shape(const Sphere &sphere) {
    PLUMB_CHECK(is_finite(sphere.center),
                "sphere centre must be finite, got " << Printed{sphere.center});
    PLUMB_CHECK(sphere.radius >= Real(0) && is_finite(sphere.radius),
                "sphere radius must be finite and not negative, got " << sphere.radius);
}

void check_shape(const Box &box) {
    PLUMB_CHECK(is_finite(box.center), "box centre must be finite, got " << Printed{box.center});
    PLUMB_CHECK(is_unit(glm::dot(box.rotation, box.rotation)),
                "box rotation must have unit length, got (w, x, y, z) = ("
                    << box.rotation.w << ", " << box.rotation.x << ", " << box.rotation.y << ", "
                    << box.rotation.z << ')');
    PLUMB_CHECK(is_finite(box.half_extents) && box.half_extents.x >= Real(0) &&
                    box.half_extents.y >= Real(0) && box.half_extents.z >= Real(0),
                "box half extents must be finite and not negative, got "
                    << Printed{box.half_extents});
}

void check_shape(const Capsule &capsule) {
    PLUMB_CHECK(is_finite(capsule.a), "capsule end a must be finite, got " << Printed{capsule.a});
    PLUMB_CHECK(is_finite(capsule.b), "capsule end b must be finite, got " << Printed{capsule.b});
    PLUMB_CHECK(capsule.radius >= Real(0) && is_finite(capsule.radius),
                "capsule radius must be finite and not negative, got " << capsule.radius);
}

void check_shape(const HalfSpace &half_space) {
    PLUMB_CHECK(is_unit(glm::dot(half_space.normal, half_space.normal)),
                "half-space normal must have unit length, got " << Printed{half_space.normal});
    PLUMB_CHECK(is_finite(half_space.offset),
                "half-space offset must be finite, got " << half_space.offset);
}

} // namespace

Sphere placed(const Sphere &local, const Transform &pose) {
    return {to_world_point(pose, local.center), local.radius};
}

Box placed(const Box &local, const Transform &pose) {
    return {to_world_point(pose, local.center), pose.rotation * local.rotation, local.half_extents};
}

Capsule placed(const Capsule &local, const Transform &pose) {
    return {to_world_point(pose, local.a), to_world_point(pose, local.b), local.radius};
}

HalfSpace placed(const HalfSpace &local, const Transform &pose) {
    const Vec3 normal = to_world_vector(pose, local.normal);
    return {normal, local.offset + glm::dot(normal, pose.position)};
}

Shape placed(const Shape &local, const Transform &pose) {
    return std::visit([&](const auto &shape) { return Shape{placed(shape, pose)}; }, local);
}

Aabb bounds(const Sphere &sphere) {
    return {sphere.center - sphere.radius, sphere.center + sphere.radius};
}

Aabb bounds(const Box &box) {
    // The extent along a world axis is the sum of the projections of the three half edges
    // (Ericson 2005, "Real-Time Collision Detection", 4.2.6).
    const Mat3 rotation = glm::mat3_cast(box.rotation);
    const Vec3 extent = glm::abs(rotation[0]) * box.half_extents.x +
                        glm::abs(rotation[1]) * box.half_extents.y +
                        glm::abs(rotation[2]) * box.half_extents.z;
    return {box.center - extent, box.center + extent};
}

Aabb bounds(const Capsule &capsule) {
    return {glm::min(capsule.a, capsule.b) - capsule.radius,
            glm::max(capsule.a, capsule.b) + capsule.radius};
}

Aabb bounds(const Shape &shape) {
    if (const auto *sphere = std::get_if<Sphere>(&shape))
        return bounds(*sphere);
    if (const auto *box = std::get_if<Box>(&shape))
        return bounds(*box);
    if (const auto *capsule = std::get_if<Capsule>(&shape))
        return bounds(*capsule);
    const HalfSpace &half_space = std::get<HalfSpace>(shape);
    PLUMB_CHECK(false, "a half-space has no finite bounds; its normal is "
                           << Printed{half_space.normal} << " and its offset "
                           << half_space.offset);
}

void check_valid(const Shape &shape) {
    std::visit([](const auto &solid) { check_shape(solid); }, shape);
}

} // namespace plumb::inline PLUMB_PRECISION
