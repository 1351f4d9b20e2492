// The frame in which an oriented rectangle is axis-aligned and centred.
#pragma once

#include "engine/geometry/shapes_2d.h"

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

inline Vec2 to_frame_vector(const OrientedRectangle &rectangle, const Vec2 &v) {
    return {glm::dot(v, rectangle.axis), glm::dot(v, perpendicular(rectangle.axis))};
}
inline Vec2 from_frame_vector(const OrientedRectangle &rectangle, const Vec2 &v) {
    return v.x * rectangle.axis + v.y * perpendicular(rectangle.axis);
}
inline Vec2 to_frame(const OrientedRectangle &rectangle, const Vec2 &point) {
    return to_frame_vector(rectangle, point - rectangle.center);
}

} // namespace plumb::inline PLUMB_PRECISION
