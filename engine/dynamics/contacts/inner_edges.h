// Edges and faces where static solids lie flush against each other: a floor of tiles is as one
// slab, and what slides or rolls over a seam meets nothing there.
#pragma once

#include "engine/geometry/manifold.h"

#include <span>
#include <variant>

namespace plumb::inline PLUMB_PRECISION {

// A static solid, or one triangle of a static surface, in the world.
using StaticPiece = std::variant<Shape, Triangle>;

// How far from a covered point a free face may be that stands for it, in units of `flush`; the
// neighbours of all that is so near are asked for.
inline constexpr Real near_reach = Real(200);

// How far a point is from a piece (m); 0 inside.
Real distance_to(const StaticPiece &piece, const Vec3 &point);

// The manifold of a solid (a) and a piece (b) without what other pieces, which are near its points,
// cover. A normal is an inner one where a neighbour reaches the point and goes on in front of the
// plane of contact: there the pieces together are flat or hollow, and nothing can rest against that
// edge or face alone. A face of the piece that is free beside the point keeps its contact (a floor
// at the foot of a wall). Where no point is left, the contact of the piece's free face that the
// solid is least deep in stands for it, for points over that face; else there is none.
//
// `flush` (> 0, m): how far faces may be from each other, or out of one plane, to count as flush.
// Points farther apart than `margin` make no contact.
Manifold without_inner_edges(const Manifold &manifold, const Shape &solid, const StaticPiece &piece,
                             std::span<const StaticPiece> neighbors, Real margin, Real flush);

} // namespace plumb::inline PLUMB_PRECISION
