// Poses between two steps, for display.
#pragma once

#include "engine/scene/simulation.h"

#include <vector>

namespace plumb {

struct Pose {
    glm::dvec3 position{0};
    glm::dquat orientation{1, 0, 0, 0};
};

// Of every body, holes included (their pose is whatever the simulation says).
[[nodiscard]] std::vector<Pose> poses_of(const Simulation &simulation);

// Positions linearly, orientations by normalised linear interpolation along the shorter way; exact
// at alpha 0 and 1. Bodies that only `present` has appear at once.
[[nodiscard]] std::vector<Pose> blend(const std::vector<Pose> &previous,
                                      const std::vector<Pose> &present, double alpha);

} // namespace plumb
