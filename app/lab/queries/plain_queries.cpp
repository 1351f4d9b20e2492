#include "app/lab/queries/plain_queries.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace plumb::plain {

namespace {

constexpr float near_enough = 1e-4f; // metres, whatever the size

float squared(const Vec3 &v) {
    return glm::dot(v, v);
}

bool slabs(const Aabb &box, const Vec3 &origin, const Vec3 &direction, float max_t) {
    const Vec3 inverse = 1.0f / direction; // infinite for a zero component; 0 * infinity is NaN
    const Vec3 one = (box.min - origin) * inverse;
    const Vec3 other = (box.max - origin) * inverse;
    const Vec3 low = glm::min(one, other);
    const Vec3 high = glm::max(one, other);
    const float enter = std::max({low.x, low.y, low.z, 0.0f});
    const float exit = std::min({high.x, high.y, high.z, max_t});
    return enter <= exit;
}

bool slabs(const Box &box, const Vec3 &origin, const Vec3 &direction, float max_t) {
    const Mat3 axes = glm::mat3_cast(box.rotation);
    return slabs(Aabb{-box.half_extents, box.half_extents}, (origin - box.center) * axes,
                 direction * axes, max_t);
}

bool moeller_trumbore(const Triangle &triangle, const Vec3 &origin, const Vec3 &direction,
                      float max_t) {
    const Vec3 ab = triangle.b - triangle.a;
    const Vec3 ac = triangle.c - triangle.a;
    const Vec3 p = glm::cross(direction, ac);
    const float determinant = glm::dot(ab, p);
    if (std::abs(determinant) < 1e-7f)
        return false;
    const float inverse = 1.0f / determinant;
    const Vec3 s = origin - triangle.a;
    const float u = inverse * glm::dot(s, p);
    if (u < 0 || u > 1)
        return false;
    const Vec3 q = glm::cross(s, ab);
    const float v = inverse * glm::dot(direction, q);
    if (v < 0 || u + v > 1)
        return false;
    const float t = inverse * glm::dot(ac, q);
    return t >= 0 && t <= max_t;
}

} // namespace

bool contains(const Sphere &sphere, const Vec3 &point) {
    return squared(point - sphere.center) <= sphere.radius * sphere.radius;
}

bool contains(const Segment &segment, const Vec3 &point) {
    const Vec3 along = segment.b - segment.a;
    const float length = squared(along);
    const float t =
        length > 0 ? std::clamp(glm::dot(point - segment.a, along) / length, 0.0f, 1.0f) : 0.0f;
    return squared(segment.a + t * along - point) <= near_enough * near_enough;
}

bool contains(const Triangle &triangle, const Vec3 &point) {
    const Vec3 ab = triangle.b - triangle.a;
    const Vec3 ac = triangle.c - triangle.a;
    const Vec3 ap = point - triangle.a;
    const Vec3 normal = glm::cross(ab, ac);
    if (std::abs(glm::dot(ap, normal)) > near_enough * glm::length(normal))
        return false;
    const float d00 = glm::dot(ab, ab), d01 = glm::dot(ab, ac), d11 = glm::dot(ac, ac);
    const float d20 = glm::dot(ap, ab), d21 = glm::dot(ap, ac);
    const float inverse = 1.0f / (d00 * d11 - d01 * d01);
    const float v = (d11 * d20 - d01 * d21) * inverse;
    const float w = (d00 * d21 - d01 * d20) * inverse;
    return v >= 0 && w >= 0 && v + w <= 1;
}

bool raycast(const Sphere &sphere, const Ray &ray) {
    const Vec3 m = ray.origin - sphere.center;
    const float c = squared(m) - sphere.radius * sphere.radius;
    if (c <= 0)
        return true;
    const float b = glm::dot(m, ray.direction);
    return b <= 0 && b * b >= squared(ray.direction) * c;
}

bool raycast(const Aabb &box, const Ray &ray) {
    return slabs(box, ray.origin, ray.direction, ray.max_t);
}

bool raycast(const Box &box, const Ray &ray) {
    return slabs(box, ray.origin, ray.direction, ray.max_t);
}

bool raycast(const Triangle &triangle, const Ray &ray) {
    return moeller_trumbore(triangle, ray.origin, ray.direction, ray.max_t);
}

bool linetest(const Aabb &box, const Vec3 &a, const Vec3 &b) {
    return slabs(box, a, b - a, 1);
}

bool linetest(const Box &box, const Vec3 &a, const Vec3 &b) {
    return slabs(box, a, b - a, 1);
}

bool linetest(const Triangle &triangle, const Vec3 &a, const Vec3 &b) {
    return moeller_trumbore(triangle, a, b - a, 1);
}

bool overlaps(const Sphere &a, const Aabb &b) {
    return squared(glm::clamp(a.center, b.min, b.max) - a.center) <= a.radius * a.radius;
}

bool overlaps(const Aabb &a, const Box &b) {
    return overlaps(Box{0.5f * (a.min + a.max), identity_rotation, 0.5f * (a.max - a.min)}, b);
}

bool overlaps(const Box &a, const Box &b) {
    const Mat3 axes_a = glm::mat3_cast(a.rotation);
    const Mat3 axes_b = glm::mat3_cast(b.rotation);
    const Mat3 turn = glm::transpose(axes_a) * axes_b; // turn[j][i]: axis i of A on axis j of B
    const Vec3 t = (b.center - a.center) * axes_a;
    Mat3 size{0};
    for (int j = 0; j < 3; ++j)
        size[j] = glm::abs(turn[j]) + 1e-6f;
    for (int i = 0; i < 3; ++i) {
        const float reach = b.half_extents.x * size[0][i] + b.half_extents.y * size[1][i] +
                            b.half_extents.z * size[2][i];
        if (std::abs(t[i]) > a.half_extents[i] + reach)
            return false;
        if (std::abs(glm::dot(t, turn[i])) > b.half_extents[i] + glm::dot(a.half_extents, size[i]))
            return false;
    }
    for (int i = 0; i < 3; ++i) {
        const int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
        for (int j = 0; j < 3; ++j) {
            const int j1 = (j + 1) % 3, j2 = (j + 2) % 3;
            const float reach_a =
                a.half_extents[i1] * size[j][i2] + a.half_extents[i2] * size[j][i1];
            const float reach_b =
                b.half_extents[j1] * size[j2][i] + b.half_extents[j2] * size[j1][i];
            if (std::abs(t[i2] * turn[j][i1] - t[i1] * turn[j][i2]) > reach_a + reach_b)
                return false;
        }
    }
    return true;
}

bool overlaps(const Triangle &a, const Aabb &b) {
    const Vec3 center = 0.5f * (b.min + b.max);
    const Vec3 half = 0.5f * (b.max - b.min);
    const std::array<Vec3, 3> v{a.a - center, a.b - center, a.c - center};
    const std::array<Vec3, 3> edges{v[1] - v[0], v[2] - v[1], v[0] - v[2]};
    const auto parts = [&](const Vec3 &axis) {
        const float p0 = glm::dot(v[0], axis), p1 = glm::dot(v[1], axis), p2 = glm::dot(v[2], axis);
        const float reach = glm::dot(half, glm::abs(axis));
        return std::min({p0, p1, p2}) > reach || std::max({p0, p1, p2}) < -reach;
    };
    for (int i = 0; i < 3; ++i) {
        Vec3 axis{0};
        axis[i] = 1;
        if (parts(axis))
            return false;
        for (const Vec3 &edge : edges)
            if (parts(glm::cross(axis, edge)))
                return false;
    }
    return !parts(glm::cross(edges[0], edges[1]));
}

bool overlaps(const Triangle &a, const Triangle &b) {
    return linetest(b, a.a, a.b) || linetest(b, a.b, a.c) || linetest(b, a.c, a.a) ||
           linetest(a, b.a, b.b) || linetest(a, b.b, b.c) || linetest(a, b.c, b.a);
}

} // namespace plumb::plain
