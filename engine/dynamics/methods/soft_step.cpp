// Soft step: small substeps, soft constraints, and a relaxing pass that takes the softness' push
// out of the velocities again. Catto 2024, "Solver2D" (there TGS Soft); Macklin et al. 2019, "Small
// Steps in Physics Simulation", for why substeps beat iterations.
//
// One thing is different here. Gravity comes in two halves, before the move and after it, each with
// its half of the remembered impulses; joints are solved for the poses at the substep's end, and
// relaxed with their lever arms there. That is the order of RATTLE (Andersen 1983), a scheme of
// second order, at the price of one more pass over the bodies: a pendulum keeps its energy, which
// the plain scheme loses at the rate omega^2 h.
#include "engine/dynamics/joint_constraint.h"
#include "engine/dynamics/method.h"
#include "engine/dynamics/motion.h"

namespace plumb::inline PLUMB_PRECISION {

namespace {

void advance(StepContext &context) {
    const StepSettings &settings = context.settings;
    const auto h = static_cast<Real>(settings.dt / settings.substeps);
    const Real rate = Real(1) / h;
    const Vec3 gravity{settings.gravity};
    const Softness joint_softness =
        make_soft(static_cast<Real>(settings.joint_frequency_ratio) * rate,
                  static_cast<Real>(settings.joint_damping_ratio), h);
    const ContactBias contact_bias{
        make_soft(static_cast<Real>(settings.contact_frequency_ratio) * rate,
                  static_cast<Real>(settings.contact_damping_ratio), h),
        static_cast<Real>(settings.push_velocity), Real(0)};

    ContactBias relax_bias;
    relax_bias.loaded_only = true;

    std::vector<ContactConstraint> contacts = prepare_contacts(context);
    std::vector<JointConstraint> joints = prepare_joints(context);
    std::vector<FreeFlight> flights(context.motions.size());

    for (int substep = 0; substep < settings.substeps; ++substep) {
        resolve_impacts(context, contacts, h);
        for (std::size_t i = 0; i < flights.size(); ++i)
            flights[i] = begin_flight(context.motions[i], context.bodies[i], gravity, h,
                                      Kick::around, settings.gyroscopic_iterations);
        refresh_joints(context, joints);
        remember_joints(joints);
        remember_contacts(contacts);
        recall_joints(context, joints, Real(0.5));
        recall_contacts(context, contacts, Real(0.5));
        for (int i = 0; i < settings.iterations; ++i) {
            solve_joints(context, joints, joint_softness, h);
            solve_contacts(context, contacts, contact_bias, h);
        }
        for (std::size_t i = 0; i < flights.size(); ++i) {
            move(context.motions[i], context.bodies[i], flights[i], h);
            end_flight(context.motions[i], context.bodies[i], flights[i], Kick::around);
        }
        refresh_joints(context, joints);
        recall_joints(context, joints, Real(0.5));
        recall_contacts(context, contacts, Real(0.5));
        for (int i = 0; i < settings.iterations; ++i) {
            solve_joints(context, joints, Softness{}, Real(0));
            solve_contacts(context, contacts, relax_bias, h);
        }
    }
    store_joints(context, joints);
    store_contacts(context, contacts);
}

} // namespace

Method soft_step() {
    return {{.name = "soft_step",
             .title = "Soft step",
             .source = "Catto 2024, Solver2D; Macklin et al. 2019, Small Steps",
             .contacts = true,
             .joints = true,
             .reads = {SettingGroup::constraints, SettingGroup::soft, SettingGroup::impacts,
                       SettingGroup::gyroscopic},
             .default_substeps = 4,
             .default_iterations = 1,
             .body_passes = [](int substeps, int) { return 2 * substeps; },
             .constraint_passes = [](int substeps,
                                     int iterations) { return substeps * (2 + 2 * iterations); }},
            advance};
}

} // namespace plumb::inline PLUMB_PRECISION
