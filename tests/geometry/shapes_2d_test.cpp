#include "engine/geometry/shapes_2d.h"

#include "tests/geometry/oracle_2d.h"
#include "tests/says.h"
#include "tests/trials.h"

#include <gtest/gtest.h>

#include <string>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace oracle_2d;

// Wide enough for the sum of any two doubles used here.
__extension__ using Quad = __float128;

TEST(Shapes2, BoundsOfACircleAreTheNearestOutwards) {
    Random random(0x2d51);
    const Real inf = std::numeric_limits<Real>::infinity();
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const Circle circle = any_circle(random);
        const Rectangle box = bounds(circle);
        for (int i = 0; i < 2; ++i) {
            const Quad low = Quad(circle.center[i]) - Quad(circle.radius);
            const Quad high = Quad(circle.center[i]) + Quad(circle.radius);
            ASSERT_TRUE(Quad(box.min[i]) <= low && low < Quad(std::nextafter(box.min[i], inf)));
            ASSERT_TRUE(Quad(box.max[i]) >= high && high > Quad(std::nextafter(box.max[i], -inf)));
        }
    }
}

TEST(Shapes2, BoundsOfAnOrientedRectangleHoldItsCorners) {
    Random random(0x2d52);
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const OrientedRectangle rectangle = any_oriented(random);
        const Rectangle box = bounds(rectangle);
        const Polygon outline = polygon(rectangle);
        Wide low{1e300L}, high{-1e300L};
        for (std::size_t k = 0; k < 4; ++k) {
            low = glm::min(low, outline.corners[k]);
            high = glm::max(high, outline.corners[k]);
        }
        // The corners are only known up to a rounding of long double.
        const W known = 4 * std::numeric_limits<W>::epsilon() * size_of(rectangle);
        for (int i = 0; i < 2; ++i) {
            const W center = W(rectangle.center[i]);
            const W rounding =
                2 * W(epsilon) * std::max(std::abs(W(box.min[i])), std::abs(W(box.max[i])));
            const W most = 8 * W(epsilon) * size_of(rectangle) + rounding;
            // Differences from the centre are exact in long double for float, and nearly so for
            // double.
            const W slack = known + 4 * std::numeric_limits<W>::epsilon() * std::abs(center);
            ASSERT_LE(W(box.min[i]) - center, low[i] + slack);
            ASSERT_GE(W(box.min[i]) - center, low[i] - most);
            ASSERT_GE(W(box.max[i]) - center, high[i] - slack);
            ASSERT_LE(W(box.max[i]) - center, high[i] + most);
        }
    }
}

TEST(Shapes2, BoundsAreExactWhereTheyCanBe) {
    const Rectangle circle = bounds(Circle{{Real(1), Real(-2)}, Real(3)});
    EXPECT_EQ(circle.min, (Vec2{Real(-2), Real(-5)}));
    EXPECT_EQ(circle.max, (Vec2{Real(4), Real(1)}));
    const Rectangle standing =
        bounds(OrientedRectangle{{Real(1), Real(-2)}, {-Real(0), Real(-1)}, {Real(5), Real(3)}});
    EXPECT_EQ(standing.min, (Vec2{Real(-2), Real(-7)}));
    EXPECT_EQ(standing.max, (Vec2{Real(4), Real(3)}));
    const Rectangle segment = bounds(Segment2{{Real(4), Real(1)}, {Real(3), Real(2)}});
    EXPECT_EQ(segment.min, (Vec2{Real(3), Real(1)}));
    EXPECT_EQ(segment.max, (Vec2{Real(4), Real(2)}));
    const Compound2 both({Circle{Vec2{Real(0)}, Real(1)}, Rectangle{Vec2{Real(0)}, Vec2{Real(4)}}});
    EXPECT_EQ(bounds(both).min, Vec2{Real(-1)});
    EXPECT_EQ(bounds(both).max, Vec2{Real(4)});
}

TEST(Shapes2, OrientedRectangleFromAnAngle) {
    Random random(0x2d53);
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const Real angle = any_real(random, -7.0, 7.0);
        const OrientedRectangle rectangle =
            oriented_rectangle(Vec2{Real(1)}, angle, {Real(2), Real(3)});
        ASSERT_NEAR(double(rectangle.axis.x), double(std::cos(W(angle))), epsilon);
        ASSERT_NEAR(double(rectangle.axis.y), double(std::sin(W(angle))), epsilon);
        ASSERT_EQ(rectangle.half_extents, (Vec2{Real(2), Real(3)}));
    }
}

TEST(Shapes2, LengthOfASegment) {
    Random random(0x2d54);
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const Vec2 a = any_position(random);
        const Vec2 b = a + any_vector(random, double(any_size(random)));
        const W expected = std::hypot(W(b.x) - W(a.x), W(b.y) - W(a.y));
        ASSERT_NEAR(double(W(length(Segment2{a, b})) - expected), 0.0,
                    2.0 * epsilon * double(expected));
    }
    EXPECT_EQ(length(Segment2{{Real(1), Real(1)}, {Real(4), Real(5)}}), Real(5));
    EXPECT_EQ(length(Segment2{{Real(1), Real(1)}, {Real(1), Real(1)}}), Real(0));
}

TEST(Shapes2, SayWhatIsWrong) {
    const Real nan = std::numeric_limits<Real>::quiet_NaN();
    const Vec2 zero{Real(0)};
    says([&] { oriented_rectangle(zero, nan, Vec2{Real(1)}); }, "nan");
    says([&] { oriented_rectangle(zero, Real(1), Vec2{Real(-4)}); }, "(-4, -4)");
    says([&] { bounds(Circle{Vec2{nan}, Real(1)}); }, "nan");
    says([&] { bounds(Segment2{zero, Vec2{nan}}); }, "nan");
    says([&] { Compound2({Circle{zero, Real(-5)}}); }, "-5");
    says([&] { Compound2({Rectangle{}}); }, "empty");
    says([&] { Compound2(std::vector<Part2>{}); }, "at least one part");
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
