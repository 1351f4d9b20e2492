// Sequential impulses: projected Gauss-Seidel on velocities with accumulated, warm-started
// impulses, and Baumgarte's bias against drift. Catto 2005, "Iterative Dynamics with Temporal
// Coherence"; Catto 2006, "Fast and Simple Physics using Sequential Impulses". Penetration is
// removed by pseudo velocities, and joints foresee turns; impulse_substeps.h says why. That,
// impacts propagated in sweeps, the implicit gyroscopic term and the order of passes are ours:
// passes visit a contact's points forwards and backwards in turn. If they always started from the
// first, each would leave too much to the last; stacks then sway, and eight cubes fall.
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
