// Elimination by dense fronts: the residual, in double, of what it solves.
#include "engine/dynamics/joints/fronts.h"

#include "engine/core/random.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <set>
#include <vector>

#include <gtest/gtest.h>
#include <hwy/targets.h>

namespace plumb::inline PLUMB_PRECISION {
namespace {

// A sparse symmetric positive definite matrix of 3 x 3 blocks, numbered in a postorder of its
// elimination tree, with the fill-in of its factor.
struct Sparse {
    std::vector<std::uint32_t> start{0};
    std::vector<std::uint32_t> rows;
    std::vector<double> values; // of all, row by row
    std::size_t size() const { return 3 * (start.size() - 1); }
    FactorColumns columns() const { return {start, rows}; }
};

using Rows = std::vector<std::set<std::uint32_t>>; // per column, those below the diagonal

void fill_in(Rows &below) {
    for (std::uint32_t column = 0; column < below.size(); ++column)
        if (!below[column].empty()) {
            const std::uint32_t parent = *below[column].begin();
            for (const std::uint32_t row : below[column])
                if (row != parent)
                    below[parent].insert(row);
        }
}

// Where each column goes in a postorder.
std::vector<std::uint32_t> postorder(const Rows &below) {
    std::vector<std::uint32_t> to(below.size());
    std::uint32_t next = 0;
    const auto visit = [&](auto &&self, std::uint32_t column) -> void {
        for (std::uint32_t child = 0; child < column; ++child)
            if (!below[child].empty() && *below[child].begin() == column)
                self(self, child);
        to[column] = next++;
    };
    for (std::uint32_t column = 0; column < below.size(); ++column)
        if (below[column].empty())
            visit(visit, column);
    return to;
}

Sparse random_sparse(Random &random, std::uint32_t blocks, double share) {
    Rows below(blocks);
    for (std::uint32_t column = 0; column < blocks; ++column)
        for (std::uint32_t row = column + 1; row < blocks; ++row)
            if (random.next_in(0, 1) < share)
                below[column].insert(row);
    const Rows given = below;
    fill_in(below);
    const std::vector<std::uint32_t> to = postorder(below);
    Sparse matrix;
    const std::size_t size = std::size_t{3} * blocks;
    matrix.values.assign(size * size, 0);
    const auto at = [&](std::size_t row, std::size_t column) -> double & {
        return matrix.values[row * size + column];
    };
    Rows moved(blocks);
    for (std::uint32_t column = 0; column < blocks; ++column) {
        for (const std::uint32_t row : below[column])
            moved[std::min(to[column], to[row])].insert(std::max(to[column], to[row]));
        for (const std::uint32_t row : given[column]) {
            for (std::size_t i = 0; i < 3; ++i)
                for (std::size_t j = 0; j < 3; ++j)
                    at(3 * to[row] + i, 3 * to[column] + j) =
                        at(3 * to[column] + j, 3 * to[row] + i) =
                            static_cast<double>(static_cast<float>(random.next_in(-1, 1)));
        }
    }
    for (std::size_t i = 0; i < size; ++i) {
        double sum = 1;
        for (std::size_t j = 0; j < size; ++j)
            sum += std::abs(at(i, j));
        at(i, i) = static_cast<double>(static_cast<float>(sum));
    }
    for (const std::set<std::uint32_t> &column : moved) {
        matrix.rows.insert(matrix.rows.end(), column.begin(), column.end());
        matrix.start.push_back(static_cast<std::uint32_t>(matrix.rows.size()));
    }
    return matrix;
}

std::vector<Sparse> random_matrices(Random &random, int count) {
    std::vector<Sparse> matrices;
    for (int i = 0; i < count; ++i) {
        const std::uint32_t blocks = 1 + random.next_index(60);
        matrices.push_back(random_sparse(random, blocks, random.next_in(0, 6) / blocks));
    }
    return matrices;
}

template <typename Number>
WideMatrix<Number> block_of(const Sparse &matrix, std::size_t row, std::size_t column) {
    typename WideMatrix<Number>::Narrow block;
    for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i)
            block[j][i] = static_cast<Number>(
                matrix.values[(3 * row + static_cast<std::size_t>(i)) * matrix.size() + 3 * column +
                              static_cast<std::size_t>(j)]);
    return WideMatrix<Number>(block);
}

// Solves for random sides by fronts, all matrices in one memory. By how much K x is off them at
// most, and the solutions.
struct Solved {
    double worst = 0;
    std::vector<double> x;
};
template <typename Number> Solved solve(Random random, const std::vector<Sparse> &matrices) {
    Fronts fronts;
    fronts.clear();
    Sparse all; // one after the other, in one numbering
    std::vector<std::uint32_t> firsts;
    for (const Sparse &one : matrices) {
        const auto first = static_cast<std::uint32_t>(all.start.size() - 1);
        firsts.push_back(first);
        for (const std::uint32_t row : one.rows)
            all.rows.push_back(first + row);
        for (std::size_t i = 1; i < one.start.size(); ++i)
            all.start.push_back(all.start[first] + one.start[i]);
        fronts.add(first, static_cast<std::uint32_t>(all.start.size() - 1), all.columns());
    }
    Fronts::Memory<Number> memory;
    fronts.resize(memory);
    // What was there before does not matter.
    std::ranges::fill(memory.panels, Number(7));
    std::ranges::fill(memory.work, Number(7));
    std::vector<WideMatrix<Number>> inverse(all.start.size() - 1);
    for (std::size_t m = 0; m < matrices.size(); ++m) {
        const Sparse &one = matrices[m];
        fronts.begin(firsts[m], memory);
        for (std::uint32_t column = 0; column + 1 < one.start.size(); ++column) {
            fronts.set(firsts[m] + column, 0, block_of<Number>(one, column, column), memory);
            const std::span rows = one.columns().of(column);
            for (std::size_t i = 0; i < rows.size(); ++i)
                fronts.set(firsts[m] + column, i + 1, block_of<Number>(one, rows[i], column),
                           memory);
        }
    }
    for (const std::uint32_t first : firsts)
        fronts.factor<Number>(first, inverse, memory);
    Solved result;
    for (std::size_t m = 0; m < matrices.size(); ++m) {
        const Sparse &one = matrices[m];
        std::vector<WideVector<Number>> solved(one.size() / 3);
        std::vector<double> sides;
        for (WideVector<Number> &solution : solved) {
            typename WideVector<Number>::Narrow side;
            for (int k = 0; k < 3; ++k)
                sides.push_back(
                    static_cast<double>(side[k] = static_cast<Number>(random.next_in(-1, 1))));
            solution = WideVector<Number>(side);
        }
        fronts.solve<Number>(firsts[m], all.columns(), inverse, memory, solved);
        std::vector<double> x;
        for (const WideVector<Number> &solution : solved)
            for (int k = 0; k < 3; ++k)
                x.push_back(static_cast<double>(solution[k]));
        for (std::size_t i = 0; i < x.size(); ++i) {
            double off = -sides[i];
            for (std::size_t j = 0; j < x.size(); ++j)
                off += one.values[i * one.size() + j] * x[j];
            if (!(std::abs(off) <= result.worst))
                result.worst = std::abs(off);
        }
        result.x.insert(result.x.end(), x.begin(), x.end());
    }
    return result;
}

TEST(Fronts, SolveToRounding) {
    Random random(5);
    for (int trial = 0; trial < 60; ++trial) {
        const std::vector<Sparse> matrices = random_matrices(random, 1 + trial % 3);
        EXPECT_LT(solve<float>(random, matrices).worst, 3e-6) << trial;
        EXPECT_LT(solve<double>(random, matrices).worst, 6e-15) << trial;
    }
}

TEST(Fronts, AreTheSameAtEveryWidth) {
    Random random(6);
    const std::vector<Sparse> matrices = random_matrices(random, 20);
    const auto solve_both = [&] {
        std::vector<double> x = solve<float>(Random(1), matrices).x;
        std::ranges::copy(solve<double>(Random(1), matrices).x, std::back_inserter(x));
        return x;
    };
    const std::vector<double> usual = solve_both();
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
        hwy::SetSupportedTargetsForTest(target);
        hwy::GetChosenTarget().Update(hwy::SupportedTargets());
        EXPECT_EQ(solve_both(), usual) << hwy::TargetName(target);
    }
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
