#include "engine/geometry/contains_2d.h"

#include "engine/geometry/oriented_frame_2d.h"
#include "engine/math/predicates.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

bool contains(const Segment2 &segment, const Vec2 &point) {
    return contains(bounds(segment), point) && orient2d(segment.a, segment.b, point) == 0;
}

bool contains(const Ray2 &ray, const Vec2 &point) {
    check_valid(ray);
    check_valid(point);
    if (cross_sign(ray.direction, ray.origin, point) != 0)
        return false;
    // On the line, t is the quotient of the components on either axis; use the axis with the larger
    // one.
    const int i = std::abs(ray.direction.x) >= std::abs(ray.direction.y) ? 0 : 1;
    if (ray.direction[i] > Real(0) ? point[i] < ray.origin[i] : point[i] > ray.origin[i])
        return false;
    if (!(ray.max_t >= Real(0)))
        return false;
    if (ray.max_t == std::numeric_limits<Real>::infinity())
        return true;
    // The sign of (point - origin) - max_t direction on that axis, as a cross product.
    const Vec2 slope{Real(1), ray.max_t};
    const int beyond = cross_sign(slope, {Real(0), ray.origin[i]}, {ray.direction[i], point[i]});
    return ray.direction[i] > Real(0) ? beyond <= 0 : beyond >= 0;
}

bool contains(const Circle &circle, const Vec2 &point) {
    check_valid(circle);
    check_valid(point);
    return ball_sign({circle.center, Real(0)}, circle.radius, {point, Real(0)}) >= 0;
}

bool contains(const Rectangle &rectangle, const Vec2 &point) {
    check_valid(rectangle);
    check_valid(point);
    return point.x >= rectangle.min.x && point.x <= rectangle.max.x && point.y >= rectangle.min.y &&
           point.y <= rectangle.max.y;
}

bool contains(const OrientedRectangle &rectangle, const Vec2 &point) {
    check_valid(rectangle);
    check_valid(point);
    const Vec2 local = to_frame(rectangle, point);
    return std::abs(local.x) <= rectangle.half_extents.x &&
           std::abs(local.y) <= rectangle.half_extents.y;
}

bool contains(const Compound2 &compound, const Vec2 &point) {
    if (!contains(compound.bounds(), point))
        return false;
    return std::ranges::any_of(compound.parts(), [&](const Part2 &part) {
        return std::visit([&](const auto &shape) { return contains(shape, point); }, part);
    });
}

} // namespace plumb::inline PLUMB_PRECISION
