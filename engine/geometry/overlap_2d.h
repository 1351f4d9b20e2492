// Whether two 2D shapes overlap, and how deep.
//
// All sets are closed: touching shapes overlap. An invalid shape fails a check with the value in
// its message; an empty rectangle overlaps nothing.
//
// Segment with Segment and Rectangle with Rectangle are exact for the inputs as given. The others
// are exact for small integers (up to 2^9 in float, 2^23 in double; oriented rectangles turned by
// multiples of 90 degrees). Otherwise the answer may be wrong only for shapes whose signed distance
// is within this of 0 (r radius, h half extents; axes one rounding off unit length):
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

// The same with the arguments swapped.
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

// The common points of two segments: none, a point (a == b), or the overlap of two collinear
// segments, starting at its lesser end (by x, then y). Whether there are any is exact, and so is a
// point that is an end of either segment. A crossing point is rounded: within 8 epsilon times the
// largest coordinate of either segment.
std::optional<Segment2> intersection(const Segment2 &a, const Segment2 &b);

// The axis of largest separation among the four face normals; the first if tied. separation <= 0:
// they overlap, and -separation along `normal` is the minimum translation of B that separates them.
// separation > 0: they are disjoint, at a distance between separation and sqrt(2) separation.
struct SatResult2 {
    Real separation = Real(0); // off by at most 8 epsilon (|centre b - centre a| + |h_a| + |h_b|)
    Vec2 normal{Real(0)};      // unit, from A to B
    int axis = 0;              // 0, 1: A's local x, y; 2, 3: B's
};

// Concentric rectangles separate along the positive direction of an axis.
SatResult2 separating_axis(const OrientedRectangle &a, const OrientedRectangle &b);

} // namespace plumb::inline PLUMB_PRECISION
