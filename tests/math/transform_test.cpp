#include "engine/math/types.h"

#include "engine/core/random.h"
#include "tests/trials.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <limits>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using Wide = glm::vec<3, long double>;

constexpr double epsilon = double(std::numeric_limits<Real>::epsilon());

Wide wide(const Vec3 &v) {
    return {v.x, v.y, v.z};
}

// The rotation matrix of a quaternion of any length (Euler-Rodrigues), row by row.
Wide matrix_times(const Quat &q, const Wide &v) {
    const long double w = q.w, x = q.x, y = q.y, z = q.z;
    const long double n = w * w + x * x + y * y + z * z;
    return Wide{(w * w + x * x - y * y - z * z) * v.x + 2 * (x * y - w * z) * v.y +
                    2 * (x * z + w * y) * v.z,
                2 * (x * y + w * z) * v.x + (w * w - x * x + y * y - z * z) * v.y +
                    2 * (y * z - w * x) * v.z,
                2 * (x * z - w * y) * v.x + 2 * (y * z + w * x) * v.y +
                    (w * w - x * x - y * y + z * z) * v.z} /
           n;
}

Vec3 any_vector(Random &random, double reach) {
    const double x = random.next_in(-reach, reach), y = random.next_in(-reach, reach);
    const double z = random.next_in(-reach, reach);
    return {Real(x), Real(y), Real(z)};
}

Quat any_rotation(Random &random) {
    for (;;) {
        const double w = random.next_in(-1, 1), x = random.next_in(-1, 1);
        const double y = random.next_in(-1, 1), z = random.next_in(-1, 1);
        const double length = std::sqrt(w * w + x * x + y * y + z * z);
        if (length > 0.1 && length < 1)
            return {Real(w / length), Real(x / length), Real(y / length), Real(z / length)};
    }
}

// Two cross products, three sums and a product, each rounding a value of at most 4 |v|.
TEST(Rotated, AgainstTheRotationMatrix) {
    Random random(1);
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const Quat q = any_rotation(random);
        const Vec3 v = any_vector(random, 10);
        const double size = double(glm::length(wide(v)));
        const Wide error = wide(rotated(q, v)) - matrix_times(q, wide(v));
        EXPECT_LE(double(glm::length(error)), 12 * epsilon * size);
    }
}

// rotated() divides by the quaternion's squared length, so it keeps lengths whatever that is; GLM's
// product is off by twice the error of the quaternion's length.
TEST(Rotated, LengthIsKeptByAQuaternionThatIsNotOfUnitLength) {
    Random random(2);
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const Quat q = Real(1.001) * any_rotation(random);
        const Vec3 v = any_vector(random, 10);
        const double before = double(glm::length(wide(v)));
        EXPECT_NEAR(double(glm::length(wide(rotated(q, v)))), before, 12 * epsilon * before);
        const double by_glm = double(glm::length(wide(q * v)));
        EXPECT_GT(std::abs(by_glm - before), 0);
    }
}

// A vector rotated there and back many times. Without bias the roundings (each at most 12 epsilon)
// do not all point one way; a tenth of the worst case is far more than a random walk.
TEST(Rotated, ThereAndBackManyTimes) {
    Random random(3);
    const int turns = 10000;
    Vec3 v = any_vector(random, 10);
    const double before = double(glm::length(wide(v)));
    for (int i = 0; i < turns; ++i) {
        const Quat q = any_rotation(random);
        v = rotated(glm::conjugate(q), rotated(q, v));
    }
    EXPECT_NEAR(double(glm::length(wide(v))), before, 0.1 * turns * 12 * epsilon * before);
}

// Each way is a rotation (12 roundings of up to |v|) and a sum; the quaternion's length error, at
// most 2 epsilon, scales the vector by twice that each way.
TEST(Transform, RoundTrips) {
    Random random(4);
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const Transform frame{any_vector(random, 5), any_rotation(random)};
        const Vec3 v = any_vector(random, 10);
        const double size = double(glm::length(wide(v)) + glm::length(wide(frame.position)));
        const double tolerance = 32 * epsilon * size;
        EXPECT_LE(double(glm::distance(to_local_point(frame, to_world_point(frame, v)), v)),
                  tolerance);
        EXPECT_LE(double(glm::distance(to_world_point(frame, to_local_point(frame, v)), v)),
                  tolerance);
        EXPECT_LE(double(glm::distance(to_local_vector(frame, to_world_vector(frame, v)), v)),
                  tolerance);
        EXPECT_LE(double(glm::distance(to_world_vector(frame, to_local_vector(frame, v)), v)),
                  tolerance);
    }
}

TEST(Transform, RotateThenTranslate) {
    Random random(5);
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const Transform frame{any_vector(random, 5), any_rotation(random)};
        const Vec3 v = any_vector(random, 10);
        const Wide expected = wide(frame.position) + matrix_times(frame.rotation, wide(v));
        EXPECT_LE(double(glm::length(wide(to_world_point(frame, v)) - expected)),
                  20 * epsilon * 25);
    }
    const Transform nothing;
    const Vec3 v{Real(1), Real(2), Real(3)};
    EXPECT_EQ(to_world_point(nothing, v), v);
    EXPECT_EQ(to_local_point(nothing, v), v);
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
