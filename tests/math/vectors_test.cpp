#include "engine/math/vectors.h"

#include "engine/core/random.h"
#include "tests/trials.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using W = long double;
using W3 = glm::vec<3, W, glm::defaultp>;

constexpr W epsilon = std::numeric_limits<Real>::epsilon();
constexpr W pi = 3.14159265358979323846264338327950288L;

W3 widened(const Vec3 &v) {
    return {W(v.x), W(v.y), W(v.z)};
}

// Any direction, any order of magnitude, some components 0, -0 or tiny.
Vec3 any_vector(Random &random, double low, double high) {
    const double length = std::pow(10.0, random.next_in(low, high));
    Vec3 v{Real(random.next_in(-1, 1) * length), Real(random.next_in(-1, 1) * length),
           Real(random.next_in(-1, 1) * length)};
    for (int i = 0; i < 3; ++i)
        switch (random.next_index(12)) {
        case 0:
            v[i] = Real(0);
            break;
        case 1:
            v[i] = -Real(0);
            break;
        case 2:
            v[i] *= Real(1e-8);
            break;
        default:
            break;
        }
    return v;
}

constexpr double least_power = std::numeric_limits<Real>::min_exponent10;
constexpr double most_power = std::numeric_limits<Real>::max_exponent10;

TEST(Normalized, AnyLength) {
    Random random(1);
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const Vec3 v = any_vector(random, least_power - 3, most_power);
        const auto unit = normalized<3>(v);
        ASSERT_EQ(unit.has_value(), v != Vec3{Real(0)});
        if (!unit) {
            ASSERT_EQ(normalized_or<3>(v, Vec3{Real(7)}), Vec3{Real(7)});
            continue;
        }
        const W3 w = widened(v);
        const W largest = std::max({std::abs(w.x), std::abs(w.y), std::abs(w.z)});
        const W3 scaled = w / largest;
        const W3 exact = scaled / std::sqrt(glm::dot(scaled, scaled));
        for (int i = 0; i < 3; ++i) // each component to its last places
            ASSERT_LE(std::abs(W((*unit)[i]) - exact[i]),
                      3 * epsilon * std::abs(exact[i]) + std::numeric_limits<Real>::denorm_min())
                << "trial " << trial;
        const auto flat = normalized<2>(Vec2{v});
        ASSERT_EQ(flat.has_value(), v.x != Real(0) || v.y != Real(0));
        if (flat) {
            ASSERT_LE(std::abs(std::hypot(W(flat->x), W(flat->y)) - 1), 3 * epsilon);
        }
    }
    EXPECT_EQ(normalized<3>(Vec3{Real(0), -Real(0), Real(0)}), std::nullopt);
    EXPECT_EQ(*normalized<2>(Vec2{Real(3), Real(-4)}), (Vec2{Real(0.6), Real(-0.8)}));
}

// A diverged vector has no direction, but normalizing it is no error.
TEST(Normalized, WhatIsNotFiniteStaysSo) {
    constexpr Real nan = std::numeric_limits<Real>::quiet_NaN();
    constexpr Real infinity = std::numeric_limits<Real>::infinity();
    for (const Real bad : {nan, infinity, -infinity})
        for (int i = 0; i < 3; ++i) {
            Vec3 v{Real(1), Real(2), Real(3)};
            v[i] = bad;
            const auto unit = normalized<3>(v);
            ASSERT_TRUE(unit.has_value());
            EXPECT_FALSE(std::isfinite(unit->x + unit->y + unit->z)) << bad << " at " << i;
        }
}

// Integer vectors at tiny angles to each other: their cross and dot products are exact in integers,
// 128 bits where 64 are too few.
__extension__ typedef __int128 Int; // NOLINT(modernize-use-using): __extension__ needs it
struct Int3 {
    std::int64_t x = 0, y = 0, z = 0;
};
constexpr int bits = sizeof(Real) == sizeof(float) ? 23 : 50;

Int3 any_whole(Random &random, int of_bits) {
    const auto any = [&] {
        return std::int64_t(random.next_in(-1, 1) * double(std::int64_t(1) << of_bits));
    };
    const std::int64_t x = any(), y = any(), z = any();
    return {x, y, z};
}
Vec3 real(const Int3 &v) {
    return {Real(v.x), Real(v.y), Real(v.z)};
}
// In long double, rounded only at the end.
W exact_angle(const Int3 &a, const Int3 &b) {
    const W x = W(Int(a.y) * b.z - Int(a.z) * b.y), y = W(Int(a.z) * b.x - Int(a.x) * b.z),
            z = W(Int(a.x) * b.y - Int(a.y) * b.x);
    return std::atan2(std::sqrt(x * x + y * y + z * z),
                      W(Int(a.x) * b.x + Int(a.y) * b.y + Int(a.z) * b.z));
}

TEST(AngleBetween, AccurateNearZeroAndPi) {
    Random random(2);
    W worst = 0;
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const Int3 a = any_whole(random, bits - 1);
        // a or -a with some low bits changed, few or nearly all.
        const std::int64_t sign = random.next_index(2) == 0 ? 1 : -1;
        const Int3 noise = any_whole(random, int(random.next_index(std::uint32_t(bits - 1))));
        Int3 b{sign * a.x + noise.x, sign * a.y + noise.y, sign * a.z + noise.z};
        if ((a.x == 0 && a.y == 0 && a.z == 0) || (b.x == 0 && b.y == 0 && b.z == 0))
            continue;
        const int power = int(random.next_index(40)) - 20;
        const W exact = exact_angle(a, b);
        const W angle = W(angle_between(real(a) * std::ldexp(Real(1), power), real(b)));
        ASSERT_GE(angle, W(0));
        // A few ulps of the angle, however small, and near pi a few ulps of pi.
        ASSERT_LE(std::abs(angle - exact), 4 * epsilon * exact) << "trial " << trial;
        worst = std::max(worst, std::abs(angle - exact) / (epsilon * exact));
        const Int3 flat_a{a.x, a.y, 0}, flat_b{b.x, b.y, 0};
        const W flat = exact_angle(flat_a, flat_b);
        ASSERT_LE(std::abs(W(angle_between(Vec2{real(a)}, Vec2{real(b)})) - flat),
                  4 * epsilon * flat);
    }
    RecordProperty("worst_error_in_epsilon", std::to_string(worst));
    EXPECT_EQ(angle_between(Vec3{Real(0)}, Vec3{Real(1)}), Real(0));
    EXPECT_EQ(angle_between(Vec3{Real(1), Real(2), Real(3)}, Vec3{Real(1), Real(2), Real(3)}),
              Real(0));
    const Vec3 x{Real(1), Real(0), Real(0)};
    EXPECT_EQ(angle_between(x, Real(-5) * x), Real(pi));
    const Real huge = std::numeric_limits<Real>::max(), tiny = std::numeric_limits<Real>::min();
    EXPECT_EQ(angle_between(huge * x, Vec3{Real(0), tiny, Real(0)}), Real(pi / 2));
}

TEST(AccurateCross, ToTheLastPlace) {
    Random random(3);
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const Int3 a = any_whole(random, bits);
        const Int3 noise = any_whole(random, int(random.next_index(std::uint32_t(bits))));
        const Int3 b{(a.x + noise.x) / 2, (a.y + noise.y) / 2, (a.z + noise.z) / 2};
        const Vec3 cross = accurate_cross(real(a), real(b));
        const std::array<Int, 3> exact{Int(a.y) * b.z - Int(a.z) * b.y,
                                       Int(a.z) * b.x - Int(a.x) * b.z,
                                       Int(a.x) * b.y - Int(a.y) * b.x};
        for (int i = 0; i < 3; ++i) {
            const W right = W(exact[std::size_t(i)]);
            ASSERT_LE(std::abs(W(cross[i]) - right), W(1.5) * epsilon * std::abs(right))
                << "trial " << trial;
        }
    }
}

TEST(ProjectionAndReflection, PartsAddUpAndAreAtRightAngles) {
    Random random(4);
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const Vec3 v = any_vector(random, -6, 6);
        Vec3 axis = any_vector(random, -12, 12);
        if (random.next_index(4) == 0) // nearly parallel to v
            axis = v + Real(std::pow(10.0, random.next_in(-8, -1))) * glm::length(v) *
                           normalized_or<3>(axis, Vec3{Real(0)});
        const W3 w = widened(v), n = widened(axis);
        const W length = glm::length(w), squared = glm::dot(n, n);
        const W3 p = widened(projection<3>(v, axis)), q = widened(rejection(v, axis));
        const W3 r = widened(reflection<3>(v, axis));
        if (squared == W(0)) {
            ASSERT_EQ(p, W3{W(0)});
            ASSERT_EQ(q, w);
            ASSERT_EQ(r, w);
            continue;
        }
        const W3 along = n * (glm::dot(w, n) / squared);
        ASSERT_LE(glm::length(p - along), 4 * epsilon * length) << "trial " << trial;
        ASSERT_LE(glm::length(r - (w - W(2) * along)), 8 * epsilon * length) << "trial " << trial;
        // The rejection is accurate relative to its own length, down to the long double oracle's
        // own rounding.
        const W3 across = w - along;
        const W slack = 64 * std::numeric_limits<W>::epsilon() * length;
        ASSERT_LE(glm::length(q - across), 8 * epsilon * glm::length(across) + slack)
            << "trial " << trial;
        ASSERT_LE(std::abs(glm::dot(q, n)), 8 * epsilon * glm::length(q) * glm::length(n));

        const Vec2 v2{v}, axis2{axis};
        if (axis2 != Vec2{Real(0)}) {
            const Vec2 sum = projection<2>(v2, axis2) + rejection(v2, axis2);
            ASSERT_LE(glm::length(sum - v2), Real(8 * epsilon) * glm::length(v2));
            ASSERT_LE(std::abs(glm::dot(normalized_or<2>(rejection(v2, axis2), Vec2{Real(0)}),
                                        *normalized<2>(axis2))),
                      Real(8 * epsilon));
        }
    }
    const Vec3 v{Real(1), Real(2), Real(3)}, y{Real(0), Real(4), Real(0)};
    EXPECT_EQ(projection<3>(v, y), (Vec3{Real(0), Real(2), Real(0)}));
    EXPECT_EQ(rejection(v, y), (Vec3{Real(1), Real(0), Real(3)}));
    EXPECT_EQ(reflection<3>(v, y), (Vec3{Real(1), Real(-2), Real(3)}));
    EXPECT_EQ(rejection(Vec2{Real(1), Real(2)}, Vec2{Real(0), Real(-3)}), (Vec2{Real(1), Real(0)}));
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
