// Sequential impulses: projected Gauss-Seidel on velocities with accumulated, warm-started
// impulses, and Baumgarte's bias against drift. Catto 2005, "Iterative Dynamics with Temporal
// Coherence"; Catto 2006, "Fast and Simple Physics using Sequential Impulses".
#include "engine/dynamics/joint_constraint.h"
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

    std::vector<ContactConstraint> contacts = prepare_contacts(context);
    std::vector<JointConstraint> joints = prepare_joints(context);
    std::vector<FreeFlight> flights(context.motions.size());

    for (int substep = 0; substep < settings.substeps; ++substep) {
        resolve_impacts(context, contacts, h);
        for (std::size_t i = 0; i < flights.size(); ++i)
            flights[i] = begin_flight(context.motions[i], context.bodies[i], gravity, h,
                                      Kick::before, settings.gyroscopic_iterations);
        refresh_joints(context, joints);
        remember_joints(joints);
        remember_contacts(contacts);
        recall_joints(context, joints, Real(1));
        recall_contacts(context, contacts, Real(1));
        for (int i = 0; i < settings.iterations; ++i) {
            solve_joints(context, joints, rigid, Real(0));
            solve_contacts(context, contacts, contact_bias, h);
        }
        for (std::size_t i = 0; i < flights.size(); ++i) {
            move(context.motions[i], context.bodies[i], flights[i], h);
            end_flight(context.motions[i], context.bodies[i], flights[i], Kick::before);
        }
    }
    store_joints(context, joints);
    store_contacts(context, contacts);
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
             .default_substeps = 1,
             .default_iterations = 10,
             .body_passes = [](int substeps, int) { return 2 * substeps; },
             .constraint_passes = [](int substeps,
                                     int iterations) { return substeps * (1 + iterations); }},
            advance};
}

} // namespace plumb::inline PLUMB_PRECISION
