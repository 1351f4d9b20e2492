// How hard a violated constraint pulls back.
#pragma once

#include "engine/core/precision.h"

#include <numbers>

namespace plumb::inline PLUMB_PRECISION {

// Catto 2011, "Soft Constraints", with the spring given as natural frequency and damping ratio. A
// rigid constraint has bias_rate 0, mass 1 and impulse 0.
struct Softness {
    Real bias_rate = Real(0); // 1/s
    Real mass_scale = Real(1);
    Real impulse_scale = Real(0);
};

// `frequency` in Hz; h is the substep (s). Catto 2024, "Solver2D": with zeta the damping ratio and
// omega = 2 pi f, a1 = 2 zeta + h omega, a2 = h omega a1, bias omega / a1, mass a2 / (1 + a2),
// impulse 1 / (1 + a2).
inline Softness make_soft(Real frequency, Real damping_ratio, Real h) {
    const Real omega = Real(2) * std::numbers::pi_v<Real> * frequency;
    const Real a1 = Real(2) * damping_ratio + h * omega;
    const Real a2 = h * omega * a1;
    const Real a3 = Real(1) / (Real(1) + a2);
    return {omega / a1, a2 * a3, a3};
}

} // namespace plumb::inline PLUMB_PRECISION
