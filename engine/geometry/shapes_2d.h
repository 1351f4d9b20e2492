// 2D shapes in the xy plane, and the 2D ray, as plain values.
//
// All sets are closed: a point on the border is inside. Solid shapes are filled. Lengths in metres.
#pragma once

#include "engine/geometry/shapes.h"

#include <limits>
#include <variant>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {

// All points a + s (b - a), 0 <= s <= 1. a == b is a point.
struct Segment2 {
    Vec2 a{Real(0)};
    Vec2 b{Real(0)};
};

// The points origin + t * direction for 0 <= t <= max_t; none when max_t is negative. `direction`
// may have any non-zero length, and t is in units of it.
struct Ray2 {
    Vec2 origin{Real(0)};
    Vec2 direction{Real(1), Real(0)};
    Real max_t = std::numeric_limits<Real>::infinity();
};

struct Circle {
    Vec2 center{Real(0)};
    Real radius = Real(0); // >= 0; zero is a point
};

// An axis-aligned rectangle; empty when min > max in any component.
struct Rectangle {
    Vec2 min{std::numeric_limits<Real>::max()};
    Vec2 max{std::numeric_limits<Real>::lowest()};
};

// A rectangle of any orientation. `axis` is the unit vector of its own x axis; its y axis is
// perpendicular(axis), a quarter turn counter-clockwise from it.
struct OrientedRectangle {
    Vec2 center{Real(0)};
    Vec2 axis{Real(1), Real(0)};
    Vec2 half_extents{Real(0)}; // >= 0 in each component
};

// v rotated by 90 degrees counter-clockwise.
inline Vec2 perpendicular(const Vec2 &v) {
    return {-v.y, v.x};
}

// Rotated counter-clockwise by `angle` (radians). The cosine of a float quarter turn is not zero:
// for exact quarter turns set the axis directly.
OrientedRectangle oriented_rectangle(const Vec2 &center, Real angle, const Vec2 &half_extents);

using Part2 = std::variant<Circle, Rectangle, OrientedRectangle>;

// The union of some parts, with a bounding rectangle so that most queries need not look at the
// parts. The parts may overlap.
class Compound2 {
  public:
    // Needs at least one part; an empty rectangle does not count. Parts are checked here, once.
    explicit Compound2(std::vector<Part2> parts);

    const std::vector<Part2> &parts() const { return parts_; }
    const Rectangle &bounds() const { return bounds_; }

  private:
    std::vector<Part2> parts_;
    Rectangle bounds_;
};

inline bool is_empty(const Rectangle &rectangle) {
    return !(rectangle.min.x <= rectangle.max.x && rectangle.min.y <= rectangle.max.y);
}

// The smallest rectangle around a shape, rounded outwards: no point of the shape is outside. Exact
// if representable, except for an oriented rectangle not turned by a multiple of 90 degrees: that
// adds at most 8 epsilon |half_extents| on each side, besides the rounding.
Rectangle bounds(const Segment2 &segment);
Rectangle bounds(const Circle &circle);
Rectangle bounds(const OrientedRectangle &rectangle);
inline const Rectangle &bounds(const Rectangle &rectangle) {
    return rectangle;
}
inline const Rectangle &bounds(const Compound2 &compound) {
    return compound.bounds();
}

// Relative error at most 2 epsilon if the square neither overflows nor underflows.
Real length(const Segment2 &segment);

// The same in 3D, in the plane z = 0.
inline Aabb lifted(const Rectangle &rectangle) {
    return {Vec3{rectangle.min, Real(0)}, Vec3{rectangle.max, Real(0)}};
}
inline Ray lifted(const Ray2 &ray) {
    return {Vec3{ray.origin, Real(0)}, Vec3{ray.direction, Real(0)}, ray.max_t};
}

// Fails a check, naming the value, if a member is NaN or infinite (a ray's max_t may be infinite),
// a size is negative, a direction is zero, or an axis is not of unit length (is_unit). An empty
// rectangle is valid: the empty set.
void check_valid(const Vec2 &point);
void check_valid(const Segment2 &segment);
void check_valid(const Ray2 &ray);
void check_valid(const Circle &circle);
void check_valid(const Rectangle &rectangle);
void check_valid(const OrientedRectangle &rectangle);
inline void check_valid(const Compound2 &) {} // valid by construction

} // namespace plumb::inline PLUMB_PRECISION
