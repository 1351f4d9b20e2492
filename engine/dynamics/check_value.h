// Rejects numbers that a definition must not have.
#pragma once

#include "engine/core/check.h"
#include "engine/math/types.h"

#include <cmath>

namespace plumb::inline PLUMB_PRECISION {

// `name` is what the message calls the value.
inline void check_not_negative(const char *name, Real value) {
    PLUMB_CHECK(std::isfinite(value) && value >= Real(0),
                name << " must be finite and not negative, got " << value);
}

inline void check_positive(const char *name, Real value) {
    PLUMB_CHECK(std::isfinite(value) && value > Real(0),
                name << " must be finite and positive, got " << value);
}

} // namespace plumb::inline PLUMB_PRECISION
