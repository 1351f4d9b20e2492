#include "engine/geometry/sat.h"

#include "engine/core/check.h"
#include "tests/geometry/oracle.h"
#include "tests/trials.h"

#include <gtest/gtest.h>

#include <utility>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace oracle;

// Sizes are below 4 m; centre, rotation and projection take some 20 roundings.
constexpr double rounding = 20 * 0.5 * 4 * double(std::numeric_limits<Real>::epsilon());

// Pairs that nearly touch, many with parallel or nearly parallel edges.
std::pair<Box, Box> any_boxes(Random &random, bool is_awkward) {
    const auto any = [&] {
        const Vec3 half{any_real(random, 0.05, 0.9), any_real(random, 0.05, 0.9),
                        any_real(random, 0.05, 0.9)};
        return Box{any_vector(random, 0.5),
                   is_awkward ? awkward_rotation(random) : any_rotation(random), half};
    };
    Box a = any(), b = any();
    const V u = any_direction(random);
    const double gap = random.next_in(-1.0, 0.3) * std::pow(10.0, -double(random.next_index(8)));
    const double along = std::max(0.0, translation_along(Solid(a), Solid(b), u) + gap);
    // A random part of the separating translation, to close in on touching.
    const V by = u * along * random.next_in(0.6, 1.0);
    b.center += Vec3{Real(by.x), Real(by.y), Real(by.z)};
    return {a, b};
}

TEST(Sat, OverlapAgainstClipping) {
    Random random(1);
    int overlapping = 0;
    const int count = trials(100'000); // box_overlap_test.cpp runs the million
    for (int trial = 0; trial < count; ++trial) {
        const auto [a, b] = any_boxes(random, trial % 2 == 0);
        const bool answer = overlaps(a, b);
        overlapping += answer;
        // The answer is right outside a rounding band around touching.
        if (answer) {
            ASSERT_TRUE(boxes_meet(WideBox(a), WideBox(b), rounding)) << "trial " << trial;
        } else {
            ASSERT_FALSE(boxes_meet(WideBox(a), WideBox(b), -rounding)) << "trial " << trial;
        }
    }
    EXPECT_GT(overlapping, count / 5);
    EXPECT_LT(overlapping, count / 5 * 4);
}

TEST(Sat, SeparationIsTrueOfItsAxisAndABoundOfTheDistance) {
    Random random(2);
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const auto [a, b] = any_boxes(random, trial % 2 == 0);
        const SatResult result = separating_axis(a, b);
        const V n = wide(result.normal);
        const Solid wide_a(a), wide_b(b);
        ASSERT_NEAR(glm::length(n), 1.0, rounding);
        ASSERT_NEAR(double(result.separation), -translation_along(wide_a, wide_b, n), rounding);
        // When the boxes overlap, no other direction is better by more than rounding.
        for (int i = 0; i < 6 && result.separation <= Real(0); ++i)
            ASSERT_GE(translation_along(wide_a, wide_b, any_direction(random)),
                      -double(result.separation) - rounding);
        if (trial % 10 == 0 && result.separation > Real(0)) {
            ASSERT_LE(double(result.separation), distance(wide_a, wide_b) + rounding);
        }
        if (std::abs(double(result.separation)) > rounding) {
            ASSERT_EQ(overlaps(a, b), result.separation <= Real(0));
        }
    }
}

// Two boxes with crossing edges: only an edge-edge axis separates them.
TEST(Sat, FindsEdgeEdgeAxes) {
    Random random(3);
    const double h = 0.70710678118654752440;
    for (int trial = 0; trial < trials(100'000); ++trial) {
        // Each box stands on an edge; seen from above, the edges cross at right angles.
        const Quat on_z{Real(std::cos(0.39269908169872414)), Real(0), Real(0),
                        Real(std::sin(0.39269908169872414))};
        const Quat on_x{Real(std::cos(0.39269908169872414)), Real(std::sin(0.39269908169872414)),
                        Real(0), Real(0)};
        const double gap = random.next_in(1e-3, 0.05);
        const Real half = any_real(random, 0.5, 1.0);
        const double reach = 2.0 * h * double(half);
        const Box a{Vec3{Real(0)}, on_z, Vec3{half}};
        const Box b{{Real(0), Real(2.0 * reach + gap), Real(0)}, on_x, Vec3{half}};
        const SatResult result = separating_axis(a, b);
        EXPECT_EQ(result.axis, SatAxis::edges);
        EXPECT_NEAR(double(result.separation), gap, rounding);
        EXPECT_NEAR(double(result.normal.y), 1.0, rounding);
        EXPECT_FALSE(overlaps(a, b));
        const Box closer{{Real(0), Real(2.0 * reach - gap), Real(0)}, on_x, Vec3{half}};
        EXPECT_TRUE(overlaps(a, closer));
    }
}

TEST(Sat, ParallelAndIdenticalBoxes) {
    const Box a{Vec3{Real(0)}, identity_rotation, Vec3{Real(0.5)}};
    EXPECT_TRUE(overlaps(a, a));
    EXPECT_EQ(separating_axis(a, a).separation, Real(-1));
    Box b = a;
    b.center.x = Real(1); // touching: sets are closed
    EXPECT_TRUE(overlaps(a, b));
    EXPECT_EQ(separating_axis(a, b).separation, Real(0));
    b.center.x = std::nextafter(Real(1), Real(2));
    EXPECT_FALSE(overlaps(a, b));
    b.center = {Real(1), Real(1), Real(1)}; // by a corner
    EXPECT_TRUE(overlaps(a, b));
    // A point and a plate have zero extent in some directions.
    const Box point{{Real(0.5), Real(0), Real(0)}, identity_rotation, Vec3{Real(0)}};
    EXPECT_TRUE(overlaps(a, point));
    EXPECT_TRUE(overlaps(point, point));
}

TEST(Sat, MisuseNamesTheValue) {
    const Box good{Vec3{Real(0)}, identity_rotation, Vec3{Real(1)}};
    const Box bad{Vec3{Real(0)}, identity_rotation, Vec3{Real(-3)}};
    try {
        overlaps(good, bad);
        FAIL();
    } catch (const CheckFailure &error) {
        EXPECT_NE(std::string(error.what()).find("-3"), std::string::npos) << error.what();
    }
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
