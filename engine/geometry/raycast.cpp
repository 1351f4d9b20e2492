#include "engine/geometry/raycast.h"

#include "engine/core/check.h"
#include "engine/geometry/closest.h"
#include "engine/geometry/slab.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

constexpr Real infinity = std::numeric_limits<Real>::infinity();

void check_ray(const Ray &ray) {
    for (int i = 0; i < 3; ++i) {
        PLUMB_CHECK(std::isfinite(ray.origin[i]),
                    "ray origin must be finite, got " << ray.origin[i] << " on axis " << i);
        PLUMB_CHECK(std::isfinite(ray.direction[i]),
                    "ray direction must be finite, got " << ray.direction[i] << " on axis " << i);
    }
    PLUMB_CHECK(ray.direction != Vec3{Real(0)}, "ray direction must not be zero, got (0, 0, 0)");
    PLUMB_CHECK(!std::isnan(ray.max_t), "ray max_t must be a number, got " << ray.max_t);
}

void check_point(const Vec3 &point) {
    for (int i = 0; i < 3; ++i)
        PLUMB_CHECK(!std::isnan(point[i]),
                    "point must have no NaN, got " << point[i] << " on axis " << i);
}

// The direction divided by its largest component, so that its square neither overflows nor
// vanishes. Parameters along it are `scale` times those of the ray.
struct ScaledDirection {
    Vec3 direction{Real(0)};
    Real scale = Real(1);
};

ScaledDirection scaled(const Vec3 &direction) {
    const Real scale =
        std::max({std::abs(direction.x), std::abs(direction.y), std::abs(direction.z)});
    return {direction / scale, scale};
}

// A stretch of the whole line, before it is cut to the ray.
struct Stretch {
    Real enter = infinity;
    Real exit = -infinity;
    Vec3 outward{Real(0)}; // the outward direction at enter, of any length

    bool is_empty() const { return !(enter <= exit); }
};

// The line m -> t * d against a ball, or a cylinder when m and d are perpendicular to its axis; m
// leads from the line's origin to the centre. From the point of closest approach, so that what is
// squared is of the size of the radius, not of the distance to the origin.
Stretch through_round(const Vec3 &m, const Vec3 &d, Real radius) {
    const Real squared = glm::dot(d, d);
    const Real middle = glm::dot(m, d) / squared;
    const Vec3 to_center = m - middle * d;
    const Real rest = radius * radius - glm::dot(to_center, to_center);
    if (!(rest >= Real(0)))
        return {};
    const Real half = std::sqrt(rest / squared);
    Vec3 outward = -to_center - half * d;
    if (outward == Vec3{Real(0)})
        outward = -d; // radius zero
    return {middle - half, middle + half, outward};
}

// Cuts a stretch to the ray. `starts_inside` is decided by the origin alone.
std::optional<RayInterval> cut(const Stretch &stretch, Real scale, bool starts_inside, Real max_t) {
    RayInterval interval;
    if (starts_inside) {
        if (!(max_t >= Real(0)))
            return std::nullopt;
        const Real exit = stretch.is_empty() ? Real(0) : stretch.exit / scale;
        interval.t_exit = std::clamp(exit, Real(0), max_t);
        return interval;
    }
    if (stretch.is_empty())
        return std::nullopt;
    interval.t_enter = stretch.enter / scale;
    interval.t_exit = std::min(std::max(stretch.exit / scale, interval.t_enter), max_t);
    // An origin outside cannot have the solid around it: a stretch that seems to begin behind it
    // by rounding and end before it begins at once.
    if (stretch.exit < Real(0) || !(interval.t_enter <= max_t) || interval.t_enter == infinity)
        return std::nullopt;
    interval.t_enter = std::max(interval.t_enter, Real(0));
    if (interval.t_exit < interval.t_enter)
        return std::nullopt;
    interval.enter_normal = glm::normalize(stretch.outward);
    return interval;
}

bool is_inside(const Sphere &sphere, const Vec3 &point) {
    const Vec3 d = point - sphere.center;
    return glm::dot(d, d) <= sphere.radius * sphere.radius;
}

bool is_inside(const Capsule &capsule, const Vec3 &point) {
    const Vec3 along = capsule.b - capsule.a;
    const Vec3 from_a = point - capsule.a;
    const Vec3 d = from_a - closest_parameter(Vec3{Real(0)}, along, from_a) * along;
    return glm::dot(d, d) <= capsule.radius * capsule.radius;
}

bool is_inside(const HalfSpace &half_space, const Vec3 &point) {
    return glm::dot(half_space.normal, point) <= half_space.offset;
}

bool is_inside(const Aabb &box, const Vec3 &point) {
    return point.x >= box.min.x && point.x <= box.max.x && point.y >= box.min.y &&
           point.y <= box.max.y && point.z >= box.min.z && point.z <= box.max.z;
}

// A box in a frame in which it is axis-aligned. Without rotation that is the world, with the faces
// at center -+ half_extents as the caller would compute them, so that rays in its faces are exact.
struct AlignedFrame {
    Aabb box;
    Vec3 origin{Real(0)};
    Quat to_local = identity_rotation;
    bool is_world = true;

    explicit AlignedFrame(const Box &oriented) {
        is_world = oriented.rotation.x == Real(0) && oriented.rotation.y == Real(0) &&
                   oriented.rotation.z == Real(0);
        if (is_world) {
            box = {oriented.center - oriented.half_extents,
                   oriented.center + oriented.half_extents};
        } else {
            box = {-oriented.half_extents, oriented.half_extents};
            origin = oriented.center;
            to_local = glm::conjugate(oriented.rotation);
        }
    }
    Vec3 point(const Vec3 &world) const { return is_world ? world : to_local * (world - origin); }
};

bool is_inside(const Box &box, const Vec3 &point) {
    const AlignedFrame frame(box);
    return is_inside(frame.box, frame.point(point));
}

std::optional<RayInterval> through_aligned(const Aabb &box, const Ray &ray) {
    RayInterval interval;
    int axis = -1;
    if (!slab_interval(box, ray, interval.t_enter, interval.t_exit, axis) ||
        interval.t_enter == infinity)
        return std::nullopt;
    if (axis >= 0)
        interval.enter_normal[axis] = ray.direction[axis] > Real(0) ? Real(-1) : Real(1);
    return interval;
}

} // namespace

std::optional<RayInterval> ray_interval(const Sphere &sphere, const Ray &ray) {
    check_ray(ray);
    check_valid(sphere);
    const ScaledDirection d = scaled(ray.direction);
    return cut(through_round(sphere.center - ray.origin, d.direction, sphere.radius), d.scale,
               is_inside(sphere, ray.origin), ray.max_t);
}

std::optional<RayInterval> ray_interval(const Aabb &box, const Ray &ray) {
    check_ray(ray);
    for (int i = 0; i < 3; ++i)
        PLUMB_CHECK(!std::isnan(box.min[i]) && !std::isnan(box.max[i]),
                    "box bounds must be numbers, got [" << box.min[i] << ", " << box.max[i]
                                                        << "] on axis " << i);
    if (box.min.x > box.max.x || box.min.y > box.max.y || box.min.z > box.max.z)
        return std::nullopt;
    return through_aligned(box, ray);
}

std::optional<RayInterval> ray_interval(const Box &box, const Ray &ray) {
    check_ray(ray);
    check_valid(box);
    const AlignedFrame frame(box);
    if (frame.is_world)
        return through_aligned(frame.box, ray);
    const Ray local{frame.point(ray.origin), frame.to_local * ray.direction, ray.max_t};
    std::optional<RayInterval> interval = through_aligned(frame.box, local);
    if (interval)
        interval->enter_normal = box.rotation * interval->enter_normal;
    return interval;
}

std::optional<RayInterval> ray_interval(const Capsule &capsule, const Ray &ray) {
    check_ray(ray);
    check_valid(capsule);
    const ScaledDirection d = scaled(ray.direction);
    const Vec3 to_a = capsule.a - ray.origin;
    const Vec3 to_b = capsule.b - ray.origin;

    // A capsule is two balls and the cylinder between them. It is convex, so its stretch goes from
    // the first entry to the last exit of the three.
    Stretch whole = through_round(to_a, d.direction, capsule.radius);
    const auto join = [&](const Stretch &part) {
        if (part.is_empty())
            return;
        if (part.enter < whole.enter) {
            whole.enter = part.enter;
            whole.outward = part.outward;
        }
        whole.exit = std::max(whole.exit, part.exit);
    };
    join(through_round(to_b, d.direction, capsule.radius));

    const Vec3 along = capsule.b - capsule.a;
    const Real length = glm::length(along);
    if (length > Real(0)) {
        const Vec3 axis = along / length;
        const Vec3 d_across = d.direction - axis * glm::dot(d.direction, axis);
        // A ray along the axis enters and leaves by the balls.
        constexpr Real parallel_sine = Real(8) * std::numeric_limits<Real>::epsilon();
        if (glm::dot(d_across, d_across) > parallel_sine * parallel_sine) {
            const Vec3 m_across = to_a - axis * glm::dot(to_a, axis);
            Stretch side = through_round(m_across, d_across, capsule.radius);
            if (!side.is_empty()) {
                // Only its ends that lie between the two end planes are ends of the capsule.
                const Real m_along = glm::dot(to_a, axis);
                const Real d_along = glm::dot(d.direction, axis);
                const auto is_between = [&](Real t) {
                    const Real height = t * d_along - m_along;
                    return height >= Real(0) && height <= length;
                };
                if (is_between(side.enter) && side.enter < whole.enter) {
                    whole.enter = side.enter;
                    whole.outward = side.outward;
                }
                if (is_between(side.exit))
                    whole.exit = std::max(whole.exit, side.exit);
                // With one end found here and none by the balls (a ray that enters by the side at
                // the very seam), the stretch is that point.
                if (whole.enter < infinity && whole.exit < whole.enter)
                    whole.exit = whole.enter;
                if (whole.enter == infinity && whole.exit > -infinity) {
                    whole.enter = whole.exit;
                    whole.outward = side.outward;
                }
            }
        }
    }
    return cut(whole, d.scale, is_inside(capsule, ray.origin), ray.max_t);
}

std::optional<RayInterval> ray_interval(const HalfSpace &half_space, const Ray &ray) {
    check_ray(ray);
    check_valid(half_space);
    const Real height = glm::dot(half_space.normal, ray.origin) - half_space.offset;
    const Real climb = glm::dot(half_space.normal, ray.direction);
    if (!(ray.max_t >= Real(0)))
        return std::nullopt;
    RayInterval interval;
    if (is_inside(half_space, ray.origin)) {
        interval.t_exit = ray.max_t;
        if (climb > Real(0))
            interval.t_exit = std::clamp(-height / climb, Real(0), ray.max_t);
        return interval;
    }
    if (!(climb < Real(0)))
        return std::nullopt;
    interval.t_enter = height / -climb;
    if (!(interval.t_enter <= ray.max_t) || interval.t_enter == infinity)
        return std::nullopt;
    interval.t_exit = ray.max_t;
    interval.enter_normal = half_space.normal;
    return interval;
}

std::optional<RayInterval> ray_interval(const Shape &shape, const Ray &ray) {
    return std::visit([&](const auto &solid) { return ray_interval(solid, ray); }, shape);
}

bool contains(const Shape &shape, const Vec3 &point) {
    check_point(point);
    check_valid(shape);
    return std::visit([&](const auto &solid) { return is_inside(solid, point); }, shape);
}

bool linetest(const Shape &shape, const Vec3 &a, const Vec3 &b) {
    check_point(a);
    check_point(b);
    // The ends are asked for themselves: b as origin + 1 * direction would be rounded.
    if (contains(shape, a) || contains(shape, b))
        return true;
    return a != b && ray_interval(shape, Ray{a, b - a, Real(1)}).has_value();
}

} // namespace plumb::inline PLUMB_PRECISION
