// Planes: on which side of one a shape lies, and where two or three of them meet.
#pragma once

#include "engine/geometry/shapes.h"

#include <optional>

namespace plumb::inline PLUMB_PRECISION {

enum class PlaneSide { behind, across, in_front };

struct PlaneTest {
    PlaneSide side = PlaneSide::across;
    // From the plane to the shape's nearest point, metres along the normal: negative behind,
    // positive in front, 0 across.
    Real distance = Real(0);
};

// A shape that touches the plane is across it. The side of a point, a segment and a triangle is
// exact for the numbers as they are given (range: shapes.h); that of a round shape or a box may be
// wrong where it is nearer to touching than 8 epsilon times the largest coordinate or size. The
// distance is off by no more. A shape or plane that is not valid, a point that is not finite, or an
// empty Aabb fails a check.
PlaneTest classify(const Plane &plane, const Vec3 &point);
PlaneTest classify(const Plane &plane, const Sphere &sphere);
PlaneTest classify(const Plane &plane, const Aabb &box);
PlaneTest classify(const Plane &plane, const Box &box);
PlaneTest classify(const Plane &plane, const Capsule &capsule);
PlaneTest classify(const Plane &plane, const Cylinder &cylinder);
PlaneTest classify(const Plane &plane, const Segment &segment);
PlaneTest classify(const Plane &plane, const Triangle &triangle);

// A line without ends; `direction` has unit length.
struct Line {
    Vec3 point{Real(0)};
    Vec3 direction{Real(0), Real(0), Real(1)};
};

// Where planes meet, if they are not nearly parallel: none when the sine of their angle is not
// above the square root of epsilon (3.5e-4 in float, 1.5e-8 in double). `direction` is
// normal_a x normal_b, and `point` the line's closest to the origin. For the numbers as they are
// given, it is off by at most 8 epsilon times the larger offset over the sine, so even at worst
// half of its digits are right.
std::optional<Line> intersection(const Plane &a, const Plane &b);

// The one point that three planes have in common; none when the volume spanned by their normals,
// |normal_a . (normal_b x normal_c)|, is not above the square root of epsilon. It is off by at most
// 16 epsilon times (its distance from the origin + the largest offset) over that volume.
std::optional<Vec3> intersection(const Plane &a, const Plane &b, const Plane &c);

} // namespace plumb::inline PLUMB_PRECISION
