// Sequential impulses: projected Gauss-Seidel on velocities with accumulated, warm-started
// impulses, and Baumgarte's bias against drift. Catto 2005, "Iterative Dynamics with Temporal
// Coherence"; Catto 2006, "Fast and Simple Physics using Sequential Impulses". With pseudo
// velocities against penetration, and joints whose turns are foreseen: impulse_substeps.h says why.
// That, impacts that are propagated in sweeps, the implicit gyroscopic term and the order of passes
// are ours: a contact's points are taken from the first to the last and back in turns. Always from
// the first, each pass leaves the last one too much, stacks sway by it, and eight cubes fall.
#include "engine/dynamics/methods/parts/impulse_substeps.h"

namespace plumb::inline PLUMB_PRECISION {

namespace {

void advance_sequential_impulses(StepContext &context) {
    advance_by_impulses(context, [&](const auto &pass) {
        for (int i = 0; i < context.settings.iterations; ++i)
            pass(i % 2 == 0 ? PointOrder::forwards : PointOrder::backwards);
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
