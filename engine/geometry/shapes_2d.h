// The shapes of the xy plane and the ray in it, as plain values.
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
// has any length but zero, and t is in units of it.
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
// perpendicular(axis), a quarter turn further counter-clockwise.
struct OrientedRectangle {
    Vec2 center{Real(0)};
    Vec2 axis{Real(1), Real(0)};
    Vec2 half_extents{Real(0)}; // >= 0 in each component
};

// v turned counter-clockwise by a quarter.
inline Vec2 perpendicular(const Vec2 &v) {
    return {-v.y, v.x};
}

// Turned counter-clockwise by `angle`. The cosine of a float quarter turn is not zero: for quarter
// turns without rounding, give the axis itself.
OrientedRectangle oriented_rectangle(const Vec2 &center, Real angle, const Vec2 &half_extents);

using Part2 = std::variant<Circle, Rectangle, OrientedRectangle>;

// The union of some parts, with a rectangle around them all, so that most questions are answered
// without looking at the parts. The parts may overlap each other.
class Compound2 {
  public:
    // At least one part; an empty rectangle is none. Parts are checked here, once.
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
// when it can be represented, unless an oriented rectangle is not turned by quarters; then it is at
// most 8 epsilon |half_extents| wider on each side, besides the rounding.
Rectangle bounds(const Segment2 &segment);
Rectangle bounds(const Circle &circle);
Rectangle bounds(const OrientedRectangle &rectangle);
inline const Rectangle &bounds(const Rectangle &rectangle) {
    return rectangle;
}
inline const Rectangle &bounds(const Compound2 &compound) {
    return compound.bounds();
}

// Within 2 epsilon of itself, where its square neither overflows nor underflows.
Real length(const Segment2 &segment);

// The same in space, in the plane z = 0.
inline Aabb lifted(const Rectangle &rectangle) {
    return {Vec3{rectangle.min, Real(0)}, Vec3{rectangle.max, Real(0)}};
}
inline Ray lifted(const Ray2 &ray) {
    return {Vec3{ray.origin, Real(0)}, Vec3{ray.direction, Real(0)}, ray.max_t};
}

// Fails a check, naming the value, when a member is NaN or infinite (a ray's max_t may be
// infinite), a size is negative, a direction zero, or an axis not of unit length (is_unit). An
// empty rectangle is valid: the empty set.
void check_valid(const Vec2 &point);
void check_valid(const Segment2 &segment);
void check_valid(const Ray2 &ray);
void check_valid(const Circle &circle);
void check_valid(const Rectangle &rectangle);
void check_valid(const OrientedRectangle &rectangle);
inline void check_valid(const Compound2 &) {} // cannot be made otherwise

} // namespace plumb::inline PLUMB_PRECISION
