// After Davis 2005, "Algorithm 849: A Concise Sparse Cholesky Factorization Package"; the
// permutation is Eigen's.
#include "engine/math/sparse_cholesky.h"

#include <algorithm>
#include <cstddef>

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>

namespace plumb::inline PLUMB_PRECISION {

namespace {

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

} // namespace

void SparseCholesky::factor(int unknowns, std::span<const MatrixEntry> entries) {
    const auto same = [](const MatrixEntry &entry, const std::pair<int, int> &place) {
        return entry.row == place.first && entry.column == place.second;
    };
    if (order_.size() != at(unknowns) || !std::ranges::equal(entries, pattern_, same))
        arrange(unknowns, entries);
    std::ranges::fill(values_, 0.0);
    for (std::size_t i = 0; i < entries.size(); ++i)
        values_[at(entry_places_[i])] += entries[i].value;
    find_values();
}

// The symbolic phase. Eigen permutes a matrix whose values are their own places.
void SparseCholesky::arrange(int unknowns, std::span<const MatrixEntry> entries) {
    using Matrix = Eigen::SparseMatrix<double>;
    std::vector<Eigen::Triplet<double>> ones;
    for (const MatrixEntry &entry : entries)
        ones.emplace_back(entry.row, entry.column, 1.0);
    Matrix lower(unknowns, unknowns);
    lower.setFromTriplets(ones.begin(), ones.end());
    for (int place = 0; place < lower.nonZeros(); ++place)
        lower.valuePtr()[place] = place;
    const Matrix whole = lower.selfadjointView<Eigen::Lower>();
    Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> inverse;
    Eigen::AMDOrdering<int>()(whole, inverse);
    const Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order = inverse.inverse();
    Matrix permuted(unknowns, unknowns);
    permuted.selfadjointView<Eigen::Upper>() =
        lower.selfadjointView<Eigen::Lower>().twistedBy(order);

    order_.assign(order.indices().begin(), order.indices().end());
    starts_.assign(permuted.outerIndexPtr(), permuted.outerIndexPtr() + unknowns + 1);
    rows_.assign(permuted.innerIndexPtr(), permuted.innerIndexPtr() + permuted.nonZeros());
    values_.resize(rows_.size());
    std::vector<int> moved(rows_.size()); // where each value of `lower` ended up
    for (int place = 0; place < permuted.nonZeros(); ++place)
        moved[at(static_cast<int>(permuted.valuePtr()[place]))] = place;
    entry_places_.clear();
    for (const MatrixEntry &entry : entries) {
        const int *rows = lower.innerIndexPtr();
        const int *column = rows + lower.outerIndexPtr()[entry.column];
        const int *end = rows + lower.outerIndexPtr()[entry.column + 1];
        entry_places_.push_back(
            moved[static_cast<std::size_t>(std::lower_bound(column, end, entry.row) - rows)]);
    }

    // The rows of L: each follows the paths from its entries up the elimination tree.
    const std::size_t n = order_.size();
    parents_.assign(n, -1);
    visitors_.assign(n, -1);
    std::vector<int> counts(n, 0);
    for (int k = 0; k < unknowns; ++k) {
        visitors_[at(k)] = k;
        for (int p = starts_[at(k)]; p < starts_[at(k) + 1]; ++p)
            for (int i = rows_[at(p)]; visitors_[at(i)] != k; i = parents_[at(i)]) {
                if (parents_[at(i)] == -1)
                    parents_[at(i)] = k;
                ++counts[at(i)];
                visitors_[at(i)] = k;
            }
    }
    factor_starts_.assign(n + 1, 0);
    for (std::size_t i = 0; i < n; ++i)
        factor_starts_[i + 1] = factor_starts_[i] + counts[i];
    factor_rows_.resize(at(factor_starts_[n]));
    factor_values_.resize(at(factor_starts_[n]));
    diagonal_.resize(n);
    factor_ends_.resize(n);
    row_.resize(n);
    path_.resize(n);
    permuted_.resize(n);
    pattern_.clear();
    for (const MatrixEntry &entry : entries)
        pattern_.emplace_back(entry.row, entry.column);
}

void SparseCholesky::find_values() {
    const int n = static_cast<int>(order_.size());
    std::ranges::fill(row_, 0.0);
    std::ranges::fill(visitors_, -1);
    std::copy_n(factor_starts_.begin(), n, factor_ends_.begin());
    for (int k = 0; k < n; ++k) {
        // The columns with an entry in row k, each after the columns it depends on.
        int top = n;
        visitors_[at(k)] = k;
        for (int p = starts_[at(k)]; p < starts_[at(k) + 1]; ++p) {
            int i = rows_[at(p)];
            row_[at(i)] = values_[at(p)];
            int length = 0;
            for (; visitors_[at(i)] != k; i = parents_[at(i)]) {
                path_[at(length++)] = i;
                visitors_[at(i)] = k;
            }
            while (length > 0)
                path_[at(--top)] = path_[at(--length)];
        }
        // The row itself, by a triangular solve.
        double pivot = row_[at(k)];
        row_[at(k)] = 0;
        for (; top < n; ++top) {
            const int i = path_[at(top)];
            const double entry = row_[at(i)];
            row_[at(i)] = 0;
            const int end = factor_ends_[at(i)]++;
            for (int p = factor_starts_[at(i)]; p < end; ++p)
                row_[at(factor_rows_[at(p)])] -= factor_values_[at(p)] * entry;
            const double factor = entry / diagonal_[at(i)];
            pivot -= factor * entry;
            factor_rows_[at(end)] = k;
            factor_values_[at(end)] = factor;
        }
        diagonal_[at(k)] = pivot;
    }
}

void SparseCholesky::solve(std::span<double> side) {
    const int n = static_cast<int>(order_.size());
    std::vector<double> &x = permuted_;
    for (std::size_t i = 0; i < order_.size(); ++i)
        x[at(order_[i])] = side[i];
    for (int i = 0; i < n; ++i)
        for (int p = factor_starts_[at(i)]; p < factor_starts_[at(i) + 1]; ++p)
            x[at(factor_rows_[at(p)])] -= factor_values_[at(p)] * x[at(i)];
    for (std::size_t i = 0; i < order_.size(); ++i)
        x[i] *= 1 / diagonal_[i];
    for (int i = n - 1; i >= 0; --i)
        for (int p = factor_starts_[at(i)]; p < factor_starts_[at(i) + 1]; ++p)
            x[at(i)] -= factor_values_[at(p)] * x[at(factor_rows_[at(p)])];
    for (std::size_t i = 0; i < order_.size(); ++i)
        side[i] = x[at(order_[i])];
}

} // namespace plumb::inline PLUMB_PRECISION
