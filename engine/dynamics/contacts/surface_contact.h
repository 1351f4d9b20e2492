// Contacts of solids with the triangles of a surface.
#pragma once

#include "engine/geometry/manifold.h"
#include "engine/space/triangle_surface.h"

namespace plumb::inline PLUMB_PRECISION {

// Whether the middle of a solid with those bounds is behind the triangle's plane.
bool is_behind(const Aabb &solid, const Triangle &triangle);

// The contact of a convex solid (a) with one triangle (b), by its index, of a surface that is
// placed by `pose`: none beyond the margin (>= 0, m), none for a flat triangle or a half-space.
//
// A surface that is solid on its front lets what has its middle behind pass, and pushes all else to
// the front. Where the solid meets an edge or corner over which the surface is flat or hollow, or
// leans beyond the neighbour's normal at a ridge, the normal is the face's: so what slides or rolls
// over a seam does not stumble (Ericson, Real-Time Collision Detection, 2005, section 5.1.5, has
// the Voronoi regions that this decides by). What has come down on a ridge is held there, by the
// face's normal, though its deepest point lies beyond.
Manifold collide(const Shape &solid, const TriangleSurface &surface, const Transform &pose,
                 std::uint32_t index, Real margin);

} // namespace plumb::inline PLUMB_PRECISION
