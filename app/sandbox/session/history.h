// The states to step back to.
#pragma once

#include "engine/scene/simulation.h"

#include <cstddef>
#include <deque>
#include <memory>

namespace plumb {

// The states before the last steps, the oldest forgotten first. Of what does not change from one to
// the next there is one copy: a world at rest takes next to nothing.
class History {
  public:
    // The most memory that one history takes, if it holds more than one state, and the most steps
    // that it remembers.
    static constexpr std::size_t memory_limit = 256u << 20; // bytes
    static constexpr std::size_t most_states = 3600;        // a minute at 60 steps a second

    void clear();
    [[nodiscard]] std::size_t size() const { return states_.size(); }
    [[nodiscard]] std::size_t bytes() const { return bytes_; }
    void remember(const Simulation &simulation);
    // Takes the simulation one remembered state back. False, and nothing happens, if there is none.
    bool recall(Simulation &simulation);

  private:
    std::unique_ptr<Simulation::Saved> forget_oldest();

    std::deque<std::unique_ptr<Simulation::Saved>> states_; // the newest last
    std::size_t bytes_ = 0;                                 // of them all
};

} // namespace plumb
