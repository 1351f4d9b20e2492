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

    // From start to start, until one misses. `progress` is called with the fraction done.
    [[nodiscard]] TunedRun run(const RunOptions &options, const Progress &progress) const;

    // Of that run from start to end: what comes to rest sleeps, and costs next to nothing at the
    // end.
    [[nodiscard]] RunTimer timer(const TunedRun &run) const;

    // The scene as it is held to be: with so much of each tolerance.
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
    TunedRun *run; // of that trial
};

// Times runs against each other, in turns. Sets their timings and cost, or leaves them all as they
// are when it is interrupted.
void time_in_turns(const std::vector<TimedRun> &runs, const TuneOptions &options,
                   const Progress &progress);

// Whether it cost more than the other in each round, by same_cost: of a few, or of very short ones,
// the median would be noise.
[[nodiscard]] bool is_always_dearer(const TunedRun &run, const TunedRun &other);

} // namespace plumb
