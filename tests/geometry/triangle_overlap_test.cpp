#include "engine/geometry/triangle_overlap.h"

#include "engine/core/random.h"
#include "engine/geometry/raycast.h"
#include "engine/geometry/triangle.h"
#include "tests/geometry/exact.h"
#include "tests/geometry/wide_triangle.h"
#include "tests/says.h"
#include "tests/trials.h"

#include <gtest/gtest.h>

#include <string>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace exact_oracle;
using namespace wide_triangle;

// Integer points of a few bits, where coplanar, touching, flat and equal triangles are common; and
// of 20 bits, a few units of the last place apart, at sizes of 1e5 m and 1e-3 m.
struct Grid {
    int reach;
    int offset;
    double scale; // units per metre

    Vec3 point(Random &random) const {
        const auto coordinate = [&] {
            const int units = offset + int(random.next_index(2 * std::uint32_t(reach) + 1)) - reach;
            return static_cast<Real>(double(units) / scale);
        };
        return {coordinate(), coordinate(), coordinate()};
    }
    // Relative to the middle of the grid.
    template <typename Whole> Whole3<Whole> whole(const Vec3 &v) const {
        return exact_oracle::whole<Whole>(v, scale, offset);
    }
    // Calls `ask` with an integer large enough for the oracle, for its type.
    template <typename Ask> bool in_whole_numbers(const Ask &ask) const {
        return reach < 4096 ? ask(0LL) : ask(Int128(0));
    }
};

template <typename Whole> Polytope<Whole> whole(const Grid &grid, const Triangle &t) {
    return Polytope<Whole>::triangle(grid.whole<Whole>(t.a), grid.whole<Whole>(t.b),
                                     grid.whole<Whole>(t.c));
}
template <typename Whole> Polytope<Whole> whole(const Grid &grid, const Segment &s) {
    return Polytope<Whole>::segment(grid.whole<Whole>(s.a), grid.whole<Whole>(s.b));
}
template <typename Whole> Polytope<Whole> whole(const Grid &grid, const Aabb &box) {
    return Polytope<Whole>::box(grid.whole<Whole>(box.min), grid.whole<Whole>(box.max));
}
template <typename Whole> Polytope<Whole> whole(const Grid &grid, const Vec3 &point) {
    return Polytope<Whole>::point(grid.whole<Whole>(point));
}

template <typename A, typename B> bool truly_meet(const Grid &grid, const A &a, const B &b) {
    return grid.in_whole_numbers([&](auto zero) {
        using Whole = decltype(zero);
        return polytopes_meet(whole<Whole>(grid, a), whole<Whole>(grid, b));
    });
}

constexpr Grid grids[] = {
    {1, 0, 1.0},           {3, 0, 1.0},     {9, 0, 1.0},          {9, 12'800'000, 128.0},
    {1000, -800'000, 8.0}, {40, 0, 0x1p15}, {500'000, 0, 0x1p29},
};

// Sometimes shares corners with another triangle, has two equal corners, or three in a line.
Triangle any_triangle(Random &random, const Grid &grid, const Triangle &other) {
    Triangle t{grid.point(random), grid.point(random), grid.point(random)};
    switch (random.next_index(10)) {
    case 0:
        t.a = other.b;
        break;
    case 1:
        t.a = other.c;
        t.b = other.a;
        break;
    case 2:
        t.c = t.a;
        break;
    case 3:
        t.c = t.b + (t.b - t.a);
        break;
    case 4: // in the other's plane
        t.a = other.a + (other.b - other.c);
        t.b = other.b + (other.c - other.a);
        t.c = t.c.x < other.a.x ? other.c : other.a + (other.a - other.c);
        break;
    default:
        break;
    }
    return t;
}

TEST(TriangleOverlap, TriangleIsExact) {
    Random random(21);
    int meets = 0;
    const int count = trials(1'000'000);
    for (int trial = 0; trial < count; ++trial) {
        const Grid &grid = grids[random.next_index(std::size(grids))];
        const Triangle first{grid.point(random), grid.point(random), grid.point(random)};
        const Triangle a = any_triangle(random, grid, first);
        const Triangle b = any_triangle(random, grid, a);
        const bool answer = overlaps(a, b);
        ASSERT_EQ(answer, truly_meet(grid, a, b)) << "trial " << trial;
        if (trial % 16 == 0) {
            ASSERT_EQ(answer, overlaps(b, a));
            ASSERT_EQ(answer, overlaps(Triangle{a.c, a.b, a.a}, Triangle{b.b, b.c, b.a}));
        }
        meets += answer;
    }
    EXPECT_GT(meets, count / 5);
    EXPECT_LT(meets, count - count / 5);
}

TEST(TriangleOverlap, LinetestAndContainsAreExact) {
    Random random(22);
    int meets = 0, contained = 0;
    const int count = trials(1'000'000);
    for (int trial = 0; trial < count; ++trial) {
        const Grid &grid = grids[random.next_index(std::size(grids))];
        const Triangle first{grid.point(random), grid.point(random), grid.point(random)};
        const Triangle t = any_triangle(random, grid, first);
        const Triangle ends = any_triangle(random, grid, t);
        const bool is_met = linetest(t, ends.a, ends.b);
        ASSERT_EQ(is_met, truly_meet(grid, t, Segment{ends.a, ends.b})) << "trial " << trial;
        meets += is_met;
        if (trial % 4 == 0) {
            const bool is_in = contains(t, ends.a);
            ASSERT_EQ(is_in, truly_meet(grid, t, ends.a));
            ASSERT_EQ(is_in, linetest(t, ends.a, ends.a));
            contained += is_in;
        }
    }
    EXPECT_GT(meets, count / 6);
    EXPECT_GT(contained, count / 40);
}

TEST(TriangleOverlap, AabbIsExact) {
    Random random(23);
    int meets = 0;
    const int count = trials(1'000'000);
    for (int trial = 0; trial < count; ++trial) {
        const Grid &grid = grids[random.next_index(std::size(grids))];
        const Vec3 p = grid.point(random), q = grid.point(random);
        const Aabb box{glm::min(p, q), glm::max(p, q)};
        const Triangle corners{box.min, box.max, Vec3{box.min.x, box.max.y, box.min.z}};
        const Triangle t = any_triangle(random, grid, corners);
        const bool answer = overlaps(t, box);
        ASSERT_EQ(answer, truly_meet(grid, t, box)) << "trial " << trial;
        meets += answer;
        if (trial % 4 == 0) {
            ASSERT_EQ(linetest(box, t.a, t.b), truly_meet(grid, Segment{t.a, t.b}, box));
        }
    }
    EXPECT_GT(meets, count / 5);
    EXPECT_LT(meets, count - count / 5);
    EXPECT_FALSE(overlaps(Triangle{}, Aabb{}));
}

TEST(TriangleOverlap, PlaneIsExact) {
    Random random(24);
    int meets = 0;
    const int count = trials(1'000'000);
    // Unit vectors with components and products that are exact, or rounded: the plane is taken at
    // face value.
    for (int trial = 0; trial < count; ++trial) {
        const Grid &grid = grids[random.next_index(std::size(grids))];
        const Vec3 &n = plane_normals[random.next_index(4)];
        const Triangle t{grid.point(random), grid.point(random), grid.point(random)};
        const Real offset =
            random.next_index(3) == 0 ? glm::dot(n, grid.point(random)) : glm::dot(n, t.b);
        const auto height = [&](const Vec3 &p) { return side_of(n, offset, p); };
        const int low = std::min({height(t.a), height(t.b), height(t.c)});
        const int high = std::max({height(t.a), height(t.b), height(t.c)});
        const bool answer = overlaps(t, Plane{n, offset});
        ASSERT_EQ(answer, low <= 0 && high >= 0);
        ASSERT_EQ(linetest(Plane{n, offset}, t.a, t.b), height(t.a) * height(t.b) <= 0);
        ASSERT_EQ(linetest(HalfSpace{n, offset}, t.a, t.b), height(t.a) <= 0 || height(t.b) <= 0);
        meets += answer;
    }
    EXPECT_GT(meets, count / 5);
    EXPECT_LT(meets, count - count / 20);
}

// The distance between integer points below 64 is the root of a fraction n / q with q < 2^32, so it
// is either an integer radius or at least 2^-32 / (2 r) > 1e-12 away from it.
bool is_at_most(const Range &distance, int radius) {
    EXPECT_LT(distance.high - distance.low, 4e-13L);
    return distance.low < static_cast<long double>(radius) + 4e-13L;
}

TEST(TriangleOverlap, SphereIsExactForSmallIntegers) {
    Random random(25);
    int meets = 0, touches = 0;
    const int count = trials(1'000'000);
    for (int trial = 0; trial < count; ++trial) {
        const Grid grid{random.next_index(2) == 0 ? 3 : 63, 0, 1.0};
        const Triangle t = any_triangle(random, grid, {});
        const Vec3 center = grid.point(random);
        const int radius = int(random.next_index(std::uint32_t(grid.reach) + 1));
        const bool answer = overlaps(t, Sphere{center, Real(radius)});
        const Range distance = distance_to_triangle(wide(t), wide(center));
        ASSERT_EQ(answer, is_at_most(distance, radius)) << "trial " << trial;
        meets += answer;
        touches += std::abs(distance.low - radius) < 4e-13L;
    }
    EXPECT_GT(meets, count / 10);
    EXPECT_GT(touches, count / 200);
}

TEST(TriangleOverlap, CapsuleIsExactForSmallIntegers) {
    Random random(28);
    int meets = 0, touches = 0;
    const int count = trials(1'000'000);
    for (int trial = 0; trial < count; ++trial) {
        const Grid grid{random.next_index(2) == 0 ? 3 : 63, 0, 1.0};
        const Triangle t = any_triangle(random, grid, {});
        const Vec3 a = grid.point(random), b = random.next_index(9) == 0 ? a : grid.point(random);
        const int radius = int(random.next_index(std::uint32_t(grid.reach)));
        const bool answer = overlaps(t, Capsule{a, b, Real(radius)});
        const Range distance = distance_of_segment_to_triangle(wide(t), wide(a), wide(b));
        ASSERT_EQ(answer, is_at_most(distance, radius)) << "trial " << trial;
        meets += answer;
        touches += std::abs(distance.low - radius) < 4e-13L;
    }
    EXPECT_GT(meets, count / 5);
    EXPECT_GT(touches, count / 200);
}

// The stated bound, over all sizes and distances from the origin, including narrow triangles.
TEST(TriangleOverlap, RoundShapesWithinTheBound) {
    Random random(26);
    int meets = 0, sharp = 0;
    const int count = trials(1'000'000);
    for (int trial = 0; trial < count; ++trial) {
        const Triangle t = awkward_triangle(random);
        const double size =
            std::pow(10.0, random.next_in(-3.0, 1.0)) * (1e-3 + double(glm::length(t.b - t.a)));
        const Vec3 p = t.a + Real(random.next_unit()) * (t.b - t.a) + any_offset(random, size);
        const Vec3 q = p + any_offset(random, size);
        const bool is_sphere = trial % 2 == 0;
        const Range distance = is_sphere
                                   ? distance_to_triangle(wide(t), wide(p))
                                   : distance_of_segment_to_triangle(wide(t), wide(p), wide(q));
        const long double largest = std::max({largest_of(t), largest_of(p), largest_of(q)});
        const long double bound = 8.0L * epsilon * std::max(largest, distance.high);
        // A radius that touches to within a few bounds, or any.
        Real radius = static_cast<Real>(distance.low);
        radius += random.next_index(2) == 0
                      ? static_cast<Real>(double(bound) * random.next_in(-4.0, 4.0))
                      : radius * static_cast<Real>(random.next_in(-0.5, 0.5));
        radius = std::max(radius, Real(0));
        const bool answer =
            is_sphere ? overlaps(t, Sphere{p, radius}) : overlaps(t, Capsule{p, q, radius});
        meets += answer;
        if (distance.low > static_cast<long double>(radius) + bound)
            ASSERT_FALSE(answer) << "trial " << trial << " distance " << double(distance.low)
                                 << " radius " << double(radius) << " bound " << double(bound);
        else if (distance.high < static_cast<long double>(radius) - bound)
            ASSERT_TRUE(answer) << "trial " << trial << " distance " << double(distance.high)
                                << " radius " << double(radius) << " bound " << double(bound);
        else
            continue;
        ++sharp;
    }
    EXPECT_GT(meets, count / 4);
    EXPECT_GT(sharp, count / 2);
}

TEST(TriangleOverlap, BoxWithinTheBound) {
    Random random(29);
    int meets = 0, sharp = 0;
    const int count = trials(1'000'000);
    for (int trial = 0; trial < count; ++trial) {
        const double size = std::pow(10.0, random.next_in(-3.0, 5.0));
        const Vec3 center = any_offset(random, random.next_index(2) == 0 ? size : 1e5);
        const Quat rotation = any_rotation(random);
        const Box box{center, rotation,
                      glm::abs(any_offset(random, random.next_index(4) == 0 ? 1e-3 : size))};
        const Triangle t{center + any_offset(random, 2.0 * size),
                         center + any_offset(random, 2.0 * size),
                         center + any_offset(random, 2.0 * size)};
        const bool answer = overlaps(t, box);
        meets += answer;
        const long double bound =
            8.0L * epsilon *
            std::max(largest_of(t),
                     static_cast<long double>(largest_of(center) + largest_of(box.half_extents)));
        if (clipped_by_box(t, box, -bound))
            ASSERT_TRUE(answer) << "trial " << trial;
        else if (!clipped_by_box(t, box, bound))
            ASSERT_FALSE(answer) << "trial " << trial;
        else
            continue;
        ++sharp;
    }
    EXPECT_GT(meets, count / 10);
    EXPECT_GT(sharp, count / 2);
}

TEST(TriangleOverlap, MisuseNamesTheValue) {
    const Real nan = std::numeric_limits<Real>::quiet_NaN();
    const Real inf = std::numeric_limits<Real>::infinity();
    const Triangle good{{Real(0), Real(0), Real(0)}, {Real(1), Real(0), Real(0)}, Vec3{Real(1)}};
    const Triangle bad{Vec3{Real(0)}, {Real(1), inf, Real(0)}, Vec3{Real(1)}};
    says([&] { overlaps(good, bad); }, "inf");
    says([&] { overlaps(bad, good); }, "inf");
    says([&] { overlaps(bad, Sphere{}); }, "inf");
    says([&] { overlaps(good, Sphere{Vec3{nan}, Real(1)}); }, "nan");
    says([&] { overlaps(good, Sphere{Vec3{Real(0)}, Real(-3)}); }, "-3");
    says([&] { overlaps(Capsule{Vec3{Real(0)}, Vec3{Real(1)}, Real(-4)}, good); }, "-4");
    says([&] { overlaps(bad, Aabb{}); }, "inf");
    says([&] { overlaps(good, Plane{{Real(0), Real(5), Real(0)}, Real(0)}); }, "5");
    says([&] { linetest(good, Vec3{nan}, Vec3{Real(0)}); }, "nan");
    says([&] { contains(bad, Vec3{Real(0)}); }, "inf");
    says([&] { closest_point(good, Vec3{inf}); }, "inf");
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
