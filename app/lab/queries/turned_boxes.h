// Arbitrarily rotated boxes for charted queries, judged in long double with a margin.
#pragma once

#include "app/lab/queries/query_case.h"
#include "engine/core/random.h"
#include "engine/geometry/shapes.h"

#include <optional>

namespace plumb {

// Empty if the answer is within the margin of error.
std::optional<bool> truth_of(const Box &box, const Vec3 &origin, const Vec3 &along,
                             long double max_t);
std::optional<bool> truth_of(const Box &box_a, const Box &box_b);

// A rotation close to `q`.
Quat nearby(Random &random, const Quat &q);

// Two boxes in edge-edge configuration, the closest edges at right angles.
Pair<Box, Box> edge_on_edge(Random &random);

} // namespace plumb
