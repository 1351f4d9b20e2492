// When two moving solids will touch, or where they come closest.
#pragma once

#include "engine/dynamics/bodies/body.h"

#include <optional>

namespace plumb::inline PLUMB_PRECISION {

// Where a body is after `t` seconds at its present velocities.
Motion ahead(const Motion &motion, Real t);

// A solid that moves with its body; the shape is in the body's mass frame.
struct MovingSolid {
    const Shape *shape = nullptr;
    Motion motion;         // at the start; the velocity is the mean over the interval
    Real extent = Real(0); // from the centre of mass to the farthest point of its core (m)
};

// The distance between two solids (m) and the unit normal from a to b; there is none at a distance
// of 0.
struct Gap {
    Real distance = Real(0);
    Vec3 normal{Real(0)};
};

struct Approach {
    Real time = Real(0);     // s, from the start
    Real distance = Real(0); // m, at that time; 0: they touch
};

// The first touch of two solids within `duration` (s), both going on at their present velocities,
// spin included. If they do not touch: where they are closest or, along the normal there, come no
// nearer than half of their distance. If they are farther apart than `margin` (m) all the time:
// some place where they are. Solids that overlap at the start touch at time 0, and solids that
// slide or roll along each other within a twentieth of the margin count as touching.
//
// By conservative advancement (shape_cast.h), with a bound on what the spins add to the approach
// speed (Mirtich 1996, 2.3), so nothing is passed through. Two half-spaces are never near each
// other. `guess`: the direction from a to b at the start, as far as it is known; `first`: the gap
// there, if it is known. They only save time.
Approach approach(const MovingSolid &a, const MovingSolid &b, Real duration, Real margin,
                  const Vec3 &guess = Vec3{Real(0)}, const std::optional<Gap> &first = {});
// The same with a triangle (in the mass frame of its body) in place of the second solid.
Approach approach(const MovingSolid &a, const Triangle &b, const Motion &motion_b, Real extent_b,
                  Real duration, Real margin, const Vec3 &guess = Vec3{Real(0)});

} // namespace plumb::inline PLUMB_PRECISION
