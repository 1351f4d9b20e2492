#include "engine/geometry/raycast.h"

#include "engine/geometry/aabb.h"
#include "engine/geometry/check_query.h"
#include "engine/geometry/contains.h"
#include "engine/geometry/hull_queries.h"
#include "engine/geometry/slab.h"
#include "engine/geometry/triangle_exact.h"
#include "engine/math/constants.h"
#include "engine/math/predicates.h"
#include "engine/math/rigid.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <type_traits>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

using Wide = glm::dvec3;
template <typename T> using Vector = glm::vec<3, T, glm::defaultp>;

// The greatest power of two not above |x|, so that dividing by it does not round; at least the
// smallest normal one.
Real power_of_two_in(Real x) {
    using Bits = std::conditional_t<sizeof(Real) == 4, std::uint32_t, std::uint64_t>;
    const Bits exponent = std::bit_cast<Bits>(infinity);
    return std::max(std::bit_cast<Real>(Bits(std::bit_cast<Bits>(x) & exponent)),
                    std::numeric_limits<Real>::min());
}

// A vector divided by the power of two in its largest component: exact, and its square neither
// overflows nor vanishes.
struct Scaled {
    Vec3 vector{Real(0)};
    Real scale = Real(1);

    explicit Scaled(const Vec3 &v)
        : scale(power_of_two_in(std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}))) {
        vector = v * (Real(1) / scale);
    }
};

// An interval on the infinite line, before clipping to the ray.
template <typename T> struct Stretch {
    T enter = std::numeric_limits<T>::infinity();
    T exit = -std::numeric_limits<T>::infinity();
    Vector<T> outward{T(0)}; // the outward direction at enter, of any length

    bool is_empty() const { return !(enter <= exit); }
};

// The line t * d and a ball around m. `rest` is the discriminant by Lagrange's identity, which
// squares the ball's distance from the line, not from the origin.
template <typename T> struct LineAndBall {
    Vector<T> m, d;
    T squared;
    T middle;
    T rest; // >= 0 when they meet
    bool is_point;

    LineAndBall(const Vector<T> &center, const Vector<T> &direction, T radius)
        : m(center), d(direction), squared(glm::dot(d, d)), middle(glm::dot(m, d)),
          is_point(!(radius > T(0))) {
        const Vector<T> moment = glm::cross(m, d);
        rest = radius * radius * squared - glm::dot(moment, moment);
    }
    Stretch<T> stretch() const {
        const T half = std::sqrt(rest);
        Stretch<T> stretch{(middle - half) / squared, (middle + half) / squared, Vector<T>(T(0))};
        // Computed from the line's closest point to the centre, which may be much closer than the
        // origin. A ball of radius 0 has no outward direction: the difference is only rounding.
        stretch.outward = is_point ? -d : (middle / squared * d - m) - half / squared * d;
        return stretch;
    }
};

Stretch<double> through_ball(const Wide &m, const Wide &d, double radius) {
    const LineAndBall<double> both(m, d, radius);
    return both.rest >= 0.0 ? both.stretch() : Stretch<double>{};
}

// Clips a stretch to the ray. `starts_inside` depends only on the origin.
template <typename T>
std::optional<RayInterval> cut(const Stretch<T> &stretch, Real scale, bool starts_inside,
                               Real max_t) {
    RayInterval interval;
    if (starts_inside) {
        if (!(max_t >= Real(0)))
            return std::nullopt;
        const Real exit = stretch.is_empty() ? Real(0) : Real(stretch.exit) / scale;
        interval.t_exit = std::clamp(exit, Real(0), max_t);
        return interval;
    }
    // The origin is outside, so a stretch that by rounding begins behind it and ends ahead of it
    // begins at the origin.
    if (stretch.is_empty() || stretch.exit < T(0))
        return std::nullopt;
    interval.t_enter = std::max(Real(stretch.enter) / scale, Real(0));
    if (!(interval.t_enter <= max_t) || interval.t_enter == infinity)
        return std::nullopt;
    interval.t_exit = std::min(std::max(Real(stretch.exit) / scale, interval.t_enter), max_t);
    interval.enter_normal = Vec3(glm::normalize(stretch.outward));
    return interval;
}

bool is_rotated(const Box &box) {
    return box.rotation.x != Real(0) || box.rotation.y != Real(0) || box.rotation.z != Real(0);
}

// A box without rotation, with the faces as the caller would compute them, so that rays in its
// faces are handled exactly.
Aabb aligned(const Box &box) {
    return {box.center - box.half_extents, box.center + box.half_extents};
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

// An axis, the ray's line relative to its start, and shared products. In double, where products of
// coordinates and radius do not overflow.
struct AxisAndLine {
    Wide axis;
    Wide m; // from the line's origin to the axis' start
    Wide d;
    Wide across; // d x axis
    double axis_squared;
    double across_squared; // 0 when they are parallel

    AxisAndLine(const Vec3 &a, const Vec3 &b, const Vec3 &origin, const Scaled &direction)
        : axis(Wide(b) - Wide(a)), m(Wide(a) - Wide(origin)), d(direction.vector),
          across(accurate_cross(Vec3{Real(0)}, direction.vector, a, b)),
          axis_squared(glm::dot(axis, axis)), across_squared(glm::dot(across, across)) {}

    // The line's height over the start along the axis, from 0 to axis_squared between the ends.
    double height(double t) const { return t * glm::dot(d, axis) - glm::dot(m, axis); }

    // Outward from the axis.
    Wide outward(double t) const {
        const Wide from_start = t * d - m;
        return from_start - glm::dot(from_start, axis) / axis_squared * axis;
    }
};

// The line against an infinite cylinder not parallel to it. |(t d - m) x axis| = r |axis| has the
// discriminant axis^2 (r^2 (d x axis)^2 - (m . (d x axis))^2): the distance between two lines by
// their moments, so nearly parallel lines lose no precision.
Stretch<double> through_side(const AxisAndLine &line, double radius) {
    const double volume = glm::dot(line.m, line.across);
    const double rest = radius * radius * line.across_squared - volume * volume;
    if (!(rest >= 0.0))
        return {};
    const double half = std::sqrt(line.axis_squared * rest);
    const double middle = glm::dot(glm::cross(line.m, line.axis), line.across);
    Stretch<double> stretch{(middle - half) / line.across_squared,
                            (middle + half) / line.across_squared, Wide(0.0)};
    // For radius 0 only the ray gives a direction: its component perpendicular to the axis.
    stretch.outward = radius > 0.0
                          ? line.outward(stretch.enter)
                          : glm::dot(line.d, line.axis) / line.axis_squared * line.axis - line.d;
    return stretch;
}

// A capsule is two balls and a cylinder. It is convex, so its stretch runs from the first entry to
// the last exit of the three.
Stretch<double> through_capsule(const AxisAndLine &line, double radius) {
    Stretch<double> whole = through_ball(line.m, line.d, radius);
    const auto enter_at = [&](double t, const Wide &outward) {
        if (t < whole.enter) {
            whole.enter = t;
            whole.outward = outward;
        }
    };
    const Stretch<double> other = through_ball(line.m + line.axis, line.d, radius);
    enter_at(other.enter, other.outward);
    whole.exit = std::max(whole.exit, other.exit);
    // A ray along the axis enters and leaves through the balls.
    if (!(line.across_squared > 0.0))
        return whole;
    const Stretch<double> side = through_side(line, radius);
    if (side.is_empty())
        return whole;
    // Only ends between the two end planes belong to the capsule.
    const auto is_between = [&](double t) {
        const double height = line.height(t);
        return height >= 0.0 && height <= line.axis_squared;
    };
    if (is_between(side.enter))
        enter_at(side.enter, side.outward);
    if (is_between(side.exit)) {
        whole.exit = std::max(whole.exit, side.exit);
        enter_at(side.exit, line.outward(side.exit)); // through the seam, missing both balls
    }
    if (whole.enter < std::numeric_limits<double>::infinity()) // else nothing was hit
        whole.exit = std::max(whole.exit, whole.enter);
    return whole;
}

// The line between a cylinder's two end planes.
Stretch<double> between_ends(const AxisAndLine &line) {
    const double climb = glm::dot(line.d, line.axis);
    const double start = glm::dot(line.m, line.axis); // the height of the start over the origin
    if (climb == 0.0) {
        if (start > 0.0 || start + line.axis_squared < 0.0)
            return {};
        return {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
                Wide(0.0)};
    }
    const double to_start = start / climb, to_end = (start + line.axis_squared) / climb;
    return climb > 0.0 ? Stretch<double>{to_start, to_end, -line.axis}
                       : Stretch<double>{to_end, to_start, line.axis};
}

Stretch<double> through_cylinder(const AxisAndLine &line, double radius) {
    Stretch<double> whole = between_ends(line);
    if (!(line.across_squared > 0.0)) {
        const Wide moment = glm::cross(line.m, line.axis);
        return glm::dot(moment, moment) <= radius * radius * line.axis_squared ? whole
                                                                               : Stretch<double>{};
    }
    const Stretch<double> side = through_side(line, radius);
    if (side.enter > whole.enter) {
        whole.enter = side.enter;
        whole.outward = side.outward;
    }
    whole.exit = std::min(whole.exit, side.exit);
    return whole;
}

// Closer to touching than rounding can resolve: decided by exact signs.
[[gnu::cold]] std::optional<RayInterval> through_touched(const Sphere &sphere, const Ray &ray,
                                                         const Scaled &direction) {
    const auto &[center, radius] = sphere;
    const Vec3 zero{Real(0)};
    const bool starts_inside = ball_sign(center, radius, ray.origin) >= 0;
    const int line = line_ball_sign(center, radius, ray.origin, zero, direction.vector);
    if (!starts_inside && (line < 0 || dot_sign(ray.origin, center, zero, direction.vector) < 0))
        return std::nullopt;
    LineAndBall<double> both(Wide(center) - Wide(ray.origin), Wide(direction.vector),
                             double(radius));
    both.rest = line > 0 ? std::max(both.rest, 0.0) : 0.0;
    Stretch<double> stretch = both.stretch();
    stretch.exit = std::max(stretch.exit, 0.0); // already known to be ahead
    return cut(stretch, direction.scale, starts_inside, ray.max_t);
}

} // namespace

std::optional<RayInterval> ray_interval(const Sphere &sphere, const Ray &ray) {
    check_ray(ray);
    check_valid(sphere);
    const Scaled d(ray.direction);
    const Real radius = sphere.radius;
    const LineAndBall<Real> both(sphere.center - ray.origin, d.vector, radius);
    const Vec3 &m = both.m;
    const Real away = glm::dot(m, m);
    const Real reach = radius * radius;
    // Bounds on the error from rounding and underflow in `rest` and in the origin's depth: as in
    // line_ball_sign and ball_sign (predicates.h), whose unit is half an epsilon. If the origin is
    // outside by that much and the line hits the ball, `middle` is too large for its sign to be
    // wrong: its square is at least the height over the ball times |d|^2.
    const Real e = Real(4) * epsilon * (((std::abs(m.x) + std::abs(m.y)) + std::abs(m.z)) + radius);
    const Real doubt =
        both.squared * (e * (Real(2) * radius + e)) + std::numeric_limits<Real>::min();
    const Real depth_doubt = Real(4) * epsilon * (reach + away) + std::numeric_limits<Real>::min();
    // Written so that overflow counts as doubt.
    if (!(std::abs(both.rest) > doubt && std::abs(reach - away) > depth_doubt)) [[unlikely]]
        return through_touched(sphere, ray, d);
    const bool starts_inside = away < reach;
    if (!starts_inside && (both.rest < Real(0) || both.middle < Real(0)))
        return std::nullopt;
    return cut(both.stretch(), d.scale, starts_inside, ray.max_t);
}

std::optional<RayInterval> ray_interval(const Aabb &box, const Ray &ray) {
    check_ray(ray);
    check_valid(box);
    if (is_empty(box))
        return std::nullopt;
    return through_aligned(box, ray);
}

PreparedRay::PreparedRay(const Ray &ray) : slabs_(ray) {
    check_ray(ray);
}

std::optional<RayInterval> ray_interval(const Box &box, const Ray &ray) {
    check_ray(ray);
    check_valid(box);
    if (!is_rotated(box))
        return through_aligned(aligned(box), ray);
    const Mat3 axes = rotation_matrix(box.rotation);
    const Ray local{(ray.origin - box.center) * axes, ray.direction * axes, ray.max_t};
    std::optional<RayInterval> interval =
        through_aligned({-box.half_extents, box.half_extents}, local);
    if (interval)
        interval->enter_normal = axes * interval->enter_normal;
    return interval;
}

std::optional<RayInterval> ray_interval(const Capsule &capsule, const Ray &ray) {
    check_ray(ray);
    check_valid(capsule);
    const Scaled d(ray.direction);
    const AxisAndLine line(capsule.a, capsule.b, ray.origin, d);
    return cut(through_capsule(line, double(capsule.radius)), d.scale,
               contains(capsule, ray.origin), ray.max_t);
}

std::optional<RayInterval> ray_interval(const Cylinder &cylinder, const Ray &ray) {
    check_ray(ray);
    check_valid(cylinder);
    const Scaled d(ray.direction);
    const AxisAndLine line(cylinder.a, cylinder.b, ray.origin, d);
    return cut(through_cylinder(line, double(cylinder.radius)), d.scale,
               contains(cylinder, ray.origin), ray.max_t);
}

std::optional<RayInterval> ray_interval(const HalfSpace &half_space, const Ray &ray) {
    check_ray(ray);
    check_valid(half_space);
    const Vec3 &normal = half_space.normal;
    const Real offset = half_space.offset;
    const int climb = plane_sign(normal, Real(0), ray.direction);
    const auto to_surface = [&] {
        const double height = glm::dot(Wide(normal), Wide(ray.origin)) - double(offset);
        return Real(std::max(0.0, -height / glm::dot(Wide(normal), Wide(ray.direction))));
    };
    if (!(ray.max_t >= Real(0)))
        return std::nullopt;
    RayInterval interval;
    interval.t_exit = ray.max_t;
    if (plane_sign(normal, offset, ray.origin) <= 0) {
        if (climb > 0)
            interval.t_exit = std::min(to_surface(), ray.max_t);
        return interval;
    }
    if (climb >= 0)
        return std::nullopt;
    interval.t_enter = to_surface();
    if (!(interval.t_enter <= ray.max_t) || interval.t_enter == infinity)
        return std::nullopt;
    interval.enter_normal = normal;
    return interval;
}

std::optional<RayInterval> ray_interval(const Shape &shape, const Ray &ray) {
    return std::visit([&](const auto &solid) { return ray_interval(solid, ray); }, shape);
}

std::optional<RayHit> raycast(const Plane &plane, const Ray &ray) {
    check_ray(ray);
    check_valid(plane);
    const int side = plane_sign(plane.normal, plane.offset, ray.origin);
    if (side == 0)
        return ray.max_t >= Real(0)
                   ? std::optional(RayHit{Real(0), ray.origin, Vec3{Real(0)}, true})
                   : std::nullopt;
    // To a ray from this side, the plane and everything beyond it is solid.
    const Real front = Real(side);
    return raycast(HalfSpace{front * plane.normal, front * plane.offset}, ray);
}

namespace {

// The ends are tested directly: b as origin + 1 * direction would be rounded.
template <typename Solid> bool has_point_of(const Solid &solid, const Vec3 &a, const Vec3 &b) {
    check_point(b);
    if (contains(solid, a) || contains(solid, b))
        return true;
    return a != b && ray_interval(solid, Ray{a, b - a, Real(1)}).has_value();
}

} // namespace

bool linetest(const Sphere &sphere, const Vec3 &a, const Vec3 &b) {
    check_point(b);
    if (contains(sphere, a) || contains(sphere, b))
        return true;
    const auto &[center, radius] = sphere;
    return dot_sign(a, center, a, b) > 0 && dot_sign(center, b, a, b) > 0 &&
           line_ball_sign(center, radius, a, a, b) >= 0;
}

bool linetest(const Box &box, const Vec3 &a, const Vec3 &b) {
    check_valid(box);
    if (!is_rotated(box))
        return linetest(aligned(box), a, b);
    check_point(a);
    check_point(b);
    const Mat3 axes = rotation_matrix(box.rotation);
    return segment_meets_box({(a - box.center) * axes, (b - box.center) * axes},
                             {-box.half_extents, box.half_extents});
}

bool linetest(const Aabb &box, const Vec3 &a, const Vec3 &b) {
    check_valid(box);
    check_point(a);
    check_point(b);
    return !is_empty(box) && segment_meets_box({a, b}, box);
}

bool linetest(const Capsule &capsule, const Vec3 &a, const Vec3 &b) {
    return has_point_of(capsule, a, b);
}

bool linetest(const Cylinder &cylinder, const Vec3 &a, const Vec3 &b) {
    return has_point_of(cylinder, a, b);
}

bool linetest(const HalfSpace &half_space, const Vec3 &a, const Vec3 &b) {
    check_point(b);
    return contains(half_space, a) || contains(half_space, b);
}

bool linetest(const Plane &plane, const Vec3 &a, const Vec3 &b) {
    check_valid(plane);
    check_point(a);
    check_point(b);
    return plane_sign(plane.normal, plane.offset, a) * plane_sign(plane.normal, plane.offset, b) <=
           0;
}

bool linetest(const Shape &shape, const Vec3 &a, const Vec3 &b) {
    return std::visit([&](const auto &solid) { return linetest(solid, a, b); }, shape);
}

} // namespace plumb::inline PLUMB_PRECISION
