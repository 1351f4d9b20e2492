// A second simulation of the running scene with another method, stepped beside the first.
#pragma once

#include "app/sandbox/session/history.h"
#include "engine/scene/simulation.h"

#include <cstdint>
#include <memory>
#include <string>

namespace plumb {

struct GhostDistance {
    double metres = 0;
    std::string name; // the body or particle farthest from its ghost
};

// Given instead of a method name: the accurate run (app/lab/run/accurate_run.h), in double, with a
// quarter of the dt and 16 substeps.
inline constexpr const char *reference_ghost = "reference";

class Ghost {
  public:
    // Starts from the current state of `beside`, on one thread. Throws as Simulation::create does.
    Ghost(const Simulation &beside, const std::string &method);
    [[nodiscard]] bool is_reference() const { return is_reference_; }

    // Call before `beside` steps: remembers the state that go_back restores.
    void begin_step();
    // Call after `beside` has stepped: catches up with its time. A failure ends the ghost's motion
    // and is reported. The reference uses no more than its time allowance, and then lags; while
    // `beside` stands still, go_on brings it level.
    void catch_up(const Simulation &beside);
    void go_on(const Simulation &beside);
    [[nodiscard]] double lag(const Simulation &beside) const; // s; 0: level
    void allow(double seconds) { allowance_ = seconds; }      // per call
    // `beside` has gone back one step. False if the ghost did not exist then.
    bool go_back();
    // Applies a command given to `beside` to the ghost too, except method and settings. Of the
    // world settings, gravity is shared, and so is dt, of which the reference keeps its fraction. A
    // command the ghost cannot obey, or any command while it lags, ends its motion and is reported.
    void apply(const Simulation &beside, const Command &command);

    [[nodiscard]] const Simulation &simulation() const { return *simulation_; }
    [[nodiscard]] const Frame &previous() const { return previous_; }
    [[nodiscard]] const Frame &present() const { return present_; }
    [[nodiscard]] const std::string &failure() const { return failure_; } // empty: none
    // Over everything both have, matched by name; meaningless while the ghost lags.
    [[nodiscard]] GhostDistance farthest(const Simulation &beside, const Frame &frame) const;

  private:
    void fail(const std::string &why);
    void step_towards(const Simulation &beside);

    bool is_reference_ = false;
    double allowance_ = 0; // s; 0 unless a reference: unlimited
    std::unique_ptr<Simulation> simulation_;
    History history_; // one state per step of `beside`
    Frame previous_, present_;
    std::string failure_;
    std::int64_t steps_ = 0;       // steps of `beside` since the ghost began
    std::int64_t failed_from_ = 0; // failed after this many of those steps
};

} // namespace plumb
