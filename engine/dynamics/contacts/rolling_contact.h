// Cylinders, coins and hulls that roll on a rim or from corner to corner: their contact point runs
// round the rim much faster than they turn, and moves on within a step.
#pragma once

#include "engine/dynamics/bodies/body.h"
#include "engine/dynamics/contacts/inner_edges.h"

#include <optional>

namespace plumb::inline PLUMB_PRECISION {

// Whether one of two colliders is a cylinder.
bool has_rim(const Collider &a, const Collider &b);

// Whether a solid has faces on which the four points of a contact leave long arcs: a cylinder, or a
// hull with faces of more than six corners.
bool is_wide(const Collider &collider);

// Sine of the least angle between a cylinder's side and a plane at which it stands on a rim; below
// that the cylinder counts as round there (Contact::rounding_a).
inline constexpr Real least_rim_sine = Real(0.7);
// The same for a cylinder whose point follows the rim through the substeps.
inline constexpr Real followed_rim_sine = Real(0.1);

// The part of a surface's distance along a normal that rolling does not change: the radius of a
// ball or capsule. For a cylinder on its side, or on a rim up to 44 degrees from that, it is the
// distance from its axis along the normal. The rest of the way to the middle then lies on the axis,
// and rolling does not move it; otherwise a leaning coin would sink in as it rolls, be pushed out,
// and gain energy.
Real rounding_along(const Collider &collider, const Quat &rotation, const Vec3 &normal);

// How much lower the rim will be in the middle of a step than at the point that was lowest at
// rotation `before` (m). `now`: the solid's rotation; `half_turn`: how far it turns against the
// other body in half of the step (rad); `out`: a unit normal away from the solid. 0 without a rim:
// for other shapes, and for a cylinder that lies on its side or stands upright.
Real rolled_depth(const Shape &local, const Quat &before, const Quat &now, const Vec3 &out,
                  const Vec3 &half_turn);

// Moves a manifold's deepest point along the solid's rim to where the rim will be lowest after half
// of the solid's turn against the other in the step: `half_turn` (rad). A point that is lowest at
// the start of the step would act as a pivot: the solid would come down as it tips over it, be
// pushed up where the rim has dipped below, and gain energy. About a point that is lowest in the
// middle it goes up as far as down. Only if the solid stands on that point alone, at `least_sine`
// or more, and the other body is below the new place, too. Returns the point's feature if it moves
// and the other body is below it until the end of the step: then it can be followed.
std::optional<std::uint32_t> lead_along_rim(Manifold &manifold, const Shape &solid,
                                            const FloorPiece &other, const Vec3 &out,
                                            const Vec3 &half_turn, Real least_sine);

// Leaves out the points of a manifold within `radius` of the one with the feature, which stands for
// them as it runs round the rim. Returns its index; below 0 if there is none.
int follow_rim(Manifold &manifold, std::uint32_t feature, Real radius);
// The lowest point of the rim that the solid stands on; none where it stands on no rim.
std::optional<Vec3> lowest_on_rim(const Shape &solid, const Vec3 &out);

// How much lower a hull will be, after `turn` against the other body, than at any of a manifold's
// points (m). 0 for hulls whose faces have six corners at most, and where it stands on more than
// one point.
Real missed_depth(const Manifold &manifold, const ConvexHull &hull, const Vec3 &out,
                  const Vec3 &turn);

// Adds the corner of a hull that will be lowest after `turn` (rad) against the other body, if the
// manifold lacks it: a manifold has four corners of a many-cornered face, and a hull rolling on its
// edge would sink into the floor with the next ones. If there are four points already, it replaces
// the one farthest from touching. Only where missed_depth may be more than 0.
void add_next_corner(Manifold &manifold, const ConvexHull &hull, const FloorPiece &other,
                     const Vec3 &out, const Vec3 &turn);

} // namespace plumb::inline PLUMB_PRECISION
