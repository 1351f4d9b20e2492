#include "engine/geometry/overlap_2d.h"

#include "engine/geometry/oriented_frame_2d.h"
#include "engine/math/predicates.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

bool touch(const Rectangle &a, const Rectangle &b) {
    return a.min.x <= b.max.x && b.min.x <= a.max.x && a.min.y <= b.max.y && b.min.y <= a.max.y;
}

// Whether a rectangle around the origin comes within `radius` of a point.
bool reaches(const Vec2 &low, const Vec2 &high, const Vec2 &point, Real radius) {
    const Vec2 d = glm::max(glm::max(low - point, point - high), Vec2{Real(0)});
    return glm::dot(d, d) <= radius * radius;
}

bool overlaps_any_part(const Compound2 &compound, const auto &shape) {
    if (!touch(compound.bounds(), bounds(shape)))
        return false;
    return std::ranges::any_of(compound.parts(), [&](const Part2 &part) {
        return std::visit([&](const auto &other) { return overlaps(other, shape); }, part);
    });
}

// The order along a line: by x, then y.
bool comes_before(const Vec2 &a, const Vec2 &b) {
    return std::tie(a.x, a.y) < std::tie(b.x, b.y);
}

// Which sides of each segment's line the other's ends are on; exact.
struct SegmentSides {
    int b_a = 0; // of b.a, relative to a's line
    int b_b = 0;
    int a_a = 0;
    int a_b = 0;

    SegmentSides(const Segment2 &a, const Segment2 &b)
        : b_a(orient2d(a.a, a.b, b.a)), b_b(orient2d(a.a, a.b, b.b)), a_a(orient2d(b.a, b.b, a.a)),
          a_b(orient2d(b.a, b.b, a.b)) {}
    // Sufficient for segments whose bounds touch (Cormen, Leiserson, Rivest, Stein, "Introduction
    // to Algorithms", 33.1).
    bool do_overlap() const { return b_a * b_b <= 0 && a_a * a_b <= 0; }
    bool are_on_one_line() const { return b_a == 0 && b_b == 0 && a_a == 0 && a_b == 0; }
};

} // namespace

bool overlaps(const Circle &a, const Circle &b) {
    check_valid(a);
    check_valid(b);
    const Vec2 d = b.center - a.center;
    const Real reach = a.radius + b.radius;
    return glm::dot(d, d) <= reach * reach;
}

bool overlaps(const Circle &circle, const Rectangle &rectangle) {
    check_valid(circle);
    check_valid(rectangle);
    return !is_empty(rectangle) &&
           reaches(rectangle.min, rectangle.max, circle.center, circle.radius);
}

bool overlaps(const Circle &circle, const OrientedRectangle &rectangle) {
    check_valid(circle);
    check_valid(rectangle);
    return reaches(-rectangle.half_extents, rectangle.half_extents,
                   to_frame(rectangle, circle.center), circle.radius);
}

bool overlaps(const Rectangle &a, const Rectangle &b) {
    check_valid(a);
    check_valid(b);
    return !is_empty(a) && !is_empty(b) && touch(a, b);
}

// By separating axes, as below. A's corners are taken relative to B's centre, so that roundings
// scale with the rectangles and not with their distance from the origin.
bool overlaps(const Rectangle &a, const OrientedRectangle &b) {
    check_valid(a);
    check_valid(b);
    if (is_empty(a))
        return false;
    const Vec2 low = a.min - b.center;
    const Vec2 high = a.max - b.center;
    const Vec2 axis = glm::abs(b.axis);
    const Vec2 &half = b.half_extents;
    const Vec2 extent{axis.x * half.x + axis.y * half.y, axis.y * half.x + axis.x * half.y};
    if (!touch({low, high}, {-extent, extent}))
        return false;
    // Whether A's projection on an axis of B reaches B.
    const auto covers = [&](const Vec2 &u, Real reach) {
        const auto [left, right] = std::minmax({low.x * u.x, high.x * u.x});
        const auto [bottom, top] = std::minmax({low.y * u.y, high.y * u.y});
        return left + bottom <= reach && right + top >= -reach;
    };
    return covers(b.axis, half.x) && covers(perpendicular(b.axis), half.y);
}

bool overlaps(const OrientedRectangle &a, const OrientedRectangle &b) {
    return separating_axis(a, b).separation <= Real(0);
}

bool overlaps(const Compound2 &compound, const Circle &circle) {
    return overlaps_any_part(compound, circle);
}

bool overlaps(const Compound2 &compound, const Rectangle &rectangle) {
    check_valid(rectangle);
    return !is_empty(rectangle) && overlaps_any_part(compound, rectangle);
}

bool overlaps(const Compound2 &compound, const OrientedRectangle &rectangle) {
    return overlaps_any_part(compound, rectangle);
}

bool overlaps(const Compound2 &a, const Compound2 &b) {
    return overlaps_any_part(a, b);
}

bool overlaps(const Segment2 &a, const Segment2 &b) {
    return touch(bounds(a), bounds(b)) && SegmentSides(a, b).do_overlap();
}

std::optional<Segment2> intersection(const Segment2 &a, const Segment2 &b) {
    const Rectangle box_a = bounds(a);
    const Rectangle box_b = bounds(b);
    if (!touch(box_a, box_b))
        return std::nullopt;
    const SegmentSides sides(a, b);
    if (!sides.do_overlap())
        return std::nullopt;
    if (sides.are_on_one_line()) {
        const auto [first_a, last_a] = std::minmax(a.a, a.b, comes_before);
        const auto [first_b, last_b] = std::minmax(b.a, b.b, comes_before);
        return Segment2{std::max(first_a, first_b, comes_before),
                        std::min(last_a, last_b, comes_before)};
    }
    if (sides.b_a == 0)
        return Segment2{b.a, b.a};
    if (sides.b_b == 0)
        return Segment2{b.b, b.b};
    if (sides.a_a == 0)
        return Segment2{a.a, a.a};
    if (sides.a_b == 0)
        return Segment2{a.b, a.b};

    // They cross. Interpolate along b by its ends' distances from a's line: however small the
    // angle, the point is no farther from that line than the error of these distances. Nearly
    // parallel segments may have a larger error along their direction, but the point is clamped to
    // their ends.
    const Vec2 along = a.b - a.a;
    const Vec2 from_a = b.a - a.a;
    const Vec2 to_b = b.b - a.a;
    const Real left = std::abs(along.x * from_a.y - along.y * from_a.x);
    const Real right = std::abs(along.x * to_b.y - along.y * to_b.x);
    const Real sum = left + right;
    const Real t = sum > Real(0) ? left / sum : Real(0.5);
    const Vec2 point = glm::clamp(b.a + t * (b.b - b.a), glm::max(box_a.min, box_b.min),
                                  glm::min(box_a.max, box_b.max));
    return Segment2{point, point};
}

// Separating axes (Gottschalk, Lin, Manocha 1996, in 2D): only their face normals can separate two
// rectangles.
SatResult2 separating_axis(const OrientedRectangle &a, const OrientedRectangle &b) {
    check_valid(a);
    check_valid(b);
    const Vec2 t = b.center - a.center;
    const Vec2 in_a = to_frame_vector(a, t);
    const Vec2 in_b = to_frame_vector(b, t);
    // |cosine| and |sine| of the angle between them.
    const Real along = std::abs(glm::dot(a.axis, b.axis));
    const Real across = std::abs(glm::dot(perpendicular(a.axis), b.axis));
    const Vec2 b_in_a{along * b.half_extents.x + across * b.half_extents.y,
                      across * b.half_extents.x + along * b.half_extents.y};
    const Vec2 a_in_b{along * a.half_extents.x + across * a.half_extents.y,
                      across * a.half_extents.x + along * a.half_extents.y};
    const Vec2 apart_a = glm::abs(in_a) - (a.half_extents + b_in_a);
    const Vec2 apart_b = glm::abs(in_b) - (b.half_extents + a_in_b);

    SatResult2 best{-std::numeric_limits<Real>::infinity(), a.axis, 0};
    const auto consider = [&](int axis, Real separation, const Vec2 &u, Real side) {
        if (separation > best.separation)
            best = {separation, side < Real(0) ? -u : u, axis};
    };
    consider(0, apart_a.x, a.axis, in_a.x);
    consider(1, apart_a.y, perpendicular(a.axis), in_a.y);
    consider(2, apart_b.x, b.axis, in_b.x);
    consider(3, apart_b.y, perpendicular(b.axis), in_b.y);
    return best;
}

} // namespace plumb::inline PLUMB_PRECISION
