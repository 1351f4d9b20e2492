// Another engine wrapped as a Simulation, so that it is measured exactly as ours is.
#pragma once

#include "app/lab/engines/other_engines.h"
#include "app/lab/run/expectation.h"
#include "engine/scene/simulation.h"

#include <memory>
#include <vector>

namespace plumb {

// Each step runs the engine for the given number of substeps. Energies and momenta come from its
// poses and velocities, penetration and joint drift from its poses alone, by our geometry in
// double. `restore` reruns the engine from the start, as its internal state cannot be restored.
// Commands are not supported. Throws std::invalid_argument if why_not is not empty.
[[nodiscard]] std::unique_ptr<Simulation>
engine_simulation(const OtherEngine &engine, const SceneDesc &scene, const ResolvedRun &run);

// Outcomes whose quantity the engines do not tell, those of contact forces, become unseen.
void drop_unmeasured(std::vector<ExpectOutcome> &outcomes);

// Sets the engine's dynamic bodies to the poses and velocities in `scene`, which may differ from
// the original in nothing else; the engine keeps what it remembers. Requires a simulation made by
// engine_simulation.
void put(Simulation &of_engine, const SceneDesc &scene);

} // namespace plumb
