#include "app/lab/chart/pareto.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace plumb {

std::vector<bool> pareto_front(std::span<const CostAndError> choices) {
    std::vector<std::size_t> order(choices.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::erase_if(order, [&](std::size_t i) {
        return !std::isfinite(choices[i].cost) || !std::isfinite(choices[i].error);
    });
    // By ascending cost, ties by error: a choice is on the front if it is more accurate than all
    // before it, or equal to the last on the front.
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        if (choices[a].cost != choices[b].cost)
            return choices[a].cost < choices[b].cost;
        if (choices[a].error != choices[b].error)
            return choices[a].error < choices[b].error;
        return a < b;
    });
    std::vector<bool> front(choices.size(), false);
    CostAndError last{-1, std::numeric_limits<double>::infinity()};
    for (const std::size_t i : order) {
        const bool same = choices[i].cost == last.cost && choices[i].error == last.error;
        if (choices[i].error < last.error || same) {
            front[i] = true;
            last = choices[i];
        }
    }
    return front;
}

} // namespace plumb
