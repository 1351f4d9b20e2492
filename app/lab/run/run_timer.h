// Times parts of a run repeatedly, from the same states.
#pragma once

#include "engine/scene/simulation.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace plumb {

// A timed stretch of a run, and the share of the run it stands for.
struct TimedPart {
    std::unique_ptr<Simulation::Saved> start;
    std::uint64_t steps = 1;
    double share = 1;
};

// States of a run at evenly spaced times, and what its steps had cost by then: enough to choose the
// parts to time. A scene that falls, lands and sleeps spends most of its CPU time in a small part
// of the run.
class RunRecord {
  public:
    // For a run of `end` seconds, of which about `timed` will be timed; the whole run if `timed` is
    // not less.
    RunRecord(double end, double timed);

    // When to call note() (s), ascending; the first is 0.
    [[nodiscard]] const std::vector<double> &times() const { return times_; }
    // Call before the first step at or after that time; `used`: time taken by the steps so far (s).
    void note(const Simulation &simulation, double used);
    // Call at the end, or as far as the run got. Consumes the notes.
    [[nodiscard]] std::vector<TimedPart> take_parts(const Simulation &simulation, double used);

  private:
    struct Note {
        std::unique_ptr<Simulation::Saved> state;
        std::uint64_t step = 0;
        double used = 0;
    };
    double each_; // simulated s: one part, where the cost is steady
    std::vector<double> times_;
    std::vector<Note> notes_;
};

class RunTimer {
  public:
    // `cost` is the parts' approximate cost: CPU seconds per simulated second.
    RunTimer(std::unique_ptr<Simulation> simulation, std::vector<TimedPart> parts, double cost,
             bool wall_clock = false);

    // CPU seconds of this thread, or wall-clock seconds, per simulated second; nullopt if a step
    // failed or `stop`, called about twenty times a second, returned true.
    [[nodiscard]] std::optional<double> time(const std::function<bool()> &stop = {}) const;

  private:
    std::unique_ptr<Simulation> simulation_;
    std::vector<TimedPart> parts_;
    int rounds_ = 1;           // in one timing
    std::uint64_t asking_ = 1; // steps between calls of `stop`
    bool wall_clock_;
};

} // namespace plumb
