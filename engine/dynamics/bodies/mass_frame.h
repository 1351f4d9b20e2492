// A body's mass, and the point and axes about which it turns.
#pragma once

#include "engine/dynamics/bodies/body.h"

namespace plumb::inline PLUMB_PRECISION {

// Mass, centre of mass and principal moments of a dynamic body.
struct MassFrame {
    Real mass = Real(0);   // kg
    Transform frame;       // the identity if the colliders' own axes are principal
    Vec3 inertia{Real(0)}; // kg m^2, principal
};

// Sums the colliders' solids (mass.h) by the parallel axis theorem, in double; a body with a single
// centred shape keeps that shape's closed form and axes. Sensors weigh nothing. Fails a check if
// the mass is not positive and finite, if a collider is a half-space or a surface, or if a moment
// is not positive: a point cannot turn.
MassFrame mass_frame(const BodyDef &def);

} // namespace plumb::inline PLUMB_PRECISION
