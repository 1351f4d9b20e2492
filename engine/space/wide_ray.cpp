#include "engine/math/constants.h"
#include "engine/space/wide_raycast.h"

#include "engine/geometry/raycast.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include <glm/gtc/type_ptr.hpp>

namespace plumb::inline PLUMB_PRECISION {

WideRay wide_ray(const Ray &ray, const Aabb &bounds) {
    // No branches on signs or sizes: with rays in all directions they are mispredicted.
    WideRay result;
    result.given = ray;
    const Real *const direction = glm::value_ptr(ray.direction);
    const Real *const origin = glm::value_ptr(ray.origin);
    const Real *const lowest = glm::value_ptr(bounds.min);
    const Real *const highest = glm::value_ptr(bounds.max);
    const Real sizes[3] = {std::abs(direction[0]), std::abs(direction[1]), std::abs(direction[2])};
    std::size_t main_axis = sizes[1] > sizes[0] ? 1 : 0;
    main_axis = sizes[2] > sizes[main_axis] ? 2 : main_axis;
    static constexpr std::array<std::size_t, 3> axes[3] = {{1, 2, 0}, {2, 0, 1}, {0, 1, 2}};
    result.axes = axes[main_axis];
    // The power of two that brings the main component to between 1 and 2.
    const std::uint64_t exponent = std::bit_cast<std::uint64_t>(double(sizes[main_axis])) >> 52;
    const double scale = std::bit_cast<double>((2046 - exponent) << 52);
    result.time_scale = scale;
    result.max_time = static_cast<Real>(double(ray.max_t) * std::bit_cast<double>(exponent << 52));

    // Large enough that squared rounding errors do not vanish.
    Real reach = Real(1e-9);
    for (std::size_t i = 0; i < 3; ++i)
        reach = std::max(reach, std::max(highest[i] - origin[i], origin[i] - lowest[i]));
    result.reach = reach;

    // Any box the ray enters is entered by time `reach`, so there (bound - origin) * inverse is off
    // by at most 1.5 epsilon reach. The origins are shifted by more than that, even after the shift
    // is rounded. Along a zero or tiny component the ray travels less than its origin is shifted,
    // so 2^-60 can stand in for it, which keeps everything finite.
    constexpr Real least = Real(0x1p-60);
    for (std::size_t i = 0; i < 3; ++i) {
        result.origin[i] = origin[i];
        result.direction[i] = double(direction[i]) * scale;
        const Real component = static_cast<Real>(result.direction[i]);
        const Real size = std::max(std::abs(component), least);
        const Real shift = std::copysign(
            Real(4) * (epsilon * size + least) * reach + epsilon * std::abs(origin[i]), component);
        result.enter_origin[i] = origin[i] + shift;
        result.leave_origin[i] = origin[i] - shift;
        result.inverse[i] = Real(1) / std::copysign(size, component);
        result.enter_side[i] = std::signbit(component) ? 1 : 0;
    }
    return result;
}

namespace {

// Clamps a hit's time to the interval in which the ray is in the triangle's own box, using the same
// operations as for the boxes around it, so no box is skipped whose triangle is hit before another.
Real within_box(const WideRay &ray, const Triangle &triangle, double time) {
    const Real *const a = glm::value_ptr(triangle.a);
    const Real *const b = glm::value_ptr(triangle.b);
    const Real *const c = glm::value_ptr(triangle.c);
    Real enter = Real(0);
    Real leave = std::numeric_limits<Real>::infinity();
    for (std::size_t i = 0; i < 3; ++i) {
        const Real lowest = std::min(std::min(a[i], b[i]), c[i]);
        const Real highest = std::max(std::max(a[i], b[i]), c[i]);
        const bool is_backward = ray.enter_side[i] != 0;
        const Real near = is_backward ? highest : lowest;
        const Real far = is_backward ? lowest : highest;
        enter = std::max(enter, (near - ray.enter_origin[i]) * ray.inverse[i]);
        leave = std::min(leave, (far - ray.leave_origin[i]) * ray.inverse[i]);
    }
    return std::max(std::min(static_cast<Real>(time), leave), enter);
}

// For signs that rounding leaves undecided.
bool meets_exactly(const WideRay &ray, const Triangle &triangle, Real &time) {
    const std::optional<RayHit> hit = raycast(triangle, {ray.given.origin, ray.given.direction});
    if (!hit)
        return false;
    time = within_box(ray, triangle, double(hit->t) / ray.time_scale);
    return true;
}

} // namespace

bool meets(const WideRay &ray, const Triangle &triangle, Real &time, std::array<double, 3> &edges) {
    // Sheared so that the ray is the third axis (Woop, Benthin, Wald 2013, section 3), and
    // multiplied by the direction's main component rather than divided, so that small integers
    // stay exact.
    const auto [i, j, k] = ray.axes;
    const double main = ray.direction[k];
    const Real *const corners[3] = {glm::value_ptr(triangle.a), glm::value_ptr(triangle.b),
                                    glm::value_ptr(triangle.c)};
    double x[3], y[3], z[3];
    double sum = 0.0;
    for (std::size_t corner = 0; corner < 3; ++corner) {
        const Real *const at = corners[corner];
        z[corner] = double(at[k]) - double(ray.origin[k]);
        x[corner] = (double(at[i]) - double(ray.origin[i])) * main - ray.direction[i] * z[corner];
        y[corner] = (double(at[j]) - double(ray.origin[j])) * main - ray.direction[j] * z[corner];
        sum += std::abs(x[corner]) + std::abs(y[corner]);
    }
    const double u = x[1] * y[2] - x[2] * y[1];
    const double v = x[2] * y[0] - x[0] * y[2];
    const double w = x[0] * y[1] - x[1] * y[0];
    const double least = std::min(std::min(u, v), w);
    const double most = std::max(std::max(u, v), w);

    // x and y are off by at most delta = 12 reach 2^-53, so an edge function by less than 1.5 sum
    // delta + 2 delta^2.
    const double delta = 0x1p-49 * double(ray.reach);
    const double error = 2.0 * delta * (sum + delta);
    if (least < -error && most > error)
        return false;
    const bool is_ahead = z[0] * main > 0.0 && z[1] * main > 0.0 && z[2] * main > 0.0;
    if (!is_ahead || !(least > error || most < -error)) {
        edges = {};
        return meets_exactly(ray, triangle, time);
    }
    const double total = u + v + w;
    time = within_box(ray, triangle, (u * z[0] + v * z[1] + w * z[2]) / (total * main));
    edges = main > 0.0 ? std::array{u, v, w} : std::array{-u, -v, -w};
    return true;
}

} // namespace plumb::inline PLUMB_PRECISION
