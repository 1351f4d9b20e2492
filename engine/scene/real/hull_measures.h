// Measures of the convex hull of points.
#pragma once

#include "engine/core/precision.h"

#include <span>

#include <glm/vec3.hpp>

namespace plumb {

struct HullMeasures {
    bool is_solid = false;     // else the others are 0
    double volume = 0;         // m^3
    double smallest_width = 0; // m, between parallel planes
};

} // namespace plumb

namespace plumb::inline PLUMB_PRECISION {

// The most vertices that a scene's hull may have; see convex_hull.
inline constexpr int max_hull_vertices = 256;

HullMeasures measure_hull(std::span<const glm::dvec3> points);

} // namespace plumb::inline PLUMB_PRECISION
