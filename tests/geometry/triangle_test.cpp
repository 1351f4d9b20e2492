#include "engine/geometry/triangle.h"

#include "engine/core/random.h"
#include "engine/geometry/triangle_exact.h"
#include "tests/geometry/exact.h"
#include "tests/geometry/wide_triangle.h"
#include "tests/trials.h"

#include <gtest/gtest.h>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace wide_triangle;

Vec3 any_point_near(Random &random, const Triangle &t) {
    const double size = double(glm::length(t.b - t.a)) + double(glm::length(t.c - t.a));
    const Real s = static_cast<Real>(random.next_in(-0.5, 1.5));
    const Real u = static_cast<Real>(random.next_in(-0.5, 1.5));
    const Vec3 in_plane = t.a + s * (t.b - t.a) + u * (t.c - t.a);
    switch (random.next_index(4)) {
    case 0:
        return in_plane;
    case 1:
        return in_plane + any_offset(random, size * std::pow(10.0, random.next_in(-9.0, 0.0)));
    case 2:
        return t.b + s * (t.c - t.b);
    default:
        return t.a + any_offset(random, 3.0 * size);
    }
}

// The closest point is in the triangle, and no part of the triangle lies beyond it as seen from the
// query point, which only needs checking at the corners.
TEST(Triangle, ClosestPointWithinTheBound) {
    Random random(31);
    const int count = trials(1'000'000);
    double worst = 0.0;
    for (int trial = 0; trial < count; ++trial) {
        const Triangle t = awkward_triangle(random);
        const Vec3 p = any_point_near(random, t);
        const Vec3 q = closest_point(t, p);
        const long double largest = std::max(largest_of(t), largest_of(p));
        const long double bound = 8.0L * epsilon * largest;
        const WideTriangle w = wide(t);
        const Range distance = distance_to_triangle(w, wide(p));
        const long double found = glm::distance(wide(q), wide(p));
        ASSERT_LE(found, distance.high + bound) << "trial " << trial;
        ASSERT_GE(found, distance.low - bound) << "trial " << trial;
        const long double off = glm::distance(nearest_on_triangle(w, wide(q)), wide(q));
        ASSERT_LE(off, bound) << "trial " << trial;
        worst = std::max({worst, double(off / bound), double((found - distance.high) / bound)});
    }
    RecordProperty("worst", std::to_string(worst));
}

TEST(Triangle, ClosestPointKeepsBits) {
    Random random(32);
    int kept = 0;
    const int count = trials(1'000'000);
    for (int trial = 0; trial < count; ++trial) {
        const Triangle t = awkward_triangle(random);
        ASSERT_EQ(closest_point(t, t.a), t.a);
        ASSERT_EQ(closest_point(t, t.c), t.c);
        // Points on edges rarely lie exactly on them; integer points in integer triangles often do.
        const auto whole = [&] {
            return Vec3{Real(random.next_index(5)), Real(random.next_index(5)),
                        Real(random.next_index(5))};
        };
        const Triangle small{whole(), whole(), whole()};
        const Vec3 p = whole();
        if (contains(small, p)) {
            ASSERT_EQ(closest_point(small, p), p);
            ++kept;
        }
    }
    EXPECT_GT(kept, count / 50);
}

// The weights reproduce a point from the corners: exact rationals for the weights, and the result's
// own weights back to the foot.
TEST(Triangle, Barycentric) {
    using namespace exact_oracle;
    Random random(33);
    int flat = 0;
    const int count = trials(1'000'000);
    for (int trial = 0; trial < count; ++trial) {
        const Triangle t = awkward_triangle(random);
        const Vec3 p = any_point_near(random, t);
        const auto weights = barycentric(t, p);
        const Wide3 n = wide_normal(wide(t));
        if (!weights) {
            ++flat;
            ASSERT_EQ(n, Wide3{0.0L}) << "trial " << trial;
            ASSERT_EQ(normal(t), Vec3{Real(0)});
            ASSERT_EQ(area(t), Real(0));
            continue;
        }
        ASSERT_NE(n, Wide3{0.0L}) << "trial " << trial;
        const WideTriangle w = wide(t);
        const long double edges[] = {glm::distance(w[0], w[1]), glm::distance(w[1], w[2]),
                                     glm::distance(w[2], w[0])};
        const long double longest = *std::max_element(edges, edges + 3);
        const long double twice = glm::length(wide_cross(w)); // twice the area
        const long double height = twice / longest;
        const long double distance = glm::distance(w[0], wide(p));
        const long double bound = 8.0L * epsilon * std::max(1.0L, distance / height);
        if (bound > 0.1L)
            continue; // no promise here
        ASSERT_NEAR(double(area(t)), double(0.5L * twice), double(8.0L * epsilon * twice));
        ASSERT_LE(glm::distance(Wide3(normal(t)), n), 16.0L * epsilon) << "trial " << trial;
        const Wide3 from_b = w[1] - wide(p), from_c = w[2] - wide(p), from_a = w[0] - wide(p);
        const long double truth[] = {glm::dot(n, glm::cross(from_b, from_c)) / twice,
                                     glm::dot(n, glm::cross(from_c, from_a)) / twice,
                                     glm::dot(n, glm::cross(from_a, from_b)) / twice};
        for (int i = 0; i < 3; ++i)
            ASSERT_NEAR(double((*weights)[i]), double(truth[i]), double(bound))
                << "trial " << trial << " weight " << i;
        ASSERT_NEAR(double(weights->x) + double(weights->y) + double(weights->z), 1.0,
                    double(bound));
    }
    EXPECT_GT(flat, count / 20);
}

TEST(Triangle, BarycentricIsExactForSmallIntegers) {
    using namespace exact_oracle;
    Random random(34);
    int on_edge = 0;
    const int count = trials(1'000'000);
    for (int trial = 0; trial < count; ++trial) {
        const auto whole = [&] {
            return Vec3{Real(random.next_index(7)) - 3, Real(random.next_index(7)) - 3,
                        Real(random.next_index(7)) - 3};
        };
        const Triangle t{whole(), whole(), whole()};
        const Vec3 p = whole();
        const auto weights = barycentric(t, p);
        const Whole3<long long> a = exact_oracle::whole<long long>(t.a, 1),
                                b = exact_oracle::whole<long long>(t.b, 1),
                                c = exact_oracle::whole<long long>(t.c, 1),
                                q = exact_oracle::whole<long long>(p, 1);
        const auto n = cross(b - a, c - a);
        ASSERT_EQ(weights.has_value(), !is_zero(n));
        if (!weights)
            continue;
        const double squared = double(dot(n, n));
        const long long parts[] = {dot(n, cross(b - q, c - q)), dot(n, cross(c - q, a - q)),
                                   dot(n, cross(a - q, b - q))};
        for (int i = 0; i < 3; ++i) {
            ASSERT_EQ((*weights)[i], static_cast<Real>(double(parts[i]) / squared));
            on_edge += parts[i] == 0;
        }
    }
    EXPECT_GT(on_edge, count / 50);
}

TEST(Triangle, Bounds) {
    Random random(35);
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const Triangle t = awkward_triangle(random);
        const Aabb box = bounds(t);
        for (int i = 0; i < 3; ++i) {
            ASSERT_TRUE(box.min[i] <= t.a[i] && box.min[i] <= t.b[i] && box.min[i] <= t.c[i]);
            ASSERT_TRUE(box.max[i] >= t.a[i] && box.max[i] >= t.b[i] && box.max[i] >= t.c[i]);
            ASSERT_TRUE(box.min[i] == t.a[i] || box.min[i] == t.b[i] || box.min[i] == t.c[i]);
            ASSERT_TRUE(box.max[i] == t.a[i] || box.max[i] == t.b[i] || box.max[i] == t.c[i]);
        }
    }
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
