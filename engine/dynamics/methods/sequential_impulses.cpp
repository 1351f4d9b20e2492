// Sequential impulses: projected Gauss-Seidel on velocities with accumulated, warm-started
// impulses, and Baumgarte's bias against drift. Catto 2005, "Iterative Dynamics with Temporal
// Coherence"; Catto 2006, "Fast and Simple Physics using Sequential Impulses". With pseudo
// velocities against penetration, and joints whose turns are foreseen: impulse_substeps.h says why.
// That, impacts that are propagated in sweeps and the implicit gyroscopic term are ours.
#include "engine/dynamics/impulse_substeps.h"

namespace plumb::inline PLUMB_PRECISION {

namespace {

void advance_sequential_impulses(StepContext &context) {
    advance_by_impulses(context, [&](const auto &pass) {
        for (int i = 0; i < context.settings.iterations; ++i)
            pass();
    });
}

} // namespace

Method sequential_impulses() {
    return {{.name = "sequential_impulses",
             .title = "Sequential impulses",
             .source = "Catto 2005, Iterative Dynamics with Temporal Coherence",
             .contacts = true,
             .joints = true,
             .springs = true,
             .reads = read_by_impulses(),
             .defaults = {.substeps = 1, .iterations = 10}},
            advance_sequential_impulses};
}

} // namespace plumb::inline PLUMB_PRECISION
