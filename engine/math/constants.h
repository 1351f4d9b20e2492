// Numeric constants.
#pragma once

#include "engine/math/types.h"

#include <limits>

namespace plumb::inline PLUMB_PRECISION {

inline constexpr Real epsilon = std::numeric_limits<Real>::epsilon();
inline constexpr Real infinity = std::numeric_limits<Real>::infinity();
inline constexpr Real pi = Real(3.14159265358979323846L);

} // namespace plumb::inline PLUMB_PRECISION
