#include "engine/geometry/closest_point_2d.h"

#include "engine/core/check.h"
#include "engine/geometry/contains_2d.h"
#include "engine/geometry/oriented_frame_2d.h"
#include "engine/math/printed.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

Vec2 closest_point(const Segment2 &segment, const Vec2 &point) {
    if (contains(segment, point))
        return point;
    const Vec2 along = segment.b - segment.a;
    const Real squared = glm::dot(along, along);
    const Real reached = glm::dot(point - segment.a, along);
    if (!(reached > Real(0)))
        return segment.a;
    if (!(reached < squared))
        return segment.b;
    return segment.a + (reached / squared) * along;
}

Vec2 closest_point(const Ray2 &ray, const Vec2 &point) {
    check_valid(ray);
    check_valid(point);
    PLUMB_CHECK(ray.max_t >= Real(0), "ray max_t must not be negative, got " << ray.max_t);
    if (contains(ray, point))
        return point;
    const Real squared = glm::dot(ray.direction, ray.direction);
    const Real t = glm::dot(point - ray.origin, ray.direction) / squared;
    return ray.origin + glm::clamp(t, Real(0), ray.max_t) * ray.direction;
}

Vec2 closest_point(const Circle &circle, const Vec2 &point) {
    if (contains(circle, point))
        return point;
    const Vec2 d = point - circle.center;
    return circle.center + d * (circle.radius / glm::length(d));
}

Vec2 closest_point(const Rectangle &rectangle, const Vec2 &point) {
    check_valid(rectangle);
    check_valid(point);
    PLUMB_CHECK(!is_empty(rectangle), "an empty rectangle has no closest point, min is "
                                          << Printed{rectangle.min} << " and max "
                                          << Printed{rectangle.max});
    return glm::clamp(point, rectangle.min, rectangle.max);
}

Vec2 closest_point(const OrientedRectangle &rectangle, const Vec2 &point) {
    if (contains(rectangle, point))
        return point;
    const Vec2 local =
        glm::clamp(to_frame(rectangle, point), -rectangle.half_extents, rectangle.half_extents);
    return rectangle.center + from_frame_vector(rectangle, local);
}

Vec2 closest_point(const Compound2 &compound, const Vec2 &point) {
    check_valid(point);
    Vec2 best = point;
    Real best_squared = std::numeric_limits<Real>::infinity();
    for (const Part2 &part : compound.parts()) {
        const Vec2 candidate =
            std::visit([&](const auto &shape) { return closest_point(shape, point); }, part);
        const Vec2 d = point - candidate;
        const Real squared = glm::dot(d, d);
        if (squared < best_squared) {
            best = candidate;
            best_squared = squared;
        }
    }
    return best;
}

} // namespace plumb::inline PLUMB_PRECISION
