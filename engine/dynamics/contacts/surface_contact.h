// Contacts of solids with the triangles of a surface.
#pragma once

#include "engine/geometry/manifold.h"
#include "engine/space/triangle_surface.h"

namespace plumb::inline PLUMB_PRECISION {

// Whether the middle of a solid with these bounds is behind the triangle's plane.
bool is_behind(const Aabb &solid, const Triangle &triangle);

// The contact of a convex solid (a) with triangle `index` (b) of a surface placed by `pose`: none
// beyond the margin (>= 0, m), none for a degenerate triangle or a half-space.
//
// A surface that is solid on its front lets solids pass whose middle is behind it, and pushes all
// others to the front. Where the solid meets an edge or corner over which the surface is flat or
// concave, or leans beyond the neighbour's normal at a ridge, the normal is the face's, so that
// nothing stumbles as it slides or rolls over a seam (Ericson, Real-Time Collision Detection, 2005,
// section 5.1.5, has the Voronoi regions that this decides by). A solid that has come down on a
// ridge is held there by the face's normal, even if its deepest point lies beyond. `load`: as for
// collide_under; null: unknown.
Manifold collide(const Shape &solid, const TriangleSurface &surface, const Transform &pose,
                 std::uint32_t index, Real margin, const Vec3 *load = nullptr);

// The contact of a solid whose middle is inside a surface that is solid: at the nearest place on
// that surface, as deep as the solid's farthest point is behind it. None for any other solid.
Manifold collide_inside(const Shape &solid, const TriangleSurface &surface, const Transform &pose);

} // namespace plumb::inline PLUMB_PRECISION
