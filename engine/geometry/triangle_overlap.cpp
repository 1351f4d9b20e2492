#include "engine/geometry/triangle_overlap.h"

#include "engine/geometry/aabb.h"
#include "engine/geometry/triangle_exact.h"
#include "engine/math/predicates.h"

#include <array>
#include <cmath>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

using Wide = glm::dvec3;

// The next three test whether a distance is at most a radius without division or square root, so
// that integers stay exact: they compare squares of volumes, areas and lengths.

bool is_near_segment(const Wide &a, const Wide &b, const Wide &p, double squared_radius) {
    const Wide along = b - a, from_a = p - a, from_b = p - b;
    if (!(glm::dot(from_a, along) > 0.0))
        return glm::dot(from_a, from_a) <= squared_radius;
    if (glm::dot(from_b, along) >= 0.0)
        return glm::dot(from_b, from_b) <= squared_radius;
    const Wide cross = glm::cross(from_a, along);
    return glm::dot(cross, cross) <= squared_radius * glm::dot(along, along);
}

// Whether the lines' closest points are between the ends of both segments, and near.
bool are_near_between_ends(const Segment &a, const Segment &b, double squared_radius) {
    const Wide across = accurate_cross(a.a, a.b, b.a, b.b);
    const double squared = glm::dot(across, across);
    if (!(squared > 0.0))
        return false;
    const Wide between = Wide(b.a) - Wide(a.a);
    const double volume = glm::dot(between, across);
    if (!(volume * volume <= squared_radius * squared))
        return false;
    const double s = glm::dot(glm::cross(between, Wide(b.b) - Wide(b.a)), across);
    const double t = glm::dot(glm::cross(between, Wide(a.b) - Wide(a.a)), across);
    return s >= 0.0 && s <= squared && t >= 0.0 && t <= squared;
}

// A triangle with precomputed values for distances.
struct WideTriangle {
    Wide a, b, c;
    Wide across; // normal to it, of length twice its area; zero when flat
    double squared;

    explicit WideTriangle(const Triangle &t)
        : a(t.a), b(t.b), c(t.c), across(accurate_cross(t.a, t.b, t.a, t.c)),
          squared(glm::dot(across, across)) {}

    bool is_near(const Vec3 &point, double squared_radius) const {
        const Wide p(point);
        if (squared > 0.0) {
            const double volume = glm::dot(across, p - a);
            if (volume * volume > squared_radius * squared)
                return false;
            if (is_over(a, b, p) && is_over(b, c, p) && is_over(c, a, p))
                return true;
        }
        return is_near_segment(a, b, p, squared_radius) ||
               is_near_segment(b, c, p, squared_radius) || is_near_segment(c, a, p, squared_radius);
    }

  private:
    // Whether p is on the inner side of an edge.
    bool is_over(const Wide &from, const Wide &to, const Wide &p) const {
        return glm::dot(across, glm::cross(to - from, p - from)) >= 0.0;
    }
};

double square(Real value) {
    return double(value) * double(value);
}

} // namespace

bool overlaps(const Triangle &a, const Triangle &b) {
    check_valid(a);
    check_valid(b);
    return triangle_meets_triangle(a, b);
}

bool overlaps(const Triangle &triangle, const Sphere &sphere) {
    check_valid(triangle);
    check_valid(sphere);
    return WideTriangle(triangle).is_near(sphere.center, square(sphere.radius));
}

bool overlaps(const Triangle &triangle, const Capsule &capsule) {
    check_valid(triangle);
    check_valid(capsule);
    const double squared_radius = square(capsule.radius);
    const WideTriangle wide(triangle);
    if (wide.is_near(capsule.a, squared_radius) || wide.is_near(capsule.b, squared_radius))
        return true;
    const Segment axis{capsule.a, capsule.b};
    const Wide a(axis.a), b(axis.b);
    return is_near_segment(a, b, wide.a, squared_radius) ||
           is_near_segment(a, b, wide.b, squared_radius) ||
           is_near_segment(a, b, wide.c, squared_radius) ||
           are_near_between_ends(axis, {triangle.a, triangle.b}, squared_radius) ||
           are_near_between_ends(axis, {triangle.b, triangle.c}, squared_radius) ||
           are_near_between_ends(axis, {triangle.c, triangle.a}, squared_radius) ||
           segment_meets_triangle(axis, triangle);
}

bool overlaps(const Triangle &triangle, const Aabb &box) {
    check_valid(triangle);
    check_valid(box);
    return !is_empty(box) && triangle_meets_box(triangle, box);
}

bool overlaps(const Triangle &triangle, const Box &box) {
    check_valid(triangle);
    check_valid(box);
    if (box.rotation.x == Real(0) && box.rotation.y == Real(0) && box.rotation.z == Real(0))
        return triangle_meets_box(triangle,
                                  {box.center - box.half_extents, box.center + box.half_extents});
    const glm::dquat to_local =
        glm::normalize(glm::dquat(double(box.rotation.w), -double(box.rotation.x),
                                  -double(box.rotation.y), -double(box.rotation.z)));
    const auto local = [&](const Vec3 &p) { return Vec3(to_local * (Wide(p) - Wide(box.center))); };
    return triangle_meets_box({local(triangle.a), local(triangle.b), local(triangle.c)},
                              {-box.half_extents, box.half_extents});
}

bool overlaps(const Triangle &triangle, const Plane &plane) {
    check_valid(triangle);
    check_valid(plane);
    const int a = plane_sign(plane.normal, plane.offset, triangle.a);
    const int b = plane_sign(plane.normal, plane.offset, triangle.b);
    const int c = plane_sign(plane.normal, plane.offset, triangle.c);
    return a == 0 || b != a || c != a;
}

} // namespace plumb::inline PLUMB_PRECISION
