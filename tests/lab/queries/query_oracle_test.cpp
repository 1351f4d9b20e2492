#include "app/lab/queries/query_oracle.h"

#include "engine/core/random.h"
#include "tests/trials.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace plumb::oracle {
namespace {

// Cases small enough to check every point of a fine grid. Shapes that meet share a grid point when
// all crossings lie on multiples of 1 / lcm of the slopes, so the grid can only prove a yes.
constexpr Int grid = 12;

Point any_point(Random &random, Int reach) {
    const auto one = [&] {
        return static_cast<Int>(random.next_index(static_cast<std::uint32_t>(2 * reach + 1))) -
               reach;
    };
    const Int x = one(), y = one(), z = one();
    return {x, y, z};
}

Point scaled(const Point &p, Int by) {
    return {p.x * by, p.y * by, p.z * by};
}

TEST(QueryOracle, PointsOfLinesThatLieInShapesProveThatTheyMeet) {
    Random random(1);
    int met = 0;
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const Line line{any_point(random, 3), any_point(random, 3), true};
        const Point p = any_point(random, 3), q = any_point(random, 3);
        const Block block{{std::min(p.x, q.x), std::min(p.y, q.y), std::min(p.z, q.z)},
                          {std::max(p.x, q.x), std::max(p.y, q.y), std::max(p.z, q.z)}};
        const Ball ball{any_point(random, 3), static_cast<Int>(random.next_index(4))};
        // Everything scaled by twelve, and the line's points at its twelfths.
        const Block big_block{scaled(block.min, grid), scaled(block.max, grid)};
        const Ball big_ball{scaled(ball.center, grid), ball.radius * grid};
        for (Int k = 0; k <= grid; ++k) {
            const Point on = scaled(line.origin, grid) + scaled(line.along, k);
            ASSERT_TRUE(
                contains(Line{scaled(line.origin, grid), scaled(line.along, grid), true}, on));
            const auto within = [&](int i) {
                return on[i] >= big_block.min[i] && on[i] <= big_block.max[i];
            };
            if (within(0) && within(1) && within(2)) {
                ASSERT_TRUE(meets(line, block)) << trial;
                ++met;
            }
            if (contains(big_ball, on)) {
                ASSERT_TRUE(meets(line, ball)) << trial;
            }
        }
    }
    EXPECT_GT(met, trials(1'000'000) / 4);
}

TEST(QueryOracle, TriangleHasItsCornersEdgesAndMiddle) {
    Random random(2);
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const Corners t{any_point(random, 5), any_point(random, 5), any_point(random, 5)};
        const Corners big{scaled(t[0], 6), scaled(t[1], 6), scaled(t[2], 6)};
        const Point half = scaled(t[0] + t[1], 3);
        const Point middle = scaled(t[0] + t[1] + t[2], 2);
        for (const Point &p : {big[0], big[1], big[2], half, middle}) {
            ASSERT_TRUE(contains(big, p)) << trial;
            ASSERT_TRUE(meets(Line{p, any_point(random, 5), true}, big)) << trial;
            ASSERT_TRUE(meets(big, Corners{p, any_point(random, 30), any_point(random, 30)}))
                << trial;
            ASSERT_TRUE(meets(big, Block{p, p})) << trial;
        }
    }
}

TEST(QueryOracle, APlaneBetweenThemProvesThatTheyDoNotMeet) {
    Random random(3);
    int apart = 0;
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const Corners t{any_point(random, 5), any_point(random, 5), any_point(random, 5)};
        const Corners u{any_point(random, 5), any_point(random, 5), any_point(random, 5)};
        const Point n = any_point(random, 5);
        const auto height = [&](const Point &p) { return p.x * n.x + p.y * n.y + p.z * n.z; };
        const Int top = std::max({height(t[0]), height(t[1]), height(t[2])});
        const Int bottom = std::min({height(u[0]), height(u[1]), height(u[2])});
        if (top >= bottom)
            continue;
        ++apart;
        ASSERT_FALSE(meets(t, u));
        ASSERT_FALSE(meets(Line{t[0], t[1] - t[0], true}, u));
        ASSERT_FALSE(contains(u, t[0]));
    }
    EXPECT_GT(apart, trials(1'000'000) / 100);
}

TEST(QueryOracle, KnowsTheEdgesOfSets) {
    const Block block{{0, 0, 0}, {2, 2, 2}};
    EXPECT_TRUE(meets(Line{{-1, 2, 1}, {1, 0, 0}}, block)); // in a face
    EXPECT_TRUE(meets(Line{{-1, 2, 2}, {1, 0, 0}}, block)); // in an edge
    EXPECT_TRUE(meets(Line{{3, 3, 3}, {-1, -1, -1}}, block));
    EXPECT_FALSE(meets(Line{{3, 3, 3}, {1, 1, 1}}, block));
    EXPECT_TRUE(meets(Line{{1, 1, 1}, {}, true}, block)); // a point inside
    EXPECT_FALSE(meets(Line{{-2, 1, 1}, {1, 0, 0}, true}, block));
    EXPECT_TRUE(meets(Line{{-2, 1, 1}, {2, 0, 0}, true}, block));
    EXPECT_TRUE(contains(Ball{{0, 0, 0}, 5}, {3, 4, 0}));
    EXPECT_TRUE(meets(Line{{-9, 5, 0}, {1, 0, 0}}, Ball{{0, 0, 0}, 5})); // a tangent
    EXPECT_FALSE(meets(Line{{9, 0, 0}, {1, 0, 0}}, Ball{{0, 0, 0}, 5})); // behind
    const Corners t{{{0, 0, 0}, {4, 0, 0}, {0, 0, 4}}};
    EXPECT_TRUE(meets(Line{{2, 1, 2}, {0, -1, 0}}, t));  // through an edge
    EXPECT_FALSE(meets(Line{{3, 1, 2}, {0, -1, 0}}, t)); // past it
    EXPECT_TRUE(meets(Line{{-1, 0, 1}, {1, 0, 0}}, t));  // in its plane
    EXPECT_FALSE(meets(Line{{-1, 0, 1}, {-1, 0, 0}}, t));
    EXPECT_TRUE(meets(t, Corners{{{4, 0, 0}, {9, 0, 0}, {9, 0, 9}}})); // by a corner, coplanar
    EXPECT_FALSE(meets(t, Corners{{{5, 0, 0}, {9, 0, 0}, {9, 0, 9}}}));
}

} // namespace
} // namespace plumb::oracle
