// Sequential impulses: projected Gauss-Seidel on velocities with accumulated, warm-started
// impulses, and Baumgarte's bias against drift. Catto 2005, "Iterative Dynamics with Temporal
// Coherence"; Catto 2006, "Fast and Simple Physics using Sequential Impulses", with Box2D Lite.
//
// The defaults are as published, with pseudo velocities for contacts (split_impulse, Catto 2006);
// the order of a contact's points is not stated there, and alternates here. Our additions are
// settings, off by default: foresee_turns, closed_form_flight, impact_sweeps, and a limit to
// push_velocity. Box2D Lite does not bounce; without sweeps, contacts bounce once a step, as in TGS
// Soft.
//
// Three things are not as published, since as published they are wrong, not just inaccurate: a
// friction pyramid holds up to sqrt(2) times as much along its diagonals, whatever the step, so
// friction is Coulomb's circular cone; in 3D, spins without their gyroscopic term do not conserve
// angular momentum, whatever the step, so there is an implicit one (gyroscopic_iterations 0: none);
// and with a bias that takes the same share of the drift back in every step, however short, a chain
// with a heavy end gains more energy the finer the steps, so the rate stays that of 60 Hz
// (baumgarte_time 0: as published). Contacts are found like all methods', some before bodies touch
// (speculative_distance). The publications have neither soft joints, springs nor particles: these
// are implicit Euler's.
#include "engine/dynamics/methods/parts/impulse_substeps.h"

#include <utility>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {

namespace {

void advance_sequential_impulses(StepContext &context) {
    const bool alternates = context.settings.alternate_points != 0;
    advance_by_impulses(context, [&](const auto &pass) {
        for (int i = 0; i < context.settings.iterations; ++i)
            pass(alternates && i % 2 != 0 ? PointOrder::backwards : PointOrder::forwards);
    });
}

} // namespace

Method sequential_impulses() {
    std::vector<SettingGroup> groups = read_by_impulses();
    groups.push_back(SettingGroup::order);
    return {{.name = "sequential_impulses",
             .title = "Sequential impulses",
             .source = "Catto 2005, Iterative Dynamics with Temporal Coherence",
             .contacts = true,
             .joints = true,
             .springs = true,
             .reads = std::move(groups),
             .defaults = {.substeps = 1,
                          .iterations = 10,
                          .split_impulse = 1,
                          .baumgarte_time = 1.0 / 60,
                          .foresee_turns = 0,
                          .alternate_points = 1,
                          .closed_form_flight = 0,
                          .push_velocity = 1e9,
                          .impact_sweeps = 0}},
            advance_sequential_impulses};
}

} // namespace plumb::inline PLUMB_PRECISION
