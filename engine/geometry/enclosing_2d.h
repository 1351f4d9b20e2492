// The smallest circle and the smallest axis-aligned rectangle around points of the plane.
#pragma once

#include "engine/geometry/shapes_2d.h"

#include <span>

namespace plumb::inline PLUMB_PRECISION {

// Every given point is in the circle, as `contains` answers, and its radius is the least but for
// rounding: at most 8 epsilon (radius + largest coordinate) more. Duplicates, points on one line
// and points on one circle are as good as any. No points, or one that is not finite, fail a check.
Circle containing_circle(std::span<const Vec2> points);

// Exact. No points, or one that is not finite, fail a check.
Rectangle containing_rectangle(std::span<const Vec2> points);

} // namespace plumb::inline PLUMB_PRECISION
