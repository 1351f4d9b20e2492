// Distance or penetration of two polyhedra when one edge of each decides it: much faster than GJK
// and EPA, but needs a guess, such as the previous step's normal.
#pragma once

#include "engine/geometry/face_gap.h"

namespace plumb::inline PLUMB_PRECISION {

// As face_gap (face_gap.h), with the edges that are farthest along the guess and most across it:
// their closest points decide.
//
// If these points are apart, and the planes through them and across the way between them have each
// shape on its own side, no points of the two shapes are closer.
//
// Edges that cross inside the shapes span a face of the Minkowski difference. Its depth is that of
// the shapes unless another face is nearer to the origin. The difference contains the pyramid from
// that face to the difference of the middles, so if no side of the pyramid is nearer, nor is any
// other face. (EPA looks for the same proof, beginning with a tetrahedron that knows no edges.)
template <HasFaceGap A, HasFaceGap B>
std::optional<Proximity> edge_gap(const A &a, const B &b, const Vec3 &guess, Real far);

// By a face or, failing that, by edges.
template <HasFaceGap A, HasFaceGap B>
std::optional<Proximity> feature_gap(const A &a, const B &b, const Vec3 &guess, Real far) {
    if (const std::optional<Proximity> found = face_gap(a, b, guess, far))
        return found;
    return edge_gap(a, b, guess, far);
}

} // namespace plumb::inline PLUMB_PRECISION
