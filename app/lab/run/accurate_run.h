// How a scene is run where cost does not matter.
#pragma once

#include "engine/scene/simulation.h"

namespace plumb {

// In double, with that dt and so many substeps for all, awake to the end: by rk4 if it can run the
// scene, else by soft_step. What else `base` gives holds.
[[nodiscard]] RunOptions accurate_run(const SceneDesc &scene, const RunOptions &base, double dt,
                                      int substeps);

} // namespace plumb
