// Another engine as a simulation: what is measured of it, is measured of ours.
#pragma once

#include "app/lab/engines/other_engines.h"
#include "engine/scene/simulation.h"

#include <memory>

namespace plumb {

// Steps the engine so many substeps at a time. Energies and momenta are computed from its poses and
// velocities, penetration and joint drift from its poses alone, by our geometry in double. Its
// `restore` runs the engine anew from the start, as it cannot be put anywhere else. It obeys no
// command. Throws std::invalid_argument where why_not is not empty.
[[nodiscard]] std::unique_ptr<Simulation>
engine_simulation(const OtherEngine &engine, const SceneDesc &scene, const ResolvedRun &run);

// Puts the engine's dynamic bodies as the scene has them, which differs from its own in their poses
// and velocities alone; what the engine remembers stays. Requires one that engine_simulation made.
void put(Simulation &of_engine, const SceneDesc &scene);

} // namespace plumb
