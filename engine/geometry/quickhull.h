// The convex hull of a point set.
#pragma once

#include "engine/geometry/hull_mesh.h"

#include <optional>
#include <span>

namespace plumb::inline PLUMB_PRECISION {

// Why a point set has no solid hull.
enum class HullProblem {
    none,
    too_few_points,   // fewer than four
    not_finite,       // a NaN or an infinity among them
    all_in_one_point, // within the tolerance, as for the next two
    all_on_one_line,
    all_in_one_plane,
    out_of_range, // the volume or the inertia overflows or vanishes in Real
};

struct HullResult {
    std::optional<HullMesh> mesh; // set exactly when the problem is `none`
    HullProblem problem = HullProblem::none;
    // 3 epsilon (max |x| + max |y| + max |z|), metres: how far coordinate rounding can move
    // coplanar points off their plane, and the height below which a point outside the hull counts
    // as on it (Gregorius 2014).
    Real tolerance = Real(0);
    // How far the farthest input point is in front of a plane of the mesh, metres: at most three
    // times the tolerance, unless `max_vertices` cut the hull short.
    Real left_out = Real(0);
};

// The convex hull, with coplanar faces (within the tolerance) merged into polygons.
//
// Its vertices are input points, bit for bit, so it never extends outside the true hull. If the
// hull needs more than `max_vertices` (>= 4, or a check fails), the points farthest outside the
// current hull are added first, and the mesh stays inside the true hull; `left_out` tells by how
// much. Duplicates and points in faces, on edges or in the interior are dropped.
//
// Signs are exact (predicates.h), so no order or position of the points can tear the surface. The
// same points in the same order give the same mesh, bit for bit. Allocates: do not call it every
// frame.
HullResult convex_hull(std::span<const Vec3> points, int max_vertices);

} // namespace plumb::inline PLUMB_PRECISION
