// The convex hull of points.
#pragma once

#include "engine/geometry/hull_mesh.h"

#include <optional>
#include <span>

namespace plumb::inline PLUMB_PRECISION {

// Why points have no solid hull.
enum class HullProblem {
    none,
    too_few_points,   // fewer than four
    not_finite,       // a NaN or an infinity among them
    all_in_one_point, // within the tolerance; likewise the next two
    all_on_one_line,
    all_in_one_plane,
    out_of_range, // the volume or the inertia overflows or vanishes in Real
};

struct HullResult {
    std::optional<HullMesh> mesh; // of value exactly when the problem is `none`
    HullProblem problem = HullProblem::none;
    // 3 epsilon (max |x| + max |y| + max |z|): what the rounding of coordinates can do to points of
    // one plane, and the height below which a point beyond the hull is taken to be on it (Gregorius
    // 2014). Metres.
    Real tolerance = Real(0);
    // How far the farthest of the points is in front of a plane of the mesh: at most three times
    // the tolerance, unless `max_vertices` cut the hull short. Metres.
    Real left_out = Real(0);
};

// The convex hull, with faces that are in one plane (within the tolerance) merged into polygons.
//
// Its vertices are some of the points, bit for bit, so it is never outside of the true hull. When
// the hull needs more than `max_vertices` (>= 4, or a check fails), those that are farthest beyond
// what there is already are taken first, and the mesh stays inside of the true hull; `left_out`
// says by how much. Any duplicates, and points in faces, edges or the inside, are left out.
//
// Signs are exact (predicates.h), so no order or place of the points can tear the surface. The same
// points in the same order give the same mesh, bit for bit. Not for each frame: it allocates.
HullResult convex_hull(std::span<const Vec3> points, int max_vertices);

} // namespace plumb::inline PLUMB_PRECISION
