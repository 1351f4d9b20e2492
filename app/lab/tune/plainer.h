// What a scene can do without, once its settings are found.
#pragma once

#include "app/lab/tune/tune.h"

#include <functional>
#include <string>
#include <vector>

namespace plumb {

// One thing less to model.
struct Simplification {
    std::string what; // that is left out, after "without"
    std::function<void(SceneDesc &, RunOptions &)> apply;
};

// What this scene has that could be left out, in the order in which it is tried: sleep; of each
// dynamic body its rotation, and its shape for a sphere of the same volume. The copies of a
// `repeat` count as one body.
[[nodiscard]] std::vector<Simplification> simplifications(const SceneDesc &scene,
                                                          const RunOptions &options);

// Tries each with the chosen settings, from the same starts and on top of those that were left out
// before. Left out is what the scene meets its expectations without, and which does not make it
// dearer in every turn by more than same_cost.
void leave_out(const std::vector<SceneDesc> &starts, const TuneOptions &options, Tuning &tuning,
               const Progress &progress);

} // namespace plumb
