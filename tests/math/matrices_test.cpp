#include "engine/math/matrices.h"

#include "engine/core/random.h"
#include "tests/trials.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include <glm/matrix.hpp>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using W = long double;
constexpr W epsilon = std::numeric_limits<Real>::epsilon();

// Sums over all permutations: with signs, and of absolute products.
template <typename Number> struct Sums {
    Number determinant = 0;
    Number permanent = 0;
};

template <typename Number> struct Square {
    std::array<std::array<Number, 4>, 4> entry{};
    std::size_t size = 0;
};

// Adds all products that extend `product`, which covers the columns before `column` and the rows in
// `used`.
template <typename Number>
void permute(const Square<Number> &m, std::size_t column, unsigned used, Number product,
             bool is_odd, Sums<Number> &sums) {
    if (column == m.size) {
        sums.determinant += is_odd ? -product : product;
        sums.permanent += product < 0 ? -product : product;
        return;
    }
    for (std::size_t row = 0; row < m.size; ++row)
        if (((used >> row) & 1U) == 0) {
            const bool passes_odd = std::popcount(used >> row) % 2 == 1;
            permute(m, column + 1, used | (1U << row), product * m.entry[column][row],
                    is_odd != passes_odd, sums);
        }
}

template <typename Number> Sums<Number> by_permutations(const Square<Number> &m) {
    Sums<Number> sums;
    permute(m, 0, 0, Number(1), false, sums);
    return sums;
}

template <int N> using Matrix = glm::mat<N, N, Real, glm::defaultp>;

// m without one column and one row; an index of -1 removes nothing.
template <typename Number, int N> Square<Number> without(const Matrix<N> &m, int column, int row) {
    Square<Number> rest;
    for (int j = 0; j < N; ++j) {
        if (j == column)
            continue;
        std::size_t count = 0;
        for (int i = 0; i < N; ++i)
            if (i != row)
                rest.entry[rest.size][count++] = Number(m[j][i]);
        ++rest.size;
    }
    return rest;
}

// Minors, cofactors and adjugates of integer matrices are exact; try_inverse fails exactly for the
// singular ones.
template <int N> void expect_whole_numbers_exact(std::uint64_t seed, int reach, int count) {
    Random random(seed);
    int singular = 0;
    for (int trial = 0; trial < count; ++trial) {
        Matrix<N> m;
        for (int j = 0; j < N; ++j)
            for (int i = 0; i < N; ++i)
                m[j][i] = Real(int(random.next_index(std::uint32_t(2 * reach + 1))) - reach);
        if (random.next_index(4) == 0)
            m[N - 1] = m[0] * Real(2) - m[N > 2 ? 1 : 0];
        const std::int64_t determinant =
            by_permutations(without<std::int64_t, N>(m, -1, -1)).determinant;
        const Matrix<N> all_minors = minors(m), all_cofactors = cofactors(m),
                        adjugated = adjugate(m);
        for (int j = 0; j < N; ++j)
            for (int i = 0; i < N; ++i) {
                const std::int64_t minor =
                    by_permutations(without<std::int64_t, N>(m, j, i)).determinant;
                ASSERT_EQ(all_minors[j][i], Real(minor)) << N << ", trial " << trial;
                const Real cofactor = Real((i + j) % 2 == 0 ? minor : -minor);
                ASSERT_EQ(all_cofactors[j][i], cofactor);
                ASSERT_EQ(adjugated[i][j], cofactor);
            }
        const auto inverse = try_inverse(m);
        ASSERT_EQ(inverse.has_value(), determinant != 0) << N << ", trial " << trial;
        singular += determinant == 0;
        if (!inverse)
            continue;
        for (int j = 0; j < N; ++j)
            for (int i = 0; i < N; ++i) {
                const W exact = W(adjugated[j][i]) / W(determinant);
                ASSERT_LE(std::abs(W((*inverse)[j][i]) - exact), epsilon * std::abs(exact));
            }
    }
    EXPECT_GT(singular, count / 10);
}

TEST(Matrices, WholeNumbersAreExact) {
    expect_whole_numbers_exact<2>(1, 9, trials(1'000'000));
    expect_whole_numbers_exact<3>(2, 9, trials(1'000'000));
}

TEST(Matrices, WholeNumbersOfFourRowsAreExact) {
    expect_whole_numbers_exact<4>(3, 5, trials(1'000'000));
}

template <int N> void expect_inverse_within_bound(std::uint64_t seed, int count) {
    Random random(seed);
    int none = 0;
    for (int trial = 0; trial < count; ++trial) {
        Matrix<N> m;
        const double scale = std::pow(10.0, random.next_in(-6, 6));
        for (int j = 0; j < N; ++j)
            for (int i = 0; i < N; ++i)
                m[j][i] =
                    Real(scale * random.next_in(-1, 1) * (random.next_index(8) == 0 ? 1e-5 : 1.0));
        const bool is_skewed = random.next_index(4) == 0;
        if (is_skewed) // nearly singular
            m[N - 1] =
                m[0] * Real(random.next_in(-1, 1)) +
                m[N - 1] *
                    Real(std::pow(10.0, random.next_in(std::log10(double(epsilon)) - 1.0, -1)));
        const Sums<W> whole = by_permutations(without<W, N>(m, -1, -1));
        const W certainty = std::abs(whole.determinant) / (epsilon * whole.permanent);
        const auto inverse = try_inverse(m);
        // The documented threshold is 16; the measure itself is accurate to a few epsilon.
        if (certainty > W(24)) {
            ASSERT_TRUE(inverse.has_value()) << N << ", trial " << trial;
        } else if (certainty < W(8)) {
            ASSERT_FALSE(inverse.has_value()) << N << ", trial " << trial;
        }
        none += !inverse;
        if (!inverse)
            continue;
        for (int j = 0; j < N; ++j)
            for (int i = 0; i < N; ++i) {
                // Entry [j][i] is the signed minor without column i and row j, over the
                // determinant.
                const auto [minor, permanent] = by_permutations(without<W, N>(m, i, j));
                const W exact = ((i + j) % 2 == 0 ? minor : -minor) / whole.determinant;
                const W bound = 8 * epsilon *
                                (permanent / std::abs(whole.determinant) +
                                 std::abs(exact) * whole.permanent / std::abs(whole.determinant));
                ASSERT_LE(std::abs(W((*inverse)[j][i]) - exact), bound)
                    << N << ", trial " << trial << ", certainty " << certainty;
            }
    }
    EXPECT_GT(none, count / 100);
}

TEST(Matrices, InverseIsWithinItsBound) {
    expect_inverse_within_bound<2>(4, trials(1'000'000));
    expect_inverse_within_bound<3>(5, trials(1'000'000));
}

TEST(Matrices, InverseOfFourRowsIsWithinItsBound) {
    expect_inverse_within_bound<4>(6, trials(1'000'000));
}

TEST(Matrices, SmallAndHugeEntriesAreNotSingular) {
    const Real tiny = std::numeric_limits<Real>::min() * Real(16);
    const Real huge = std::numeric_limits<Real>::max() / Real(16);
    for (const Real size : {tiny, Real(1), huge}) {
        const auto inverse = try_inverse(Mat4{size});
        ASSERT_TRUE(inverse.has_value()) << size;
        EXPECT_EQ(*inverse, Mat4{Real(1) / size});
    }
    Mat3 uneven{Real(1)};
    uneven[0][0] = Real(1e-12);
    uneven[2][2] = Real(1e12);
    ASSERT_TRUE(try_inverse(uneven).has_value());
    EXPECT_FALSE(try_inverse(Mat3{Real(0)}).has_value());
    uneven[1][2] = std::numeric_limits<Real>::quiet_NaN();
    EXPECT_FALSE(try_inverse(uneven).has_value());
    // This one's determinant is pure rounding error, in float and in double.
    const Mat3 counted{Vec3{Real(0.1), Real(0.2), Real(0.3)}, Vec3{Real(0.4), Real(0.5), Real(0.6)},
                       Vec3{Real(0.7), Real(0.8), Real(0.9)}};
    EXPECT_FALSE(try_inverse(counted).has_value());
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
