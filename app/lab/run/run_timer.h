// Times the end of a run, again and again from the same state.
#pragma once

#include "engine/scene/simulation.h"

#include <functional>
#include <memory>
#include <optional>

namespace plumb {

class EndTimer {
  public:
    // `simulation`, and how it was `timed` seconds of simulated time before its end. `cost` is
    // about what it takes: CPU seconds for a simulated second.
    EndTimer(std::unique_ptr<Simulation> simulation, std::unique_ptr<Simulation::Saved> saved,
             double timed, double cost, bool wall_clock = false);

    // CPU seconds of this thread, or of the clock on the wall, per simulated second; nothing when a
    // step failed, or `stop`, asked some twenty times a second, was true.
    [[nodiscard]] std::optional<double> time(const std::function<bool()> &stop = {}) const;

  private:
    std::unique_ptr<Simulation> simulation_;
    std::unique_ptr<Simulation::Saved> saved_;
    int steps_ = 1;  // in the timed segment
    int rounds_ = 1; // in one timing
    int asking_ = 1; // after how many steps
    bool wall_clock_;
};

} // namespace plumb
