// The contact manifolds of cylinders, convex hulls and triangles with every convex solid.
//
// As manifold.h and manifold_pairs.h say, and besides:
//
// The separation and the normal come from GJK and EPA (epa.h says how exact they are), unless the
// normal of a face that the contact is on is as good within feature_tolerance: then that is taken,
// so that what rests on a face does not waver. The face or side of the other shape that looks most
// against the normal is clipped by it (Sutherland, Hodgman 1974), and of the points within the
// margin four are kept: the deepest, and those that span the largest area with it. Two sides along
// each other (capsules, cylinders) give two points. Everything else gives one.
//
// The end of a cylinder is clipped as the octagon in its rim, whose corners are points of it: the
// area of contact is up to 10 % smaller, but the deepest point of the rim is always there. Of a
// hull face with more than 16 corners, 16 are taken, evenly. A triangle is a thin solid with two
// sides: what is behind it is pushed out to the back.
#pragma once

#include "engine/geometry/hull_mesh.h"
#include "engine/geometry/manifold_pairs.h"

namespace plumb::inline PLUMB_PRECISION {

Manifold collide_pair(const Sphere &a, const Cylinder &b, Real margin);
Manifold collide_pair(const Sphere &a, const ConvexHull &b, Real margin);
Manifold collide_pair(const Sphere &a, const Triangle &b, Real margin);
Manifold collide_pair(const Box &a, const Cylinder &b, Real margin);
Manifold collide_pair(const Box &a, const ConvexHull &b, Real margin);
Manifold collide_pair(const Box &a, const Triangle &b, Real margin);
Manifold collide_pair(const Capsule &a, const Cylinder &b, Real margin);
Manifold collide_pair(const Capsule &a, const ConvexHull &b, Real margin);
Manifold collide_pair(const Capsule &a, const Triangle &b, Real margin);
Manifold collide_pair(const Cylinder &a, const Cylinder &b, Real margin);
Manifold collide_pair(const Cylinder &a, const ConvexHull &b, Real margin);
Manifold collide_pair(const Cylinder &a, const Triangle &b, Real margin);
Manifold collide_pair(const ConvexHull &a, const ConvexHull &b, Real margin);
Manifold collide_pair(const ConvexHull &a, const Triangle &b, Real margin);
Manifold collide_pair(const Cylinder &a, const HalfSpace &b, Real margin);
Manifold collide_pair(const ConvexHull &a, const HalfSpace &b, Real margin);

} // namespace plumb::inline PLUMB_PRECISION
