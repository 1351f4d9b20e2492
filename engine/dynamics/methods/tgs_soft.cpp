// TGS Soft: small substeps, soft contacts and joints, and a relaxation pass that removes the
// softness push from the velocities; bounces once, at the end of the step. Catto 2024, "Solver2D";
// Macklin et al. 2019, "Small Steps in Physics Simulation", for why substeps beat iterations.
//
// As there, contacts are twice as stiff against immovable bodies. What differs: lever arms stay
// those of the step's start, as in that article's Soft Step (turned with their bodies, they make
// rolling balls gain a tenth of their speed, and 2.7 times of it over tiles); bounces, which it
// does not have; and frequencies, which keep their ratio to the substep rate when substeps get
// finer. At 60 Hz and four substeps they are its own: 30 Hz for contacts and joints.
#include "engine/dynamics/method.h"

namespace plumb::inline PLUMB_PRECISION {

namespace {

void advance_tgs_soft(StepContext &context) {
    const StepSettings &settings = context.settings;
    const Real h = context.substep();
    const Real rate = Real(1) / h;
    const Vec3 gravity{settings.gravity};
    const Softness joint_softness =
        make_soft(static_cast<Real>(settings.joint_frequency_ratio) * rate,
                  static_cast<Real>(settings.joint_damping_ratio), h);
    const auto contact_softness = [&](Real stiffer) {
        return make_soft(stiffer * static_cast<Real>(settings.contact_frequency_ratio) * rate,
                         static_cast<Real>(settings.contact_damping_ratio), h);
    };
    const ContactBias biased{.softness = contact_softness(Real(1)),
                             .push_velocity = static_cast<Real>(settings.push_velocity),
                             .stiff = contact_softness(Real(2))};
    const ParticlePush particle_push{biased.softness.bias_rate, biased.push_velocity};
    const JointPass holding{.softness = joint_softness, .h = h};
    const JointPass relaxing{.softness = {}, .h = h, .springs = Springs::skip};

    prepare_contacts(context);
    prepare_joints(context);
    prepare_particles(context);
    note_approach(context);
    for (int substep = 0; substep < settings.substeps; ++substep) {
        kick(context, gravity, h);
        kick_particles(context, gravity, h);
        refresh_joints(context);
        remember_joints(context);
        remember_contacts(context);
        warm_start_joints(context, Real(1), Springs::at_the_end);
        warm_start_contacts(context, Real(1));
        refresh_particles(context, h, SpringRule::implicit_euler);
        refresh_separations(context);
        for (int i = 0; i < settings.iterations; ++i) {
            solve_joints(context, holding);
            solve_springs(context);
            solve_particle_contacts(context, particle_push, h);
            solve_contacts(context, biased, h);
        }
        drift(context, h);
        drift_particles(context, h);
        refresh_separations(context);
        for (int i = 0; i < settings.iterations; ++i) {
            solve_joints(context, relaxing);
            solve_particle_contacts(context, {.loaded_only = true}, h);
            solve_contacts(context, ContactBias{}, h);
        }
        restitute_particles(context, static_cast<Real>(settings.restitution_threshold));
        note_loads(context);
        note_joint_loads(context);
    }
    restitute(context, static_cast<Real>(settings.restitution_threshold));
    store_joints(context);
    store_contacts(context);
}

} // namespace

Method tgs_soft() {
    return {{.name = "tgs_soft",
             .title = "TGS Soft",
             .source = "Catto 2024, Solver2D",
             .contacts = true,
             .joints = true,
             .springs = true,
             .reads = {SettingGroup::constraints, SettingGroup::speculative, SettingGroup::soft,
                       SettingGroup::push, SettingGroup::threshold, SettingGroup::gyroscopic},
             .defaults = {.substeps = 4,
                          .iterations = 1,
                          .joint_frequency_ratio = 0.125,
                          .joint_damping_ratio = 10,
                          .push_velocity = 4}},
            advance_tgs_soft};
}

} // namespace plumb::inline PLUMB_PRECISION
