// Velocity Verlet for free bodies, particles and springs: half kick, drift, half kick (Swope,
// Andersen, Berens, Wilson 1982; Hairer, Lubich, Wanner 2006, "Geometric Numerical Integration",
// eq. (I.1.17)). Second order, symplectic; the last evaluation is the next substep's first.
//
// Velocity-dependent forces are taken at the end velocities, by one extra correction.
#include "engine/dynamics/method.h"

namespace plumb::inline PLUMB_PRECISION {

namespace {

void advance_velocity_verlet(StepContext &context) {
    const StepSettings &settings = context.settings;
    const Real h = context.substep();
    Accelerations &now = context.scratch.accelerations[0];
    const bool corrects = depend_on_velocities(context);
    find_accelerations(context, now);
    for (int substep = 0; substep < settings.substeps; ++substep) {
        kick_smoothly(context, now, h / 2);
        drift_smoothly(context, h);
        find_accelerations(context, now);
        if (corrects) {
            remember_velocities(context);
            kick_smoothly(context, now, h / 2);
            find_accelerations(context, now);
            restore_velocities(context);
        }
        kick_smoothly(context, now, h / 2);
    }
}

} // namespace

Method velocity_verlet() {
    return {{.name = "velocity_verlet",
             .title = "Velocity Verlet",
             .source = "Swope, Andersen, Berens, Wilson 1982",
             .contacts = false,
             .joints = false,
             .springs = true,
             .reads = {},
             .defaults = {.substeps = 1, .iterations = 1}},
            advance_velocity_verlet};
}

} // namespace plumb::inline PLUMB_PRECISION
