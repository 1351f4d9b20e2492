#include "engine/geometry/overlap.h"

#include "engine/core/check.h"
#include "engine/geometry/aabb.h"
#include "engine/geometry/closest_point.h"
#include "engine/geometry/contains.h"
#include "engine/geometry/plane.h"
#include "engine/math/predicates.h"
#include "engine/math/rigid.h"
#include "engine/math/vectors.h"

#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// A box as an Aabb in its own frame.
Aabb local_box(const Box &box) {
    return {-box.half_extents, box.half_extents};
}

bool is_longer(const Vec3 &v, Real radius) {
    return glm::dot(v, v) > radius * radius;
}

// Whether the segment from a along d comes within `radius` of `point` between its ends.
bool interior_is_near(const Vec3 &a, const Vec3 &d, const Vec3 &point, Real radius) {
    const Vec3 from_a = point - a;
    const Real height = glm::dot(from_a, d);
    const Real squared = glm::dot(d, d);
    if (height <= Real(0) || height >= squared)
        return false;
    const Vec3 cross = glm::cross(from_a, d);
    return glm::dot(cross, cross) <= radius * radius * squared;
}

// Whether two segments come within `radius` of each other at points between the ends of both. There
// is no division, so integers stay exact, and the cross product is accurate, so nearly parallel
// segments lose no precision.
bool interiors_are_near(const Vec3 &a, const Vec3 &along_a, const Vec3 &b, const Vec3 &along_b,
                        Real radius) {
    const Vec3 offset = b - a;
    const Vec3 across = accurate_cross(along_a, along_b);
    const Real squared = glm::dot(across, across);
    // With these over `squared`, offset + t along_b - s along_a is parallel to `across`.
    const Real s = glm::dot(accurate_cross(offset, along_b), across);
    const Real t = glm::dot(accurate_cross(offset, along_a), across);
    if (squared == Real(0) || s < Real(0) || s > squared || t < Real(0) || t > squared)
        return false;
    const Real gap = glm::dot(offset, across);
    return product_difference_sign(gap, gap, radius * radius, squared) <= 0;
}

// Whether a segment has a point in the box, by separating axes: the box's axes, and their cross
// products with the segment.
bool meets(const Aabb &box, const Vec3 &a, const Vec3 &b) {
    const Vec3 low = box.min - a, high = box.max - a; // the box relative to a
    const Vec3 d = b - a;
    for (int i = 0; i < 3; ++i)
        if (std::max(Real(0), d[i]) < low[i] || std::min(Real(0), d[i]) > high[i])
            return false;
    for (int i = 0; i < 3; ++i) {
        // Projected along axis i, the corners must not all be on one side of the line.
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        const Real most =
            std::max(low[j] * d[k], high[j] * d[k]) - std::min(low[k] * d[j], high[k] * d[j]);
        const Real least =
            std::min(low[j] * d[k], high[j] * d[k]) - std::max(low[k] * d[j], high[k] * d[j]);
        if (most < Real(0) || least > Real(0))
            return false;
    }
    return true;
}

// Whether the segment comes within `radius` of a box edge along axis i, at points between the ends
// of both. Projected along the axis the edge is a point. For a segment along the axis an end is
// also closest, so the tests of ends and corners cover it.
bool passes_edge(const Aabb &box, int i, const Vec3 &a, const Vec3 &d, Real radius) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const Real squared = d[j] * d[j] + d[k] * d[k];
    const Real low = (box.min[i] - a[i]) * squared, high = (box.max[i] - a[i]) * squared;
    for (int corner = 0; corner < 4; ++corner) {
        const Real y = ((corner & 1) == 0 ? box.min[j] : box.max[j]) - a[j];
        const Real z = ((corner & 2) == 0 ? box.min[k] : box.max[k]) - a[k];
        const Real s = y * d[j] + z * d[k]; // the segment's parameter, over `squared`
        const Real climb = s * d[i];
        if (squared == Real(0) || s < Real(0) || s > squared || climb < low || climb > high)
            continue;
        const Real across = y * d[k] - z * d[j];
        if (across * across <= radius * radius * squared)
            return true;
    }
    return false;
}

// Whether the segment from a to b comes within `radius` of the box: an end does, or it enters the
// box, or it passes that close to a corner or an edge.
bool is_near(const Aabb &box, const Vec3 &a, const Vec3 &b, Real radius) {
    const Vec3 gap = glm::max(box.min - glm::max(a, b), glm::min(a, b) - box.max);
    if (gap.x > radius || gap.y > radius || gap.z > radius)
        return false;
    if (!is_longer(a - glm::clamp(a, box.min, box.max), radius) ||
        !is_longer(b - glm::clamp(b, box.min, box.max), radius) || meets(box, a, b))
        return true;
    const Vec3 d = b - a;
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3 point{(corner & 1) == 0 ? box.min.x : box.max.x,
                         (corner & 2) == 0 ? box.min.y : box.max.y,
                         (corner & 4) == 0 ? box.min.z : box.max.z};
        if (interior_is_near(a, d, point, radius))
            return true;
    }
    return passes_edge(box, 0, a, d, radius) || passes_edge(box, 1, a, d, radius) ||
           passes_edge(box, 2, a, d, radius);
}

} // namespace

bool overlaps(const Sphere &a, const Sphere &b) {
    check_valid(a);
    check_valid(b);
    return !is_longer(b.center - a.center, a.radius + b.radius);
}

bool overlaps(const Sphere &sphere, const Aabb &box) {
    check_valid(sphere);
    check_valid(box);
    return !is_empty(box) &&
           !is_longer(sphere.center - glm::clamp(sphere.center, box.min, box.max), sphere.radius);
}

bool overlaps(const Sphere &sphere, const Box &box) {
    check_valid(sphere);
    check_valid(box);
    const Vec3 center = rotated(glm::conjugate(box.rotation), sphere.center - box.center);
    const Vec3 closest = glm::clamp(center, -box.half_extents, box.half_extents);
    return !is_longer(center - closest, sphere.radius);
}

bool overlaps(const Sphere &sphere, const Plane &plane) {
    return classify(plane, sphere).side == PlaneSide::across;
}

bool overlaps(const Aabb &a, const Aabb &b) {
    check_valid(a);
    check_valid(b);
    return !is_empty(a) && !is_empty(b) && a.min.x <= b.max.x && b.min.x <= a.max.x &&
           a.min.y <= b.max.y && b.min.y <= a.max.y && a.min.z <= b.max.z && b.min.z <= a.max.z;
}

bool overlaps(const Aabb &box, const Plane &plane) {
    check_valid(box);
    check_valid(plane);
    return !is_empty(box) && classify(plane, box).side == PlaneSide::across;
}

bool overlaps(const Box &box, const Plane &plane) {
    return classify(plane, box).side == PlaneSide::across;
}

bool overlaps(const Plane &a, const Plane &b) {
    check_valid(a);
    check_valid(b);
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3;
        if (product_difference_sign(a.normal[i], b.normal[j], a.normal[j], b.normal[i]) != 0)
            return true;
    }
    for (int i = 0; i < 3; ++i)
        if (product_difference_sign(a.offset, b.normal[i], b.offset, a.normal[i]) != 0)
            return false;
    return true;
}

bool overlaps(const Capsule &a, const Capsule &b) {
    check_valid(a);
    check_valid(b);
    const Real radius = a.radius + b.radius;
    const Vec3 along_a = a.b - a.a;
    const Vec3 along_b = b.b - b.a;
    // The closest points are two ends, an end and an interior point, or two interior points.
    return !is_longer(b.a - a.a, radius) || !is_longer(b.b - a.a, radius) ||
           !is_longer(b.a - a.b, radius) || !is_longer(b.b - a.b, radius) ||
           interior_is_near(a.a, along_a, b.a, radius) ||
           interior_is_near(a.a, along_a, b.b, radius) ||
           interior_is_near(b.a, along_b, a.a, radius) ||
           interior_is_near(b.a, along_b, a.b, radius) ||
           interiors_are_near(a.a, along_a, b.a, along_b, radius);
}

bool overlaps(const Capsule &capsule, const Sphere &sphere) {
    check_valid(capsule);
    check_valid(sphere);
    return contains(Capsule{capsule.a, capsule.b, capsule.radius + sphere.radius}, sphere.center);
}

bool overlaps(const Capsule &capsule, const Aabb &box) {
    check_valid(capsule);
    check_valid(box);
    return !is_empty(box) && is_near(box, capsule.a, capsule.b, capsule.radius);
}

bool overlaps(const Capsule &capsule, const Box &box) {
    check_valid(capsule);
    check_valid(box);
    const Mat3 axes = rotation_matrix(box.rotation);
    return is_near(local_box(box), (capsule.a - box.center) * axes, (capsule.b - box.center) * axes,
                   capsule.radius);
}

bool overlaps(const Capsule &capsule, const Plane &plane) {
    return classify(plane, capsule).side == PlaneSide::across;
}

} // namespace plumb::inline PLUMB_PRECISION
