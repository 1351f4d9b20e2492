// Questions to convex polyhedra.
//
// A query in the world is turned into the frame of the mesh. Without rotation that is a subtraction
// of the position, exact for coordinates such as small integers; otherwise it rounds, by a few
// epsilon times the distance from the position.
#pragma once

#include "engine/geometry/hull_mesh.h"
#include "engine/geometry/plane.h"
#include "engine/geometry/raycast.h"

#include <optional>

namespace plumb::inline PLUMB_PRECISION {

// The smallest axis-aligned box around the hull's vertices as placed in the world.
Aabb bounds(const ConvexHull &hull);

// --- For pair tests: the mesh in its own frame. In hot code, so nothing is checked but in debug
// builds: the direction must be finite; zero gives some vertex (face).

// The vertex farthest along a direction of any length: the first of the greatest dot products as
// they are rounded.
std::uint32_t support_vertex(const HullMesh &mesh, const Vec3 &direction);
// The same with a vertex to start from, such as the last answer for a similar direction: climbs
// along edges. The vertex it gives is as far as the farthest within mesh.slack.
std::uint32_t support_vertex(const HullMesh &mesh, const Vec3 &direction, std::uint32_t start);
// The face whose outward normal has the greatest dot product with the direction; the first of
// equals.
std::uint32_t supporting_face(const HullMesh &mesh, const Vec3 &direction);
// Whether a point is at most `height` (m) above the plane of every other face; where `height` is
// that above `face`, whether this is the nearest of a point inside.
bool is_nearest_face(const HullMesh &mesh, std::uint32_t face, const Vec3 &point, Real height);

// The point of the hull in the world that is farthest along a direction in the world: a vertex.
Vec3 support(const ConvexHull &hull, const Vec3 &direction);

// --- Points and planes. A point that is not finite fails a check.

// In the following, `doubt` is mesh.slack and 8 epsilon times (|x| + |y| + |z| in the frame of the
// mesh, and the same of its farthest vertex): how much the height of a point above a face may be
// misjudged by rounding. With rotation, the rounding into that frame is to be added.

// Exact for a hull without rotation whose faces are exactly flat (mesh.has_flat_faces), when point
// - position is exact. Elsewhere right but where the greatest height above a face is within the
// doubt of zero.
bool contains(const ConvexHull &hull, const Vec3 &point);

// The point of the solid that is closest; a point inside is its own answer, bit for bit. It is in
// the solid, and as close as the closest, within the doubt.
Vec3 closest_point(const ConvexHull &hull, const Vec3 &point);

// On which side of the plane the hull is, and the distance (plane.h). Right where it is farther
// from touching than the doubt.
PlaneTest classify(const Plane &plane, const ConvexHull &hull);

// --- Rays and segments.

// As for the other solids (raycast.h). Closed: a ray through an edge or a corner is never lost
// between two faces. Where ray.origin and ray.direction are exact in the frame of the mesh, and its
// faces exactly flat, hit or miss is exact but for the comparison of t_enter with max_t. Elsewhere
// wrong only for rays whose distance from touching is within the doubt: those of a mesh that is not
// turned and has a face that is not flat hit, and of others either. The points at t_enter and
// t_exit are on the surface within twice the doubt.
std::optional<RayInterval> ray_interval(const ConvexHull &hull, const Ray &ray);

// Whether the segment from a to b has a point in the hull. One wholly inside does; a == b asks
// whether that point is inside. Exact where a - position and b - position are exact in the frame of
// the mesh, and its faces exactly flat: a segment that crosses an edge or touches a corner meets.
// Elsewhere as right as ray_interval.
bool linetest(const ConvexHull &hull, const Vec3 &a, const Vec3 &b);

} // namespace plumb::inline PLUMB_PRECISION
