// Explicit (forward) Euler for free bodies, particles and springs: poses and velocities both
// advance by the rates at the start. First order; every undamped spring gains energy, at any step.
// Hairer, Lubich, Wanner 2006, "Geometric Numerical Integration", eq. (I.1.6).
#include "engine/dynamics/method.h"

namespace plumb::inline PLUMB_PRECISION {

namespace {

void advance_explicit_euler(StepContext &context) {
    const StepSettings &settings = context.settings;
    const Real h = context.substep();
    Accelerations &start = context.scratch.accelerations[0];
    for (int substep = 0; substep < settings.substeps; ++substep) {
        find_accelerations(context, start);
        drift_smoothly(context, h);
        kick_smoothly(context, start, h);
    }
}

} // namespace

Method explicit_euler() {
    return {{.name = "explicit_euler",
             .title = "Explicit Euler",
             .source = "Euler 1768",
             .contacts = false,
             .joints = false,
             .springs = true,
             .reads = {},
             .defaults = {.substeps = 1, .iterations = 1}},
            advance_explicit_euler};
}

} // namespace plumb::inline PLUMB_PRECISION
