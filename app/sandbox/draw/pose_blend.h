// Interpolates poses between two steps, for display.
#pragma once

#include "engine/scene/frame.h"

#include <vector>

namespace plumb {

// Interpolates positions linearly and orientations by nlerp along the shorter way; exact at alpha 0
// and 1. Bodies that only `present` has appear immediately. Everything else is taken from
// `present`.
[[nodiscard]] std::vector<BodyState> blend(const std::vector<BodyState> &previous,
                                           const std::vector<BodyState> &present, double alpha);

// The same for particle positions.
[[nodiscard]] std::vector<ParticleState> blend(const std::vector<ParticleState> &previous,
                                               const std::vector<ParticleState> &present,
                                               double alpha);

} // namespace plumb
