// States to step back to.
#pragma once

#include "engine/scene/simulation.h"

#include <cstddef>
#include <deque>
#include <memory>

namespace plumb {

// The states before the last steps; the oldest is dropped first. Data that does not change between
// consecutive states is stored once: a world at rest takes next to nothing.
class History {
  public:
    // Limits on the memory of one history (exceeded only by a single state) and on the number of
    // states.
    static constexpr std::size_t memory_limit = 256u << 20; // bytes
    static constexpr std::size_t most_states = 3600;        // a minute at 60 steps a second

    void clear();
    [[nodiscard]] std::size_t size() const { return states_.size(); }
    [[nodiscard]] std::size_t bytes() const { return bytes_; }
    void remember(const Simulation &simulation);
    // Restores the last remembered state. Returns false and does nothing if there is none.
    bool recall(Simulation &simulation);

  private:
    std::unique_ptr<Simulation::Saved> forget_oldest();

    std::deque<std::unique_ptr<Simulation::Saved>> states_; // newest last
    std::size_t bytes_ = 0;                                 // in total
};

} // namespace plumb
