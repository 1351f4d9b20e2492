// Stormer-Verlet for free bodies, particles and springs, as drift, kick, drift: the midpoint
// positions obey x(n+1) - 2 x(n) + x(n-1) = h^2 a(x(n)) (Verlet 1967; Hairer, Lubich, Wanner 2006,
// "Geometric Numerical Integration", section I.1.4), and nothing has to be remembered from the
// previous step. Second order, symplectic; one evaluation per substep.
//
// Velocity-dependent forces are taken at the mean of the velocities before and after the kick, by
// one extra correction.
#include "engine/dynamics/method.h"

namespace plumb::inline PLUMB_PRECISION {

namespace {

void advance_stormer_verlet(StepContext &context) {
    const StepSettings &settings = context.settings;
    const Real h = context.substep();
    Accelerations &middle = context.scratch.accelerations[0];
    const bool corrects = depend_on_velocities(context);
    for (int substep = 0; substep < settings.substeps; ++substep) {
        drift_smoothly(context, h / 2);
        find_accelerations(context, middle);
        if (corrects) {
            remember_velocities(context);
            kick_smoothly(context, middle, h / 2);
            find_accelerations(context, middle);
            restore_velocities(context);
        }
        kick_smoothly(context, middle, h);
        drift_smoothly(context, h / 2);
    }
}

} // namespace

Method stormer_verlet() {
    return {{.name = "stormer_verlet",
             .title = "Stormer-Verlet",
             .source = "Verlet 1967",
             .contacts = false,
             .joints = false,
             .springs = true,
             .reads = {},
             .defaults = {.substeps = 1, .iterations = 1}},
            advance_stormer_verlet};
}

} // namespace plumb::inline PLUMB_PRECISION
