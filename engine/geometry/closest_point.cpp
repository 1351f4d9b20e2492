#include "engine/geometry/closest_point.h"

#include "engine/core/check.h"
#include "engine/geometry/check_query.h"
#include "engine/geometry/closest.h"
#include "engine/geometry/contains.h"
#include "engine/geometry/hull_queries.h"
#include "engine/math/printed.h"
#include "engine/math/vectors.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

void check_not_empty(const Aabb &box) {
    PLUMB_CHECK(box.min.x <= box.max.x && box.min.y <= box.max.y && box.min.z <= box.max.z,
                "an empty box has no closest point, got min " << Printed{box.min} << " and max "
                                                              << Printed{box.max});
}

// From the box to the point, in the box's frame.
Vec3 beyond(const Box &box, const Vec3 &local) {
    return local - glm::clamp(local, -box.half_extents, box.half_extents);
}

// The parameter of the ray's closest point, in units of `direction`: the ray's direction rescaled
// so that its largest component is in [1, 2) and its square neither overflows nor vanishes.
struct AlongRay {
    Vec3 direction{Real(0)};
    Real t = Real(0);
};

AlongRay along_ray(const Ray &ray, const Vec3 &point) {
    const Vec3 direction = rescaled<3>(ray.direction);
    const Real t = glm::dot(point - ray.origin, direction) / glm::dot(direction, direction);
    const Real max_t = ray.max_t * (largest_magnitude<3>(ray.direction) /
                                    largest_magnitude<3>(direction)); // a power of two: exact
    return {direction, std::clamp(t, Real(0), max_t)};
}

void check_query(const Ray &ray, const Vec3 &point) {
    check_ray(ray);
    check_point(point);
    PLUMB_CHECK(ray.max_t >= Real(0), "ray max_t must not be negative, got " << ray.max_t);
}

} // namespace

Vec3 closest_point(const Sphere &sphere, const Vec3 &point) {
    if (contains(sphere, point))
        return point;
    return sphere.center + sphere.radius * glm::normalize(point - sphere.center);
}

Vec3 closest_point(const Aabb &box, const Vec3 &point) {
    check_valid(box);
    check_not_empty(box);
    check_point(point);
    return glm::clamp(point, box.min, box.max);
}

Vec3 closest_point(const Box &box, const Vec3 &point) {
    if (contains(box, point))
        return point;
    const Vec3 local = rotated(glm::conjugate(box.rotation), point - box.center);
    return box.center +
           rotated(box.rotation, glm::clamp(local, -box.half_extents, box.half_extents));
}

Vec3 closest_point(const Capsule &capsule, const Vec3 &point) {
    if (contains(capsule, point))
        return point;
    const Vec3 on_axis = closest_point(Segment{capsule.a, capsule.b}, point);
    return on_axis + capsule.radius * normalized_or<3>(point - on_axis, Vec3{Real(0)});
}

Vec3 closest_point(const Cylinder &cylinder, const Vec3 &point) {
    if (contains(cylinder, point))
        return point;
    const Vec3 along = cylinder.b - cylinder.a;
    const Vec3 from_a = point - cylinder.a;
    const Vec3 on_axis = closest_point(Segment{cylinder.a, cylinder.b}, point);
    const Vec3 across = rejection(from_a, along);
    const Real distance = glm::length(across);
    return on_axis + (distance > cylinder.radius ? cylinder.radius / distance : Real(1)) * across;
}

Vec3 closest_point(const HalfSpace &half_space, const Vec3 &point) {
    if (contains(half_space, point))
        return point;
    return closest_point(Plane{half_space.normal, half_space.offset}, point);
}

Vec3 closest_point(const Shape &shape, const Vec3 &point) {
    return std::visit([&](const auto &solid) { return closest_point(solid, point); }, shape);
}

Vec3 closest_point(const Plane &plane, const Vec3 &point) {
    check_valid(plane);
    check_point(point);
    const Real height = glm::dot(plane.normal, point) - plane.offset;
    return point - (height / glm::dot(plane.normal, plane.normal)) * plane.normal;
}

Vec3 closest_point(const Segment &segment, const Vec3 &point) {
    check_valid(segment);
    check_point(point);
    const Vec3 along = segment.b - segment.a;
    const Real s = closest_parameter(segment.a, along, point);
    return s < Real(1) ? segment.a + s * along : segment.b;
}

Vec3 closest_point(const Ray &ray, const Vec3 &point) {
    check_query(ray, point);
    const AlongRay along = along_ray(ray, point);
    return ray.origin + along.t * along.direction;
}

Real squared_distance(const Aabb &box, const Vec3 &point) {
    check_valid(box);
    check_not_empty(box);
    check_point(point);
    const Vec3 d = point - glm::clamp(point, box.min, box.max);
    return glm::dot(d, d);
}

Real squared_distance(const Box &box, const Vec3 &point) {
    check_valid(box);
    check_point(point);
    const Vec3 d = beyond(box, rotated(glm::conjugate(box.rotation), point - box.center));
    return glm::dot(d, d);
}

Real squared_distance(const Segment &segment, const Vec3 &point) {
    check_valid(segment);
    check_point(point);
    const Vec3 along = segment.b - segment.a;
    const Vec3 from_a = point - segment.a;
    const Vec3 from_b = point - segment.b;
    if (glm::dot(from_a, along) <= Real(0))
        return glm::dot(from_a, from_a);
    if (glm::dot(from_b, along) >= Real(0))
        return glm::dot(from_b, from_b);
    const Vec3 cross = glm::cross(from_a, along);
    return glm::dot(cross, cross) / glm::dot(along, along);
}

Real squared_distance(const Ray &ray, const Vec3 &point) {
    check_query(ray, point);
    const AlongRay along = along_ray(ray, point);
    const Vec3 d = (point - ray.origin) - along.t * along.direction;
    return glm::dot(d, d);
}

} // namespace plumb::inline PLUMB_PRECISION
