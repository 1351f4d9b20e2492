// Working memory of a method that solves for all velocities together.
#pragma once

#include "engine/math/sparse_cholesky.h"

#include <array>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {

struct ImplicitSystem {
    // Up to six unknowns of a body or particle: changes in velocity along the world axes, then in
    // spin about them; -1 where nothing changes.
    using Unknowns = std::array<int, 6>;
    std::vector<Unknowns> bodies; // per body of the model
    std::vector<Unknowns> particles;
    std::vector<MatrixEntry> entries;
    std::vector<double> sides; // right-hand side per unknown; then the solution
    SparseCholesky matrix;
};

} // namespace plumb::inline PLUMB_PRECISION
