// A second simulation of the running scene by another method, stepped beside the first.
#pragma once

#include "app/sandbox/session/history.h"
#include "engine/scene/simulation.h"

#include <cstdint>
#include <memory>
#include <string>

namespace plumb {

struct GhostDistance {
    double metres = 0;
    std::string name; // of the body or particle that is farthest from its ghost
};

// In the place of a method: the accurate run (app/lab/run/accurate_run.h), in double, with a
// quarter of the dt and 16 substeps.
inline constexpr const char *reference_ghost = "reference";

class Ghost {
  public:
    // Begins where `beside` is now, on one thread. Throws as Simulation::create does.
    Ghost(const Simulation &beside, const std::string &method);
    [[nodiscard]] bool is_reference() const { return is_reference_; }

    // Before `beside` steps: what going back comes to.
    void begin_step();
    // After it: catches up with its time. A failure ends the ghost's motion, and is told. The
    // reference takes no more than its allowance of time, and then lags; while `beside` stands
    // still more calls bring it even.
    void catch_up(const Simulation &beside);
    void go_on(const Simulation &beside);
    [[nodiscard]] double lag(const Simulation &beside) const; // s; 0: even
    void allow(double seconds) { allowance_ = seconds; }      // for each call
    // `beside` has gone back a step. False when the ghost did not exist then.
    bool go_back();
    // What has been done to `beside` is done to the ghost, but for method and settings; of the
    // world's, gravity is the same, and so is dt, of which the reference keeps its share. What it
    // cannot obey ends its motion, and is told; so does anything that is done while it lags.
    void apply(const Simulation &beside, const Command &command);

    [[nodiscard]] const Simulation &simulation() const { return *simulation_; }
    [[nodiscard]] const Frame &previous() const { return previous_; }
    [[nodiscard]] const Frame &present() const { return present_; }
    [[nodiscard]] const std::string &failure() const { return failure_; } // empty: none
    // Of all that both have, by their names; of no meaning while it lags.
    [[nodiscard]] GhostDistance farthest(const Simulation &beside, const Frame &frame) const;

  private:
    void fail(const std::string &why);
    void step_towards(const Simulation &beside);

    bool is_reference_ = false;
    double allowance_ = 0; // s; 0 of what is no reference: all that it needs
    std::unique_ptr<Simulation> simulation_;
    History history_; // one state for each step of the other
    Frame previous_, present_;
    std::string failure_;
    std::int64_t steps_ = 0;       // of the other, since the ghost began
    std::int64_t failed_from_ = 0; // the state after so many
};

} // namespace plumb
