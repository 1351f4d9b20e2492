// Which choices nothing else beats.
#pragma once

#include <span>
#include <vector>

namespace plumb {

struct CostAndError {
    double cost = 0;
    double error = 0;
};

// For each choice, whether it is on the Pareto front: no other one is as good in both and better in
// one. Equal choices are on it together. Choices that are not finite never are.
[[nodiscard]] std::vector<bool> pareto_front(std::span<const CostAndError> choices);

} // namespace plumb
