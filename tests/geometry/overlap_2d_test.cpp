#include "engine/geometry/overlap_2d.h"

#include "engine/core/check.h"
#include "tests/geometry/oracle_2d.h"
#include "tests/trials.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace oracle_2d;

void move(Circle &circle, const Vec2 &by) {
    circle.center += by;
}
void move(OrientedRectangle &rectangle, const Vec2 &by) {
    rectangle.center += by;
}
Vec2 middle(const Circle &circle) {
    return circle.center;
}
Vec2 middle(const OrientedRectangle &rectangle) {
    return rectangle.center;
}
Vec2 middle(const Rectangle &rectangle) {
    return Real(0.5) * rectangle.min + Real(0.5) * rectangle.max;
}

struct Tally {
    int wrong = 0;
    int near = 0;
    int overlapping = 0;
    double worst = 0.0; // as a share of the bound
};

// The shape's support point along n, from its middle; any point of an edge perpendicular to n.
Wide furthest(Random &, const Circle &circle, const Wide &n) {
    return n * W(circle.radius);
}
Wide furthest(Random &random, const auto &rectangle, const Wide &n) {
    const Polygon outline = polygon(rectangle);
    const Wide center = (outline.corners[0] + outline.corners[2]) / W(2);
    std::array<Wide, 4> corners{};
    for (std::size_t i = 0; i < 4; ++i)
        corners[i] = outline.corners[i] - center;
    std::sort(corners.begin(), corners.end(),
              [&](const Wide &p, const Wide &q) { return glm::dot(p, n) > glm::dot(q, n); });
    const bool is_edge = glm::dot(corners[0] - corners[1], n) <= size_of(rectangle) * 1e-12L;
    return is_edge ? corners[0] + W(random.next_unit()) * (corners[1] - corners[0]) : corners[0];
}

Wide own_normal(const Circle &, const Wide &any) {
    return any;
}
Wide own_normal(const Rectangle &, const Wide &) {
    return {1, 0};
}
Wide own_normal(const OrientedRectangle &rectangle, const Wide &) {
    return wide(rectangle.axis) / length(wide(rectangle.axis));
}

// Moves b until corners or edges touch, up to slightly more than rounding, and queries the overlap.
template <typename A, typename B>
void check_near_touch(Random &random, Tally &tally, const A &a, B b, double bound) {
    Wide n = any_unit(random);
    const std::uint32_t kind = random.next_index(4);
    if (kind >= 2)
        n = kind == 2 ? own_normal(a, n) : own_normal(b, n);
    for (std::uint32_t turns = random.next_index(4); turns > 0; --turns)
        n = {-n.y, n.x};
    const Wide target = wide(middle(a)) + furthest(random, a, n) - furthest(random, b, -n) +
                        any_unit(random) * (W(bound) * W(random.next_in(0.0, 2.0)));
    const Wide by = target - wide(middle(b));
    move(b, {static_cast<Real>(by.x), static_cast<Real>(by.y)});
    const W distance = signed_distance(a, b);
    const double share = double(std::abs(distance)) / (bound > 0.0 ? bound : 1e-300);
    tally.near += share < 4.0 ? 1 : 0;
    const bool answer = overlaps(a, b);
    ASSERT_EQ(answer, overlaps(b, a));
    tally.overlapping += answer ? 1 : 0;
    if (answer != (distance <= 0) && distance != 0) {
        ++tally.wrong;
        tally.worst = std::max(tally.worst, share);
    }
}

TEST(Overlap2, IsWrongOnlyWithinTheStatedBound) {
    Random random(0x2d21);
    const int count = trials(1'000'000);
    std::array<Tally, 5> tallies{};
    for (int trial = 0; trial < count; ++trial) {
        const Circle circle = any_circle(random);
        const Circle other = any_circle(random);
        const Rectangle rectangle = any_rectangle(random);
        const OrientedRectangle a = any_oriented(random);
        const OrientedRectangle b = any_oriented(random);
        const double r = double(circle.radius);
        check_near_touch(random, tallies[0], circle, other,
                         2.0 * epsilon * (r + double(other.radius)));
        check_near_touch(random, tallies[1], rectangle, circle, 2.0 * epsilon * r);
        check_near_touch(random, tallies[2], a, circle, 4.0 * epsilon * (r + double(size_of(a))));
        check_near_touch(random, tallies[3], rectangle, a,
                         8.0 * epsilon * double(size_of(rectangle) + size_of(a)));
        check_near_touch(random, tallies[4], a, b, 8.0 * epsilon * double(size_of(a) + size_of(b)));
    }
    for (std::size_t i = 0; i < tallies.size(); ++i) {
        const Tally &tally = tallies[i];
        EXPECT_GT(tally.near, count / 5) << i;
        EXPECT_GT(tally.overlapping, count / 8) << i;
        EXPECT_LT(tally.overlapping, count / 8 * 7) << i;
        EXPECT_LE(tally.worst, 1.0) << i;
    }
}

// Anywhere: depth and distance agree with the hull of differences.
TEST(Overlap2, SeparatingAxisGivesDepthAndDistance) {
    Random random(0x2d22);
    int overlapping = 0;
    const int count = trials(1'000'000);
    for (int trial = 0; trial < count; ++trial) {
        const Real size = any_size(random);
        const Vec2 center = any_position(random);
        const OrientedRectangle a{center, any_axis(random), any_half_extents(random, size)};
        const OrientedRectangle b{center + any_vector(random, double(size)), any_axis(random),
                                  any_half_extents(random, size * any_real(random, 0.1, 1.0))};
        const SatResult2 result = separating_axis(a, b);
        const W distance = signed_distance(a, b);
        const W offset = length(wide(b.center) - wide(a.center));
        const W bound = 8 * W(epsilon) * (offset + size_of(a) + size_of(b));
        ASSERT_NEAR(double(length(wide(result.normal))), 1.0, 4.0 * epsilon);
        if (distance <= 0) {
            ++overlapping;
            ASSERT_NEAR(double(result.separation), double(distance), double(bound));
            // The translation separates them.
            OrientedRectangle parted = b;
            const Wide by = wide(result.normal) * -W(result.separation);
            parted.center = Vec2{Real(0)};
            OrientedRectangle fixed = a;
            fixed.center = Vec2{Real(0)};
            Polygon moved = polygon(parted);
            moved.origin = wide(b.center) - wide(a.center) + by;
            ASSERT_NEAR(double(polygon_distance(polygon(fixed), moved)), 0.0, double(2 * bound));
        } else {
            ASSERT_LE(W(result.separation), distance + bound);
            ASSERT_GE(W(result.separation), distance / std::sqrt(W(2)) - bound);
        }
        ASSERT_GE(glm::dot(result.normal, b.center - a.center), Real(-0.0));
        const Vec2 &axis = result.axis < 2 ? a.axis : b.axis;
        const Vec2 own = result.axis % 2 == 0 ? axis : perpendicular(axis);
        ASSERT_TRUE(result.normal == own || result.normal == -own);
    }
    EXPECT_GT(overlapping, count / 8);
}

TEST(Overlap2, ConcentricRectanglesPartAlongTheLeastAxis) {
    const Vec2 zero{Real(0)};
    const OrientedRectangle a{zero, {Real(1), Real(0)}, {Real(3), Real(1)}};
    const OrientedRectangle b{zero, {Real(0), Real(1)}, {Real(2), Real(1)}};
    const SatResult2 result = separating_axis(a, b); // b is upright: 1 wide, 2 high
    EXPECT_EQ(result.separation, Real(-3));
    EXPECT_EQ(result.normal, (Vec2{Real(0), Real(1)}));
    EXPECT_EQ(result.axis, 1);
}

TEST(Overlap2, IsExactForSmallIntegers) {
    Random random(0x2d23);
    int touching = 0;
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const std::int64_t reach = random.next_index(2) == 0 ? 6 : 512;
        const Vec2 center_a = any_whole_point(random, reach);
        const Vec2 center_b = any_whole_point(random, reach);
        const Vec2 half_a = glm::abs(any_whole_point(random, reach));
        const Vec2 half_b = glm::abs(any_whole_point(random, reach));
        const Real radius = std::abs(any_whole(random, reach));
        const Real other_radius = std::abs(any_whole(random, reach));
        const Whole d = whole(center_b) - whole(center_a);
        const Whole a = whole(half_a), b = whole(half_b);
        const Int r = static_cast<std::int64_t>(radius);
        const Int sum = r + static_cast<std::int64_t>(other_radius);
        ASSERT_EQ(overlaps(Circle{center_a, radius}, Circle{center_b, other_radius}),
                  dot(d, d) <= sum * sum);

        // A rectangle grown by a circle is two rectangles and four circles.
        const Whole x{d.x < 0 ? -d.x : d.x, d.y < 0 ? -d.y : d.y};
        const Whole from_corner = x - b;
        const bool round = (x.x <= b.x + r && x.y <= b.y) || (x.x <= b.x && x.y <= b.y + r) ||
                           dot(from_corner, from_corner) <= r * r;
        const Circle circle{center_a, radius};
        const Rectangle rectangle{center_b - half_b, center_b + half_b};
        ASSERT_EQ(overlaps(circle, rectangle), round);
        ASSERT_EQ(overlaps(OrientedRectangle{center_b, {Real(-1), -Real(0)}, half_b}, circle),
                  round);
        ASSERT_EQ(overlaps(OrientedRectangle{center_b, {-Real(0), Real(1)}, {half_b.y, half_b.x}},
                           circle),
                  round);

        const Rectangle box{center_a - half_a, center_a + half_a};
        const bool flat = x.x <= a.x + b.x && x.y <= a.y + b.y;
        touching += x.x == a.x + b.x || x.y == a.y + b.y ? 1 : 0;
        ASSERT_EQ(overlaps(box, rectangle), flat);
        const OrientedRectangle lying{center_a, {Real(1), Real(0)}, half_a};
        const OrientedRectangle standing{center_a, {Real(0), Real(-1)}, {half_a.y, half_a.x}};
        const OrientedRectangle other{center_b, {Real(0), Real(1)}, {half_b.y, half_b.x}};
        ASSERT_EQ(overlaps(rectangle, lying), flat);
        ASSERT_EQ(overlaps(rectangle, standing), flat);
        ASSERT_EQ(overlaps(lying, other), flat);
        ASSERT_EQ(overlaps(other, standing), flat);
        const Int apart = std::max(x.x - a.x - b.x, x.y - a.y - b.y);
        ASSERT_EQ(separating_axis(standing, other).separation,
                  static_cast<Real>(static_cast<std::int64_t>(apart)));
    }
    EXPECT_GT(touching, trials(1'000'000) / 20);
}

// Whether two segments with integer ends meet, by solving for both parameters.
bool do_meet(const Segment2 &p, const Segment2 &q) {
    const Whole a = whole(p.a), u = whole(p.b) - a;
    const Whole b = whole(q.a), v = whole(q.b) - b;
    const Whole ab = b - a;
    const Int determinant = cross(u, v);
    const auto is_share = [](Int numerator, Int denominator) { // in [0, 1]
        return denominator > 0 ? numerator >= 0 && numerator <= denominator
                               : numerator <= 0 && numerator >= denominator;
    };
    if (determinant != 0)
        return is_share(cross(ab, v), determinant) && is_share(cross(ab, u), determinant);
    // Parallel, or one is a point: they meet if an end of one is in the other.
    const auto is_in = [](const Whole &point, const Whole &start, const Whole &along) {
        const Whole d = point - start;
        return cross(along, d) == 0 && dot(along, d) >= 0 && dot(d, d) <= dot(along, along);
    };
    return is_in(b, a, u) || is_in(whole(q.b), a, u) || is_in(a, b, v) || is_in(whole(p.b), b, v);
}

TEST(Overlap2, SegmentsAreExact) {
    Random random(0x2d24);
    int meeting = 0, sharing = 0;
    const int count = trials(1'000'000);
    for (int trial = 0; trial < count; ++trial) {
        const std::int64_t reach = any_reach(random);
        const Vec2 a = any_whole_point(random, reach);
        const Vec2 b = random.next_index(16) == 0 ? a : any_whole_point(random, reach);
        const Segment2 p{a, b};
        const Vec2 c =
            random.next_index(2) == 0 ? any_whole_point(random, reach) : near_line(random, a, b);
        const Segment2 q{c, near_line(random, a, b)};
        const bool expected = do_meet(p, q);
        ASSERT_EQ(overlaps(p, q), expected);
        ASSERT_EQ(overlaps(q, p), expected);
        const std::optional<Segment2> common = intersection(p, q);
        ASSERT_EQ(common.has_value(), expected);
        if (!expected)
            continue;
        ++meeting;
        // In both segments up to rounding; a shared stretch has integer ends, exactly.
        const W size = W(reach) * 2 + 1;
        for (const Vec2 &end : {common->a, common->b})
            for (const Segment2 &s : {p, q})
                ASSERT_LE(segment_distance(wide(s.a), wide(s.b), wide(end)), 8 * W(epsilon) * size);
        if (common->a == common->b)
            continue;
        ++sharing;
        for (const Vec2 &end : {common->a, common->b}) {
            ASSERT_TRUE(do_meet(p, {end, end}));
            ASSERT_TRUE(do_meet(q, {end, end}));
        }
        // It is maximal: each end is an end of p or q, and no end that is in both lies beyond.
        for (const Vec2 &end : {p.a, p.b, q.a, q.b})
            if (do_meet(p, {end, end}) && do_meet(q, {end, end})) {
                ASSERT_TRUE(do_meet(*common, {end, end}));
            }
    }
    EXPECT_GT(meeting, count / 8);
    EXPECT_GT(sharing, count / 100);
}

TEST(Overlap2, CrossingPointsOfRealSegments) {
    Random random(0x2d25);
    int crossing = 0;
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const Vec2 middle_point = any_position(random);
        const Real size = any_size(random);
        const Wide u = any_unit(random);
        const Wide v =
            random.next_index(2) == 0
                ? any_unit(random)
                : u + Wide{-u.y, u.x} * W(any_magnitude(random, -16.0, -1.0)); // nearly parallel
        const auto at = [&](const Wide &along) {
            const Wide p = wide(middle_point) + along * (W(size) * W(random.next_in(-1.0, 1.0)));
            return Vec2{static_cast<Real>(p.x), static_cast<Real>(p.y)};
        };
        const Segment2 p{at(u), at(u)}, q{at(v), at(v)};
        const std::optional<Segment2> common = intersection(p, q);
        ASSERT_EQ(common.has_value(), overlaps(p, q));
        if (!common)
            continue;
        ++crossing;
        W largest = 0;
        for (const Vec2 &end : {p.a, p.b, q.a, q.b})
            largest = std::max({largest, std::abs(W(end.x)), std::abs(W(end.y))});
        for (const Segment2 &s : {p, q})
            ASSERT_LE(segment_distance(wide(s.a), wide(s.b), wide(common->a)),
                      8 * W(epsilon) * largest);
    }
    EXPECT_GT(crossing, trials(1'000'000) / 20);
}

TEST(Overlap2, CompoundIsAnyOfItsParts) {
    Random random(0x2d26);
    int some = 0;
    const int count = trials(1'000'000);
    for (int trial = 0; trial < count; ++trial) {
        const auto any_parts = [&] {
            const Circle circle{any_vector(random, 9.0), any_real(random, 0.0, 3.0)};
            const Vec2 corner = any_whole_point(random, 9);
            const Rectangle rectangle{corner, corner + glm::abs(any_whole_point(random, 4))};
            const OrientedRectangle oriented{any_vector(random, 9.0), any_axis(random),
                                             any_half_extents(random, Real(2))};
            return std::vector<Part2>{circle, rectangle, oriented};
        };
        const std::vector<Part2> parts = any_parts();
        const Compound2 compound(parts);
        const Compound2 other(any_parts());
        bool any = false;
        for (const Part2 &shape : other.parts()) {
            bool expected = false;
            for (const Part2 &part : parts)
                expected = expected ||
                           std::visit([](const auto &a, const auto &b) { return overlaps(a, b); },
                                      part, shape);
            ASSERT_EQ(std::visit([&](const auto &b) { return overlaps(compound, b); }, shape),
                      expected);
            ASSERT_EQ(std::visit([&](const auto &b) { return overlaps(b, compound); }, shape),
                      expected);
            any = any || expected;
        }
        ASSERT_EQ(overlaps(compound, other), any);
        some += any ? 1 : 0;
    }
    EXPECT_GT(some, count / 8);
    EXPECT_LT(some, count / 8 * 7);
}

TEST(Overlap2, TheEmptySetOverlapsNothing) {
    const Vec2 zero{Real(0)};
    const Rectangle all{Vec2{Real(-9)}, Vec2{Real(9)}};
    for (const Rectangle &empty :
         {Rectangle{}, Rectangle{{Real(1), Real(-1)}, {Real(0), Real(1)}}}) {
        EXPECT_FALSE(overlaps(empty, all));
        EXPECT_FALSE(overlaps(all, empty));
        EXPECT_FALSE(overlaps(Circle{zero, Real(9)}, empty));
        EXPECT_FALSE(overlaps(empty, OrientedRectangle{zero, {Real(1), Real(0)}, Vec2{Real(9)}}));
        EXPECT_FALSE(overlaps(Compound2({all}), empty));
        EXPECT_THROW(Compound2({empty}), CheckFailure);
    }
    EXPECT_THROW(Compound2({}), CheckFailure);
    const Real nan = std::numeric_limits<Real>::quiet_NaN();
    EXPECT_THROW(overlaps(all, Rectangle{Vec2{nan}, zero}), CheckFailure);
    EXPECT_THROW(overlaps(Circle{zero, nan}, all), CheckFailure);
    EXPECT_THROW(overlaps(Segment2{zero, Vec2{nan}}, Segment2{zero, zero}), CheckFailure);
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
