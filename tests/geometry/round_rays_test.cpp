// Rays tangent to a capsule, and rays against shapes without a radius.
#include "engine/geometry/raycast.h"
#include "engine/geometry/raycast_2d.h"
#include "tests/geometry/oracle.h"
#include "tests/trials.h"

#include <gtest/gtest.h>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace oracle;
using L = glm::vec<3, long double>;

constexpr double epsilon = double(std::numeric_limits<Real>::epsilon());

L wider(const Vec3 &v) {
    return {v.x, v.y, v.z};
}

// A point's distance from the segment.
long double off_axis(const Capsule &capsule, const L &p) {
    const L a = wider(capsule.a), d = wider(capsule.b) - a;
    const long double squared = glm::dot(d, d);
    const long double t =
        squared > 0.0L ? std::clamp(glm::dot(p - a, d) / squared, 0.0L, 1.0L) : 0.0L;
    return glm::length(p - (a + t * d));
}

TEST(RoundRays, TangentsOfACapsuleEndWhereTheyBegin) {
    const auto one =
        ray_interval(Capsule{{Real(0), Real(0), Real(0)}, {Real(0), Real(1), Real(0)}, Real(1)},
                     Ray{{Real(0.6), Real(-0.8), Real(0)}, {Real(0.8), Real(0.6), Real(0)}});
    if (one) { // on the surface, or off it by a rounding
        EXPECT_LE(double(one->t_exit), 1e-2);
    }

    Random random(1);
    int on_surface = 0;
    for (int trial = 0; trial < trials(500'000); ++trial) {
        Capsule capsule{any_vector(random, 1.0), any_vector(random, 1.0),
                        Real(random.next_in(0.1, 2.0))};
        if (trial % 8 == 0)
            capsule.b = capsule.a;
        // A point of a cap or the side, and a direction in the tangent plane there.
        V out = any_direction(random);
        const V along{capsule.b - capsule.a};
        V at{capsule.a};
        if (trial % 3 == 0 && glm::dot(along, along) > 0.0) {
            out = glm::normalize(out - along * (glm::dot(out, along) / glm::dot(along, along)));
            at += along * random.next_in(0.0, 1.0);
        } else if (glm::dot(out, along) > 0.0) {
            at = V{capsule.b};
        }
        const V p = at + double(capsule.radius) * out;
        const V d = glm::cross(out, any_direction(random));
        const Ray ray{{Real(p.x), Real(p.y), Real(p.z)}, {Real(d.x), Real(d.y), Real(d.z)}};
        const auto inside = ray_interval(capsule, ray);
        if (!inside)
            continue;
        ++on_surface;
        // The surface of a capsule may be off by 16 epsilon: tangents can be inside that for a
        // while.
        const double allowed = 16.0 * epsilon * 8.0;
        ASSERT_LE(inside->t_enter, inside->t_exit);
        for (const Real t : {inside->t_enter, inside->t_exit}) {
            ASSERT_TRUE(std::isfinite(t)) << "trial " << trial;
            const L on_ray = wider(ray.origin) + (long double)(t)*wider(ray.direction);
            ASSERT_NEAR(double(off_axis(capsule, on_ray)), double(capsule.radius), allowed)
                << "trial " << trial;
        }
    }
    EXPECT_GT(on_surface, trials(500'000) / 4);
}

// Integer axes and rays, so that the rays hit lines and points exactly.
TEST(RoundRays, NormalsOfWhatHasNoRadiusAreAgainstTheRay) {
    Random random(2);
    int lines = 0, points = 0;
    const auto whole = [&](int range) {
        return Vec3{Real(int(random.next_index(std::uint32_t(2 * range + 1))) - range),
                    Real(int(random.next_index(std::uint32_t(2 * range + 1))) - range),
                    Real(int(random.next_index(std::uint32_t(2 * range + 1))) - range)};
    };
    const auto check = [&](const auto &solid, const Ray &ray, int &count) {
        const auto inside = ray_interval(solid, ray);
        if (!inside || inside->enter_normal == Vec3{Real(0)})
            return;
        ++count;
        const Vec3 &n = inside->enter_normal;
        const double speed = double(glm::length(ray.direction));
        ASSERT_NEAR(double(glm::length(n)), 1.0, 4.0 * epsilon);
        ASSERT_LT(double(glm::dot(n, ray.direction)), 4.0 * epsilon * speed);
    };
    for (int trial = 0; trial < trials(300'000); ++trial) {
        const Vec3 a = whole(4);
        const Vec3 axis = Real(4) * whole(2);
        const Vec3 on_line = a + axis * (Real(random.next_index(5)) / Real(4));
        const Vec3 d = whole(5);
        if (d == Vec3{Real(0)})
            continue;
        const Ray ray{on_line - Real(1 + int(random.next_index(3))) * d, d};
        check(Capsule{a, a + axis, Real(0)}, ray, lines);
        if (axis != Vec3{Real(0)})
            check(Cylinder{a, a + axis, Real(0)}, ray, lines);
        const Ray to_point{a - Real(3) * d, d};
        check(Capsule{a, a, Real(0)}, to_point, points);
        const auto ball = ray_interval(Sphere{a, Real(0)}, to_point);
        ASSERT_TRUE(ball);
        ASSERT_LT(double(glm::distance(ball->enter_normal, -glm::normalize(d))), 8.0 * epsilon);
        const Vec2 d2{d.x, d.y};
        if (d2 != Vec2{Real(0)}) {
            const auto disc = ray_interval(Circle{Vec2{a.x, a.y}, Real(0)},
                                           Ray2{Vec2{a.x, a.y} - Real(3) * d2, d2});
            ASSERT_TRUE(disc);
            ASSERT_LT(double(glm::distance(disc->enter_normal, -glm::normalize(d2))),
                      8.0 * epsilon);
        }
    }
    EXPECT_GT(lines, trials(300'000) / 8);
    EXPECT_GT(points, trials(300'000) / 8);
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
