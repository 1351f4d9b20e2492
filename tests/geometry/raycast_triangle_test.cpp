#include "engine/core/check.h"
#include "engine/core/random.h"
#include "engine/geometry/raycast.h"
#include "engine/geometry/triangle.h"
#include "tests/geometry/exact.h"
#include "tests/geometry/wide_triangle.h"
#include "tests/trials.h"

#include <gtest/gtest.h>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace exact_oracle;
using namespace wide_triangle;

Vec3 any_whole(Random &random, int reach) {
    const auto coordinate = [&] {
        const int units = int(random.next_index(2 * std::uint32_t(reach) + 1)) - reach;
        return units == 0 && random.next_index(2) == 0 ? -Real(0) : Real(units);
    };
    return {coordinate(), coordinate(), coordinate()};
}

// Integer rays and triangles, in space and in a common plane, along edges, through corners, flat.
// The ray is represented by a segment that is long enough.
TEST(RaycastTriangle, IsExact) {
    Random random(41);
    int hits = 0, inside = 0;
    const int count = trials(1'000'000);
    for (int trial = 0; trial < count; ++trial) {
        const int reach = trial % 4 == 0 ? 1 : (trial % 4 == 1 ? 400 : 4);
        Triangle t{any_whole(random, reach), any_whole(random, reach), any_whole(random, reach)};
        if (random.next_index(8) == 0)
            t.c = t.b + (t.b - t.a);
        Ray ray{any_whole(random, reach), any_whole(random, random.next_index(2) == 0 ? 2 : 5)};
        switch (random.next_index(6)) {
        case 0: // in the plane
            ray.origin = t.a + (t.b - t.c);
            ray.direction = random.next_index(2) == 0 ? t.c - t.a : t.b - t.a;
            break;
        case 1: // along an edge
            ray.direction = t.b - t.a;
            ray.origin = t.a + Real(int(random.next_index(5)) - 2) * ray.direction;
            break;
        case 2: // through a corner
            ray.direction = t.c - ray.origin;
            break;
        default:
            break;
        }
        if (ray.direction == Vec3{Real(0)})
            continue;
        const auto hit = raycast(t, ray);
        const auto exactly = [](const Vec3 &v) { return whole<long long>(v, 1.0); };
        const auto origin = exactly(ray.origin), d = exactly(ray.direction);
        const long long far = 8192;
        auto segment = Polytope<long long>::segment(
            origin, {origin.x + far * d.x, origin.y + far * d.y, origin.z + far * d.z});
        segment.edges[0] = d; // any length will do, and this one cannot overflow
        const bool is_met = polytopes_meet(
            Polytope<long long>::triangle(exactly(t.a), exactly(t.b), exactly(t.c)), segment);
        ASSERT_EQ(hit.has_value(), is_met) << "trial " << trial;
        if (!hit)
            continue;
        ++hits;
        ASSERT_EQ(hit->starts_inside, contains(t, ray.origin));
        ASSERT_EQ(hit->starts_inside, hit->t == Real(0));
        ASSERT_EQ(hit->starts_inside, hit->normal == Vec3{Real(0)});
        inside += hit->starts_inside;
        if (trial % 8 >= 4 || hit->starts_inside)
            continue;
        // The first common point is in the triangle, and no earlier point is.
        const Wide3 from = wide(ray.origin), along = wide(ray.direction);
        const long double at = hit->t;
        ASSERT_LT(distance_to_triangle(wide(t), from + at * along).high, 16.0L * epsilon * 2000.0L);
        ASSERT_GT(distance_of_segment_to_triangle(wide(t), from, from + 0.99L * at * along).low,
                  0.0L)
            << "trial " << trial;
        ASSERT_NEAR(double(glm::length(hit->normal)), 1.0, double(8 * epsilon));
        const auto cut = raycast(t, Ray{ray.origin, ray.direction, hit->t});
        ASSERT_TRUE(cut && cut->t == hit->t);
        ASSERT_FALSE(raycast(t, Ray{ray.origin, ray.direction, std::nextafter(hit->t, Real(0))}));
    }
    EXPECT_GT(hits, count / 5);
    EXPECT_GT(inside, count / 50);
}

// Closed surfaces seen from inside, with rays to their corners and edges: none gets through, at any
// size, far from the origin, with directions of any length.
TEST(RaycastTriangle, ClosedSurfacesAreWatertight) {
    Random random(42);
    const int faces[8][3] = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                             {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    const int count = trials(1'000'000) / 8;
    for (int trial = 0; trial < count; ++trial) {
        const double size = std::pow(10.0, random.next_in(-3.0, 5.0));
        const Vec3 at = any_offset(random, random.next_index(2) == 0 ? size : 10.0 * size);
        Vec3 corner[6];
        for (int i = 0; i < 6; ++i) {
            Vec3 out{Real(0)};
            out[i / 2] = static_cast<Real>((i % 2 == 0 ? size : -size) * random.next_in(0.5, 1.0));
            corner[i] = at + out + any_offset(random, 0.1 * size);
        }
        const Vec3 origin = at + any_offset(random, 0.05 * size);
        for (int ray = 0; ray < 8; ++ray) {
            const int *face = faces[random.next_index(8)];
            const Vec3 &a = corner[face[0]], &b = corner[face[1]];
            const Real s =
                random.next_index(2) == 0 ? Real(0) : static_cast<Real>(random.next_unit());
            const Vec3 direction =
                static_cast<Real>(std::pow(10.0, random.next_in(-6.0, 6.0)) / size) *
                (a + s * (b - a) - origin);
            int hits = 0;
            for (const auto &f : faces)
                hits += raycast(Triangle{corner[f[0]], corner[f[1]], corner[f[2]]},
                                Ray{origin, direction})
                            .has_value();
            ASSERT_GE(hits, 1) << "trial " << trial << " ray " << ray;
        }
    }
}

TEST(RaycastTriangle, ParameterWithinTheBound) {
    Random random(43);
    int hits = 0;
    const int count = trials(1'000'000);
    for (int trial = 0; trial < count; ++trial) {
        const Triangle t = awkward_triangle(random);
        const double size = double(glm::length(t.b - t.a)) + double(glm::length(t.c - t.a));
        const Real u = static_cast<Real>(random.next_unit());
        const Real v = static_cast<Real>(random.next_unit()) * (Real(1) - u);
        const Vec3 origin =
            t.a + any_offset(random, size * std::pow(10.0, random.next_in(-2.0, 1.0)));
        const Vec3 target = t.a + u * (t.b - t.a) + v * (t.c - t.a);
        const Real speed = static_cast<Real>(std::pow(10.0, random.next_in(-6.0, 6.0)));
        const Ray ray{origin, speed * (target - origin)};
        if (ray.direction == Vec3{Real(0)})
            continue;
        const auto hit = raycast(t, ray);
        if (!hit || hit->starts_inside)
            continue;
        const Wide3 n = wide_normal(wide(t));
        if (n == Wide3{0.0L})
            continue;
        const long double climb = glm::dot(n, wide(ray.direction));
        if (std::abs(climb) < 1e-12L * glm::length(wide(ray.direction)))
            continue; // beyond the oracle's own digits
        ++hits;
        const long double truth = glm::dot(n, wide(t.a) - wide(origin)) / climb;
        const long double largest = std::max(largest_of(t), largest_of(origin));
        ASSERT_LE(std::abs((static_cast<long double>(hit->t) - truth) * climb),
                  8.0L * epsilon * largest)
            << "trial " << trial;
        ASSERT_LE(glm::dot(wide(hit->normal), wide(ray.direction)), 0.0L);
        ASSERT_LE(glm::distance(wide(hit->normal), climb < 0 ? n : -n), 16.0L * epsilon);
    }
    EXPECT_GT(hits, count / 3);
}

TEST(RaycastTriangle, Misuse) {
    const Triangle t{Vec3{Real(0)}, {Real(1), Real(0), Real(0)}, {Real(0), Real(1), Real(0)}};
    const Vec3 zero{Real(0)}, x{Real(1), Real(0), Real(0)};
    EXPECT_THROW(raycast(t, Ray{x, zero}), CheckFailure);
    EXPECT_THROW(raycast(t, Ray{Vec3{std::numeric_limits<Real>::quiet_NaN()}, x}), CheckFailure);
    EXPECT_THROW(raycast(t, Ray{x, x, std::numeric_limits<Real>::quiet_NaN()}), CheckFailure);
    EXPECT_THROW(raycast(Triangle{x, x, Vec3{std::numeric_limits<Real>::infinity()}}, Ray{zero, x}),
                 CheckFailure);
    EXPECT_FALSE(raycast(t, Ray{zero, x, Real(-1)}));
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
