#include "app/sandbox/history.h"

#include <algorithm>

namespace plumb {

std::size_t History::capacity(std::size_t bodies, std::size_t contacts) {
    const std::size_t state =
        std::max(bytes_per_body * std::max<std::size_t>(bodies, 1), bytes_per_contact * contacts);
    const std::size_t fits = memory_limit / state;
    return std::clamp<std::size_t>(fits, 1, most_states);
}

void History::remember(const Simulation &simulation) {
    // The oldest one's memory is used again.
    std::unique_ptr<Simulation::Saved> oldest;
    while (states_.size() >= capacity(simulation.body_count(), simulation.report().contacts)) {
        oldest = std::move(states_.front());
        states_.pop_front();
    }
    states_.push_back(simulation.save(std::move(oldest)));
}

bool History::recall(Simulation &simulation) {
    if (states_.empty())
        return false;
    simulation.restore(*states_.back());
    states_.pop_back();
    return true;
}

} // namespace plumb
