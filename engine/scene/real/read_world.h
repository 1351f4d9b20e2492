// Reads a world's visible state in scene terms (Simulation::read).
#pragma once

#include "engine/math/types.h"
#include "engine/scene/simulation.h"

#include <cstdint>
#include <span>

namespace plumb::inline PLUMB_PRECISION {

class World;

BodyState body_state(const World &world, std::uint32_t body);
// `joints`: their descriptions, by index.
void read_world(const World &world, std::span<const JointDesc> joints, Frame &into,
                const FrameParts &parts);

} // namespace plumb::inline PLUMB_PRECISION
