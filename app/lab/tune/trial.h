// Runs a scene with one combination of settings from each of its starts.
#pragma once

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

    // Times those runs against each other, in turns and from start to end: what comes to rest
    // sleeps, and costs next to nothing at the end.
    // Sets their timings and cost, or leaves them all as they are when it is interrupted.
    void time(const std::vector<TunedRun *> &runs, const Progress &progress) const;

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

} // namespace plumb
