// The smallest circle and the smallest axis-aligned rectangle around 2D points.
#pragma once

#include "engine/geometry/shapes_2d.h"

#include <span>

namespace plumb::inline PLUMB_PRECISION {

// `contains` reports every given point inside the circle. Its radius exceeds the minimum by
// rounding only: at most 8 epsilon (radius + largest coordinate). Duplicates, collinear points and
// points on one circle are fine. No points, or a non-finite one, fails a check.
Circle containing_circle(std::span<const Vec2> points);

// Exact. No points, or a non-finite one, fails a check.
Rectangle containing_rectangle(std::span<const Vec2> points);

} // namespace plumb::inline PLUMB_PRECISION
