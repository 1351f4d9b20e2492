// Rays and segments against shapes of the plane.
//
// A shape or ray that is not valid fails a check with the value in its message. A ray with a
// negative max_t, and an empty rectangle, meet nothing.
//
// Whether an endless ray meets a Circle, a Rectangle or a Segment2, and `linetest` of the three, is
// answered exactly, for the numbers as they are given. The others are exact for small integers (up
// to 2^10 in float, 2^24 in double; an oriented rectangle turned by quarters). Elsewhere the answer
// may be wrong only where the signed distance of shape and ray is within
//   8 epsilon (distance from the ray's origin to the centre + radius or |half_extents|)
// of 0, and the points at t_enter and t_exit are that near to the border; a hit on a Segment2 is
// within 8 epsilon times the largest coordinate of both. max_t is compared with the rounded
// t_enter.
#pragma once

#include "engine/geometry/shapes_2d.h"

#include <optional>

namespace plumb::inline PLUMB_PRECISION {

// The closed interval of the ray's parameter inside a solid, cut to [0, max_t].
struct RayInterval2 {
    Real t_enter = Real(0);
    Real t_exit = Real(0);
    Vec2 enter_normal{Real(0)}; // outward unit normal at t_enter; zero when the ray starts inside
};

// Empty when ray and solid have no common point. A ray that touches in one point gives
// t_enter == t_exit. Starting inside (`contains` decides) gives t_enter == 0.
std::optional<RayInterval2> ray_interval(const Circle &circle, const Ray2 &ray);
std::optional<RayInterval2> ray_interval(const Rectangle &rectangle, const Ray2 &ray);
std::optional<RayInterval2> ray_interval(const OrientedRectangle &rectangle, const Ray2 &ray);

struct RayHit2 {
    Real t = Real(0);
    Vec2 point{Real(0)};
    Vec2 normal{Real(0)};       // zero when started inside
    bool starts_inside = false; // then t == 0 and point == origin
};

// The first point of the shape on the ray. A segment has two faces: the normal is on the side that
// the ray comes from; a ray along the segment enters by an end, with the normal against the ray.
// Starting on a segment is starting inside. Of parts of a compound that are hit at once, the first.
std::optional<RayHit2> raycast(const Circle &circle, const Ray2 &ray);
std::optional<RayHit2> raycast(const Rectangle &rectangle, const Ray2 &ray);
std::optional<RayHit2> raycast(const OrientedRectangle &rectangle, const Ray2 &ray);
std::optional<RayHit2> raycast(const Compound2 &compound, const Ray2 &ray);
std::optional<RayHit2> raycast(const Segment2 &segment, const Ray2 &ray);

// Whether the segment from a to b has a point in the shape. A segment wholly inside does.
// a == b asks whether that point is inside.
bool linetest(const Circle &circle, const Vec2 &a, const Vec2 &b);
bool linetest(const Rectangle &rectangle, const Vec2 &a, const Vec2 &b);
bool linetest(const OrientedRectangle &rectangle, const Vec2 &a, const Vec2 &b);
bool linetest(const Compound2 &compound, const Vec2 &a, const Vec2 &b);
bool linetest(const Segment2 &segment, const Vec2 &a, const Vec2 &b);

} // namespace plumb::inline PLUMB_PRECISION
