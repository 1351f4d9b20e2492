// Boxes turned at will, for charted queries: judged in long double, with a margin.
#pragma once

#include "app/lab/queries/query_case.h"
#include "engine/core/random.h"
#include "engine/geometry/shapes.h"

#include <optional>

namespace plumb {

// Empty when a margin decides.
std::optional<bool> truth_of(const Box &box, const Vec3 &origin, const Vec3 &along,
                             long double max_t);
std::optional<bool> truth_of(const Box &box_a, const Box &box_b);

// Nearly as another is turned.
Quat nearby(Random &random, const Quat &q);

// Two boxes that an edge of each parts: nearest to each other along edges at right angles.
Pair<Box, Box> edge_on_edge(Random &random);

} // namespace plumb
