// What AVBD leaves of an error that its passes take back.
#pragma once

#include "engine/dynamics/world.h"

#include <cmath>

namespace plumb::inline PLUMB_PRECISION {
namespace trial {

// As a share, of one body alone: with penalty_start at 1 a pass takes back half.
inline double left_by_avbd(const World &world) {
    return std::ldexp(1.0, -world.settings().iterations);
}

} // namespace trial
} // namespace plumb::inline PLUMB_PRECISION
