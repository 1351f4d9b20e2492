// Rays and segments against 2D shapes.
//
// An invalid shape or ray fails a check with the value in its message. A ray with a negative max_t
// hits nothing, and nothing hits an empty rectangle.
//
// Whether an infinite ray hits a Circle, Rectangle or Segment2, and `linetest` for these three, are
// exact for the inputs as given. The others are exact for small integers (up to 2^10 in float, 2^24
// in double; oriented rectangles turned by multiples of 90 degrees). Otherwise the answer may be
// wrong only if the signed distance between shape and ray is within
//   8 epsilon (distance from the ray's origin to the centre + radius or |half_extents|)
// of 0. The points at t_enter and t_exit are that close to the border; a hit on a Segment2 is
// within 8 epsilon times the largest coordinate of both. max_t is compared with the rounded
// t_enter.
#pragma once

#include "engine/geometry/shapes_2d.h"

#include <optional>

namespace plumb::inline PLUMB_PRECISION {

// The closed interval of the ray's parameter inside a solid, clipped to [0, max_t].
struct RayInterval2 {
    Real t_enter = Real(0);
    Real t_exit = Real(0);
    Vec2 enter_normal{Real(0)}; // outward unit normal at t_enter; zero when the ray starts inside
};

// Empty when the ray misses the solid. A ray that touches in one point gives t_enter == t_exit.
// Starting inside (`contains` decides) gives t_enter == 0.
std::optional<RayInterval2> ray_interval(const Circle &circle, const Ray2 &ray);
std::optional<RayInterval2> ray_interval(const Rectangle &rectangle, const Ray2 &ray);
std::optional<RayInterval2> ray_interval(const OrientedRectangle &rectangle, const Ray2 &ray);

struct RayHit2 {
    Real t = Real(0);
    Vec2 point{Real(0)};
    Vec2 normal{Real(0)};       // zero when started inside
    bool starts_inside = false; // then t == 0 and point == origin
};

// The first hit of the ray on the shape. A segment is two-sided: the normal is on the side the ray
// comes from; a ray along the segment enters at an end, with the normal against the ray. Starting
// on a segment counts as starting inside. If several parts of a compound are hit at the same t, the
// first wins.
std::optional<RayHit2> raycast(const Circle &circle, const Ray2 &ray);
std::optional<RayHit2> raycast(const Rectangle &rectangle, const Ray2 &ray);
std::optional<RayHit2> raycast(const OrientedRectangle &rectangle, const Ray2 &ray);
std::optional<RayHit2> raycast(const Compound2 &compound, const Ray2 &ray);
std::optional<RayHit2> raycast(const Segment2 &segment, const Ray2 &ray);

// Whether the segment from a to b has a point in the shape. A segment wholly inside does. a == b
// tests that point.
bool linetest(const Circle &circle, const Vec2 &a, const Vec2 &b);
bool linetest(const Rectangle &rectangle, const Vec2 &a, const Vec2 &b);
bool linetest(const OrientedRectangle &rectangle, const Vec2 &a, const Vec2 &b);
bool linetest(const Compound2 &compound, const Vec2 &a, const Vec2 &b);
bool linetest(const Segment2 &segment, const Vec2 &a, const Vec2 &b);

} // namespace plumb::inline PLUMB_PRECISION
