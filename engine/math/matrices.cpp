#include "engine/math/matrices.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/matrix.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// a b - c d, and the same with both products positive, which measures the possible rounding error.
struct Determinant {
    Real value = Real(0);
    Real permanent = Real(0);
};

Determinant determinant2(Real a, Real b, Real c, Real d) {
    const Real ab = a * b, cd = c * d;
    return {ab - cd, std::abs(ab) + std::abs(cd)};
}

template <int N> using MatN = glm::mat<N, N, Real, glm::defaultp>;

// The determinant of m without column `skip_column` and row `skip_row`.
Determinant minor_of(const Mat3 &m, int skip_column, int skip_row) {
    const int j0 = skip_column == 0 ? 1 : 0, j1 = skip_column == 2 ? 1 : 2;
    const int i0 = skip_row == 0 ? 1 : 0, i1 = skip_row == 2 ? 1 : 2;
    return determinant2(m[j0][i0], m[j1][i1], m[j1][i0], m[j0][i1]);
}

Determinant minor_of(const Mat4 &m, int skip_column, int skip_row) {
    std::array<int, 3> j{}, i{};
    for (int k = 0; k < 3; ++k) {
        j[static_cast<std::size_t>(k)] = k < skip_column ? k : k + 1;
        i[static_cast<std::size_t>(k)] = k < skip_row ? k : k + 1;
    }
    Determinant sum;
    for (std::size_t k = 0; k < 3; ++k) {
        const int a = j[(k + 1) % 3], b = j[(k + 2) % 3];
        const Determinant rest = determinant2(m[a][i[1]], m[b][i[2]], m[b][i[1]], m[a][i[2]]);
        const Real first = m[j[k]][i[0]];
        sum.value += first * rest.value;
        sum.permanent += std::abs(first) * rest.permanent;
    }
    return sum;
}

Determinant minor_of(const Mat2 &m, int skip_column, int skip_row) {
    const Real left = m[1 - skip_column][1 - skip_row];
    return {left, std::abs(left)};
}

template <int N> MatN<N> all_minors(const MatN<N> &m) {
    MatN<N> result;
    for (int j = 0; j < N; ++j)
        for (int i = 0; i < N; ++i)
            result[j][i] = minor_of(m, j, i).value;
    return result;
}

template <int N> MatN<N> with_signs(MatN<N> m) {
    for (int j = 0; j < N; ++j)
        for (int i = 0; i < N; ++i)
            if ((i + j) % 2 == 1)
                m[j][i] = -m[j][i];
    return m;
}

template <int N> std::optional<MatN<N>> inverse_by_adjugate(MatN<N> m) {
    Real largest = Real(0);
    for (int j = 0; j < N; ++j)
        for (int i = 0; i < N; ++i) {
            if (!std::isfinite(m[j][i]))
                return std::nullopt;
            largest = std::max(largest, std::abs(m[j][i]));
        }
    if (largest == Real(0))
        return std::nullopt;
    // Scale by a power of two, which is exact, so that products of N entries do not overflow.
    const int exponent = std::ilogb(largest);
    for (int j = 0; j < N; ++j)
        for (int i = 0; i < N; ++i)
            m[j][i] = std::scalbn(m[j][i], -exponent);

    MatN<N> adjugated;
    Determinant determinant;
    for (int j = 0; j < N; ++j)
        for (int i = 0; i < N; ++i) {
            const Determinant minor = minor_of(m, j, i);
            const Real sign = (i + j) % 2 == 1 ? Real(-1) : Real(1);
            adjugated[i][j] = sign * minor.value;
            if (j == 0) { // expand along the first column
                determinant.value += sign * m[0][i] * minor.value;
                determinant.permanent += std::abs(m[0][i]) * minor.permanent;
            }
        }
    constexpr Real open = Real(16) * std::numeric_limits<Real>::epsilon();
    if (!(std::abs(determinant.value) > open * determinant.permanent))
        return std::nullopt;
    for (int j = 0; j < N; ++j)
        for (int i = 0; i < N; ++i)
            adjugated[j][i] = std::scalbn(adjugated[j][i] / determinant.value, -exponent);
    return adjugated;
}

} // namespace

Mat2 minors(const Mat2 &m) {
    return all_minors<2>(m);
}
Mat3 minors(const Mat3 &m) {
    return all_minors<3>(m);
}
Mat4 minors(const Mat4 &m) {
    return all_minors<4>(m);
}

Mat2 cofactors(const Mat2 &m) {
    return with_signs<2>(minors(m));
}
Mat3 cofactors(const Mat3 &m) {
    return with_signs<3>(minors(m));
}
Mat4 cofactors(const Mat4 &m) {
    return with_signs<4>(minors(m));
}

Mat2 adjugate(const Mat2 &m) {
    return glm::transpose(cofactors(m));
}
Mat3 adjugate(const Mat3 &m) {
    return glm::transpose(cofactors(m));
}
Mat4 adjugate(const Mat4 &m) {
    return glm::transpose(cofactors(m));
}

std::optional<Mat2> try_inverse(const Mat2 &m) {
    return inverse_by_adjugate<2>(m);
}
std::optional<Mat3> try_inverse(const Mat3 &m) {
    return inverse_by_adjugate<3>(m);
}
std::optional<Mat4> try_inverse(const Mat4 &m) {
    return inverse_by_adjugate<4>(m);
}

} // namespace plumb::inline PLUMB_PRECISION
