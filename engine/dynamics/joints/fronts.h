// Elimination of joints with many loops, as in nets and frames, by dense fronts. Duff and Reid
// 1983, "The Multifrontal Solution of Indefinite Sparse Symmetric Linear Equations"; Liu 1992, "The
// Multifrontal Method for Sparse Matrix Solution: Theory and Practice". Eigen's factors are of
// single numbers, one at a time; CHOLMOD's come of a BLAS, whose bits depend on the machine.
#pragma once

#include "engine/dynamics/joints/wide_matrix.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {

// The columns of a sparse factor: in each the rows below the diagonal, ascending, with fill-in.
// Blocks of 3 x 3 numbers are numbered in the order of elimination.
struct FactorColumns {
    std::span<const std::uint32_t> start; // one more than blocks
    std::span<const std::uint32_t> rows;
    std::span<const std::uint32_t> of(std::uint32_t block) const {
        return rows.subspan(start[block], start[block + 1] - start[block]);
    }
};

inline constexpr std::size_t front_lanes = 8;

// Dense columns of numbers.
template <typename Number> struct FrontColumns {
    Number *values;
    std::size_t size;   // numbers in a column
    std::size_t stride; // from one column to the next, a multiple of `front_lanes`
    Number *at(std::size_t row, std::size_t column) const { return values + column * stride + row; }
};

// A symmetric matrix of which the lower triangle counts; what lies above is undefined.
template <typename Number> struct FrontMatrix {
    std::size_t own;            // columns to be eliminated
    FrontColumns<Number> panel; // those, in full
    FrontColumns<Number> rest;  // the other columns, without the rows of the first
};

// Rows of a front's rest that are next to each other in the parent, too (blocks).
struct FrontRun {
    std::uint32_t from = 0;
    std::uint32_t to = 0;
    std::uint32_t count = 0;
};

// Neighbouring columns with the same rows are eliminated as one front: a dense matrix of these
// columns and rows. What remains of it is added to the front of the first of those rows. So nearly
// all of the work is done in dense columns, several numbers at a time.
class Fronts {
  public:
    template <typename Number> struct Memory {
        std::vector<Number> panels;
        std::vector<Number> work;
    };

    void clear();
    // Adds the blocks first..last - 1, which depend on no others, in a postorder of their
    // elimination tree (children before their parent, one that shares its rows next to it).
    void add(std::uint32_t first, std::uint32_t last, const FactorColumns &columns);
    template <typename Number> void resize(Memory<Number> &memory) const {
        memory.panels.resize(panel_space_);
        memory.work.resize(work_space_);
    }

    // What follows works on the blocks that were added with `first`, and on memory of their own, so
    // different ones may be factored and solved at the same time.

    // Begins a new matrix: of zeros, until they are replaced.
    template <typename Number> void begin(std::uint32_t first, Memory<Number> &memory) const;
    // Sets a block of it: on the diagonal (entry 0), or the nth below, counting from 1.
    template <typename Number>
    void set(std::uint32_t block, std::size_t entry, const WideMatrix<Number> &value,
             Memory<Number> &memory) const;
    // Factors the matrix as L D L^T. Writes D^-1.
    template <typename Number>
    void factor(std::uint32_t first, std::span<WideMatrix<Number>> inverse_diagonal,
                Memory<Number> &memory) const;
    // Solves in place for right-hand sides, one a block, the first for `first`.
    template <typename Number>
    void solve(std::uint32_t first, const FactorColumns &columns,
               std::span<const WideMatrix<Number>> inverse_diagonal, Memory<Number> &memory,
               std::span<WideVector<Number>> sides) const;

  private:
    struct Front {
        std::uint32_t first = 0;    // of its own blocks
        std::uint32_t count = 0;    // of its own blocks
        std::uint32_t rows = 0;     // blocks that remain
        std::uint32_t children = 0; // first of them in children_
        std::uint32_t runs = 0;     // first of them in runs_
        std::size_t panel = 0;      // in panels
        std::size_t rest = 0;       // in work, until its parent takes it
    };
    // Fronts first..last - 1 of blocks that were added together.
    struct Mesh {
        std::uint32_t block = 0;
        std::uint32_t first = 0;
        std::uint32_t last = 0;
        std::size_t pivots = 0; // in work: three columns
    };
    const Mesh &mesh_of(std::uint32_t first) const;
    void find_fronts(std::uint32_t first, std::uint32_t last, const FactorColumns &columns);
    void find_tree(std::uint32_t first_front, const FactorColumns &columns);
    void find_runs(const FactorColumns &columns, const Front &front, const Front &parent);
    std::span<const FrontRun> runs_of(std::uint32_t front) const;
    template <typename Number>
    FrontColumns<Number> panel_of(const Front &front, Memory<Number> &memory) const;
    template <typename Number>
    FrontColumns<Number> rest_of(const Front &front, Memory<Number> &memory) const;

    std::vector<Mesh> meshes_;
    std::vector<Front> fronts_;           // and one that ends the last's children, runs and panel
    std::vector<std::uint32_t> front_of_; // per block
    std::vector<std::uint32_t> children_;
    std::vector<FrontRun> runs_;
    std::size_t panel_space_ = 0;
    std::size_t work_space_ = 0;
};

namespace kernels {

// Eliminates a block of a front: `inverse` is that of its own 3 x 3 matrix. Its columns become
// those of L, 0 on and above the diagonal; `pivots` keeps three columns meanwhile.
void eliminate(const FrontMatrix<float> &front, std::size_t block, const float *inverse,
               float *pivots);
void eliminate(const FrontMatrix<double> &front, std::size_t block, const double *inverse,
               double *pivots);
// Adds what remains of a front to its parent.
void add(const FrontColumns<float> &rest, std::span<const FrontRun> runs,
         const FrontMatrix<float> &parent);
void add(const FrontColumns<double> &rest, std::span<const FrontRun> runs,
         const FrontMatrix<double> &parent);
// Solves L x = b in place for a front's `own` columns, and takes L x from the rows below.
void substitute(const FrontColumns<float> &panel, std::size_t own, float *sides);
void substitute(const FrontColumns<double> &panel, std::size_t own, double *sides);
// Solves L^T x = b in place for a front's `own` columns, where the rows below are known.
void substitute_back(const FrontColumns<float> &panel, std::size_t own, float *sides);
void substitute_back(const FrontColumns<double> &panel, std::size_t own, double *sides);

} // namespace kernels

} // namespace plumb::inline PLUMB_PRECISION
