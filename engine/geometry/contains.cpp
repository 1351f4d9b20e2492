#include "engine/geometry/contains.h"

#include "engine/geometry/check_query.h"
#include "engine/geometry/hull_queries.h"
#include "engine/math/predicates.h"

#include <cmath>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

bool contains(const Sphere &sphere, const Vec3 &point) {
    check_valid(sphere);
    check_point(point);
    return ball_sign(sphere.center, sphere.radius, point) >= 0;
}

bool contains(const Aabb &box, const Vec3 &point) {
    check_valid(box);
    check_point(point);
    return point.x >= box.min.x && point.x <= box.max.x && point.y >= box.min.y &&
           point.y <= box.max.y && point.z >= box.min.z && point.z <= box.max.z;
}

bool contains(const Box &box, const Vec3 &point) {
    check_valid(box);
    check_point(point);
    // Without rotation the faces are where the caller would compute them, so points on them are
    // exact.
    if (box.rotation.x == Real(0) && box.rotation.y == Real(0) && box.rotation.z == Real(0)) {
        const Vec3 low = box.center - box.half_extents;
        const Vec3 high = box.center + box.half_extents;
        return point.x >= low.x && point.x <= high.x && point.y >= low.y && point.y <= high.y &&
               point.z >= low.z && point.z <= high.z;
    }
    const Vec3 local = rotated(glm::conjugate(box.rotation), point - box.center);
    return std::abs(local.x) <= box.half_extents.x && std::abs(local.y) <= box.half_extents.y &&
           std::abs(local.z) <= box.half_extents.z;
}

bool contains(const Capsule &capsule, const Vec3 &point) {
    check_valid(capsule);
    check_point(point);
    const Vec3 along = capsule.b - capsule.a;
    const Vec3 from_a = point - capsule.a;
    const Real squared_radius = capsule.radius * capsule.radius;
    const Real height = glm::dot(from_a, along);
    const Real squared_length = glm::dot(along, along);
    if (height <= Real(0))
        return glm::dot(from_a, from_a) <= squared_radius;
    if (height >= squared_length) {
        const Vec3 from_b = point - capsule.b;
        return glm::dot(from_b, from_b) <= squared_radius;
    }
    // The distance to the line is |from_a x along| / |along|. Not dividing keeps integers exact.
    const Vec3 cross = glm::cross(from_a, along);
    return glm::dot(cross, cross) <= squared_radius * squared_length;
}

bool contains(const Cylinder &cylinder, const Vec3 &point) {
    check_valid(cylinder);
    check_point(point);
    const Vec3 along = cylinder.b - cylinder.a;
    const Vec3 from_a = point - cylinder.a;
    if (glm::dot(from_a, along) < Real(0) || glm::dot(point - cylinder.b, along) > Real(0))
        return false;
    const Vec3 cross = glm::cross(from_a, along);
    return glm::dot(cross, cross) <= cylinder.radius * cylinder.radius * glm::dot(along, along);
}

bool contains(const HalfSpace &half_space, const Vec3 &point) {
    check_valid(half_space);
    check_point(point);
    return plane_sign(half_space.normal, half_space.offset, point) <= 0;
}

bool contains(const Shape &shape, const Vec3 &point) {
    return std::visit([&](const auto &solid) { return contains(solid, point); }, shape);
}

bool contains(const Plane &plane, const Vec3 &point) {
    check_valid(plane);
    check_point(point);
    return plane_sign(plane.normal, plane.offset, point) == 0;
}

bool contains(const Segment &segment, const Vec3 &point) {
    check_valid(segment);
    check_point(point);
    const auto &[a, b] = segment;
    // Collinear if the projections on all three coordinate planes are; then between the ends if
    // every coordinate is.
    const Vec3 low = glm::min(a, b), high = glm::max(a, b);
    return point.x >= low.x && point.x <= high.x && point.y >= low.y && point.y <= high.y &&
           point.z >= low.z && point.z <= high.z &&
           orient2d({a.x, a.y}, {b.x, b.y}, {point.x, point.y}) == 0 &&
           orient2d({a.y, a.z}, {b.y, b.z}, {point.y, point.z}) == 0 &&
           orient2d({a.z, a.x}, {b.z, b.x}, {point.z, point.x}) == 0;
}

bool contains(const Ray &ray, const Vec3 &point) {
    check_ray(ray);
    check_point(point);
    const auto &[o, d, max_t] = ray;
    if (!(max_t >= Real(0)))
        return false;
    if (point == o)
        return true;
    if (cross_sign(Vec2{d.x, d.y}, Vec2{o.x, o.y}, Vec2{point.x, point.y}) != 0 ||
        cross_sign(Vec2{d.y, d.z}, Vec2{o.y, o.z}, Vec2{point.y, point.z}) != 0 ||
        cross_sign(Vec2{d.z, d.x}, Vec2{o.z, o.x}, Vec2{point.z, point.x}) != 0)
        return false;
    // The point is on the line, so one coordinate decides: (point - o) / d <= max_t.
    int axis = 0;
    while (d[axis] == Real(0))
        ++axis;
    const bool is_forward = (point[axis] > o[axis]) == (d[axis] > Real(0));
    if (!is_forward || max_t == std::numeric_limits<Real>::infinity())
        return is_forward;
    // d max_t - 1 (point - o), as the cross product of (d, 1) with the vector from (o, 0) to
    // (point, max_t).
    const int beyond =
        cross_sign(Vec2{d[axis], Real(1)}, Vec2{o[axis], Real(0)}, Vec2{point[axis], max_t});
    return d[axis] > Real(0) ? beyond >= 0 : beyond <= 0;
}

} // namespace plumb::inline PLUMB_PRECISION
