#include "engine/math/sparse_cholesky.h"

#include "engine/core/random.h"

#include <cmath>
#include <cstddef>

#include <gtest/gtest.h>

namespace plumb::inline PLUMB_PRECISION {
namespace {

// The largest component of the residual b - A x.
double residual(const std::vector<MatrixEntry> &entries, const std::vector<double> &x,
                std::vector<double> side) {
    for (const auto &[row, column, value] : entries) {
        side[std::size_t(row)] -= value * x[std::size_t(column)];
        if (row != column)
            side[std::size_t(column)] -= value * x[std::size_t(row)];
    }
    double worst = 0;
    for (const double each : side)
        worst = std::max(worst, std::abs(each));
    return worst;
}

// Unit masses on springs between grid neighbours, and between a few random pairs.
std::vector<MatrixEntry> net(Random &random, int n) {
    std::vector<MatrixEntry> entries;
    const auto join = [&](int a, int b) {
        const double k = 100 * random.next_unit();
        entries.push_back({a, a, k});
        entries.push_back({std::max(a, b), std::min(a, b), -k});
        entries.push_back({b, b, k});
    };
    for (int i = 0; i < n * n; ++i) {
        entries.push_back({i, i, 1});
        if (i % n > 0)
            join(i - 1, i);
        if (i >= n)
            join(i, i - n);
        if (i > 0 && random.next_unit() < 0.1)
            join(i, int(random.next_unit() * i));
    }
    return entries;
}

TEST(SparseCholesky, SolvesNets) {
    Random random(1);
    SparseCholesky matrix;
    for (const int n : {1, 2, 5, 12, 3, 3}) {
        std::vector<MatrixEntry> entries = net(random, n);
        for (int again = 0; again < 2; ++again) {
            matrix.factor(n * n, entries);
            std::vector<double> side(std::size_t(n * n));
            for (double &each : side)
                each = random.next_unit() - 0.5;
            std::vector<double> x = side;
            matrix.solve(x);
            EXPECT_LT(residual(entries, x, side), 1e-12) << n;
            for (MatrixEntry &entry : entries)
                entry.value *= 2;
        }
    }
}

// Matrices factored earlier do not affect a solution.
TEST(SparseCholesky, ForgetsOtherMatrices) {
    Random random(2);
    const std::vector<MatrixEntry> entries = net(random, 6);
    SparseCholesky used;
    used.factor(49, net(random, 7));
    used.factor(36, net(random, 6));
    std::vector<double> x(36, 1), y(36, 1);
    used.factor(36, entries);
    used.solve(x);
    SparseCholesky anew;
    anew.factor(36, entries);
    anew.solve(y);
    EXPECT_EQ(x, y);
}

TEST(SparseCholesky, SolvesUnknownsThatShareNothing) {
    SparseCholesky matrix;
    const std::vector<MatrixEntry> entries{{2, 2, 4}, {0, 0, 1}, {1, 1, 2}, {1, 1, 0.5}};
    matrix.factor(3, entries);
    std::vector<double> x{1, 5, 8};
    matrix.solve(x);
    EXPECT_EQ(x, (std::vector<double>{1, 2, 2}));
    matrix.factor(0, {});
    std::vector<double> nothing;
    matrix.solve(nothing);
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
