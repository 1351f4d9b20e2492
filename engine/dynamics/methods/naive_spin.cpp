// For comparison: free bodies whose angular velocity stays constant in the world, as if all moments
// of inertia were equal: Euler's equations (Landau, Lifshitz 1976, "Mechanics", eq. (36.5)) without
// the gyroscopic term. Angular momentum and energy are those of another motion, however short the
// step.
#include "engine/dynamics/methods/parts/free_substeps.h"

namespace plumb::inline PLUMB_PRECISION {

namespace {

void advance_naive_spin(StepContext &context) {
    advance_free_bodies(context, [](SolverBody &motion, const Body &, Real h) {
        motion.rotation = turned(motion.rotation, motion.angular_velocity, h);
    });
}

} // namespace

Method naive_spin() {
    return {{.name = "naive_spin",
             .title = "Naive spin",
             .source = "Szauer 2017, Game Physics Cookbook, chapter 15",
             .contacts = false,
             .joints = false,
             .springs = false,
             .reads = {},
             .defaults = {.substeps = 1, .iterations = 1}},
            advance_naive_spin};
}

} // namespace plumb::inline PLUMB_PRECISION
