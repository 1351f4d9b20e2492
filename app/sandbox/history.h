// The states to step back to.
#pragma once

#include "engine/scene/simulation.h"

#include <cstddef>
#include <deque>
#include <memory>

namespace plumb {

// The states before the last steps, the oldest forgotten first.
class History {
  public:
    // About what one history may take, and the most steps that it remembers.
    static constexpr std::size_t memory_limit = 256u << 20; // bytes
    static constexpr std::size_t most_states = 3600;        // a minute at 60 steps a second
    // What the state of one resting body takes, its contacts and joints among it.
    static constexpr std::size_t bytes_per_body = 300;
    // Of one contact, for heaps where these outnumber the bodies by far.
    static constexpr std::size_t bytes_per_contact = 160;

    // How many states of a world of this many bodies and contacts are kept; at least one.
    [[nodiscard]] static std::size_t capacity(std::size_t bodies, std::size_t contacts = 0);

    void clear() { states_.clear(); }
    [[nodiscard]] std::size_t size() const { return states_.size(); }
    void remember(const Simulation &simulation);
    // Takes the simulation one remembered state back. False, and nothing happens, if there is none.
    bool recall(Simulation &simulation);

  private:
    std::deque<std::unique_ptr<Simulation::Saved>> states_; // the newest last
};

} // namespace plumb
