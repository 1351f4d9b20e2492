// Planes: which side a shape is on, and where two or three planes intersect.
#pragma once

#include "engine/geometry/shapes.h"

#include <optional>

namespace plumb::inline PLUMB_PRECISION {

enum class PlaneSide { behind, across, in_front };

struct PlaneTest {
    PlaneSide side = PlaneSide::across;
    // From the plane to the shape's closest point, metres along the normal: negative behind,
    // positive in front, 0 across.
    Real distance = Real(0);
};

// A shape that touches the plane is across it. The side of a point, segment or triangle is exact
// for the inputs as given (range: shapes.h); that of a round shape or box may be wrong if it is
// closer to touching than 8 epsilon times the largest coordinate or size. The distance has the same
// error bound. An invalid shape or plane, a non-finite point, or an empty Aabb fails a check.
PlaneTest classify(const Plane &plane, const Vec3 &point);
PlaneTest classify(const Plane &plane, const Sphere &sphere);
PlaneTest classify(const Plane &plane, const Aabb &box);
PlaneTest classify(const Plane &plane, const Box &box);
PlaneTest classify(const Plane &plane, const Capsule &capsule);
PlaneTest classify(const Plane &plane, const Cylinder &cylinder);
PlaneTest classify(const Plane &plane, const Segment &segment);
PlaneTest classify(const Plane &plane, const Triangle &triangle);

// An infinite line; `direction` has unit length.
struct Line {
    Vec3 point{Real(0)};
    Vec3 direction{Real(0), Real(0), Real(1)};
};

// The line where two planes intersect; none if they are nearly parallel, that is if the sine of
// their angle is not above the square root of epsilon (3.5e-4 in float, 1.5e-8 in double).
// `direction` is normal_a x normal_b, and `point` is the line's closest point to the origin. For
// the inputs as given it is off by at most 8 epsilon times the larger offset over the sine, so even
// at worst half of its digits are right.
std::optional<Line> intersection(const Plane &a, const Plane &b);

// The point where three planes intersect; none if the volume spanned by their normals, |normal_a .
// (normal_b x normal_c)|, is not above the square root of epsilon. It is off by at most 16 epsilon
// times (its distance from the origin + the largest offset) over that volume.
std::optional<Vec3> intersection(const Plane &a, const Plane &b, const Plane &c);

} // namespace plumb::inline PLUMB_PRECISION
