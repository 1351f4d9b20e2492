// What an augmented Lagrangian method remembers of its rows besides their loads: how stiff each has
// become. Empty for all other methods.
#pragma once

#include "engine/dynamics/joints/joint.h"

#include <vector>

namespace plumb::inline PLUMB_PRECISION {

// One contact point's.
struct PointPenalty {
    Real normal = Real(0); // N/m; 0: not known yet
    Real tangential = Real(0);
    // How far the surfaces have slipped since friction began to hold them (m), along the two
    // vectors of tangent_basis(normal).
    Vec2 slip{Real(0)};
};

struct Penalties {
    std::vector<PointPenalty> points; // one for each of State::points, or none
    std::vector<JointPenalty> joints; // one for each joint of the model, or none
};

} // namespace plumb::inline PLUMB_PRECISION
