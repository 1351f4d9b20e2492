#include "app/lab/queries/book_queries.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace plumb::book {

namespace {

// One epsilon for everything: relative above 1, absolute below.
bool nearly(float x, float y) {
    return std::abs(x - y) <=
           std::numeric_limits<float>::epsilon() * std::max({1.0f, std::abs(x), std::abs(y)});
}

float squared(const Vec3 &v) {
    return glm::dot(v, v);
}

Vec3 closest_on_segment(const Vec3 &a, const Vec3 &b, const Vec3 &point) {
    const Vec3 along = b - a;
    const float t = glm::dot(point - a, along) / squared(along); // 0 / 0 for a zero-length segment
    return a + along * std::fmin(std::fmax(t, 0.0f), 1.0f);
}

// Where a ray hits the slabs of a box.
struct SlabHit {
    bool hit = false;
    float t = 0;
};

SlabHit first_of(const std::array<float, 3> &one, const std::array<float, 3> &other) {
    float enter = -std::numeric_limits<float>::infinity();
    float exit = std::numeric_limits<float>::infinity();
    for (std::size_t i = 0; i < 3; ++i) {
        enter = std::fmax(enter, std::fmin(one[i], other[i]));
        exit = std::fmin(exit, std::fmax(one[i], other[i]));
    }
    if (exit < 0 || enter > exit)
        return {};
    return {true, enter < 0 ? exit : enter}; // from inside: the exit
}

SlabHit slabs(const Aabb &box, const Vec3 &origin, const Vec3 &direction) {
    std::array<float, 3> one{};
    std::array<float, 3> other{};
    for (int i = 0; i < 3; ++i) {
        // A zero component becomes 0.00001: a different ray.
        const float d = nearly(direction[i], 0) ? 0.00001f : direction[i];
        one[static_cast<std::size_t>(i)] = (box.min[i] - origin[i]) / d;
        other[static_cast<std::size_t>(i)] = (box.max[i] - origin[i]) / d;
    }
    return first_of(one, other);
}

SlabHit slabs(const Box &box, const Vec3 &origin, const Vec3 &direction) {
    const Mat3 axes = glm::mat3_cast(box.rotation);
    const Vec3 to_box = box.center - origin;
    std::array<float, 3> one{};
    std::array<float, 3> other{};
    for (int i = 0; i < 3; ++i) {
        float f = glm::dot(axes[i], direction);
        const float e = glm::dot(axes[i], to_box);
        const float size = box.half_extents[i];
        if (nearly(f, 0)) {
            if (-e - size > 0 || -e + size < 0)
                return {};
            f = 0.00001f;
        }
        one[static_cast<std::size_t>(i)] = (e + size) / f;
        other[static_cast<std::size_t>(i)] = (e - size) / f;
    }
    return first_of(one, other);
}

// A segment is a ray whose hit is near enough; from inside, the hit is the exit.
bool is_within(const SlabHit &hit, const Vec3 &a, const Vec3 &b) {
    return hit.hit && hit.t >= 0 && hit.t * hit.t <= squared(b - a);
}

struct TriangleHit {
    bool hit = false;
    float t = 0;
};

Vec3 projected(const Vec3 &v, const Vec3 &on) {
    return on * (glm::dot(v, on) / glm::dot(on, on));
}

// Hits the plane, then checks that barycentric coordinates are in 0..1. One-sided: rays from behind
// miss.
TriangleHit through(const Triangle &triangle, const Vec3 &origin, const Vec3 &direction) {
    const Vec3 normal =
        glm::normalize(glm::cross(triangle.b - triangle.a, triangle.c - triangle.a));
    const float offset = glm::dot(normal, triangle.a);
    const float slope = glm::dot(direction, normal);
    if (slope >= 0)
        return {};
    const float t = (offset - glm::dot(origin, normal)) / slope;
    if (!(t >= 0))
        return {};
    const Vec3 point = origin + direction * t;
    // A corner's weight: the point's distance from the opposite edge, measured along the component
    // of an adjacent edge perpendicular to it.
    const auto weight = [&](const Vec3 &corner, const Vec3 &next, const Vec3 &opposite) {
        const Vec3 edge = next - corner;
        const Vec3 v = edge - projected(edge, opposite);
        return 1.0f - glm::dot(v, point - corner) / glm::dot(v, edge);
    };
    const float a = weight(triangle.a, triangle.b, triangle.b - triangle.c);
    const float b = weight(triangle.b, triangle.c, triangle.c - triangle.a);
    const float c = weight(triangle.c, triangle.a, triangle.b - triangle.a);
    const bool inside = a >= 0 && a <= 1 && b >= 0 && b <= 1 && c >= 0 && c <= 1;
    return {inside, t};
}

struct Interval {
    float min = 0;
    float max = 0;
};

Interval interval(std::span<const Vec3> corners, const Vec3 &axis) {
    Interval result{glm::dot(axis, corners[0]), glm::dot(axis, corners[0])};
    for (const Vec3 &corner : corners.subspan(1)) {
        const float at = glm::dot(axis, corner);
        result.min = std::min(result.min, at);
        result.max = std::max(result.max, at);
    }
    return result;
}

bool overlap_along(std::span<const Vec3> a, std::span<const Vec3> b, const Vec3 &axis) {
    const Interval on_a = interval(a, axis);
    const Interval on_b = interval(b, axis);
    return on_b.min <= on_a.max && on_a.min <= on_b.max;
}

using Corners = std::array<Vec3, 8>;

Corners corners(const Vec3 &center, const Mat3 &axes, const Vec3 &half) {
    Corners result;
    for (unsigned k = 0; k < 8; ++k)
        result[k] = center + axes[0] * ((k & 1u) != 0 ? half.x : -half.x) +
                    axes[1] * ((k & 2u) != 0 ? half.y : -half.y) +
                    axes[2] * ((k & 4u) != 0 ? half.z : -half.z);
    return result;
}

Corners corners(const Aabb &box) {
    Corners result;
    for (unsigned k = 0; k < 8; ++k)
        result[k] = {(k & 1u) != 0 ? box.max.x : box.min.x, (k & 2u) != 0 ? box.max.y : box.min.y,
                     (k & 4u) != 0 ? box.max.z : box.min.z};
    return result;
}

// Three axes of A, three of B, and nine cross products, all of A's axes with each other: zero
// vectors and A's axes again. No edge-edge axis is ever tested.
bool overlap_on_book_axes(const Corners &a, const Mat3 &axes_a, const Corners &b,
                          const Mat3 &axes_b) {
    std::array<Vec3, 15> axes{axes_a[0], axes_a[1], axes_a[2], axes_b[0], axes_b[1], axes_b[2]};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            axes[6 + i * 3 + j] = glm::cross(axes[i], axes[j]);
    return std::all_of(axes.begin(), axes.end(),
                       [&](const Vec3 &axis) { return overlap_along(a, b, axis); });
}

// The axis perpendicular to both edges; if they are parallel, another one perpendicular to the
// first.
Vec3 axis_across(const Vec3 &a, const Vec3 &b, const Vec3 &c, const Vec3 &d) {
    const Vec3 across = glm::cross(b - a, d - c);
    if (!nearly(squared(across), 0))
        return across;
    const Vec3 other = glm::cross(b - a, glm::cross(b - a, c - a));
    return nearly(squared(other), 0) ? Vec3{0} : other;
}

} // namespace

// Open set: a point on the surface is outside.
bool contains(const Sphere &sphere, const Vec3 &point) {
    return squared(point - sphere.center) < sphere.radius * sphere.radius;
}

// Absolute epsilon on the squared distance: 0.3 mm at any size.
bool contains(const Segment &segment, const Vec3 &point) {
    return nearly(squared(closest_on_segment(segment.a, segment.b, point) - point), 0);
}

// Points above or below the triangle count as inside when near enough: only the signs of two dot
// products of normals are checked.
bool contains(const Triangle &triangle, const Vec3 &point) {
    const Vec3 a = triangle.a - point;
    const Vec3 b = triangle.b - point;
    const Vec3 c = triangle.c - point;
    const Vec3 bc = glm::cross(b, c);
    return glm::dot(bc, glm::cross(c, a)) >= 0 && glm::dot(bc, glm::cross(a, b)) >= 0;
}

// A sphere behind the origin is hit at a negative t.
bool raycast(const Sphere &sphere, const Ray &ray) {
    const Vec3 direction = glm::normalize(ray.direction);
    const Vec3 e = sphere.center - ray.origin;
    const float a = glm::dot(e, direction);
    return sphere.radius * sphere.radius - (squared(e) - a * a) >= 0;
}

bool raycast(const Aabb &box, const Ray &ray) {
    return slabs(box, ray.origin, glm::normalize(ray.direction)).hit;
}

bool raycast(const Box &box, const Ray &ray) {
    return slabs(box, ray.origin, glm::normalize(ray.direction)).hit;
}

bool raycast(const Triangle &triangle, const Ray &ray) {
    return through(triangle, ray.origin, glm::normalize(ray.direction)).hit;
}

// A zero-length segment has no direction: NaN.
bool linetest(const Aabb &box, const Vec3 &a, const Vec3 &b) {
    return is_within(slabs(box, a, glm::normalize(b - a)), a, b);
}

bool linetest(const Box &box, const Vec3 &a, const Vec3 &b) {
    if (squared(b - a) < 0.0000001f) {
        const Vec3 local = glm::conjugate(box.rotation) * (a - box.center);
        return glm::all(glm::lessThanEqual(glm::abs(local), box.half_extents));
    }
    return is_within(slabs(box, a, glm::normalize(b - a)), a, b);
}

bool linetest(const Triangle &triangle, const Vec3 &a, const Vec3 &b) {
    const TriangleHit hit = through(triangle, a, glm::normalize(b - a));
    return hit.hit && hit.t * hit.t <= squared(b - a);
}

bool overlaps(const Sphere &a, const Aabb &b) {
    return squared(glm::clamp(a.center, b.min, b.max) - a.center) < a.radius * a.radius;
}

bool overlaps(const Aabb &a, const Box &b) {
    const Mat3 axes = glm::mat3_cast(b.rotation);
    return overlap_on_book_axes(corners(a), Mat3{1.0f}, corners(b.center, axes, b.half_extents),
                                axes);
}

bool overlaps(const Box &a, const Box &b) {
    const Mat3 axes_a = glm::mat3_cast(a.rotation);
    const Mat3 axes_b = glm::mat3_cast(b.rotation);
    return overlap_on_book_axes(corners(a.center, axes_a, a.half_extents), axes_a,
                                corners(b.center, axes_b, b.half_extents), axes_b);
}

bool overlaps_as_published(const Box &a, const Box &b) {
    const Mat3 axes_a = glm::mat3_cast(a.rotation);
    const Corners both = corners(a.center, axes_a, a.half_extents);
    return overlap_on_book_axes(both, axes_a, both, glm::mat3_cast(b.rotation));
}

// A degenerate triangle gives zero axes, along which everything overlaps.
bool overlaps(const Triangle &a, const Aabb &b) {
    const std::array<Vec3, 3> points{a.a, a.b, a.c};
    const std::array<Vec3, 3> edges{a.b - a.a, a.c - a.b, a.a - a.c};
    const Corners box = corners(b);
    if (!overlap_along(box, points, glm::cross(edges[0], edges[1])))
        return false;
    for (int i = 0; i < 3; ++i) {
        Vec3 axis{0};
        axis[i] = 1;
        if (!overlap_along(box, points, axis))
            return false;
        for (const Vec3 &edge : edges)
            if (!overlap_along(box, points, glm::cross(axis, edge)))
                return false;
    }
    return true;
}

// The version the book calls robust. Some coplanar pairs are never separated: edge normals in the
// common plane are tested only if two edges are parallel.
bool overlaps(const Triangle &a, const Triangle &b) {
    const std::array<Vec3, 3> points_a{a.a, a.b, a.c};
    const std::array<Vec3, 3> points_b{b.a, b.b, b.c};
    const auto parts = [&](const Vec3 &axis) {
        return !overlap_along(points_a, points_b, axis) && !nearly(squared(axis), 0);
    };
    if (parts(axis_across(a.a, a.b, a.b, a.c)) || parts(axis_across(b.a, b.b, b.b, b.c)))
        return false;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            if (parts(axis_across(points_b[i], points_b[(i + 1) % 3], points_a[j],
                                  points_a[(j + 1) % 3])))
                return false;
    return true;
}

} // namespace plumb::book
