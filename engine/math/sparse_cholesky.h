// Sparse symmetric positive definite linear systems, in double whatever Real is. Eigen's own
// factorisations allocate every time.
#pragma once

#include "engine/core/precision.h"

#include <span>
#include <utility>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {

struct MatrixEntry {
    int row = 0;
    int column = 0; // <= row: the matrix is symmetric
    double value = 0;
};

// L D L^T after a minimum degree permutation. If the entries' rows and columns are the same as last
// time, only values are computed and nothing is allocated.
class SparseCholesky {
  public:
    // The matrix is the sum of all entries; each unknown needs one on the diagonal. Positive
    // definiteness is not checked: a singular matrix gives non-finite solutions.
    void factor(int unknowns, std::span<const MatrixEntry> entries);
    // Replaces the right-hand side, one number per unknown, with the solution.
    void solve(std::span<double> side);

  private:
    void arrange(int unknowns, std::span<const MatrixEntry> entries);
    void find_values();

    std::vector<std::pair<int, int>> pattern_; // row and column of each entry
    std::vector<int> entry_places_;            // each entry's place in the matrix
    std::vector<int> order_;                   // each unknown's place in the permutation
    // The permuted matrix, column by column: rows up to the diagonal.
    std::vector<int> starts_;
    std::vector<int> rows_;
    std::vector<double> values_;
    // L without its diagonal of ones, column by column, and D.
    std::vector<int> parents_; // each column's first row, or -1: the elimination tree
    std::vector<int> factor_starts_;
    std::vector<int> factor_rows_;
    std::vector<double> factor_values_;
    std::vector<double> diagonal_;
    // Scratch while computing values: each column's end so far, and the current row.
    std::vector<int> factor_ends_;
    std::vector<double> row_;
    std::vector<int> path_;
    std::vector<int> visitors_;    // the last row to visit each column
    std::vector<double> permuted_; // the right-hand side
};

} // namespace plumb::inline PLUMB_PRECISION
