// Cylinders, coins and hulls that roll on a rim or from corner to corner: the place they stand on
// runs round the rim much faster than they turn, and within a step it is not where it was.
#pragma once

#include "engine/dynamics/bodies/body.h"
#include "engine/dynamics/contacts/inner_edges.h"

#include <span>

namespace plumb::inline PLUMB_PRECISION {

// Whether one of two colliders is a cylinder.
bool has_rim(const Collider &a, const Collider &b);
// Whether contact points (in the body's mass frame) lie on the rim of a cylinder, or on a hull with
// faces of more than six corners: the patch inside them is about a disc.
bool is_round_patch(const Collider &collider, std::span<const Vec3> points);

// Sine of the least angle between a cylinder's side and a plane at which it stands on a rim; below
// it the cylinder is round there (Contact::rounding_a).
inline constexpr Real least_rim_sine = Real(0.8);

// How much lower a rim will be in the middle of a step than at the place where it was lowest with
// the solid turned as in `before` (m); `now`: where the solid is; `half_turn`: what it goes through
// in half of the step against the other (rad). 0 where no rim is: of other shapes, of a cylinder
// that lies on its side, and of one that stands upright. `out`: a unit normal away from the solid.
Real rolled_depth(const Shape &local, const Quat &before, const Quat &now, const Vec3 &out,
                  const Vec3 &half_turn);

// Moves the deepest point of a manifold along the solid's rim, to where the rim will be lowest when
// the solid has gone through half of its way against the other in the step: `half_turn` (rad). A
// point that is lowest at the start of the step would be one to pivot on: the solid would come down
// as it tips over it, be pushed up where the rim has come below, and gain energy by that. About a
// point that is lowest in the middle it goes up as far as down. Only where it stands on that point
// alone, and the other is below the new place, too.
void lead_along_rim(Manifold &manifold, const Shape &solid, const StaticPiece &other,
                    const Vec3 &out, const Vec3 &half_turn);

// How much lower a hull will be, when it has gone through `turn` against the other, than at any of
// a manifold's points (m). 0 for hulls whose faces have six corners at most, and where it stands on
// more than one point.
Real missed_depth(const Manifold &manifold, const ConvexHull &hull, const Vec3 &out,
                  const Vec3 &turn);

// Adds the corner of a hull that will be lowest when it has gone through `turn` (rad) against the
// other, where the manifold does not have it: of a face of many corners it has four, and what rolls
// on its edge would go through the floor with the next ones. In place of the point that is farthest
// from touching, if there are four. Only where the depth above may be more than 0.
void add_next_corner(Manifold &manifold, const ConvexHull &hull, const StaticPiece &other,
                     const Vec3 &out, const Vec3 &turn);

} // namespace plumb::inline PLUMB_PRECISION
