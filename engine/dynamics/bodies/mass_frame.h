// What a body weighs, and about which point and axes it turns.
#pragma once

#include "engine/dynamics/bodies/body.h"

namespace plumb::inline PLUMB_PRECISION {

// Mass, centre of mass and principal moments of a dynamic body.
struct MassFrame {
    Real mass = Real(0);   // kg
    Transform frame;       // the identity where the colliders' own axes are principal
    Vec3 inertia{Real(0)}; // kg m^2, principal
};

// Sums of the colliders' solids (mass.h) by the parallel axis theorem, in double; the body of one
// centred shape keeps that shape's closed form and axes. Sensors weigh nothing. Fails a check when
// the mass is not positive and finite, when a collider is a half-space or a surface, and when a
// moment is not positive: a point cannot turn.
MassFrame mass_frame(const BodyDef &def);

} // namespace plumb::inline PLUMB_PRECISION
