#include "engine/math/rigid.h"

#include "engine/core/check.h"
#include "engine/core/random.h"
#include "tests/trials.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using W = long double;
using W3 = glm::vec<3, W, glm::defaultp>;
using WQ = glm::qua<W, glm::defaultp>;
using WM = glm::mat<3, 3, W, glm::defaultp>;

constexpr W epsilon = std::numeric_limits<Real>::epsilon();
constexpr W pi = 3.14159265358979323846264338327950288L;

W3 widened(const Vec3 &v) {
    return {W(v.x), W(v.y), W(v.z)};
}
WM widened(const Mat3 &m) {
    return {widened(m[0]), widened(m[1]), widened(m[2])};
}

// q v q* for q of any length, in long double.
W3 turned(const Quat &q, const W3 &v) {
    const W3 u{W(q.x), W(q.y), W(q.z)};
    const W w = W(q.w), squared = w * w + glm::dot(u, u);
    return ((w * w - glm::dot(u, u)) * v + W(2) * glm::dot(u, v) * u +
            W(2) * w * glm::cross(u, v)) /
           squared;
}

// A rotation about a coordinate axis as a matrix, in long double.
WM turn_about(int axis, W angle) {
    WM m{W(1)};
    const int j = (axis + 1) % 3, k = (axis + 2) % 3;
    m[j][j] = m[k][k] = std::cos(angle);
    m[j][k] = std::sin(angle);
    m[k][j] = -std::sin(angle);
    return m;
}

W largest_difference(const WM &a, const WM &b) {
    W most = 0;
    for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i)
            most = std::max(most, std::abs(a[j][i] - b[j][i]));
    return most;
}

Vec3 any_vector(Random &random, double reach) {
    const double x = random.next_in(-reach, reach), y = random.next_in(-reach, reach);
    return {Real(x), Real(y), Real(random.next_in(-reach, reach))};
}

Quat any_rotation(Random &random) {
    for (;;) {
        const Quat q{Real(random.next_in(-1, 1)), Real(random.next_in(-1, 1)),
                     Real(random.next_in(-1, 1)), Real(random.next_in(-1, 1))};
        const Real squared = glm::dot(q, q);
        if (squared > Real(0.01) && squared < Real(1))
            return glm::normalize(q);
    }
}

W3 to_point(const Mat4 &m, const W3 &p) {
    return widened(Mat3{m}) * p + widened(Vec3{m[3]});
}

TEST(Rigid, RotationMatrixAlsoOffUnitLength) {
    Random random(1);
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        Quat q = any_rotation(random);
        if (random.next_index(2) == 0)
            q *= Real(std::pow(10.0, random.next_in(-3, 3)));
        const Mat3 m = rotation_matrix(q);
        for (int j = 0; j < 3; ++j) {
            W3 e{W(0)};
            e[j] = W(1);
            ASSERT_LE(glm::length(widened(m[j]) - turned(q, e)), 6 * epsilon) << trial;
        }
    }
    EXPECT_EQ(rotation_matrix(identity_rotation), Mat3{Real(1)});
}

TEST(Rigid, ComposeInverseAndMatrix) {
    Random random(2);
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const double reach = std::pow(10.0, random.next_in(-3, 5));
        const Transform a{any_vector(random, reach), any_rotation(random)};
        const Transform b{any_vector(random, reach), any_rotation(random)};
        const Vec3 p = any_vector(random, reach);
        const W3 w = widened(p);
        const W3 in_a = turned(b.rotation, w) + widened(b.position);
        const W3 exact = turned(a.rotation, in_a) + widened(a.position);
        const W bound = 32 * epsilon * W(reach);
        ASSERT_LE(glm::length(widened(to_world_point(compose(a, b), p)) - exact), bound) << trial;
        ASSERT_LE(glm::length(to_point(to_matrix(compose(a, b)), w) - exact), bound) << trial;
        const W3 there = turned(a.rotation, w) + widened(a.position);
        const Vec3 rounded{Real(there.x), Real(there.y), Real(there.z)};
        ASSERT_LE(glm::length(widened(to_world_point(inverse(a), rounded)) - w), bound) << trial;
        const Mat4 m = to_matrix(a);
        ASSERT_LE(glm::length(to_point(rigid_inverse(m), there) - w), bound) << trial;
        const Mat4 back = rigid_inverse(m);
        ASSERT_EQ((Vec4{back[0][3], back[1][3], back[2][3], back[3][3]}),
                  (Vec4{Real(0), Real(0), Real(0), Real(1)}));
    }
}

TEST(Rigid, Orthonormalized) {
    Random random(3);
    int none = 0;
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        Mat3 m = rotation_matrix(any_rotation(random));
        const Real drift = Real(std::pow(10.0, random.next_in(-8, 0.5)));
        for (int j = 0; j < 3; ++j)
            m[j] = (m[j] + drift * any_vector(random, 1)) *
                   Real(std::pow(10.0, random.next_in(-10, 10)));
        const std::uint32_t kind = random.next_index(8);
        if (kind == 0) // second column nearly or exactly parallel to the first
            m[1] = m[0] * Real(random.next_in(-2, 2)) +
                   m[1] *
                       (Real(std::pow(10.0, random.next_in(-9, -2))) * glm::length(m[0]) /
                        glm::length(m[1])) *
                       Real(random.next_index(2));
        if (kind == 1)
            m[2] = m[0];
        const auto axes = orthonormalized(m);
        none += !axes;
        if (kind == 1 || !axes) {
            ASSERT_FALSE(kind == 1 && axes.has_value());
            continue;
        }
        const WM q = widened(*axes);
        ASSERT_LE(largest_difference(glm::transpose(q) * q, WM{W(1)}), 4 * epsilon) << trial;
        // The first axis keeps its direction, the second its plane and side, all three their
        // handedness.
        ASSERT_LE(glm::length(q[0] - glm::normalize(widened(m[0]))), 4 * epsilon);
        const W3 second = glm::normalize(widened(m[1]));
        ASSERT_LE(std::abs(glm::dot(second, q[2])), 4 * epsilon) << trial;
        ASSERT_GT(glm::dot(second, q[1]), W(0)) << trial;
        ASSERT_GT(glm::dot(widened(m[2]), q[2]), W(0)) << trial;
    }
    EXPECT_GT(none, trials(1'000'000) / 10);
    EXPECT_FALSE(orthonormalized(Mat3{Real(0)}).has_value());
    EXPECT_EQ(*orthonormalized(Mat3{Real(-3)}), Mat3{Real(-1)});
}

TEST(Rigid, DecomposeGivesTheSameMatrix) {
    Random random(4);
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        ScaledTransform parts{any_vector(random, 1e3), any_rotation(random), {}};
        for (int i = 0; i < 3; ++i)
            parts.scale[i] =
                Real(std::pow(10.0, random.next_in(-4, 4)) * (random.next_index(2) == 0 ? 1 : -1));
        const Mat4 m = to_matrix(parts);
        const auto found = decompose(m);
        ASSERT_TRUE(found.has_value()) << trial;
        ASSERT_EQ(found->position, parts.position);
        // Mirroring goes into scale.x.
        const bool is_mirrored = parts.scale.x * parts.scale.y * parts.scale.z < Real(0);
        ASSERT_EQ(found->scale.x < Real(0), is_mirrored);
        ASSERT_GT(found->scale.y, Real(0));
        ASSERT_GT(found->scale.z, Real(0));
        const Mat4 again = to_matrix(*found);
        for (int j = 0; j < 3; ++j) {
            const W size = std::abs(W(parts.scale[j]));
            ASSERT_LE(std::abs(std::abs(W(found->scale[j])) - size), 8 * epsilon * size);
            ASSERT_LE(glm::length(widened(Vec3{again[j]}) - widened(Vec3{m[j]})),
                      16 * epsilon * size)
                << trial;
            ASSERT_LE(glm::length(widened(Vec3{m[j]}) -
                                  turned(parts.rotation, W3{Vec3{j == 0, j == 1, j == 2}}) *
                                      W(parts.scale[j])),
                      8 * epsilon * size);
        }
    }
    Mat4 sheared{Real(1)};
    sheared[1][0] = Real(0.01);
    EXPECT_FALSE(decompose(sheared).has_value());
    Mat4 flat{Real(1)};
    flat[2][2] = Real(0);
    EXPECT_FALSE(decompose(flat).has_value());
    Mat4 perspective{Real(1)};
    perspective[2][3] = Real(-1);
    EXPECT_FALSE(decompose(perspective).has_value());
}

TEST(Euler, ThereAndBack) {
    Random random(5);
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        EulerAngles angles{Real(random.next_in(-3.14159, 3.14159)),
                           Real(random.next_in(-1.570796, 1.570796)),
                           Real(random.next_in(-3.14159, 3.14159))};
        const std::uint32_t kind = random.next_index(4);
        if (kind == 0) // near gimbal lock
            angles.pitch = Real((random.next_index(2) == 0 ? 1.0 : -1.0) *
                                (1.5707963267948966 - std::pow(10.0, random.next_in(-20, -1))));
        if (kind == 1)
            angles.yaw = Real(random.next_in(-1e-6, 1e-6));
        const Quat q = rotation_of(angles);
        const WM exact = turn_about(1, W(angles.yaw)) * turn_about(0, W(angles.pitch)) *
                         turn_about(2, W(angles.roll));
        ASSERT_LE(largest_difference(widened(rotation_matrix(q)), exact), 8 * epsilon) << trial;
        const EulerAngles found = euler_angles(q);
        ASSERT_LE(std::abs(W(found.yaw)), pi * (1 + epsilon));
        ASSERT_LE(std::abs(W(found.roll)), pi * (1 + epsilon));
        ASSERT_LE(std::abs(W(found.pitch)), pi / 2 * (1 + epsilon));
        // Whatever the angles, they reproduce the rotation.
        const WM again = turn_about(1, W(found.yaw)) * turn_about(0, W(found.pitch)) *
                         turn_about(2, W(found.roll));
        ASSERT_LE(largest_difference(again, exact), 24 * epsilon)
            << trial << " pitch " << angles.pitch;
        // Away from gimbal lock they are the same angles, up to the rotation's rounding.
        const W from_lock = pi / 2 - std::abs(W(angles.pitch));
        const W bound = 16 * epsilon / std::min(W(1), from_lock);
        if (from_lock > W(0) && bound < W(0.1)) {
            ASSERT_LE(std::abs(W(found.pitch) - W(angles.pitch)), 8 * epsilon);
            ASSERT_LE(std::abs(std::remainder(W(found.yaw) - W(angles.yaw), 2 * pi)), bound);
            ASSERT_LE(std::abs(std::remainder(W(found.roll) - W(angles.roll), 2 * pi)), bound);
        }
    }
    const Real half_turn = Real(pi / 2);
    const EulerAngles up = euler_angles(rotation_of(EulerAngles{Real(1), half_turn, Real(0.25)}));
    EXPECT_EQ(up.roll, Real(0)); // locked: only yaw - roll is defined
    EXPECT_NEAR(double(up.yaw), 0.75, 8 * double(epsilon));
    const EulerAngles down =
        euler_angles(rotation_of(EulerAngles{Real(1), -half_turn, Real(0.25)}));
    EXPECT_EQ(down.roll, Real(0));
    EXPECT_NEAR(double(down.yaw), 1.25, 8 * double(epsilon));
}

TEST(AxisAngle, ThereAndBack) {
    Random random(6);
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        Vec3 axis = any_vector(random, 1);
        if (glm::length(axis) < Real(0.01))
            continue;
        axis *= Real(std::pow(10.0, random.next_in(-20, 20)));
        Real angle = Real(random.next_in(0, 3.1415926));
        if (random.next_index(2) == 0) // tiny, or nearly half a turn
            angle = Real(std::pow(10.0, random.next_in(-15, 0)));
        if (random.next_index(4) == 0)
            angle = Real(pi) - angle;
        if (angle <= Real(0))
            continue;
        const Quat q = rotation_of(AxisAngle{axis, angle});
        const W3 unit = glm::normalize(widened(axis));
        // Rodrigues' formula.
        const W3 v{W(random.next_in(-1, 1)), W(random.next_in(-1, 1)), W(random.next_in(-1, 1))};
        const W c = std::cos(W(angle)), s = std::sin(W(angle));
        const W3 exact = v * c + glm::cross(unit, v) * s + unit * (glm::dot(unit, v) * (1 - c));
        ASSERT_LE(glm::length(turned(q, v) - exact), 6 * epsilon) << trial;
        const AxisAngle found = axis_angle(random.next_index(2) == 0 ? q : -q);
        ASSERT_GE(found.angle, Real(0));
        ASSERT_LE(W(found.angle), pi * (1 + epsilon));
        // Near half a turn, rounding may flip the axis; otherwise both agree to their last places.
        const W3 found_axis = widened(found.axis);
        const bool is_same = glm::dot(found_axis, unit) > W(0);
        ASSERT_TRUE(is_same || W(angle) > pi - 8 * epsilon) << trial;
        ASSERT_LE(glm::length(is_same ? found_axis - unit : found_axis + unit), 6 * epsilon);
        ASSERT_LE(std::abs(W(found.angle) - W(angle)), (is_same ? 6 : 16) * epsilon * W(angle))
            << trial;
    }
    const AxisAngle none = axis_angle(identity_rotation);
    EXPECT_EQ(none.angle, Real(0));
    EXPECT_EQ(none.axis, (Vec3{Real(0), Real(1), Real(0)}));
    try {
        rotation_of(AxisAngle{Vec3{Real(0)}, Real(1)});
        ADD_FAILURE();
    } catch (const CheckFailure &error) {
        EXPECT_NE(std::string(error.what()).find("(0, 0, 0)"), std::string::npos);
    }
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
