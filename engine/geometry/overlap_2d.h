// Whether two shapes of the plane have a common point, and how deep.
//
// All sets are closed: shapes that touch overlap. A shape that is not valid fails a check with the
// value in its message; an empty rectangle overlaps nothing.
//
// Segments and Rectangle with Rectangle are answered exactly, for the numbers as they are given.
// The others are exact for small integers (up to 2^9 in float, 2^23 in double; oriented rectangles
// turned by quarters). Elsewhere the answer may be wrong only for shapes whose signed distance is
// within this of 0 (r radius, h half extents; axes a rounding off unit length):
//   Circle, Circle                            2 epsilon (r_a + r_b)
//   Circle, Rectangle                         2 epsilon r
//   Circle, OrientedRectangle                 4 epsilon (r + |h|)
//   Rectangle or OrientedRectangle, Oriented  8 epsilon (|h_a| + |h_b|)
//   Compound2                                 as its parts
#pragma once

#include "engine/geometry/shapes_2d.h"

#include <optional>

namespace plumb::inline PLUMB_PRECISION {

bool overlaps(const Circle &a, const Circle &b);
bool overlaps(const Circle &circle, const Rectangle &rectangle);
bool overlaps(const Circle &circle, const OrientedRectangle &rectangle);
bool overlaps(const Rectangle &a, const Rectangle &b);
bool overlaps(const Rectangle &a, const OrientedRectangle &b);
bool overlaps(const OrientedRectangle &a, const OrientedRectangle &b);
bool overlaps(const Compound2 &compound, const Circle &circle);
bool overlaps(const Compound2 &compound, const Rectangle &rectangle);
bool overlaps(const Compound2 &compound, const OrientedRectangle &rectangle);
bool overlaps(const Compound2 &a, const Compound2 &b);
bool overlaps(const Segment2 &a, const Segment2 &b);

// The same asked the other way around.
inline bool overlaps(const Rectangle &a, const Circle &b) {
    return overlaps(b, a);
}
inline bool overlaps(const OrientedRectangle &a, const Circle &b) {
    return overlaps(b, a);
}
inline bool overlaps(const OrientedRectangle &a, const Rectangle &b) {
    return overlaps(b, a);
}
inline bool overlaps(const Circle &a, const Compound2 &b) {
    return overlaps(b, a);
}
inline bool overlaps(const Rectangle &a, const Compound2 &b) {
    return overlaps(b, a);
}
inline bool overlaps(const OrientedRectangle &a, const Compound2 &b) {
    return overlaps(b, a);
}

// The common points of two segments: none, a point (a == b), or the stretch shared by two segments
// on one line, from its lesser end (by x, then y). Whether there are any is exact, and so is a
// point that is an end of either segment. A point where they cross is rounded: no further from
// either segment than 8 epsilon times the largest coordinate.
std::optional<Segment2> intersection(const Segment2 &a, const Segment2 &b);

// The axis of largest separation among the four face normals, the first of equals. separation <= 0:
// they overlap, and -separation along `normal` is the least translation of B that parts them.
// separation > 0: they are disjoint, at a distance between separation and sqrt(2) separation.
struct SatResult2 {
    Real separation = Real(0); // off by at most 8 epsilon (|centre b - centre a| + |h_a| + |h_b|)
    Vec2 normal{Real(0)};      // unit, from A to B
    int axis = 0;              // the rectangle's own: 0, 1 the x, y of A; 2, 3 those of B
};

// Concentric rectangles part along the positive direction of an axis.
SatResult2 separating_axis(const OrientedRectangle &a, const OrientedRectangle &b);

} // namespace plumb::inline PLUMB_PRECISION
