// Poses between two steps, for display.
#pragma once

#include "engine/scene/frame.h"

#include <vector>

namespace plumb {

// Positions linearly, orientations by normalised linear interpolation along the shorter way; exact
// at alpha 0 and 1. Bodies that only `present` has appear at once. All else is as
// `present` has it.
[[nodiscard]] std::vector<BodyState> blend(const std::vector<BodyState> &previous,
                                           const std::vector<BodyState> &present, double alpha);

// Positions linearly, likewise.
[[nodiscard]] std::vector<ParticleState> blend(const std::vector<ParticleState> &previous,
                                               const std::vector<ParticleState> &present,
                                               double alpha);

} // namespace plumb
