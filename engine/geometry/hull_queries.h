// Queries on convex polyhedra.
//
// World queries are transformed into the mesh's frame. Without rotation that only subtracts the
// position, which is exact for coordinates such as small integers; otherwise it rounds by a few
// epsilon times the distance from the position.
#pragma once

#include "engine/geometry/hull_mesh.h"
#include "engine/geometry/plane.h"
#include "engine/geometry/raycast.h"

#include <optional>

namespace plumb::inline PLUMB_PRECISION {

// The smallest axis-aligned box around the hull's vertices as placed in the world.
Aabb bounds(const ConvexHull &hull);

// --- For pair tests: the mesh in its own frame. Hot code, so only debug builds check anything: the
// direction must be finite; zero gives some vertex (face).

// The vertex farthest along a direction of any length: the first with the greatest rounded dot
// product.
std::uint32_t support_vertex(const HullMesh &mesh, const Vec3 &direction);
// The same by hill climbing along edges from `start`, such as the last answer for a similar
// direction. The result is within mesh.slack of the farthest vertex.
std::uint32_t support_vertex(const HullMesh &mesh, const Vec3 &direction, std::uint32_t start);
// The face whose outward normal has the greatest dot product with the direction; the first if tied.
std::uint32_t supporting_face(const HullMesh &mesh, const Vec3 &direction);
// Whether the point is at most `height` (m) above the plane of every face except `face`. If
// `height` is the height of an inside point above `face`, this tells whether `face` is the nearest
// face.
bool is_nearest_face(const HullMesh &mesh, std::uint32_t face, const Vec3 &point, Real height);

// The hull's vertex farthest along a direction, both in world space.
Vec3 support(const ConvexHull &hull, const Vec3 &direction);

// --- Points and planes. A non-finite point fails a check.

// Below, `doubt` bounds the rounding error of a point's height above a face: mesh.slack plus 8
// epsilon times (|x| + |y| + |z| of the point in the mesh's frame, plus the same for the mesh's
// farthest vertex). With rotation, add the rounding of the transform into that frame.

// Exact for a hull without rotation whose faces are exactly flat (mesh.has_flat_faces), if point -
// position is exact. Otherwise wrong only if the greatest height above a face is within the doubt
// of zero.
bool contains(const ConvexHull &hull, const Vec3 &point);

// The closest point of the solid; an inside point is returned bit for bit. The result is in the
// solid and as close as the true closest point, within the doubt.
Vec3 closest_point(const ConvexHull &hull, const Vec3 &point);

// Which side of the plane the hull is on, and its distance (plane.h). The side is right if the hull
// is farther from touching than the doubt.
PlaneTest classify(const Plane &plane, const ConvexHull &hull);

// --- Rays and segments.

// As for the other solids (raycast.h). Closed: a ray through an edge or corner never slips between
// two faces. If ray.origin and ray.direction are exact in the mesh's frame, and its faces are
// exactly flat, hit or miss is exact except for comparing t_enter with max_t. Otherwise the result
// may be wrong only for rays within the doubt of touching: they hit an unrotated mesh that has a
// non-flat face, and may hit or miss any other. The points at t_enter and t_exit are on the surface
// within twice the doubt.
std::optional<RayInterval> ray_interval(const ConvexHull &hull, const Ray &ray);

// Whether the segment from a to b has a point in the hull. A segment wholly inside does; a == b
// tests that point. Exact if a - position and b - position are exact in the mesh's frame and its
// faces are exactly flat: a segment that crosses an edge or touches a corner hits. Otherwise as
// reliable as ray_interval.
bool linetest(const ConvexHull &hull, const Vec3 &a, const Vec3 &b);

} // namespace plumb::inline PLUMB_PRECISION
