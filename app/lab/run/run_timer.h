// Times parts of a run, again and again from the same states.
#pragma once

#include "engine/scene/simulation.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace plumb {

// A stretch of a run that is timed, and how much of the run it stands for.
struct TimedPart {
    std::unique_ptr<Simulation::Saved> start;
    std::uint64_t steps = 1;
    double share = 1;
};

// How a run was at even times, and what its steps had taken by then: enough to choose the parts
// that are timed. What falls, lands and sleeps takes most of its time in little of the run.
class RunRecord {
  public:
    // Of a run of `end` seconds, of which some `timed` are to be timed; the whole run where that is
    // not less.
    RunRecord(double end, double timed);

    // When to note (s), ascending; first 0.
    [[nodiscard]] const std::vector<double> &times() const { return times_; }
    // Before the first step from there; `used`: what the steps so far have taken (s).
    void note(const Simulation &simulation, double used);
    // At the end, or as far as the run got; nothing of what was noted is left.
    [[nodiscard]] std::vector<TimedPart> take_parts(const Simulation &simulation, double used);

  private:
    struct Note {
        std::unique_ptr<Simulation::Saved> state;
        std::uint64_t step = 0;
        double used = 0;
    };
    double each_; // s, of the run: a part of those that go on alike
    std::vector<double> times_;
    std::vector<Note> notes_;
};

class RunTimer {
  public:
    // `cost` is about what the parts take: CPU seconds for a simulated second.
    RunTimer(std::unique_ptr<Simulation> simulation, std::vector<TimedPart> parts, double cost,
             bool wall_clock = false);

    // CPU seconds of this thread, or of the clock on the wall, per simulated second; nothing when a
    // step failed, or `stop`, asked some twenty times a second, was true.
    [[nodiscard]] std::optional<double> time(const std::function<bool()> &stop = {}) const;

  private:
    std::unique_ptr<Simulation> simulation_;
    std::vector<TimedPart> parts_;
    int rounds_ = 1;           // in one timing
    std::uint64_t asking_ = 1; // after how many steps
    bool wall_clock_;
};

} // namespace plumb
