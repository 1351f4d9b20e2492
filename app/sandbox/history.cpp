#include "app/sandbox/history.h"

#include <algorithm>

namespace plumb {

std::size_t History::capacity(std::size_t bodies) {
    const std::size_t fits = memory_limit / (bytes_per_body * std::max<std::size_t>(bodies, 1));
    return std::clamp<std::size_t>(fits, 1, most_states);
}

void History::remember(const Simulation &simulation) {
    states_.push_back(simulation.save());
    while (states_.size() > capacity(simulation.body_count()))
        states_.pop_front();
}

bool History::recall(Simulation &simulation) {
    if (states_.empty())
        return false;
    simulation.restore(*states_.back());
    states_.pop_back();
    return true;
}

} // namespace plumb
