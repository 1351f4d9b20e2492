// What a method of augmented Lagrangians remembers of its rows besides their loads: how stiff each
// has become. Empty under all other methods.
#pragma once

#include "engine/dynamics/joints/joint.h"

#include <vector>

namespace plumb::inline PLUMB_PRECISION {

// Of a contact point.
struct PointPenalty {
    Real normal = Real(0); // N/m; 0: not known yet
    Real tangential = Real(0);
    // How far the two have slid against each other since friction holds them (m), along the two
    // vectors of tangent_basis(normal).
    Vec2 slip{Real(0)};
};

struct Penalties {
    std::vector<PointPenalty> points; // one for each of State::points, or none
    std::vector<JointPenalty> joints; // one for each joint of the model, or none
};

} // namespace plumb::inline PLUMB_PRECISION
