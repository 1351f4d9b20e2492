// Pareto front of cost and error.
#pragma once

#include <span>
#include <vector>

namespace plumb {

struct CostAndError {
    double cost = 0;
    double error = 0;
};

// For each choice, whether it is on the Pareto front: no other is at least as good in both and
// better in one. Equal choices are on it together; non-finite ones never are.
[[nodiscard]] std::vector<bool> pareto_front(std::span<const CostAndError> choices);

} // namespace plumb
