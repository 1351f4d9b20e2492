// Semi-implicit (symplectic) Euler for free bodies, particles and springs: velocities first, then
// poses with the new ones. First order; keeps energy bounded. Hairer, Lubich, Wanner 2003,
// "Geometric numerical integration illustrated by the Stormer-Verlet method", eq. (1.5).
#include "engine/dynamics/method.h"

namespace plumb::inline PLUMB_PRECISION {

namespace {

void advance_semi_implicit_euler(StepContext &context) {
    const StepSettings &settings = context.settings;
    const Real h = context.substep();
    for (int substep = 0; substep < settings.substeps; ++substep) {
        kick_smoothly(context, h);
        drift_smoothly(context, h);
    }
}

} // namespace

Method semi_implicit_euler() {
    return {{.name = "semi_implicit_euler",
             .title = "Semi-implicit Euler",
             .source = "Hairer, Lubich, Wanner 2003",
             .contacts = false,
             .joints = false,
             .springs = true,
             .reads = {},
             .defaults = {.substeps = 1, .iterations = 1}},
            advance_semi_implicit_euler};
}

} // namespace plumb::inline PLUMB_PRECISION
