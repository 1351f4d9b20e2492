#include "engine/geometry/raycast.h"

#include "engine/geometry/contains.h"
#include "tests/geometry/oracle.h"
#include "tests/says.h"
#include "tests/trials.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace oracle;

constexpr double epsilon = double(std::numeric_limits<Real>::epsilon());

// How far a point is outside the shape, in double; negative inside.
double height_above(const Shape &shape, const V &p) {
    if (const auto *h = std::get_if<HalfSpace>(&shape))
        return glm::dot(wide(h->normal), p) - double(h->offset);
    return Solid(shape).signed_distance(p);
}

// The least height over [0, length] of a ray with a unit direction, and where: the height above a
// convex set is convex along a line, so a golden-section search finds it.
double lowest(const Shape &shape, const V &origin, const V &u, double length, double &where) {
    const double part = 0.5 * (std::sqrt(5.0) - 1.0);
    double low = 0.0, high = length, s = high - part * high, t = part * high;
    double at_s = height_above(shape, origin + s * u), at_t = height_above(shape, origin + t * u);
    for (int i = 0; i < 80; ++i) { // to 1e-16 of the length
        // The height changes by no more than the distance moved: well outside or well inside, stop.
        const double least = std::min(at_s, at_t);
        if (least > high - low || least < -1e-3)
            break;
        if (at_s <= at_t) {
            high = t;
            t = s;
            at_t = at_s;
            s = high - part * (high - low);
            at_s = height_above(shape, origin + s * u);
        } else {
            low = s;
            s = t;
            at_s = at_t;
            t = low + part * (high - low);
            at_t = height_above(shape, origin + t * u);
        }
    }
    where = at_s <= at_t ? s : t;
    return std::min(at_s, at_t);
}

// Half of them are boxes: rays against the other shapes are also tested exactly, in
// raycast_families_test.cpp.
std::uint32_t any_kind(Random &random) {
    return random.next_index(2) == 0 ? 1 : random.next_index(4);
}

Shape any_solid(Random &random, std::uint32_t kind, const Vec3 &center) {
    const Vec3 half{any_real(random, 0.2, 1.0), any_real(random, 0.2, 1.0),
                    any_real(random, 0.2, 1.0)};
    const Quat rotation = awkward_rotation(random);
    const Vec3 axis = rotation * Vec3{Real(0), half.x, Real(0)};
    const V n = any_direction(random);
    switch (kind) {
    case 0:
        return Sphere{center, half.x};
    case 1:
        return Box{center, rotation, half};
    case 2:
        return Capsule{center - axis, center + axis, half.y};
    default:
        return HalfSpace{Vec3{Real(n.x), Real(n.y), Real(n.z)}, Real(glm::dot(n, wide(center)))};
    }
}

// The ends of the interval are on the surface, to within what rounding inputs of that size is
// worth, and a ray reported as a miss has no point deeper inside than that.
void check_against_oracle(Random &random, double reach) {
    // Differences of positions are rounded at the size of the positions, then go through some 20
    // operations at the size of the differences.
    const double band = 20.0 * 0.5 * epsilon * (reach + 8.0);
    int hits = 0;
    const int count = trials(1'000'000);
    for (int trial = 0; trial < count; ++trial) {
        const std::uint32_t kind = any_kind(random);
        const Vec3 center = any_vector(random, reach) + any_vector(random, 1.0);
        const Shape shape = any_solid(random, kind, center);
        const Vec3 origin = center + any_vector(random, 3.0);
        const Vec3 target = center + any_vector(random, 1.2);
        Vec3 direction = target - origin;
        for (int i = 0; i < 3; ++i)
            if (random.next_index(8) == 0)
                direction[i] = random.next_index(2) == 0 ? Real(0) : -Real(0);
        direction *= static_cast<Real>(std::pow(10.0, random.next_in(-6.0, 6.0)));
        if (direction == Vec3{Real(0)})
            continue;
        const double speed = glm::length(wide(direction));
        const V u = wide(direction) / speed;
        const double length = random.next_index(4) == 0 ? random.next_in(0.0, 6.0) : 12.0;
        const Ray ray{origin, direction, static_cast<Real>(length / speed)};
        const auto interval = ray_interval(shape, ray);
        const V o = wide(origin);
        const double reached = double(ray.max_t) * speed;

        if (!interval) {
            double where = 0.0;
            ASSERT_GE(lowest(shape, o, u, reached, where), -band)
                << "kind " << kind << " trial " << trial << " missed at " << where;
            continue;
        }
        ++hits;
        ASSERT_GE(interval->t_enter, Real(0));
        ASSERT_LE(interval->t_enter, interval->t_exit);
        ASSERT_LE(interval->t_exit, ray.max_t);
        const double enter = double(interval->t_enter) * speed;
        const double exit = double(interval->t_exit) * speed;
        const double at_enter = height_above(shape, o + enter * u);
        const double at_exit = height_above(shape, o + exit * u);
        // A grazing ray stays within the band; otherwise the end is on the surface.
        ASSERT_LE(at_enter, band) << "kind " << kind << " trial " << trial;
        ASSERT_LE(at_exit, band) << "kind " << kind << " trial " << trial;
        if (interval->t_enter > Real(0)) {
            ASSERT_GE(at_enter, -band) << "kind " << kind << " trial " << trial;
            const V n = wide(interval->enter_normal);
            ASSERT_NEAR(glm::length(n), 1.0, 1e-5);
            ASSERT_LE(glm::dot(n, u), band * 8);
            // A step along the outward normal from the surface is that far outside. Positions off
            // by the band turn the normal of a radius of 0.2 by band / 0.2, or pick the other face
            // near an edge.
            ASSERT_GE(height_above(shape, o + enter * u + 0.1 * n), 0.1 - 12 * band)
                << "kind " << kind << " trial " << trial;
        } else {
            ASSERT_TRUE(interval->enter_normal == Vec3{Real(0)} || at_enter > -band);
        }
        if (interval->t_exit < ray.max_t) {
            ASSERT_GE(at_exit, -band) << "kind " << kind << " trial " << trial;
        }
    }
    EXPECT_GT(hits, count / 3);
}

TEST(Raycast, IntervalAgainstTheOracle) {
    Random random(1);
    check_against_oracle(random, 1.0);
}

TEST(Raycast, IntervalFarFromTheOrigin) {
    Random random(2);
    check_against_oracle(random, 1000.0);
}

// Spheres with exactly known answers seen from far away, where a discriminant with the squared
// distance in it would lose the radius.
TEST(Raycast, SphereSeenFromFarAway) {
    const Real far = Real(1 << 20);
    const Sphere sphere{Vec3{Real(0)}, Real(0.5)};
    const Ray ray{{-far, Real(0.25), Real(0)}, {Real(1), Real(0), Real(0)}};
    const auto interval = ray_interval(sphere, ray);
    ASSERT_TRUE(interval);
    const double half = std::sqrt(0.25 - 0.0625);
    EXPECT_NEAR(double(interval->t_enter), double(far) - half, double(far) * epsilon);
    EXPECT_NEAR(double(interval->enter_normal.y), 0.5, 4 * epsilon);
    EXPECT_NEAR(double(interval->enter_normal.x), -2.0 * half, 4 * epsilon);
    const Ray above{{-far, Real(0.5000001), Real(0)}, {Real(1), Real(0), Real(0)}};
    EXPECT_FALSE(ray_interval(sphere, above));
    const Capsule capsule{{Real(0), Real(0), Real(-3)}, {Real(0), Real(0), Real(3)}, Real(0.5)};
    const auto through = ray_interval(capsule, ray);
    ASSERT_TRUE(through);
    EXPECT_NEAR(double(through->t_enter), double(far) - half, double(far) * epsilon);
    EXPECT_FALSE(ray_interval(capsule, above));
}

TEST(Raycast, TangentRaysTouch) {
    const Ray ray{{Real(-2), Real(0.5), Real(0)}, {Real(1), Real(0), Real(0)}};
    const Sphere sphere{Vec3{Real(0)}, Real(0.5)};
    const auto interval = ray_interval(sphere, ray);
    ASSERT_TRUE(interval);
    EXPECT_EQ(interval->t_enter, Real(2));
    EXPECT_EQ(interval->t_exit, Real(2));
    EXPECT_EQ(interval->enter_normal, (Vec3{Real(0), Real(1), Real(0)}));
    const Capsule capsule{{Real(0), Real(0), Real(-1)}, {Real(0), Real(0), Real(1)}, Real(0.5)};
    const auto side = ray_interval(capsule, ray);
    ASSERT_TRUE(side);
    EXPECT_EQ(side->t_enter, Real(2));
    EXPECT_EQ(side->t_exit, Real(2));
}

// Every ray in a face, along an edge or through a corner of a box hits it: all combinations of
// sides, axes and signs of zero, on faces at rounded sums.
TEST(Raycast, RaysInFacesAndEdgesAreInside) {
    Random random(3);
    for (int trial = 0; trial < 100000; ++trial) {
        const Box box{
            any_vector(random, 3.0),
            identity_rotation,
            {any_real(random, 0.1, 1.0), any_real(random, 0.1, 1.0), any_real(random, 0.1, 1.0)}};
        const Aabb aabb = bounds(box);
        const int along = int(random.next_index(3));
        const int side = (along + 1) % 3, other = (along + 2) % 3;
        const Real zero = random.next_index(2) == 0 ? Real(0) : -Real(0);
        const bool is_positive = random.next_index(2) == 0;
        Ray ray{Vec3{Real(0)}, Vec3{zero}};
        ray.direction[along] = (is_positive ? Real(1) : Real(-1)) * any_real(random, 1e-6, 1e6);
        ray.origin[along] = is_positive ? aabb.min[along] - Real(2) : aabb.max[along] + Real(2);
        ray.origin[side] = random.next_index(2) == 0 ? aabb.min[side] : aabb.max[side];
        const bool in_edge = random.next_index(2) == 0;
        ray.origin[other] = in_edge ? aabb.max[other] : box.center[other];
        for (const auto &interval : {ray_interval(aabb, ray), ray_interval(box, ray)}) {
            ASSERT_TRUE(interval);
            const double speed = std::abs(double(ray.direction[along]));
            ASSERT_NEAR(double(interval->t_enter) * speed, 2.0, 8 * epsilon);
            ASSERT_EQ(interval->enter_normal[along], is_positive ? Real(-1) : Real(1));
        }
        // One ulp outside the face misses.
        ray.origin[side] = std::nextafter(ray.origin[side],
                                          ray.origin[side] == aabb.max[side] ? Real(9) : Real(-9));
        ASSERT_FALSE(ray_interval(aabb, ray));
        ASSERT_FALSE(ray_interval(box, ray));
    }
}

TEST(Raycast, RaysThroughCornersTouch) {
    // Rays that meet the box at one corner only, at t = 3, with exact coordinates and directions,
    // while the coordinate differences need two bits too many and round. The ray comes down along y
    // and leaves along x; the quotients must not lose the corner between them.
    Random random(4);
    const std::int64_t top = std::int64_t(1) << (std::numeric_limits<Real>::digits - 1);
    int rounded = 0;
    for (int trial = 0; trial < 100000; ++trial) {
        const auto any_step = [&] {
            return top + static_cast<std::int64_t>(random.next_u64() >> 12) % top;
        };
        const std::int64_t dx = any_step(), dy = any_step();
        const std::int64_t low_x = 3 * dx % 8, low_y = 3 * dy % 8;
        const Vec3 corner{Real(low_x), Real(-low_y), Real(0)};
        const Vec3 origin{Real(low_x - 3 * dx), Real(3 * dy - low_y), Real(0)};
        const Vec3 direction{Real(dx), Real(-dy), Real(0)};
        ASSERT_EQ(std::int64_t(origin.x), low_x - 3 * dx); // exact
        ASSERT_EQ(std::int64_t(origin.y), 3 * dy - low_y);
        const Aabb box{corner - Real(16), corner + Vec3{Real(0), Real(0), Real(16)}};
        const auto interval = ray_interval(box, Ray{origin, direction});
        ASSERT_TRUE(interval) << "trial " << trial;
        ASSERT_NEAR(double(interval->t_enter), 3.0, 12 * epsilon);
        ASSERT_NEAR(double(interval->t_exit), 3.0, 12 * epsilon);
        rounded += (corner.y - origin.y) / direction.y > (corner.x - origin.x) / direction.x;
    }
    EXPECT_GT(rounded, 1000); // this many could have been lost
}

TEST(Raycast, StartingInsideAndBeyond) {
    const Aabb box{Vec3{Real(-1)}, Vec3{Real(1)}};
    const Vec3 x{Real(1), Real(0), Real(0)};
    const auto hit = raycast(box, Ray{Vec3{Real(0)}, x});
    ASSERT_TRUE(hit);
    EXPECT_TRUE(hit->starts_inside);
    EXPECT_EQ(hit->t, Real(0));
    // On the surface: entering, and leaving (one common point).
    EXPECT_EQ(ray_interval(box, Ray{-x, x})->t_exit, Real(2));
    EXPECT_EQ(ray_interval(box, Ray{x, x})->t_exit, Real(0));
    // Behind, and too far away.
    EXPECT_FALSE(ray_interval(box, Ray{Real(2) * x, x}));
    EXPECT_FALSE(ray_interval(box, Ray{Real(-3) * x, x, Real(1.5)}));
    EXPECT_TRUE(ray_interval(box, Ray{Real(-3) * x, x, Real(2)}));
    EXPECT_FALSE(ray_interval(Aabb{}, Ray{Vec3{Real(0)}, x}));
    const HalfSpace ground{};
    EXPECT_FALSE(ray_interval(ground, Ray{{Real(0), Real(1), Real(0)}, x}));
    EXPECT_EQ(ray_interval(ground, Ray{Vec3{Real(0)}, x, Real(5)})->t_exit, Real(5));
    EXPECT_EQ(raycast(ground, Ray{{Real(0), Real(1), Real(0)}, {Real(1), Real(-1), Real(0)}})->t,
              Real(1));
}

TEST(Raycast, LinetestAgainstTheOracle) {
    Random random(5);
    const double band = 20.0 * 0.5 * epsilon * 9.0;
    int meets = 0;
    const int count = trials(1'600'000); // a million boxes
    for (int trial = 0; trial < count; ++trial) {
        const Vec3 center = any_vector(random, 1.0);
        const Shape shape = any_solid(random, any_kind(random), center);
        // Some entirely inside, some short, some points.
        const double size = std::pow(10.0, random.next_in(-3.0, 0.6));
        const Vec3 a = center + any_vector(random, 0.9);
        const Vec3 b = trial % 50 == 0 ? a : a + any_vector(random, size);
        const bool answer = linetest(shape, a, b);
        meets += answer;
        const double length = glm::length(wide(b) - wide(a));
        const V u = length > 0.0 ? (wide(b) - wide(a)) / length : V{1.0, 0.0, 0.0};
        double where = 0.0;
        const double height = lowest(shape, wide(a), u, length, where);
        if (answer) {
            ASSERT_LE(height, band) << "trial " << trial;
        } else {
            ASSERT_GE(height, -band) << "trial " << trial;
        }
        const double at_a = height_above(shape, wide(a));
        if (std::abs(at_a) > band) {
            ASSERT_EQ(contains(shape, a), at_a < 0.0) << "trial " << trial;
        }
    }
    EXPECT_GT(meets, count / 10 * 3);
}

TEST(Raycast, MisuseNamesTheValue) {
    const Real nan = std::numeric_limits<Real>::quiet_NaN();
    const Real inf = std::numeric_limits<Real>::infinity();
    const Sphere good{Vec3{Real(0)}, Real(1)};
    const Vec3 x{Real(1), Real(0), Real(0)};
    const Vec3 zero{Real(0)};
    says([&] { ray_interval(good, Ray{zero, zero}); }, "(0, 0, 0)");
    says([&] { ray_interval(good, Ray{zero, -zero}); }, "(0, 0, 0)");
    says([&] { ray_interval(good, Ray{zero, Vec3{inf, Real(0), Real(0)}}); }, "inf");
    says([&] { ray_interval(good, Ray{Vec3{nan}, x}); }, "nan");
    says([&] { ray_interval(good, Ray{zero, x, nan}); }, "nan");
    says([&] { ray_interval(Sphere{zero, Real(-2)}, Ray{zero, x}); }, "-2");
    says([&] { ray_interval(Capsule{zero, x, Real(-7)}, Ray{zero, x}); }, "-7");
    says([&] { ray_interval(Aabb{Vec3{nan}, x}, Ray{zero, x}); }, "nan");
    says([&] { contains(good, Vec3{nan}); }, "nan");
    says([&] { linetest(good, zero, Vec3{nan}); }, "nan");
    says(
        [&] {
            ray_interval(HalfSpace{Vec3{Real(2), Real(0), Real(0)}, Real(0)}, Ray{zero, x});
        },
        "(2, 0, 0)");
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
