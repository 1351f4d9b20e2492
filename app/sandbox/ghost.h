// A second simulation of the running scene by another method, stepped beside the first.
#pragma once

#include "app/sandbox/history.h"
#include "engine/scene/simulation.h"

#include <cstdint>
#include <memory>
#include <string>

namespace plumb {

struct GhostDistance {
    double metres = 0;
    std::string name; // of the body or particle that is farthest from its ghost
};

class Ghost {
  public:
    // Begins where `beside` is now, on one thread. Throws as Simulation::create does.
    Ghost(const Simulation &beside, const std::string &method);

    // Before `beside` steps: what going back comes to.
    void begin_step();
    // After it: catches up with its time. A failure ends the ghost's motion, and is told.
    void catch_up(const Simulation &beside);
    // `beside` has gone back a step. False when the ghost did not exist then.
    bool go_back();
    // What is done to the one is done to the other, but for method and settings; the world's
    // settings, gravity, are the same. What it cannot obey ends its motion, and is told.
    void apply(const Command &command);

    [[nodiscard]] const Simulation &simulation() const { return *simulation_; }
    [[nodiscard]] const Frame &previous() const { return previous_; }
    [[nodiscard]] const Frame &present() const { return present_; }
    [[nodiscard]] const std::string &failure() const { return failure_; } // empty: none
    // Of all that both have, by their names.
    [[nodiscard]] GhostDistance farthest(const Simulation &beside, const Frame &frame) const;

  private:
    void fail(const std::string &why);

    std::unique_ptr<Simulation> simulation_;
    History history_; // one state for each step of the other
    Frame previous_, present_;
    std::string failure_;
    std::int64_t steps_ = 0;       // of the other, since the ghost began
    std::int64_t failed_from_ = 0; // the state after so many
};

} // namespace plumb
