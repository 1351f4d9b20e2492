#include "engine/geometry/raycast_2d.h"

#include "engine/geometry/contains_2d.h"
#include "engine/geometry/oriented_frame_2d.h"
#include "engine/geometry/overlap_2d.h"
#include "engine/math/constants.h"
#include "engine/math/predicates.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

Real cross(const Vec2 &a, const Vec2 &b) {
    return a.x * b.y - a.y * b.x;
}

// A ray with its direction scaled near unit length by a power of two (exact), so that its square
// neither overflows nor vanishes.
struct RescaledRay {
    Ray2 ray;
    int exponent = 0;

    explicit RescaledRay(const Ray2 &given) : ray(given) {
        const Real largest = std::max(std::abs(ray.direction.x), std::abs(ray.direction.y));
        if (largest >= Real(0x1p-20) && largest <= Real(0x1p20))
            return;
        exponent = std::ilogb(largest);
        ray.direction = {std::scalbn(ray.direction.x, -exponent),
                         std::scalbn(ray.direction.y, -exponent)};
        ray.max_t = std::scalbn(ray.max_t, exponent);
    }
    std::optional<RayInterval2> in_given_units(std::optional<RayInterval2> interval) const {
        if (interval && exponent != 0) {
            interval->t_enter = std::scalbn(interval->t_enter, -exponent);
            interval->t_exit = std::scalbn(interval->t_exit, -exponent);
            if (interval->t_enter == infinity) // the direction is too small to get there
                return std::nullopt;
        }
        return interval;
    }
};

// Whether the line through `origin` along `direction` passes between or through the rectangle's
// corners farthest to its left and right. Exact.
bool line_meets(const Rectangle &rectangle, const Vec2 &origin, const Vec2 &direction) {
    const bool rises = (direction.x > Real(0)) == (direction.y > Real(0));
    const Vec2 left{rectangle.min.x, rises ? rectangle.max.y : rectangle.min.y};
    const Vec2 right{rectangle.max.x, rises ? rectangle.min.y : rectangle.max.y};
    return cross_sign(direction, origin, left) * cross_sign(direction, origin, right) <= 0;
}

template <typename Solid>
std::optional<RayHit2> first_of_interval(const Solid &solid, const Ray2 &ray) {
    const std::optional<RayInterval2> inside = ray_interval(solid, ray);
    if (!inside)
        return std::nullopt;
    return RayHit2{inside->t_enter, ray.origin + inside->t_enter * ray.direction,
                   inside->enter_normal, inside->enter_normal == Vec2{Real(0)}};
}

} // namespace

std::optional<RayInterval2> ray_interval(const Circle &circle, const Ray2 &ray) {
    check_valid(ray);
    const bool starts_inside = contains(circle, ray.origin);
    if (!(ray.max_t >= Real(0)))
        return std::nullopt;
    const RescaledRay rescaled(ray);
    const Vec2 &d = rescaled.ray.direction;
    const Real max_t = rescaled.ray.max_t;
    const Vec3 center{circle.center, Real(0)}, origin{ray.origin, Real(0)};
    const Vec3 zero{Real(0)}, direction{d, Real(0)};
    const int depth_sign = line_ball_sign(center, circle.radius, origin, zero, direction);
    if (!starts_inside && (depth_sign < 0 || dot_sign(origin, center, zero, direction) < 0))
        return std::nullopt;

    // The centre's distance from the line is |across| / |d|.
    const Vec2 to_center = circle.center - ray.origin;
    const Real along = glm::dot(d, to_center);
    const Real across = cross(d, to_center);
    const Real squared = glm::dot(d, d);
    const Real radius_squared = circle.radius * circle.radius;
    const Real half =
        depth_sign > 0
            ? std::sqrt(std::max(radius_squared * squared - across * across, Real(0))) / squared
            : Real(0);
    const Real middle = along / squared;
    if (starts_inside)
        return rescaled.in_given_units(
            RayInterval2{Real(0), std::clamp(middle + half, Real(0), max_t)});

    const Real enter = std::max(middle - half, Real(0));
    if (!(enter <= max_t) || enter == infinity)
        return std::nullopt;
    // For radius 0 only the ray gives a direction.
    const Vec2 outward = circle.radius > Real(0) ? enter * d - to_center : -d;
    return rescaled.in_given_units(
        RayInterval2{enter, std::min(middle + half, max_t), glm::normalize(outward)});
}

// The slab test (Kay and Kajiya 1986, "Ray tracing complex scenes"), decided by comparisons and the
// exact test above; the quotients are used only for the result.
std::optional<RayInterval2> ray_interval(const Rectangle &rectangle, const Ray2 &ray) {
    check_valid(rectangle);
    check_valid(ray);
    if (is_empty(rectangle) || !(ray.max_t >= Real(0)))
        return std::nullopt;
    RayInterval2 interval{Real(0), infinity};
    for (int i = 0; i < 2; ++i) {
        const Real origin = ray.origin[i];
        const Real direction = ray.direction[i];
        const Real low = rectangle.min[i];
        const Real high = rectangle.max[i];
        if (direction == Real(0)) {
            if (origin < low || origin > high)
                return std::nullopt;
            continue;
        }
        const bool is_forward = direction > Real(0);
        if (is_forward ? origin > high : origin < low)
            return std::nullopt;
        interval.t_exit =
            std::min(interval.t_exit, ((is_forward ? high : low) - origin) / direction);
        if (is_forward ? origin < low : origin > high) {
            const Real near = ((is_forward ? low : high) - origin) / direction;
            if (near >= interval.t_enter) {
                interval.t_enter = near;
                interval.enter_normal = Vec2{Real(0)};
                interval.enter_normal[i] = is_forward ? Real(-1) : Real(1);
            }
        }
    }
    if (ray.direction.x != Real(0) && ray.direction.y != Real(0) &&
        !line_meets(rectangle, ray.origin, ray.direction))
        return std::nullopt;
    if (!(interval.t_enter <= ray.max_t) || interval.t_enter == infinity)
        return std::nullopt;
    // For a ray through a corner rounding may have swapped them.
    interval.t_exit = std::min(std::max(interval.t_exit, interval.t_enter), ray.max_t);
    return interval;
}

std::optional<RayInterval2> ray_interval(const OrientedRectangle &rectangle, const Ray2 &ray) {
    check_valid(rectangle);
    check_valid(ray);
    const RescaledRay rescaled(ray);
    const Ray2 local{to_frame(rectangle, ray.origin),
                     to_frame_vector(rectangle, rescaled.ray.direction), rescaled.ray.max_t};
    std::optional<RayInterval2> interval =
        ray_interval(Rectangle{-rectangle.half_extents, rectangle.half_extents}, local);
    if (interval)
        interval->enter_normal = from_frame_vector(rectangle, interval->enter_normal);
    return rescaled.in_given_units(interval);
}

std::optional<RayHit2> raycast(const Circle &circle, const Ray2 &ray) {
    return first_of_interval(circle, ray);
}

std::optional<RayHit2> raycast(const Rectangle &rectangle, const Ray2 &ray) {
    return first_of_interval(rectangle, ray);
}

std::optional<RayHit2> raycast(const OrientedRectangle &rectangle, const Ray2 &ray) {
    return first_of_interval(rectangle, ray);
}

std::optional<RayHit2> raycast(const Compound2 &compound, const Ray2 &ray) {
    if (!ray_interval(compound.bounds(), ray))
        return std::nullopt;
    std::optional<RayHit2> first;
    for (const Part2 &part : compound.parts()) {
        const std::optional<RayHit2> hit =
            std::visit([&](const auto &shape) { return raycast(shape, ray); }, part);
        if (hit && (!first || hit->t < first->t || (hit->starts_inside && !first->starts_inside)))
            first = hit;
    }
    return first;
}

std::optional<RayHit2> raycast(const Segment2 &segment, const Ray2 &ray) {
    check_valid(ray);
    const bool starts_on = contains(segment, ray.origin);
    if (!(ray.max_t >= Real(0)))
        return std::nullopt;
    if (starts_on)
        return RayHit2{Real(0), ray.origin, Vec2{Real(0)}, true};

    const Vec2 &d = ray.direction;
    const int side_a = cross_sign(d, ray.origin, segment.a);
    const int side_b = cross_sign(d, ray.origin, segment.b);
    if (side_a * side_b > 0)
        return std::nullopt;

    RayHit2 hit;
    // The quotient is most accurate along the larger component.
    const int i = std::abs(d.x) >= std::abs(d.y) ? 0 : 1;
    if (side_a == 0 && side_b == 0) {
        const bool is_forward = d[i] > Real(0);
        hit.point = (segment.a[i] < segment.b[i]) == is_forward ? segment.a : segment.b;
        if (is_forward ? hit.point[i] < ray.origin[i] : hit.point[i] > ray.origin[i])
            return std::nullopt;
        hit.normal = -glm::normalize(RescaledRay(ray).ray.direction);
    } else {
        // d x (b - a) has the sign of side_b - side_a, and the segment is ahead if (a - origin) x
        // (b - origin) has the same sign.
        const int turn = side_b > side_a ? 1 : -1;
        if (orient2d(ray.origin, segment.a, segment.b) != turn)
            return std::nullopt;
        // Interpolate by the ends' distances from the ray, as in `intersection`. As there, a ray
        // nearly along the segment may be off, but never to behind the origin.
        const Vec2 along = segment.b - segment.a;
        const Vec2 unit = RescaledRay(ray).ray.direction;
        const Real left = std::abs(cross(unit, segment.a - ray.origin));
        const Real right = std::abs(cross(unit, segment.b - ray.origin));
        const Real sum = left + right;
        hit.point = segment.a + (sum > Real(0) ? left / sum : Real(0.5)) * along;
        for (int k = 0; k < 2; ++k) {
            if (d[k] >= Real(0))
                hit.point[k] = std::max(hit.point[k], ray.origin[k]);
            if (d[k] <= Real(0))
                hit.point[k] = std::min(hit.point[k], ray.origin[k]);
        }
        if (side_a == 0 || side_b == 0)
            hit.point = side_a == 0 ? segment.a : segment.b;
        hit.normal = Real(turn) * glm::normalize(perpendicular(along));
    }
    hit.t = std::max((hit.point[i] - ray.origin[i]) / d[i], Real(0));
    if (!(hit.t <= ray.max_t) || hit.t == infinity)
        return std::nullopt;
    return hit;
}

bool linetest(const Circle &circle, const Vec2 &a, const Vec2 &b) {
    check_valid(Segment2{a, b});
    if (contains(circle, a) || contains(circle, b))
        return true;
    const Vec3 center{circle.center, Real(0)}, from{a, Real(0)}, to{b, Real(0)};
    return dot_sign(from, center, from, to) > 0 && dot_sign(center, to, from, to) > 0 &&
           line_ball_sign(center, circle.radius, from, from, to) >= 0;
}

bool linetest(const Rectangle &rectangle, const Vec2 &a, const Vec2 &b) {
    if (!overlaps(rectangle, bounds(Segment2{a, b})))
        return false;
    // There must be corners on both sides of the line or on it. The signs of b - a, not its rounded
    // value, select the corners.
    const bool rises = (a.x < b.x) == (a.y < b.y);
    const Vec2 left{rectangle.min.x, rises ? rectangle.max.y : rectangle.min.y};
    const Vec2 right{rectangle.max.x, rises ? rectangle.min.y : rectangle.max.y};
    return orient2d(a, b, left) * orient2d(a, b, right) <= 0;
}

bool linetest(const OrientedRectangle &rectangle, const Vec2 &a, const Vec2 &b) {
    check_valid(rectangle);
    check_valid(Segment2{a, b});
    return linetest(Rectangle{-rectangle.half_extents, rectangle.half_extents},
                    to_frame(rectangle, a), to_frame(rectangle, b));
}

bool linetest(const Compound2 &compound, const Vec2 &a, const Vec2 &b) {
    if (!linetest(compound.bounds(), a, b))
        return false;
    return std::ranges::any_of(compound.parts(), [&](const Part2 &part) {
        return std::visit([&](const auto &shape) { return linetest(shape, a, b); }, part);
    });
}

bool linetest(const Segment2 &segment, const Vec2 &a, const Vec2 &b) {
    return overlaps(segment, Segment2{a, b});
}

} // namespace plumb::inline PLUMB_PRECISION
