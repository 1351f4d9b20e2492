// The stated range of sizes: scaling by a power of two rounds nothing, so the answer scales with
// the query.
#include "engine/geometry/epa.h"
#include "engine/geometry/manifold.h"
#include "engine/geometry/plane.h"
#include "engine/geometry/raycast.h"
#include "engine/geometry/shape_cast.h"
#include "engine/geometry/triangle.h"
#include "tests/geometry/oracle.h"
#include "tests/trials.h"

#include <gtest/gtest.h>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace oracle;

constexpr bool is_float = sizeof(Real) == 4;
constexpr double epsilon = double(std::numeric_limits<Real>::epsilon());

Sphere scaled(const Sphere &s, Real by) {
    return {by * s.center, by * s.radius};
}
Capsule scaled(const Capsule &c, Real by) {
    return {by * c.a, by * c.b, by * c.radius};
}
Cylinder scaled(const Cylinder &c, Real by) {
    return {by * c.a, by * c.b, by * c.radius};
}
Box scaled(const Box &b, Real by) {
    return {by * b.center, b.rotation, by * b.half_extents};
}
Triangle scaled(const Triangle &t, Real by) {
    return {by * t.a, by * t.b, by * t.c};
}

class Range : public testing::TestWithParam<int> {};

TEST_P(Range, AnswersScaleWithTheirQuestions) {
    // Sizes and distances are from 0.25 to 4, so they stay in range when scaled.
    const Real by = std::ldexp(Real(1), GetParam());
    Random random(1);
    const auto near = [&](Real small, Real large, const char *what, int trial) {
        ASSERT_NEAR(double(large / by), double(small), 128.0 * epsilon * 8.0)
            << what << ", trial " << trial;
    };
    for (int trial = 0; trial < trials(100'000); ++trial) {
        const auto size = [&] { return any_real(random, 0.25, 1.0); };
        const auto place = [&] { return any_vector(random, 1.5); };
        const Vec3 at = place();
        const Capsule capsule{at, at + Real(size()) * glm::normalize(place()), size()};
        const Cylinder cylinder{at, at + Real(size()) * glm::normalize(place()), size()};
        const Sphere sphere{place(), size()};
        const Box box{place(), any_rotation(random), {size(), size(), size()}};
        const Triangle triangle{place(), place(), place()};
        const auto both_of = [&](const auto &a, const auto &b, const char *what) {
            const auto big_a = scaled(a, by);
            const auto big_b = scaled(b, by);
            const Real apart = distance(a, b).distance;
            // Smaller distances are out of range.
            if (apart > Real(0.25))
                near(apart, distance(big_a, big_b).distance, what, trial);
            const auto deep = penetration(a, b), deeper = penetration(big_a, big_b);
            if (deep && deep->depth > Real(0.25)) {
                ASSERT_TRUE(deeper) << what << ", trial " << trial;
                constexpr double relative = is_float ? 1e-5 : 1e-10;
                const bool is_curved = std::is_same_v<std::decay_t<decltype(a)>, Cylinder>;
                ASSERT_NEAR(double(deeper->depth / by), double(deep->depth),
                            (is_curved ? 4e-3 : relative) * double(deep->depth) + 1024.0 * epsilon)
                    << what << ", trial " << trial;
            }
        };
        both_of(box, triangle, "box, triangle");
        both_of(capsule, box, "capsule, box");
        both_of(cylinder, box, "cylinder, box");
        both_of(sphere, box, "sphere, box");

        const Ray ray{Real(2) * place(), place()};
        const auto rays = [&](const auto &solid, const char *what) {
            const auto one = ray_interval(solid, ray);
            const auto big =
                ray_interval(scaled(solid, by), Ray{by * ray.origin, by * ray.direction});
            // Through the middle, not grazing.
            if (!one || one->t_exit - one->t_enter < Real(0.05))
                return;
            ASSERT_TRUE(big) << what << ", trial " << trial;
            const double steep =
                1.0 / double(glm::length(ray.direction)) / double((one->t_exit - one->t_enter));
            ASSERT_NEAR(double(big->t_enter), double(one->t_enter), 256.0 * epsilon * steep)
                << what << ", trial " << trial;
            ASSERT_NEAR(double(big->t_exit), double(one->t_exit), 256.0 * epsilon * steep)
                << what << ", trial " << trial;
        };
        rays(capsule, "capsule");
        rays(cylinder, "cylinder");
        rays(sphere, "sphere");
        rays(box, "box");

        const Triangle big = scaled(triangle, by);
        near(area(triangle), area(big) / by, "area", trial);
        ASSERT_LE(double(glm::distance(normal(triangle), normal(big))), 32.0 * epsilon);
        const Vec3 p = place();
        near(Real(0), glm::distance(by * closest_point(triangle, p), closest_point(big, by * p)),
             "closest point", trial);
        const Plane plane{glm::normalize(place()), size()};
        const Plane big_plane{plane.normal, by * plane.offset};
        near(classify(plane, p).distance, classify(big_plane, by * p).distance, "plane", trial);
    }
}

INSTANTIATE_TEST_SUITE_P(Ends, Range,
                         is_float ? testing::Values(-18, 26) : testing::Values(-158, 158));

// However far off, a cylinder has an axis; a body that fell for long would stop the whole world.
TEST(RangeOfPoses, ACylinderFarAwayIsStillOne) {
    for (const double far : {1e3, 4.2e6, 1e9, 1e15, 1e18})
        for (const Vec3 &way : {Vec3{1, 0, 0}, Vec3{0, -1, 0}, Vec3{-1, 1, 1}}) {
            const Cylinder there =
                placed(Cylinder{{0, 0, Real(-0.2)}, {0, Real(0.1), Real(0.2)}, Real(0.15)},
                       Transform{Real(far) * way, identity_rotation});
            EXPECT_NE(there.a, there.b) << far;
            EXPECT_GE((there.b - there.a).z, Real(0)) << far;
            EXPECT_NO_THROW(collide(there, Sphere{there.a, Real(1)}, Real(0)));
        }
}

// Signs are exact down to the least float; the doubles of predicates.h have a limit of their own.
TEST(RangeOfSigns, AreExactForTheLeastFloats) {
    if (!is_float)
        GTEST_SKIP() << "of floats only";
    const Real least = std::numeric_limits<Real>::denorm_min();
    const Plane plane{Vec3{Real(0), Real(1), Real(0)}, Real(0)};
    EXPECT_EQ(classify(plane, Vec3{Real(0), least, Real(0)}).side, PlaneSide::in_front);
    EXPECT_FALSE(linetest(plane, Vec3{Real(0), least, Real(0)}, Vec3{Real(0), least, Real(1)}));
    const Triangle triangle{Vec3{Real(0)}, Vec3{least, Real(0), Real(0)},
                            Vec3{Real(0), least, Real(0)}};
    EXPECT_TRUE(contains(triangle, Vec3{least, Real(0), Real(0)}));
    EXPECT_FALSE(contains(triangle, Vec3{least, least, Real(0)}));
    EXPECT_TRUE(linetest(Sphere{Vec3{Real(0)}, least}, Vec3{least, Real(-1), Real(0)},
                         Vec3{least, Real(1), Real(0)}));
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
