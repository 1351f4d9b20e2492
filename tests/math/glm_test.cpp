// What the engine uses of GLM unchanged, against wide arithmetic and the conventions the rest
// relies on: columns, right-handed, clip space from -w to w.
#include "engine/core/random.h"
#include "engine/math/types.h"
#include "tests/trials.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>

namespace plumb::inline PLUMB_PRECISION {
namespace {

constexpr long double epsilon = std::numeric_limits<Real>::epsilon();

Real any(Random &random, double reach = 10) {
    return static_cast<Real>(random.next_in(-reach, reach));
}

Vec3 any_vector(Random &random) {
    const Real x = any(random), y = any(random);
    return {x, y, any(random)};
}

TEST(Glm, VectorsComponentByComponentDotCrossAndLength) {
    Random random(1);
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const Vec3 a = any_vector(random), b = any_vector(random);
        for (int i = 0; i < 3; ++i) {
            ASSERT_EQ((a + b)[i], a[i] + b[i]);
            ASSERT_EQ((a - b)[i], a[i] - b[i]);
            ASSERT_EQ((a * b)[i], a[i] * b[i]);
            ASSERT_EQ((a * Real(3))[i], a[i] * Real(3));
        }
        long double dot = 0, size = 0, squared = 0;
        for (int i = 0; i < 3; ++i) {
            dot += static_cast<long double>(a[i]) * b[i];
            size += std::abs(static_cast<long double>(a[i]) * b[i]);
            squared += static_cast<long double>(a[i]) * a[i];
        }
        ASSERT_NEAR(static_cast<double>(glm::dot(a, b)), static_cast<double>(dot),
                    static_cast<double>(3 * epsilon * size));
        ASSERT_NEAR(static_cast<double>(glm::length(a)), static_cast<double>(std::sqrt(squared)),
                    static_cast<double>(3 * epsilon * std::sqrt(squared)));
        const Vec3 cross = glm::cross(a, b);
        for (int i = 0; i < 3; ++i) {
            const int j = (i + 1) % 3, k = (i + 2) % 3;
            const long double p = static_cast<long double>(a[j]) * b[k];
            const long double q = static_cast<long double>(a[k]) * b[j];
            ASSERT_NEAR(static_cast<double>(cross[i]), static_cast<double>(p - q),
                        static_cast<double>(2 * epsilon * (std::abs(p) + std::abs(q))));
        }
    }
}

// Summed over permutations, not by cofactors.
template <int N, typename Matrix> long double determinant(const Matrix &m) {
    std::array<int, N> order{};
    for (int i = 0; i < N; ++i)
        order[static_cast<std::size_t>(i)] = i;
    long double sum = 0;
    do {
        long double product = 1;
        for (int i = 0; i < N; ++i)
            product *= static_cast<long double>(m[i][order[static_cast<std::size_t>(i)]]);
        int inversions = 0;
        for (std::size_t i = 0; i < N; ++i)
            for (std::size_t j = i + 1; j < N; ++j)
                inversions += order[i] > order[j] ? 1 : 0;
        sum += inversions % 2 == 0 ? product : -product;
    } while (std::next_permutation(order.begin(), order.end()));
    return sum;
}

template <int N, typename Matrix, typename Vector> void check_matrices(std::uint64_t seed) {
    Random random(seed);
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        Matrix a(Real(0)), b(Real(0));
        Vector v(Real(0));
        for (int i = 0; i < N; ++i) {
            v[i] = any(random);
            for (int j = 0; j < N; ++j) {
                a[i][j] = any(random);
                b[i][j] = any(random);
            }
        }
        const Matrix product = a * b, transposed = glm::transpose(a);
        const Vector image = a * v;
        for (int row = 0; row < N; ++row) {
            long double along = 0;
            for (int k = 0; k < N; ++k)
                along += static_cast<long double>(a[k][row]) * v[k];
            ASSERT_NEAR(static_cast<double>(image[row]), static_cast<double>(along),
                        static_cast<double>(100 * N * N * epsilon));
            for (int column = 0; column < N; ++column) {
                ASSERT_EQ(transposed[column][row], a[row][column]);
                long double sum = 0;
                for (int k = 0; k < N; ++k)
                    sum += static_cast<long double>(a[k][row]) * b[column][k];
                ASSERT_NEAR(static_cast<double>(product[column][row]), static_cast<double>(sum),
                            static_cast<double>(100 * N * N * epsilon));
            }
        }
        ASSERT_EQ(a * Matrix(Real(1)), a);
        // Each of the N! products is at most 10^N and is rounded N times.
        const double size = std::tgamma(N + 1) * std::pow(10.0, N);
        ASSERT_NEAR(static_cast<double>(glm::determinant(a)),
                    static_cast<double>(determinant<N>(a)),
                    size * N * static_cast<double>(epsilon));
    }
}

TEST(Glm, MatricesTimesVectorsTransposedAndDeterminants) {
    check_matrices<2, Mat2, Vec2>(2);
    check_matrices<3, Mat3, Vec3>(3);
}

TEST(Glm, MatricesOfFourRowsTimesVectorsTransposedAndDeterminants) {
    check_matrices<4, Mat4, Vec4>(4);
}

TEST(Glm, TranslationScaleAndRotationActInOrder) {
    const Mat4 moved = glm::translate(Mat4(Real(1)), Vec3{1, 2, 3});
    const Mat4 scaled = glm::scale(Mat4(Real(1)), Vec3{2, 3, 4});
    EXPECT_EQ(Vec3(moved * Vec4(5, 5, 5, 1)), Vec3(6, 7, 8));
    EXPECT_EQ(Vec3(moved * Vec4(5, 5, 5, 0)), Vec3(5, 5, 5));          // a direction
    EXPECT_EQ(Vec3(moved * scaled * Vec4(1, 1, 1, 1)), Vec3(3, 5, 7)); // scale first
    // A quarter turn about y takes z to x.
    const Mat4 turned =
        glm::rotate(Mat4(Real(1)), static_cast<Real>(std::acos(0.0L)), Vec3{0, 1, 0});
    const Vec3 image(turned * Vec4(0, 0, 1, 1));
    EXPECT_NEAR(static_cast<double>(image.x), 1, 1e-6);
    EXPECT_NEAR(static_cast<double>(image.z), 0, 1e-6);
}

TEST(Glm, ViewLooksAlongMinusZAndProjectionsFillTheClipVolume) {
    const Mat4 view = glm::lookAt(Vec3{4, 0, 0}, Vec3{0, 0, 0}, Vec3{0, 1, 0});
    const Vec3 ahead(view * Vec4(0, 0, 0, 1));
    EXPECT_NEAR(static_cast<double>(ahead.z), -4, 1e-6);
    const Vec3 right(view * Vec4(0, 0, -1, 1)); // seen from +x, -z is on the right
    EXPECT_NEAR(static_cast<double>(right.x), 1, 1e-6);

    const Real half = std::atan(Real(0.5));
    const Mat4 perspective = glm::perspective(2 * half, Real(2), Real(1), Real(9));
    const auto clip = [](const Mat4 &m, const Vec3 &p) {
        const Vec4 c = m * Vec4(p, Real(1));
        return Vec3(c) / c.w;
    };
    // Height 1 and width 2 at distance 1; nine times as much at the far plane.
    const Vec3 near_corner = clip(perspective, {1, Real(0.5), -1});
    const Vec3 far_corner = clip(perspective, {-9, Real(-4.5), -9});
    for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(static_cast<double>(near_corner[i]), i == 2 ? -1 : 1, 1e-5);
        EXPECT_NEAR(static_cast<double>(far_corner[i]), i == 2 ? 1 : -1, 1e-5);
    }
    const Mat4 box = glm::ortho(Real(-2), Real(2), Real(-1), Real(1), Real(1), Real(9));
    const Vec3 corner = clip(box, {2, 1, -9});
    EXPECT_NEAR(static_cast<double>(glm::length(corner - Vec3(1))), 0, 1e-5);
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
