// Measures of a scene's shapes, in double precision.
#pragma once

#include "engine/scene/scene_desc.h"

namespace plumb {

double volume(const ShapeDesc &shape); // m^3; infinite for a plane

// The smallest distance between two parallel planes that hold the shape between them (m); infinite
// for a plane.
double smallest_width(const ShapeDesc &shape);

// Half the sides of the axis-aligned box around the turned shape (m); infinite for a plane.
glm::dvec3 half_bounds(const ShapeDesc &shape, const glm::dquat &orientation);

} // namespace plumb
