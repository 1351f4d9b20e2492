// How much of an error AVBD's passes leave.
#pragma once

#include "engine/dynamics/world.h"

#include <cmath>

namespace plumb::inline PLUMB_PRECISION {
namespace trial {

// The remaining fraction for a single body: with penalty_start at 1, each pass halves the error.
inline double left_by_avbd(const World &world) {
    return std::ldexp(1.0, -world.settings().iterations);
}

} // namespace trial
} // namespace plumb::inline PLUMB_PRECISION
