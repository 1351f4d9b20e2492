#include "engine/geometry/triangle.h"

#include "engine/core/check.h"
#include "engine/geometry/check_query.h"
#include "engine/geometry/triangle_exact.h"
#include "engine/math/predicates.h"
#include "engine/math/printed.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

using Wide = glm::dvec3;

double largest_magnitude(const Wide &v) {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

Wide closest_on_segment(const Wide &a, const Wide &b, const Wide &p) {
    const Wide along = b - a;
    const double height = glm::dot(p - a, along);
    const double squared = glm::dot(along, along);
    if (!(height > 0.0))
        return a;
    if (height >= squared)
        return b;
    return a + height / squared * along;
}

// Whether the projection of p on the plane is in the triangle; if so, `foot` is set to it. Uses
// coordinates along and across the longest edge, which stay accurate in narrow triangles, where
// areas (Ericson 2005, "Real-Time Collision Detection", 5.1.5) would cancel.
bool foot_is_in_triangle(std::array<Wide, 3> corner, const Wide &p, Wide &foot) {
    const auto squared_length = [&](int i, int j) {
        const Wide edge = corner[std::size_t(j)] - corner[std::size_t(i)];
        return glm::dot(edge, edge);
    };
    const double ab = squared_length(0, 1), bc = squared_length(1, 2), ca = squared_length(2, 0);
    if (bc >= ab && bc >= ca)
        std::swap(corner[0], corner[2]);
    else if (ca >= ab)
        std::swap(corner[1], corner[2]);
    const Wide along = corner[1] - corner[0];
    const double along_squared = glm::dot(along, along);
    if (!(along_squared > 0.0))
        return false;
    const Wide to_apex = corner[2] - corner[0];
    const double apex = glm::dot(to_apex, along) / along_squared;
    Wide across = to_apex - apex * along;
    across -= glm::dot(across, along) / along_squared * along;
    const double across_squared = glm::dot(across, across);
    if (!(across_squared > 0.0))
        return false;
    const Wide to_p = p - corner[0];
    const double s = glm::dot(to_p, along) / along_squared;
    const double t = glm::dot(to_p - s * along, across) / across_squared;
    foot = corner[0] + s * along + t * across;
    return t >= 0.0 && t <= 1.0 && s >= t * apex && s <= 1.0 - t * (1.0 - apex);
}

} // namespace

Aabb bounds(const Triangle &triangle) {
    check_valid(triangle);
    Aabb box{triangle.a, triangle.a};
    for (int i = 0; i < 3; ++i) {
        box.min[i] = std::min({triangle.a[i], triangle.b[i], triangle.c[i]});
        box.max[i] = std::max({triangle.a[i], triangle.b[i], triangle.c[i]});
    }
    return box;
}

Real area(const Triangle &triangle) {
    check_valid(triangle);
    return static_cast<Real>(
        0.5 * glm::length(accurate_cross(triangle.a, triangle.b, triangle.a, triangle.c)));
}

Vec3 normal(const Triangle &triangle) {
    check_valid(triangle);
    const Wide n = accurate_cross(triangle.a, triangle.b, triangle.a, triangle.c);
    const double largest = largest_magnitude(n);
    // Divide by the largest component first: for a tiny triangle the squares would vanish.
    return largest > 0.0 ? Vec3(glm::normalize(n / largest)) : Vec3{Real(0)};
}

bool contains(const Triangle &triangle, const Vec3 &point) {
    check_valid(triangle);
    check_point(point);
    return point_meets_triangle(point, triangle);
}

std::optional<Vec3> barycentric(const Triangle &triangle, const Vec3 &point) {
    check_valid(triangle);
    check_point(point);
    const Wide n = accurate_cross(triangle.a, triangle.b, triangle.a, triangle.c);
    const double squared = glm::dot(n, n);
    if (!(squared > 0.0))
        return std::nullopt;
    const Wide a(triangle.a);
    const Wide to_point = Wide(point) - a;
    const double v = glm::dot(n, glm::cross(to_point, Wide(triangle.c) - a));
    const double w = glm::dot(n, glm::cross(Wide(triangle.b) - a, to_point));
    return Vec3(Wide{(squared - v) - w, v, w} / squared);
}

Vec3 closest_point(const Triangle &triangle, const Vec3 &point) {
    check_valid(triangle);
    check_point(point);
    const Wide a(triangle.a), b(triangle.b), c(triangle.c), p(point);
    Wide closest{0.0};
    if (!foot_is_in_triangle({a, b, c}, p, closest)) {
        const auto squared_distance = [&](const Wide &q) { return glm::dot(q - p, q - p); };
        closest = closest_on_segment(a, b, p);
        for (const Wide &other : {closest_on_segment(b, c, p), closest_on_segment(c, a, p)})
            if (squared_distance(other) < squared_distance(closest))
                closest = other;
    }
    // A point in the triangle comes back changed only by rounding.
    const double rounding =
        16.0 * double(std::numeric_limits<Real>::epsilon()) *
        std::max({largest_magnitude(a), largest_magnitude(b), largest_magnitude(c)});
    if (largest_magnitude(closest - p) <= rounding && point_meets_triangle(point, triangle))
        return point;
    return Vec3(closest);
}

} // namespace plumb::inline PLUMB_PRECISION
