#include "engine/geometry/enclosing_2d.h"

#include "engine/core/check.h"
#include "engine/geometry/contains_2d.h"
#include "tests/geometry/oracle_2d.h"
#include "tests/trials.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace oracle_2d;

struct WideCircle {
    Wide center{W(0)};
    W radius = 0;
};

// The smallest circle is the largest of the smallest circles of all triples (Helly). That of a
// triple has two of its points as a diameter, or goes through all three.
WideCircle smallest_of_three(const Wide &a, const Wide &b, const Wide &c) {
    const std::array<Wide, 3> p{a, b, c};
    for (std::size_t i = 0; i < 3; ++i) {
        // The angle at i is right or obtuse: the other two points are a diameter.
        const Wide u = p[(i + 1) % 3] - p[i], v = p[(i + 2) % 3] - p[i];
        if (glm::dot(u, v) <= 0)
            return {(p[(i + 1) % 3] + p[(i + 2) % 3]) / W(2), length(u - v) / 2};
    }
    // R = abc / 4F, with the cross product taken at the corner of the largest angle.
    const W x = length(b - c), y = length(c - a), z = length(a - b);
    const std::size_t i = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
    const W twice_area = std::abs(cross(p[(i + 1) % 3] - p[i], p[(i + 2) % 3] - p[i]));
    return {{0, 0}, x * y * z / (2 * twice_area)};
}

W smallest_radius(const std::vector<Vec2> &points) {
    const Wide origin = wide(points[0]);
    std::vector<Wide> p;
    for (const Vec2 &point : points)
        p.push_back(wide(point) - origin);
    W radius = 0;
    for (std::size_t i = 0; i < p.size(); ++i)
        for (std::size_t j = i; j < p.size(); ++j)
            for (std::size_t k = j; k < p.size(); ++k)
                radius = std::max(radius, smallest_of_three(p[i], p[j], p[k]).radius);
    return radius;
}

struct Tally {
    double worst = 0.0; // as a share of the bound
};

void check_circle(Tally &tally, const std::vector<Vec2> &points) {
    const Circle circle = containing_circle(points);
    W largest = 0;
    for (const Vec2 &p : points) {
        ASSERT_TRUE(contains(circle, p));
        largest = std::max({largest, std::abs(W(p.x)), std::abs(W(p.y))});
    }
    const W least = smallest_radius(points);
    const W excess = W(circle.radius) - least;
    const W bound = 8 * W(epsilon) * (least + largest);
    tally.worst = std::max(tally.worst, bound > 0 ? double(std::abs(excess) / bound) : 0.0);
    if (bound == 0) {
        ASSERT_EQ(circle.radius, Real(0));
    }
}

Vec2 rounded(const Wide &p) {
    return {static_cast<Real>(p.x), static_cast<Real>(p.y)};
}

TEST(Enclosing2, CircleIsTheSmallest) {
    Random random(0x2d41);
    Tally tally;
    std::vector<Vec2> points;
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const Vec2 center = any_position(random);
        const Real size = any_size(random);
        // Usually few: there are n^3 / 6 triples.
        const std::uint32_t count = 1 + random.next_index(random.next_index(8) == 0 ? 9 : 4);
        const std::uint32_t family = random.next_index(7);
        const Wide u = any_unit(random);
        const W flat = W(any_magnitude(random, -16.0, -1.0));
        points.clear();
        for (std::uint32_t i = 0; i < count; ++i) {
            const W s = W(random.next_in(-1.0, 1.0));
            Wide p{0, 0};
            switch (family) {
            case 0: // anywhere
                p = {s, W(random.next_in(-1.0, 1.0))};
                break;
            case 1: // on one circle, up to rounding
                p = any_unit(random);
                break;
            case 2: // nearly on one circle
                p = any_unit(random) * (1 + flat * s);
                break;
            case 3: // on one line, up to rounding
                p = u * s;
                break;
            case 4: // nearly on one line
                p = u * s + Wide{-u.y, u.x} * (flat * W(random.next_in(-1.0, 1.0)));
                break;
            case 5: // in three bunches
                p = Wide{std::cos(W(i % 3) * 2), std::sin(W(i % 3) * 2)} + flat * any_unit(random);
                break;
            default: // in two bunches: needles
                p = Wide{W(i % 2), 0} + flat * any_unit(random);
            }
            points.push_back(rounded(wide(center) + p * W(size)));
        }
        if (random.next_index(4) == 0)
            points.push_back(points[random.next_index(count)]);
        check_circle(tally, points);
    }
    EXPECT_LE(tally.worst, 1.0);
}

TEST(Enclosing2, CircleAroundManyPoints) {
    // Brute force over the corners of the hull alone, which determine the circle.
    Random random(0x2d42);
    for (int trial = 0; trial < trials(300); ++trial) {
        const Real size = any_size(random);
        std::vector<Vec2> corners;
        for (int i = 0; i < 12; ++i)
            corners.push_back(rounded(any_unit(random) * W(size)));
        std::vector<Vec2> points = corners;
        for (int i = 0; i < 3000; ++i) {
            // Between two corners, pulled in so that rounding leaves it inside.
            const Wide a = wide(corners[random.next_index(12)]);
            const Wide b = wide(corners[random.next_index(12)]);
            const Wide c = wide(corners[random.next_index(12)]);
            const Wide middle = (a + b + c) / W(3);
            points.push_back(rounded(middle + W(0.9) * W(random.next_unit()) * (a - middle)));
        }
        for (std::size_t i = points.size(); i > 1; --i)
            std::swap(points[i - 1], points[random.next_index(std::uint32_t(i))]);
        const Circle circle = containing_circle(points);
        const W least = smallest_radius(corners);
        ASSERT_NEAR(double(circle.radius), double(least), 8.0 * epsilon * double(least + size));
        for (const Vec2 &p : points)
            ASSERT_TRUE(contains(circle, p));
    }
}

TEST(Enclosing2, NoRoundsAreMissing) {
    // A circle covered in points, and a line: the iteration limit is never reached, here or above.
    Random random(0x2d43);
    for (const int count : {1'000, trials(1'000'000)}) {
        std::vector<Vec2> points;
        for (int i = 0; i < count; ++i)
            points.push_back(rounded(any_unit(random)));
        const Circle circle = containing_circle(points);
        ASSERT_NEAR(double(circle.radius), 1.0, count > 1000 ? 8.0 * epsilon : 1e-2);
    }
    EXPECT_EQ(oddity("containing_circle ran out of rounds").met, 0U);
    EXPECT_GT(oddity("containing_circle ran out of rounds").looked, 0U);
}

TEST(Enclosing2, CircleIsExactWhereItCanBe) {
    const auto around = [](std::vector<Vec2> points) { return containing_circle(points); };
    const Circle one = around({{Real(3), Real(4)}});
    EXPECT_EQ(one.center, (Vec2{Real(3), Real(4)}));
    EXPECT_EQ(one.radius, Real(0));
    const Circle same = around({{Real(3), Real(4)}, {Real(3), Real(4)}, {Real(3), Real(4)}});
    EXPECT_EQ(same.radius, Real(0));
    const Circle two = around({{Real(0), Real(0)}, {Real(6), Real(8)}});
    EXPECT_EQ(two.center, (Vec2{Real(3), Real(4)}));
    EXPECT_EQ(two.radius, Real(5));
    const Circle line = around({{Real(1), Real(1)},
                                {Real(9), Real(9)},
                                {Real(5), Real(5)},
                                {Real(3), Real(3)},
                                {Real(9), Real(9)}});
    EXPECT_EQ(line.center, (Vec2{Real(5), Real(5)}));
    const Circle square = around({{Real(0), Real(0)},
                                  {Real(6), Real(0)},
                                  {Real(6), Real(8)},
                                  {Real(0), Real(8)},
                                  {Real(3), Real(4)}});
    EXPECT_EQ(square.center, (Vec2{Real(3), Real(4)}));
    EXPECT_EQ(square.radius, Real(5));
    const Circle acute = around({{Real(-4), Real(-3)}, {Real(4), Real(-3)}, {Real(0), Real(5)}});
    EXPECT_EQ(acute.center, (Vec2{Real(0), Real(0)}));
    EXPECT_EQ(acute.radius, Real(5));
}

TEST(Enclosing2, RectangleIsExact) {
    Random random(0x2d44);
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        std::vector<Vec2> points;
        for (std::uint32_t i = 0; i <= random.next_index(9); ++i)
            points.push_back(any_position(random));
        const Rectangle rectangle = containing_rectangle(points);
        std::vector<Real> x, y;
        for (const Vec2 &p : points) {
            ASSERT_TRUE(contains(rectangle, p));
            x.push_back(p.x);
            y.push_back(p.y);
        }
        std::sort(x.begin(), x.end());
        std::sort(y.begin(), y.end());
        ASSERT_EQ(rectangle.min, (Vec2{x.front(), y.front()}));
        ASSERT_EQ(rectangle.max, (Vec2{x.back(), y.back()}));
    }
}

TEST(Enclosing2, SaysWhatIsWrong) {
    EXPECT_THROW(containing_circle({}), CheckFailure);
    EXPECT_THROW(containing_rectangle({}), CheckFailure);
    const std::vector<Vec2> points{Vec2{Real(1)}, Vec2{std::numeric_limits<Real>::quiet_NaN()}};
    EXPECT_THROW(containing_circle(points), CheckFailure);
    EXPECT_THROW(containing_rectangle(points), CheckFailure);
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
