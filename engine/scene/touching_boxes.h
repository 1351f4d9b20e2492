// Finds touching pairs among many AABBs, in double precision. Not for users of the engine.
#pragma once

#include "engine/scene/shape_desc.h"

#include <cstddef>
#include <functional>
#include <span>

namespace plumb {

// Calls visit(i, j) for each pair of boxes i > j with a common point, ascending by i, then j, until
// it returns false. Coordinates must be finite and at most 1e15 in magnitude.
void for_touching_boxes(std::span<const BoundsDesc> boxes,
                        const std::function<bool(std::size_t, std::size_t)> &visit);

} // namespace plumb
