// Volume and moments of inertia of solid shapes.
#pragma once

#include "engine/geometry/shapes.h"

namespace plumb::inline PLUMB_PRECISION {

Real volume(const Shape &shape); // m^3; infinite for a half-space

// Principal moments of inertia (kg m^2) about the centre of mass for a solid of that mass (kg) and
// uniform density, in the shape's own principal frame: the local axes for a Box and a Sphere; for a
// Capsule, y is along its axis. A half-space has none: fails a check.
Vec3 principal_inertia(const Shape &shape, Real mass);

} // namespace plumb::inline PLUMB_PRECISION
