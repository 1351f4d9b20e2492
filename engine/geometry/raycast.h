// Rays and segments against solid shapes.
#pragma once

#include "engine/geometry/shapes.h"

#include <optional>

namespace plumb::inline PLUMB_PRECISION {

// The closed interval of the ray's parameter inside a solid, cut to [0, max_t].
struct RayInterval {
    Real t_enter = Real(0);
    Real t_exit = Real(0);
    Vec3 enter_normal{Real(0)}; // outward unit normal at t_enter; zero when the ray starts inside
};

// Empty when ray and solid have no common point. A ray that touches in one point gives
// t_enter == t_exit. Starting inside (or on the surface, going in) gives t_enter == 0. A zero or
// non-finite direction, or a NaN anywhere, fails a check.
std::optional<RayInterval> ray_interval(const Sphere &sphere, const Ray &ray);
std::optional<RayInterval> ray_interval(const Box &box, const Ray &ray);
std::optional<RayInterval> ray_interval(const Aabb &box, const Ray &ray);
std::optional<RayInterval> ray_interval(const Capsule &capsule, const Ray &ray);
std::optional<RayInterval> ray_interval(const HalfSpace &half_space, const Ray &ray);
std::optional<RayInterval> ray_interval(const Shape &shape, const Ray &ray);

struct RayHit {
    Real t = Real(0);
    Vec3 point{Real(0)};
    Vec3 normal{Real(0)};       // zero when started inside
    bool starts_inside = false; // then t == 0 and point == origin
};

// The first point of the solid on the ray.
template <typename Solid> std::optional<RayHit> raycast(const Solid &solid, const Ray &ray) {
    const std::optional<RayInterval> inside = ray_interval(solid, ray);
    if (!inside)
        return std::nullopt;
    return RayHit{inside->t_enter, ray.origin + inside->t_enter * ray.direction,
                  inside->enter_normal, inside->enter_normal == Vec3{Real(0)}};
}

// Whether the segment from a to b has a point in the solid. A segment wholly inside does.
// a == b asks whether that point is inside.
bool linetest(const Shape &shape, const Vec3 &a, const Vec3 &b);

// Whether a point lies in the solid (surface included).
bool contains(const Shape &shape, const Vec3 &point);

} // namespace plumb::inline PLUMB_PRECISION
