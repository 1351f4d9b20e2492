// Makes the Simulation of one precision; Simulation::create picks the precision.
#pragma once

#include "engine/core/precision.h"
#include "engine/scene/simulation.h"

namespace plumb::inline PLUMB_PRECISION {

// `run` has been resolved for this scene and the method can run it.
std::unique_ptr<Simulation> make_world_simulation(const SceneDesc &scene, const ResolvedRun &run,
                                                  TaskPool *tasks);

} // namespace plumb::inline PLUMB_PRECISION
