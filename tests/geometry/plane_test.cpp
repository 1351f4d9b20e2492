#include "engine/geometry/plane.h"

#include "tests/geometry/wide.h"
#include "tests/says.h"
#include "tests/trials.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace wide;

// A shape's heights above a plane, in metres.
struct Reach {
    W lowest = std::numeric_limits<W>::infinity();
    W highest = -std::numeric_limits<W>::infinity();

    void add(W height) {
        lowest = std::min(lowest, height);
        highest = std::max(highest, height);
    }
};

W height_over(const Plane &plane, const W3 &p) {
    const W3 n = widened(plane.normal);
    return (glm::dot(n, p) - W(plane.offset)) / glm::length(n);
}

void judge(const PlaneTest &answer, const Reach &reach, W bound, int trial) {
    const W distance = reach.lowest > W(0)    ? reach.lowest
                       : reach.highest < W(0) ? reach.highest
                                              : W(0);
    ASSERT_LE(std::abs(W(answer.distance) - distance), bound) << "trial " << trial;
    if (std::abs(reach.lowest) > bound && std::abs(reach.highest) > bound) {
        const PlaneSide side = reach.lowest > W(0)    ? PlaneSide::in_front
                               : reach.highest < W(0) ? PlaneSide::behind
                                                      : PlaneSide::across;
        ASSERT_EQ(answer.side, side) << "trial " << trial;
    }
    ASSERT_EQ(answer.side == PlaneSide::across, answer.distance == Real(0));
}

TEST(PlaneClassify, RoundShapesAndBoxesOfAnySize) {
    Random random(1);
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const W size = any_size(random);
        const W3 n = awkward_unit(random);
        const W off_unit = random.next_index(8) == 0 ? W(random.next_in(-9e-4, 9e-4)) : W(0);
        // The shape's middle, with the plane about as far away as its surface.
        const W3 middle = any_position(random);
        const W away = random.next_index(2) == 0 ? W(random.next_in(-3, 3)) * size
                                                 : size + any_gap(random, size);
        const Plane plane{narrowed(n * (W(1) + off_unit)),
                          static_cast<Real>((glm::dot(n, middle) + away) * (W(1) + off_unit))};
        const W scale = std::max(W(std::abs(plane.offset)), W(2) * size);
        const auto bound = [&](W shape) { return 8 * epsilon * std::max(scale, shape); };

        const Sphere sphere{narrowed(middle), static_cast<Real>(size)};
        Reach reach;
        for (const W side : {W(-1), W(1)})
            reach.add(height_over(plane, widened(sphere.center)) + side * W(sphere.radius));
        judge(classify(plane, sphere), reach, bound(scale_of(sphere)), trial);

        const Box box{narrowed(middle), oracle::awkward_rotation(random),
                      any_half_extents(random, size)};
        const Frame frame(box);
        reach = {};
        for (int k = 0; k < 8; ++k)
            reach.add(height_over(plane, frame.corner(k)));
        judge(classify(plane, box), reach, bound(scale_of(box)), trial);

        const Aabb aabb{box.center - box.half_extents, box.center + box.half_extents};
        reach = {};
        for (int k = 0; k < 8; ++k)
            reach.add(height_over(plane, Frame(aabb).corner(k)));
        judge(classify(plane, aabb), reach, bound(scale_of(aabb)), trial);

        const W3 u = awkward_unit(random) * size;
        const Capsule capsule{narrowed(middle), narrowed(middle + u),
                              static_cast<Real>(size * any_power(random, -2, 0))};
        reach = {};
        for (const Vec3 &end : {capsule.a, capsule.b})
            for (const W side : {W(-1), W(1)})
                reach.add(height_over(plane, widened(end)) + side * W(capsule.radius));
        judge(classify(plane, capsule), reach, bound(scale_of(capsule)), trial);

        const Cylinder cylinder{capsule.a, capsule.b, capsule.radius};
        if (cylinder.a != cylinder.b) {
            // Two directions perpendicular to the axis: the rim's highest point is up by their
            // hypotenuse.
            const W3 axis = glm::normalize(widened(cylinder.b) - widened(cylinder.a));
            const W3 e = std::abs(axis.x) < W(0.6) ? W3{1, 0, 0} : W3{0, 1, 0};
            const W3 e1 = glm::normalize(glm::cross(axis, e)), e2 = glm::cross(axis, e1);
            const W3 normal = glm::normalize(widened(plane.normal));
            const W rim = std::hypot(glm::dot(normal, e1), glm::dot(normal, e2));
            reach = {};
            for (const Vec3 &end : {cylinder.a, cylinder.b})
                for (const W side : {W(-1), W(1)})
                    reach.add(height_over(plane, widened(end)) + rim * side * W(cylinder.radius));
            judge(classify(plane, cylinder), reach, bound(scale_of(cylinder)), trial);
        }
        if (HasFatalFailure())
            return;
    }
}

TEST(PlaneClassify, PointsAreExact) {
    Random random(2);
    int across = 0;
    const auto any_int = [&](std::int64_t reach) {
        return std::int64_t(random.next_index(std::uint32_t(2 * reach + 1))) - reach;
    };
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        // A normal in multiples of 2^-12, and points within about an integer of the plane.
        const double angle = random.next_in(0.0, 6.28);
        const std::int64_t mx = std::int64_t(4096.0 * std::cos(angle));
        const std::int64_t my = std::int64_t(4096.0 * std::sin(angle));
        const Plane plane{Vec3{Real(mx), Real(my), Real(0)} / Real(4096), Real(0)};
        std::array<Vec3, 3> corners;
        int behind = 0, in_front = 0;
        for (Vec3 &corner : corners) {
            const std::int64_t far = any_int(1 << 10);
            const std::int64_t x = my * far + any_int(1), y = -mx * far, z = any_int(100);
            corner = {Real(x), Real(y), Real(z)};
            const std::int64_t height = mx * x + my * y;
            behind += height < 0;
            in_front += height > 0;
            const PlaneTest test = classify(plane, corner);
            ASSERT_EQ(test.side, height < 0   ? PlaneSide::behind
                                 : height > 0 ? PlaneSide::in_front
                                              : PlaneSide::across);
            ASSERT_LE(std::abs(W(test.distance) - height_over(plane, widened(corner))),
                      8 * epsilon * scale_of(corner));
        }
        const PlaneSide side = in_front == 3 ? PlaneSide::in_front
                               : behind == 3 ? PlaneSide::behind
                                             : PlaneSide::across;
        across += side == PlaneSide::across;
        ASSERT_EQ(classify(plane, Triangle{corners[0], corners[1], corners[2]}).side, side);
        ASSERT_EQ(classify(plane, Triangle{corners[2], corners[2], corners[2]}).side,
                  classify(plane, corners[2]).side);
        const PlaneSide a = classify(plane, corners[0]).side;
        const PlaneSide b = classify(plane, corners[1]).side;
        ASSERT_EQ(classify(plane, Segment{corners[0], corners[1]}).side,
                  a == b ? a : PlaneSide::across);
    }
    EXPECT_GT(across, trials(1'000'000) / 4);
}

TEST(PlaneClassify, WholeNumbersAreExact) {
    Random random(3);
    const auto any_int = [&](int reach) {
        return int(random.next_index(std::uint32_t(2 * reach + 1))) - reach;
    };
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        Vec3 normal{Real(0)};
        const int axis = int(random.next_index(3));
        const int sign = random.next_index(2) == 0 ? 1 : -1;
        normal[axis] = Real(sign);
        const int offset = any_int(9);
        const Plane plane{normal, Real(offset)};
        const int c = any_int(9), r = int(random.next_index(5));
        Vec3 center{Real(any_int(9)), Real(any_int(9)), Real(any_int(9))};
        center[axis] = Real(c);
        const int lowest = sign * c - r - offset, highest = sign * c + r - offset;
        const PlaneSide side = lowest > 0    ? PlaneSide::in_front
                               : highest < 0 ? PlaneSide::behind
                                             : PlaneSide::across;
        const Real distance = Real(lowest > 0 ? lowest : highest < 0 ? highest : 0);
        Vec3 half{Real(3), Real(4), Real(5)};
        half[axis] = Real(r);
        for (const PlaneTest &test : {classify(plane, Sphere{center, Real(r)}),
                                      classify(plane, Box{center, identity_rotation, half}),
                                      classify(plane, Aabb{center - half, center + half}),
                                      classify(plane, Capsule{center, center, Real(r)})}) {
            ASSERT_EQ(test.side, side);
            ASSERT_EQ(test.distance, distance);
        }
    }
}

// --- Intersections -----------------------------------------------------------------------------

// A unit normal at an angle of about `sine` to n.
W3 turned(Random &random, const W3 &n, W sine) {
    W3 v = any_unit(random);
    v -= n * glm::dot(n, v);
    return glm::normalize(n + glm::normalize(v) * sine);
}

TEST(PlaneIntersection, LineOfTwo) {
    Random random(4);
    int none = 0;
    const W least = std::sqrt(epsilon);
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const W3 n = awkward_unit(random);
        const W3 m = random.next_index(2) == 0 ? awkward_unit(random)
                                               : turned(random, n, any_power(random, -9, 0)) *
                                                     (random.next_index(2) == 0 ? W(1) : W(-1));
        const Plane a{narrowed(n), static_cast<Real>(any_gap(random, any_size(random)))};
        const Plane b{narrowed(m), static_cast<Real>(any_gap(random, any_size(random)))};
        const W3 na = widened(a.normal), nb = widened(b.normal);
        W3 cross = glm::cross(na, nb);
        W sine = glm::length(cross);
        const std::optional<Line> line = intersection(a, b);
        if (std::abs(sine - least) > least * W(1e-3)) {
            ASSERT_EQ(line.has_value(), sine > least) << "trial " << trial << ", sine " << sine;
        }
        none += !line;
        if (!line)
            continue;
        const W3 p = widened(line->point), d = widened(line->direction);
        const W offset = std::max(std::abs(W(a.offset)), std::abs(W(b.offset)));
        if (sine < W(1e-3)) { // cancels; the careful product is slow
            cross = full_cross(na, nb);
            sine = glm::length(cross);
        }
        const W3 exact_direction = cross / sine;
        // In wider numbers, checked to be on both planes and the nearest such point to the origin.
        const W3 exact =
            (glm::cross(nb, cross) * W(a.offset) + glm::cross(cross, na) * W(b.offset)) /
            (sine * sine);
        const W tiny =
            16 * std::numeric_limits<W>::epsilon() * (glm::length(exact) + offset / sine);
        ASSERT_LE(std::abs(height_over(a, exact)), tiny);
        ASSERT_LE(std::abs(height_over(b, exact)), tiny);
        ASSERT_LE(std::abs(glm::dot(exact, exact_direction)), tiny);
        ASSERT_LE(glm::length(p - exact), 8 * epsilon * offset / sine)
            << "trial " << trial << ", sine " << sine;
        ASSERT_LE(glm::length(d - exact_direction), 8 * epsilon) << "trial " << trial;
    }
    EXPECT_GT(none, trials(1'000'000) / 50);
}

TEST(PlaneIntersection, PointOfThree) {
    Random random(5);
    int none = 0;
    const W least = std::sqrt(epsilon);
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const W3 n = awkward_unit(random);
        const W3 m = random.next_index(2) == 0 ? awkward_unit(random)
                                               : turned(random, n, any_power(random, -4, 0));
        W3 o = awkward_unit(random);
        if (random.next_index(4) == 0) { // nearly perpendicular to the line of the other two
            const W3 mixed = n * W(random.next_in(-1, 1)) + m;
            o = glm::normalize(mixed + o * any_power(random, -8, -1));
        }
        std::array<Plane, 3> planes{Plane{narrowed(n), 0}, Plane{narrowed(m), 0},
                                    Plane{narrowed(o), 0}};
        W offset = 0;
        for (Plane &plane : planes) {
            plane.offset = static_cast<Real>(any_gap(random, any_size(random)));
            offset = std::max(offset, std::abs(W(plane.offset)));
        }
        const W3 na = widened(planes[0].normal), nb = widened(planes[1].normal),
                 nc = widened(planes[2].normal);
        const W volume = std::abs(glm::dot(na, glm::cross(nb, nc)));
        const std::optional<Vec3> point = intersection(planes[0], planes[1], planes[2]);
        if (std::abs(volume - least) > least * W(2e-3)) {
            ASSERT_EQ(point.has_value(), volume > least) << "trial " << trial;
        }
        none += !point;
        if (!point)
            continue;
        // Solved in long double by elimination with column pivoting.
        std::array<std::array<W, 4>, 3> rows;
        for (std::size_t i = 0; i < 3; ++i) {
            const W3 normal = widened(planes[i].normal);
            rows[i] = {normal.x, normal.y, normal.z, W(planes[i].offset)};
        }
        for (std::size_t k = 0; k < 3; ++k) {
            std::size_t pivot = k;
            for (std::size_t i = k; i < 3; ++i)
                if (std::abs(rows[i][k]) > std::abs(rows[pivot][k]))
                    pivot = i;
            std::swap(rows[k], rows[pivot]);
            for (std::size_t i = 0; i < 3; ++i)
                if (i != k) {
                    const W factor = rows[i][k] / rows[k][k];
                    for (std::size_t j = k; j < 4; ++j)
                        rows[i][j] -= factor * rows[k][j];
                }
        }
        const W3 exact{rows[0][3] / rows[0][0], rows[1][3] / rows[1][1], rows[2][3] / rows[2][2]};
        const W bound = 16 * epsilon * (offset + glm::length(exact)) / volume;
        ASSERT_LE(glm::length(widened(*point) - exact), bound)
            << "trial " << trial << ", volume " << volume;
    }
    EXPECT_GT(none, trials(1'000'000) / 100);
}

TEST(PlaneIntersection, AxesAreExactAndParallelHasNone) {
    const Plane x{{Real(1), Real(0), Real(0)}, Real(3)};
    const Plane y{{Real(0), Real(1), Real(0)}, Real(-4)};
    const Plane z{{Real(0), Real(0), Real(-1)}, Real(5)};
    EXPECT_EQ(intersection(x, y, z), (Vec3{Real(3), Real(-4), Real(-5)}));
    const std::optional<Line> line = intersection(x, y);
    ASSERT_TRUE(line.has_value());
    EXPECT_EQ(line->point, (Vec3{Real(3), Real(-4), Real(0)}));
    EXPECT_EQ(line->direction, (Vec3{Real(0), Real(0), Real(1)}));
    EXPECT_FALSE(intersection(x, x).has_value());
    EXPECT_FALSE(intersection(x, Plane{-x.normal, Real(1)}).has_value());
    EXPECT_FALSE(intersection(x, y, y).has_value());
    // Three planes that meet in parallel lines, like a tent.
    const Real s = Real(0.6), c = Real(0.8);
    EXPECT_FALSE(intersection(Plane{{s, c, Real(0)}, Real(1)}, Plane{{-s, c, Real(0)}, Real(1)}, y)
                     .has_value());
}

TEST(PlaneClassify, MisuseNamesTheValue) {
    const Plane good;
    const Real nan = std::numeric_limits<Real>::quiet_NaN();
    says([&] { classify(good, Vec3{Real(7), nan, Real(0)}); }, "(7, nan, 0)");
    says([&] { classify(good, Sphere{Vec3{Real(0)}, Real(-5)}); }, "-5");
    says([&] { classify(Plane{Vec3{Real(9), Real(0), Real(0)}, Real(0)}, Vec3{Real(0)}); }, "9");
    says([&] { classify(good, Aabb{Vec3{Real(6)}, Vec3{Real(1)}}); }, "(6, 6, 6)");
    says([&] { intersection(good, Plane{Vec3{Real(0)}, Real(0)}); }, "(0, 0, 0)");
    says([&] { intersection(good, good, Plane{good.normal, nan}); }, "nan");
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
