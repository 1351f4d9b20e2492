#include "app/sandbox/session/history.h"

#include <utility>

namespace plumb {

void History::clear() {
    states_.clear();
    bytes_ = 0;
}

// Data shared with the next state stays.
std::unique_ptr<Simulation::Saved> History::forget_oldest() {
    std::unique_ptr<Simulation::Saved> oldest = std::move(states_.front());
    states_.pop_front();
    bytes_ -= oldest->bytes_beside(states_.empty() ? nullptr : states_.front().get());
    return oldest;
}

void History::remember(const Simulation &simulation) {
    // Reuse the oldest state's memory.
    std::unique_ptr<Simulation::Saved> oldest;
    if (states_.size() == most_states || bytes_ >= memory_limit)
        oldest = forget_oldest();
    const Simulation::Saved *before = states_.empty() ? nullptr : states_.back().get();
    states_.push_back(simulation.save(std::move(oldest), before));
    bytes_ += states_.back()->bytes_beside(before);
    while (bytes_ > memory_limit && states_.size() > 1)
        forget_oldest();
}

bool History::recall(Simulation &simulation) {
    if (states_.empty())
        return false;
    const std::unique_ptr<Simulation::Saved> newest = std::move(states_.back());
    states_.pop_back();
    bytes_ -= newest->bytes_beside(states_.empty() ? nullptr : states_.back().get());
    simulation.restore(*newest);
    return true;
}

} // namespace plumb
