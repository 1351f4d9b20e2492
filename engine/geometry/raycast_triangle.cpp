// Rays against triangles, by exact signs.

#include "engine/geometry/raycast.h"

#include "engine/geometry/check_query.h"
#include "engine/geometry/triangle.h"
#include "engine/geometry/triangle_exact.h"
#include "engine/math/predicates.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

using Wide = glm::dvec3;

// The ray's parameter at a point on its line.
double parameter_of(const Ray &ray, const Vec3 &point) {
    const Wide d(ray.direction);
    return glm::dot(Wide(point) - Wide(ray.origin), d) / glm::dot(d, d);
}

// The sign of the component of direction x (b - a) along the axis.
int turn_along(int axis, const Vec3 &direction, const Vec3 &a, const Vec3 &b) {
    return cross_sign(seen_along(axis, direction), seen_along(axis, a), seen_along(axis, b));
}

// Where a ray first hits a collinear segment. The origin is not between the ends.
std::optional<double> along_segment(const Ray &ray, const Vec3 &a, const Vec3 &b) {
    for (int axis = 0; axis < 3; ++axis)
        if (turn_along(axis, ray.direction, ray.origin, a) != 0)
            return std::nullopt; // not collinear
    const double to_a = parameter_of(ray, a), to_b = parameter_of(ray, b);
    return to_a > 0.0 ? std::optional(std::min(to_a, to_b)) : std::nullopt;
}

// Where a ray hits a coplanar segment. The origin is not on the segment.
std::optional<double> to_segment(const Ray &ray, const Vec3 &a, const Vec3 &b) {
    for (int axis = 0; axis < 3; ++axis) {
        const int slope = turn_along(axis, ray.direction, a, b);
        if (slope == 0)
            continue;
        // In this projection the plane is not a line: the ray's line must pass between a and b, and
        // the ray must approach the segment's line.
        const int side_a = turn_along(axis, ray.direction, ray.origin, a);
        const int side_b = turn_along(axis, ray.direction, ray.origin, b);
        const int side_origin =
            orient2d(seen_along(axis, ray.origin), seen_along(axis, a), seen_along(axis, b));
        if (side_a * side_b > 0 || side_origin * slope < 0)
            return std::nullopt;
        if (side_a == 0)
            return parameter_of(ray, a);
        if (side_b == 0)
            return parameter_of(ray, b);
        const Wide across = accurate_cross(Vec3{Real(0)}, ray.direction, a, b);
        const Wide to_line = glm::cross(Wide(a) - Wide(ray.origin), Wide(b) - Wide(a));
        return std::max(0.0, glm::dot(to_line, across) / glm::dot(across, across));
    }
    return along_segment(ray, a, b);
}

std::optional<RayHit> hit_at(const Ray &ray, double t, const Vec3 &normal) {
    const Real rounded = static_cast<Real>(t);
    if (!(rounded <= ray.max_t) || !std::isfinite(rounded))
        return std::nullopt;
    return RayHit{rounded, ray.origin + rounded * ray.direction, normal, false};
}

std::optional<RayHit> starting_on(const Ray &ray) {
    if (!(ray.max_t >= Real(0)))
        return std::nullopt;
    return RayHit{Real(0), ray.origin, Vec3{Real(0)}, true};
}

// The ray is in the triangle's plane, or the triangle is flat and the ray's line meets it.
std::optional<RayHit> raycast_in_plane(const Triangle &triangle, const Ray &ray) {
    if (point_meets_triangle(ray.origin, triangle))
        return starting_on(ray);
    std::optional<double> first;
    const auto consider = [&](const std::optional<double> &t) {
        if (t && !(first && *first <= *t))
            first = t;
    };
    consider(to_segment(ray, triangle.a, triangle.b));
    consider(to_segment(ray, triangle.b, triangle.c));
    consider(to_segment(ray, triangle.c, triangle.a));
    if (!first)
        return std::nullopt;
    Vec3 front = normal(triangle);
    if (front == Vec3{Real(0)})
        front = -Vec3(glm::normalize(Wide(ray.direction)));
    return hit_at(ray, *first, front);
}

} // namespace

std::optional<RayHit> raycast(const Triangle &triangle, const Ray &ray) {
    check_ray(ray);
    check_valid(triangle);
    const Vec3 &a = triangle.a, &b = triangle.b, &c = triangle.c;
    // Which side the ray's line passes each edge on. It goes through the triangle if no two differ.
    const int ab = triple_sign(ray.direction, ray.origin, a, b);
    const int bc = triple_sign(ray.direction, ray.origin, b, c);
    if (ab * bc < 0)
        return std::nullopt;
    const int ca = triple_sign(ray.direction, ray.origin, c, a);
    if (bc * ca < 0 || ca * ab < 0)
        return std::nullopt;
    const int climb = ab != 0 ? ab : (bc != 0 ? bc : ca); // the sign of normal . direction
    if (climb == 0)
        return raycast_in_plane(triangle, ray);
    const int side = orient3d(a, b, c, ray.origin);
    if (side == 0)
        return starting_on(ray);
    if (side == climb)
        return std::nullopt; // leads away
    const Wide n = accurate_cross(a, b, a, c);
    const double t = glm::dot(n, Wide(a) - Wide(ray.origin)) / glm::dot(n, Wide(ray.direction));
    // Clamp to between the first corner and the last: a grazing ray's quotient may be outside.
    const double to_a = parameter_of(ray, a), to_b = parameter_of(ray, b),
                 to_c = parameter_of(ray, c);
    const double first = std::max(0.0, std::min({to_a, to_b, to_c}));
    const double last = std::max({first, to_a, to_b, to_c});
    return hit_at(ray, std::min(std::max(first, t), last), Real(side) * normal(triangle));
}

bool linetest(const Triangle &triangle, const Vec3 &a, const Vec3 &b) {
    check_valid(triangle);
    check_point(a);
    check_point(b);
    return segment_meets_triangle({a, b}, triangle);
}

} // namespace plumb::inline PLUMB_PRECISION
