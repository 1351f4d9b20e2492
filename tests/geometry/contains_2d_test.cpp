#include "engine/geometry/contains_2d.h"

#include "tests/geometry/oracle_2d.h"
#include "tests/says.h"
#include "tests/trials.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace oracle_2d;

// A point near the border: finds the border along a random direction from the centre and moves off
// it by a few roundings.
template <typename Shape> Vec2 near_border(Random &random, const Shape &shape, const Vec2 &center) {
    const Wide u = any_unit(random);
    const W size = size_of(shape);
    W low = 0;
    W high = 2 * size;
    for (int i = 0; i < 9; ++i) {
        // Never steps past the border, which is at least that close.
        const Wide p = wide(center) + high * u;
        const W outside =
            signed_distance(shape, Vec2{static_cast<Real>(p.x), static_cast<Real>(p.y)});
        high = std::max(low, high - outside);
    }
    high += size * W(epsilon) * W(random.next_in(-8.0, 8.0));
    const Wide p = wide(center) + high * u;
    return {static_cast<Real>(p.x), static_cast<Real>(p.y)};
}

struct Tally {
    int wrong = 0;
    int near = 0;
    double worst = 0.0; // as a share of the bound
};

template <typename Shape>
void check_point(Tally &tally, const Shape &shape, const Vec2 &point, double bound) {
    const W distance = signed_distance(shape, point);
    const double share = double(std::abs(distance)) / (bound > 0.0 ? bound : 1e-300);
    tally.near += share < 4.0 ? 1 : 0;
    if (contains(shape, point) != (distance <= 0) && distance != 0) {
        ++tally.wrong;
        tally.worst = std::max(tally.worst, share);
    }
}

TEST(Contains2, IsWrongOnlyWithinTheStatedBound) {
    Random random(0x2d01);
    Tally circles, rectangles;
    const int count = trials(1'000'000);
    for (int trial = 0; trial < count; ++trial) {
        const Circle circle = any_circle(random);
        check_point(circles, circle, near_border(random, circle, circle.center),
                    2.0 * epsilon * double(circle.radius));
        const OrientedRectangle rectangle = any_oriented(random);
        check_point(rectangles, rectangle, near_border(random, rectangle, rectangle.center),
                    4.0 * epsilon * double(size_of(rectangle)));
    }
    // Some points this close to the border must come out wrong, or the test is looking in the wrong
    // place.
    EXPECT_GT(circles.near, count / 8);
    EXPECT_GT(rectangles.near, count / 8);
    EXPECT_GT(circles.wrong + rectangles.wrong, 0);
    EXPECT_LE(circles.worst, 1.0);
    EXPECT_LE(rectangles.worst, 1.0);
}

TEST(Contains2, IsExactForSmallIntegers) {
    Random random(0x2d02);
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const std::int64_t reach = random.next_index(2) == 0 ? 6 : 512;
        const Vec2 center = any_whole_point(random, reach);
        const Vec2 point = any_whole_point(random, reach);
        const Whole d = whole(point) - whole(center);
        const Real radius = std::abs(any_whole(random, reach));
        const Int r = static_cast<std::int64_t>(radius);
        ASSERT_EQ(contains(Circle{center, radius}, point), dot(d, d) <= r * r);

        const Vec2 half = glm::abs(any_whole_point(random, reach));
        const Whole h = whole(half);
        const Whole size{d.x < 0 ? -d.x : d.x, d.y < 0 ? -d.y : d.y};
        const bool lying = size.x <= h.x && size.y <= h.y;
        const bool standing = size.x <= h.y && size.y <= h.x;
        ASSERT_EQ(contains(Rectangle{center - half, center + half}, point), lying);
        const Real zero = random.next_index(2) == 0 ? Real(0) : -Real(0);
        for (const Real one : {Real(1), Real(-1)}) {
            ASSERT_EQ(contains(OrientedRectangle{center, {one, zero}, half}, point), lying);
            ASSERT_EQ(contains(OrientedRectangle{center, {zero, one}, half}, point), standing);
        }
    }
}

TEST(Contains2, IsExactOnSegmentsAndRays) {
    Random random(0x2d03);
    int hits = 0;
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const std::int64_t reach = any_reach(random);
        const Vec2 a = any_whole_point(random, reach);
        const Vec2 b = random.next_index(8) == 0 ? a : any_whole_point(random, reach);
        const Vec2 p = near_line(random, a, b);
        const Whole along = whole(b) - whole(a);
        const Whole from_a = whole(p) - whole(a);
        // On the line, and between the ends by distance along it.
        const bool on_line = cross(along, from_a) == 0;
        const bool between = dot(along, from_a) >= 0 && dot(from_a, from_a) <= dot(along, along);
        ASSERT_EQ(contains(Segment2{a, b}, p), on_line && between);
        hits += on_line && between ? 1 : 0;
        if (a == b)
            continue;
        ASSERT_EQ(contains(Ray2{a, b - a}, p), on_line && dot(along, from_a) >= 0);
        ASSERT_EQ(contains(Ray2{a, b - a, Real(1)}, p), on_line && between);
        ASSERT_EQ(contains(Ray2{a, b - a, Real(0)}, p), p == a);
        ASSERT_FALSE(contains(Ray2{a, b - a, Real(-1)}, p));
    }
    EXPECT_GT(hits, trials(1'000'000) / 8);
}

TEST(Contains2, SegmentsScaledAndMovedByPowersOfTwo) {
    // The same points, tiny and far away: only exponents change.
    Random random(0x2d04);
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const Real scale = std::ldexp(Real(1), int(random.next_index(40)) - 20);
        const Vec2 a = any_whole_point(random, 9), b = any_whole_point(random, 9);
        const Vec2 p = near_line(random, a, b);
        ASSERT_EQ(contains(Segment2{scale * a, scale * b}, scale * p), contains(Segment2{a, b}, p));
    }
}

TEST(Contains2, CompoundIsAnyOfItsParts) {
    Random random(0x2d05);
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const Circle circle{any_whole_point(random, 9), std::abs(any_whole(random, 5))};
        const Vec2 half = glm::abs(any_whole_point(random, 5));
        const Vec2 corner = any_whole_point(random, 9);
        const Rectangle rectangle{corner, corner + half};
        const OrientedRectangle oriented{any_whole_point(random, 9), any_axis(random), half};
        const Compound2 compound({circle, rectangle, oriented});
        const Vec2 p = any_whole_point(random, 12);
        ASSERT_EQ(contains(compound, p),
                  contains(circle, p) || contains(rectangle, p) || contains(oriented, p));
    }
}

TEST(Contains2, SaysWhatIsWrong) {
    const Real nan = std::numeric_limits<Real>::quiet_NaN();
    const Real inf = std::numeric_limits<Real>::infinity();
    const Vec2 zero{Real(0)};
    says([&] { contains(Circle{zero, Real(-2)}, zero); }, "-2");
    says([&] { contains(Circle{zero, nan}, zero); }, "nan");
    says([&] { contains(Circle{zero, inf}, zero); }, "inf");
    says([&] { contains(Circle{zero, Real(1)}, Vec2{Real(3), inf}); }, "(3, inf)");
    says([&] { contains(Rectangle{Vec2{nan}, zero}, zero); }, "(nan, nan)");
    says([&] { contains(Rectangle{zero, zero}, Vec2{nan}); }, "nan");
    says([&] { contains(OrientedRectangle{zero, {Real(2), Real(0)}, zero}, zero); }, "(2, 0)");
    says(
        [&] {
            contains(OrientedRectangle{zero, {Real(1), Real(0)}, {Real(-3), Real(1)}}, zero);
        },
        "(-3, 1)");
    says([&] { contains(Segment2{zero, Vec2{nan}}, zero); }, "nan");
    says([&] { contains(Ray2{zero, zero}, zero); }, "(0, 0)");
    says([&] { contains(Ray2{zero, {Real(1), Real(0)}, nan}, zero); }, "nan");
    EXPECT_FALSE(contains(Rectangle{}, zero)); // the empty set
    EXPECT_FALSE(contains(Rectangle{{Real(-1), Real(1)}, {Real(1), Real(-1)}}, zero));
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
