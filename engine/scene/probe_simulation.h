// The Simulation of a scene that has only probes: no world, and steps that cost nothing.
#pragma once

#include "engine/scene/simulation.h"

namespace plumb {

// `run` has been resolved for this scene, which has no world.
std::unique_ptr<Simulation> make_probe_simulation(const SceneDesc &scene, const ResolvedRun &run);

} // namespace plumb
