// Systems of linear equations with a sparse, symmetric, positive definite matrix, in double
// whatever Real is. Eigen's own factors allocate in every factorisation.
#pragma once

#include "engine/core/precision.h"

#include <span>
#include <utility>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {

struct MatrixEntry {
    int row = 0;
    int column = 0; // not above row: the matrix is symmetric
    double value = 0;
};

// L D L^T after a permutation of least degree. Where the entries' rows and columns are those of
// last time, only values are computed, and nothing is allocated.
class SparseCholesky {
  public:
    // The matrix is the sum of all entries; each unknown has one on the diagonal. Not checked to be
    // positive definite: where it is singular, solutions are not finite.
    void factor(int unknowns, std::span<const MatrixEntry> entries);
    // Replaces the right-hand side, one number for each unknown, by the solution.
    void solve(std::span<double> side);

  private:
    void arrange(int unknowns, std::span<const MatrixEntry> entries);
    void find_values();

    std::vector<std::pair<int, int>> pattern_; // row and column of each entry
    std::vector<int> entry_places_;            // of each entry, in the matrix
    std::vector<int> order_;                   // of each unknown: its place in the permutation
    // The permuted matrix, column by column: rows up to the diagonal.
    std::vector<int> starts_;
    std::vector<int> rows_;
    std::vector<double> values_;
    // L without its diagonal of ones, column by column, and D.
    std::vector<int> parents_; // of each column, the first row in it, or -1
    std::vector<int> factor_starts_;
    std::vector<int> factor_rows_;
    std::vector<double> factor_values_;
    std::vector<double> diagonal_;
    // While values are found: the rows of each column so far, and the row that is being found.
    std::vector<int> factor_ends_;
    std::vector<double> row_;
    std::vector<int> path_;
    std::vector<int> visitors_;    // of each column: the row that came to it last
    std::vector<double> permuted_; // the right-hand side
};

} // namespace plumb::inline PLUMB_PRECISION
