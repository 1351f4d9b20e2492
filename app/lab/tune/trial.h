// Runs a scene with one combination of settings from each of its starts.
#pragma once

#include "app/lab/run/run_timer.h"
#include "app/lab/tune/tune.h"
#include "engine/scene/scene_desc.h"

#include <vector>

namespace plumb {

class Trial {
  public:
    // Keeps both by reference.
    Trial(const std::vector<SceneDesc> &starts, const TuneOptions &options);

    // Runs each start in turn until one misses. `progress` is called with the fraction done.
    [[nodiscard]] TunedRun run(const RunOptions &options, const Progress &progress) const;

    // Times that run from start to end: bodies that come to rest sleep, and cost next to nothing at
    // the end.
    [[nodiscard]] RunTimer timer(const TunedRun &run) const;

    // The scene with tightened tolerances, as it is judged.
    [[nodiscard]] const SceneDesc &scene() const { return tightened_.front(); }

  private:
    [[nodiscard]] std::unique_ptr<Simulation> make(const SceneDesc &scene,
                                                   const RunOptions &options) const;
    [[nodiscard]] bool stopped() const { return options_.stop && options_.stop(); }

    const std::vector<SceneDesc> &starts_;
    const TuneOptions &options_;
    std::vector<SceneDesc> tightened_;
};

struct TimedRun {
    const Trial *trial;
    TunedRun *run; // made by that trial
};

// Times runs against each other, interleaved. Sets their timings and cost, or leaves them all
// unchanged if interrupted.
void time_in_turns(const std::vector<TimedRun> &runs, const TuneOptions &options,
                   const Progress &progress);

// Whether `run` cost more than `other` by same_cost in every round: with few or very short timings
// the median would be noise.
[[nodiscard]] bool is_always_dearer(const TunedRun &run, const TunedRun &other);

} // namespace plumb
