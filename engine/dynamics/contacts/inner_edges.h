// Inner edges and faces, where solids that forces do not move lie flush: a tiled floor acts as one
// slab, and bodies slide or roll over its seams without catching.
#pragma once

#include "engine/geometry/manifold.h"

#include <span>
#include <variant>

namespace plumb::inline PLUMB_PRECISION {

// A solid, or one triangle of a surface, in the world, of a static or kinematic body.
using FloorPiece = std::variant<Shape, Triangle>;

// How far a free face that stands in for a covered point may be from it, in units of `flush`; all
// neighbours this near must be passed in.
inline constexpr Real near_reach = Real(200);

// How far a point is from a piece (m); 0 inside.
Real distance_to(const FloorPiece &piece, const Vec3 &point);

// The manifold of a solid (a) and a piece (b) without the points covered by other pieces near them.
// A normal is an inner one if a neighbour reaches the point and continues in front of the contact
// plane: there the pieces together are flat or concave, and nothing can rest against that edge or
// face alone. A face of the piece that is free beside the point keeps its contact (a floor at the
// foot of a wall). If no point is left, the contact with the piece's free face that the solid is
// least deep in stands in, for points over that face; else there is no contact.
//
// `flush` (> 0, m): how far apart, or out of one plane, faces may be and still count as flush.
// Points farther apart than `margin` make no contact.
Manifold without_inner_edges(const Manifold &manifold, const Shape &solid, const FloorPiece &piece,
                             std::span<const FloorPiece> neighbors, Real margin, Real flush);

} // namespace plumb::inline PLUMB_PRECISION
