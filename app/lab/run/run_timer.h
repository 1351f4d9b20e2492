// Times parts of a run, again and again from the same states.
#pragma once

#include "engine/scene/simulation.h"

#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace plumb {

// Stretches of a run that take as long as each other, and as much of it before them as after: what
// falls, lands and sleeps counts as much as it lasts.
struct TimedParts {
    std::vector<double> starts; // s
    double each = 0;            // s
};
// Of a run of `end` seconds, `timed` in all; the whole run where that is not less.
[[nodiscard]] TimedParts timed_parts(double end, double timed);

class RunTimer {
  public:
    using Saves = std::vector<std::unique_ptr<Simulation::Saved>>;
    // `simulation`, and how it was at the start of each part, which are `each` seconds of simulated
    // time long. `cost` is about what they take: CPU seconds for a simulated second.
    RunTimer(std::unique_ptr<Simulation> simulation, Saves starts, double each, double cost,
             bool wall_clock = false);

    // CPU seconds of this thread, or of the clock on the wall, per simulated second; nothing when a
    // step failed, or `stop`, asked some twenty times a second, was true.
    [[nodiscard]] std::optional<double> time(const std::function<bool()> &stop = {}) const;

  private:
    std::unique_ptr<Simulation> simulation_;
    Saves starts_;
    int steps_ = 1;  // in each part
    int rounds_ = 1; // in one timing
    int asking_ = 1; // after how many steps
    bool wall_clock_;
};

} // namespace plumb
