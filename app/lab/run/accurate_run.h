// How a scene is run where cost does not matter.
#pragma once

#include "engine/scene/simulation.h"

namespace plumb {

// In double, with the given dt, the same number of substeps for every island and no sleeping: by
// rk4 if it can run the scene, else by soft_step. Otherwise as `base`.
[[nodiscard]] RunOptions accurate_run(const SceneDesc &scene, const RunOptions &base, double dt,
                                      int substeps);

} // namespace plumb
