// Memory of a method that solves for all velocities at once.
#pragma once

#include "engine/math/sparse_cholesky.h"

#include <array>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {

struct ImplicitSystem {
    // Up to six unknowns of a body or particle: changes of velocity along the world's axes, then of
    // spin about them; -1 where nothing changes.
    using Unknowns = std::array<int, 6>;
    std::vector<Unknowns> bodies; // of the model
    std::vector<Unknowns> particles;
    std::vector<MatrixEntry> entries;
    std::vector<double> sides; // of each unknown; then the solution
    SparseCholesky matrix;
};

} // namespace plumb::inline PLUMB_PRECISION
