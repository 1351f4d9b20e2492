// Sequential impulses: projected Gauss-Seidel on velocities with accumulated, warm-started
// impulses, and Baumgarte's bias against drift. Catto 2005, "Iterative Dynamics with Temporal
// Coherence"; Catto 2006, "Fast and Simple Physics using Sequential Impulses".
#include "engine/dynamics/method.h"
#include "engine/dynamics/motion.h"

namespace plumb::inline PLUMB_PRECISION {

namespace {

void advance(StepContext &context) {
    const StepSettings &settings = context.settings;
    const auto h = static_cast<Real>(settings.dt / settings.substeps);
    const Vec3 gravity{settings.gravity};
    const Softness rigid{static_cast<Real>(settings.baumgarte) / h, Real(1), Real(0)};
    const ContactBias contact_bias{rigid, static_cast<Real>(settings.push_velocity),
                                   static_cast<Real>(settings.penetration_slop)};

    const JointPass joint_pass{.softness = rigid, .h = h, .spring_time = h};

    prepare_contacts(context);
    prepare_joints(context);
    for (int substep = 0; substep < settings.substeps; ++substep) {
        resolve_impacts(context, h);
        begin_flights(context, gravity, h, Kick::before);
        refresh_joints(context);
        remember_joints(context);
        remember_contacts(context);
        recall_joints(context, Real(1), Springs::solve);
        recall_contacts(context, Real(1));
        for (int i = 0; i < settings.iterations; ++i) {
            solve_joints(context, joint_pass);
            solve_contacts(context, contact_bias, h);
        }
        end_flights(context, h, Kick::before);
    }
    store_joints(context);
    store_contacts(context);
}

} // namespace

Method sequential_impulses() {
    return {{.name = "sequential_impulses",
             .title = "Sequential impulses",
             .source = "Catto 2005, Iterative Dynamics with Temporal Coherence",
             .contacts = true,
             .joints = true,
             .reads = {SettingGroup::constraints, SettingGroup::baumgarte, SettingGroup::impacts,
                       SettingGroup::gyroscopic},
             .defaults = {.substeps = 1, .iterations = 10}},
            advance};
}

} // namespace plumb::inline PLUMB_PRECISION
