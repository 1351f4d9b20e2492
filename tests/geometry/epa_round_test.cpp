// Hulls so round that EPA runs into its limit: checks the depth in wide numbers along every
// possible face normal of the Minkowski difference.
#include "engine/core/check.h"
#include "engine/geometry/epa.h"
#include "engine/geometry/quickhull.h"
#include "tests/geometry/convex_oracle.h"

#include <gtest/gtest.h>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace oracle;

HullMesh fibonacci_hull(int count) {
    std::vector<Vec3> points;
    for (int i = 0; i < count; ++i) {
        const double z = 1.0 - (2.0 * i + 1.0) / count;
        const double angle = i * 3.14159265358979323846 * (3.0 - std::sqrt(5.0));
        const double r = std::sqrt(1.0 - z * z);
        points.push_back({Real(r * std::cos(angle)), Real(r * std::sin(angle)), Real(z)});
    }
    HullResult made = convex_hull(points, count);
    return std::move(*made.mesh);
}

Quat turn(double angle) {
    const double s = std::sin(angle / 2) / std::sqrt(14.0);
    return glm::normalize(
        Quat{Real(std::cos(angle / 2)), Real(1.0 * s), Real(2.0 * s), Real(3.0 * s)});
}

template <typename A, typename B> void expect_least(const A &a, const B &b, const char *what) {
    SCOPED_TRACE(what);
    const Pair<A, B> pair(a, b);
    const std::optional<Penetration> found = penetration(a, b);
    ASSERT_TRUE(found);
    const double least = -double(polytope_separation(pair.wide_a, pair.wide_b));
    const double allowed = (sizeof(Real) == 4 ? 1e-5 : 1e-10) * least;
    const double rounding = 32.0 * double(std::numeric_limits<Real>::epsilon()) * pair.size;
    EXPECT_NEAR(double(found->depth), least, allowed + rounding);
    EXPECT_EQ(found->excess, Real(0));
    const W n = to_wide(found->normal);
    EXPECT_NEAR(double(overlap_along(pair.wide_a, pair.wide_b, n / glm::length(n))), least,
                allowed + rounding);
    const W on_a = to_wide(found->on_a) - pair.place, on_b = to_wide(found->on_b) - pair.place;
    EXPECT_LE(double(pair.wide_a.outside(on_a)), allowed + rounding);
    EXPECT_LE(double(pair.wide_b.outside(on_b)), allowed + rounding);
    EXPECT_LE(double(glm::length(on_a - on_b - n * Wide(found->depth))),
              4.0 * (allowed + rounding));
}

TEST(EpaOfRoundHulls, FindsTheLeast) {
    const HullMesh small = fibonacci_hull(64), middle = fibonacci_hull(128),
                   large = fibonacci_hull(500);
    const Vec3 zero{Real(0)}, near{Real(0.1), Real(0), Real(0)};
    const ConvexHull upright{&small, zero, identity_rotation};
    const std::uint64_t limits = oddity("epa: vertex limit").met;
    expect_least(upright, upright, "64 points, with itself");
    expect_least(ConvexHull{&middle, zero, identity_rotation}, ConvexHull{&middle, zero, turn(1.0)},
                 "128 points, turned by one radian");
    expect_least(ConvexHull{&large, zero, identity_rotation}, Vec3{Real(0.01), Real(0), Real(0)},
                 "500 points and a point");
    expect_least(Segment{-near, near}, ConvexHull{&large, zero, turn(0.5)},
                 "500 points and a segment");
    expect_least(Triangle{-near, near, Vec3{Real(0), Real(0.2), Real(0.1)}},
                 ConvexHull{&large, zero, turn(0.5)}, "500 points and a triangle");
    expect_least(Triangle{-near, near, Vec3{Real(0.3), Real(0), Real(0)}},
                 ConvexHull{&large, zero, turn(0.5)}, "500 points and a flat triangle");
    expect_least(ConvexHull{&large, zero, turn(0.25)}, Box{zero, turn(1.0), Vec3{Real(0.02)}},
                 "500 points and a box");
    expect_least(Aabb{-near, near}, ConvexHull{&large, zero, turn(0.25)},
                 "500 points and an aligned box, flat");
    EXPECT_GE(oddity("epa: vertex limit").met, limits + 6U); // the limit was indeed reached
}

// As many pairs of edges as the oracle can do in a second.
TEST(EpaOfRoundHulls, FindsTheLeastOfFiveHundredPoints) {
    const HullMesh large = fibonacci_hull(500);
    const ConvexHull a{&large, Vec3{Real(0)}, identity_rotation};
    const ConvexHull b{&large, Vec3{Real(0.1), Real(0), Real(0)}, identity_rotation};
    const std::optional<Penetration> found = penetration(a, b);
    ASSERT_TRUE(found);
    // The oracle prunes: an arc of one hull and a normal of the other cannot cross unless they are
    // within the largest angle between neighbouring normals of that hull.
    const Pair<ConvexHull, ConvexHull> pair(a, b);
    const Wide depth = Wide(found->depth);
    for (const auto &plane : pair.wide_a.planes)
        EXPECT_GE(double(overlap_along(pair.wide_a, pair.wide_b, plane[0])),
                  double(depth) * (1.0 - 1e-5));
    for (const auto &plane : pair.wide_b.planes)
        EXPECT_GE(double(overlap_along(pair.wide_a, pair.wide_b, -plane[0])),
                  double(depth) * (1.0 - 1e-5));
    Random random(3);
    for (int i = 0; i < 100'000; ++i)
        EXPECT_GE(double(overlap_along(pair.wide_a, pair.wide_b, W(any_direction(random)))),
                  double(depth) * (1.0 - 1e-5));
    const W n = to_wide(found->normal);
    EXPECT_NEAR(double(overlap_along(pair.wide_a, pair.wide_b, n / glm::length(n))), double(depth),
                1e-5);
}

// A cylinder is followed to within 4e-3; if the limit comes first, the result states how much
// smaller the depth could be.
TEST(EpaOfRoundHulls, SaysWhatACylinderMayMiss) {
    const HullMesh large = fibonacci_hull(500);
    int limited = 0;
    Random random(4);
    for (int i = 0; i < 40; ++i) {
        const ConvexHull hull{&large, Vec3{Real(0)}, turn(0.1 * i)};
        const Real size = Real(random.next_in(0.05, 1.0));
        const Cylinder cylinder{Vec3{Real(0), -size, Real(0)}, Vec3{Real(0), size, Real(0)}, size};
        const Pair<ConvexHull, Cylinder> pair(hull, cylinder);
        const std::optional<Penetration> found = penetration(hull, cylinder);
        ASSERT_TRUE(found);
        limited += found->excess > Real(0) ? 1 : 0;
        ASSERT_GE(found->excess, Real(0));
        const double allowed = std::max(double(found->excess), 4e-3 * double(found->depth)) + 1e-5;
        for (int k = 0; k < 2000; ++k)
            ASSERT_GE(double(overlap_along(pair.wide_a, pair.wide_b, W(any_direction(random)))),
                      double(found->depth) - allowed);
    }
    EXPECT_GT(limited, 0);
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
