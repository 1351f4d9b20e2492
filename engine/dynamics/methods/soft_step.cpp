// Soft step: small substeps, soft constraints, and a relaxing pass that takes the softness' push
// out of the velocities again. Catto 2024, "Solver2D" (there TGS Soft); Macklin et al. 2019, "Small
// Steps in Physics Simulation", for why substeps beat iterations.
//
// This is not the method that article calls Soft Step. What is different here: gravity comes in two
// halves, before the move and after it, each with its half of the remembered impulses; joints are
// solved for the poses at the substep's end, and relaxed with their lever arms there. That is the
// order of RATTLE (Andersen 1983), a scheme of second order, at the price of one more pass over the
// bodies: a pendulum keeps its energy, which the plain scheme loses at the rate omega^2 h.
//
// And joints that hang together without many loops are solved together, with the limits that bear
// something, as long as the substep can follow them, and again after the contacts of their bodies;
// contacts of what rests are kept as they were found (kept_travel), those of what moves fast for
// its size are found where it will be (looks_ahead), and all are solved in columns.
#include "engine/dynamics/bodies/motion.h"
#include "engine/dynamics/joints/joint_groups.h"
#include "engine/dynamics/method.h"

#include <algorithm>

namespace plumb::inline PLUMB_PRECISION {

namespace {

int holding_passes(const StepContext &context) {
    return context.settings.iterations + (context.active.pace.settles ? 1 : 0);
}

// One pass takes only a part of the push out of the velocities of what lies on each other: a stack
// that lands would be thrown up again, and a heavy slab by what it lands on. Where something was
// struck there are up to two for each contact that it may go through, as long as they change
// something (still_relaxes). A blow lasts a few steps, so they may cost a multiple of the budget;
// but where that buys only a few they do nothing for what is tall, and there is one as elsewhere.
int relaxing_passes(const StepContext &context) {
    constexpr std::size_t for_each_contact = 2, most = 128, least = 24, budgets = 16;
    const StepSettings &settings = context.settings;
    const auto affordable =
        static_cast<std::size_t>(settings.substep_budget / settings.substeps) * budgets;
    // Each group's share of the budget is that of its contacts.
    const std::size_t passes =
        affordable / (context.contacts.size() + context.active.joints.size() + 1);
    const int usual = holding_passes(context);
    if (passes < least || !anything_is_struck(context))
        return usual;
    const std::size_t wanted = for_each_contact * context.active.contacts.size();
    return std::max(static_cast<int>(std::min({passes, wanted, most})), usual);
}

// Whether the pass before changed enough for another one.
bool still_relaxes(const StepContext &context, const ContactBias &relax_bias) {
    constexpr Real enough = Real(0.2); // of struck_speed
    return any_is_corrected(context, enough * relax_bias.struck_speed);
}

void advance_soft_step(StepContext &context) {
    const StepSettings &settings = context.settings;
    const Vec3 gravity{settings.gravity};
    if (context.active.is_free()) { // nothing of what follows would do anything
        fly_freely(context, gravity);
        return;
    }
    const Real h = context.substep();
    const Real rate = Real(1) / h;
    const Softness joint_softness =
        make_soft(static_cast<Real>(settings.joint_frequency_ratio) * rate,
                  static_cast<Real>(settings.joint_damping_ratio), h);
    ContactBias contact_bias{make_soft(static_cast<Real>(settings.contact_frequency_ratio) * rate,
                                       static_cast<Real>(settings.contact_damping_ratio), h),
                             static_cast<Real>(settings.push_velocity), Real(0)};

    const ParticlePush particle_push{contact_bias.softness.bias_rate, contact_bias.push_velocity};

    ContactBias relax_bias;
    relax_bias.loaded_only = true;
    // Twice as stiff against what does not give way: the ground bears all that stands on it (Catto
    // 2024, Solver2D). From 2.25 times on, some of what bears several of its own weights rocks, and
    // walks off.
    contact_bias.on_static =
        make_soft(Real(2) * static_cast<Real>(settings.contact_frequency_ratio) * rate,
                  static_cast<Real>(settings.contact_damping_ratio), h);
    contact_bias.struck_speed = relax_bias.struck_speed =
        glm::length(gravity) * static_cast<Real>(settings.dt);

    // Finer substeps than four push no faster than those: what lies on the joints is pushed, too,
    // and does not give all of it back.
    const Real push_share = std::min(Real(1), Real(4) * h / static_cast<Real>(settings.dt));

    // First for the poses at the substep's end, with half of the forces and springs by the first
    // half of the midpoint rule; then for the velocities there.
    const JointPass holding{.softness = joint_softness,
                            .held_share = Real(0.5),
                            .push_share = push_share,
                            .push_velocity = static_cast<Real>(settings.push_velocity),
                            .h = h,
                            .at_the_end = true,
                            .springs = Springs::midpoint,
                            .force_share = Real(0.5)};
    const JointPass relaxing{.softness = {}, .h = h, .springs = Springs::skip, .loaded_only = true};

    find_partners(context);
    prepare_contact_columns(context);
    prepare_contacts(context, Prepare::striking); // for their impacts
    prepare_joints(context);
    prepare_particles(context, SpringRule::midpoint);
    context.scratch.joint_system->arrange(context);
    prepare_joint_columns(context);
    const bool has_particles = context.active.has_particles;
    for (int substep = 0; substep < settings.substeps; ++substep) {
        // There and back, then back and there: one pass leaves most to the points that come last,
        // and always the same ones would feed slow sways: a pyramid of base 25 would never rest,
        // and what is heavy on light would walk.
        contact_bias.backwards = context.active.pace.alternates && substep % 2 == 1;
        relax_bias.backwards = context.active.pace.alternates && substep % 2 == 0;
        follow_loads(context, h);
        if (substep == 0)
            weigh_joints(context);
        else // the poses are those of the substep before
            weigh_changed_joints(context);
        resolve_impacts(context, h);
        meet_contact_columns(context);
        begin_flights(context, gravity, h, Kick::around);
        remember_joints(context);
        warm_start_joints(context, Real(0.5), Springs::midpoint);
        turn_contact_columns(context, Real(0.5) * h); // friction takes a rider along the chord
        warm_start_contact_columns(context, Real(0.5), true);
        note_lasting_loads(context);
        if (has_particles) {
            kick_particles(context, gravity, Real(0.5) * h);
            refresh_particles(context, h, SpringRule::midpoint);
        }
        push_groups(context, holding);
        for (int i = 0; i < holding_passes(context); ++i) {
            solve_joints(context, holding);
            for (int k = 0; has_particles && k < spring_passes(context); ++k) {
                solve_springs(context, SpringRule::midpoint);
                solve_particle_contacts(context, particle_push, h);
            }
            solve_contact_columns(context, contact_bias, h);
        }
        // Contacts give way, joints that are solved together do not: what is jointed would be
        // pulled apart by what it lies on, and never rest.
        hold_touched_groups(context, holding);
        end_flights(context, h, Kick::around);
        if (has_particles)
            drift_particles(context, h);
        take_back_pushes(context);
        refresh_joints(context);
        warm_start_joints(context, Real(0.5), Springs::skip);
        turn_contact_columns(context, Real(0));
        rearm_contact_columns(context); // for the next substep's first half, too
        warm_start_contact_columns(context, Real(0.5), false);
        repeat_springs(context);
        if (has_particles) {
            kick_particles(context, gravity, Real(0.5) * h);
            repeat_particle_springs(context, h);
        }
        const int usual = holding_passes(context), passes = relaxing_passes(context);
        for (int i = 0; i < passes && (i < usual || still_relaxes(context, relax_bias)); ++i) {
            solve_joints(context, relaxing);
            if (has_particles)
                solve_particle_contacts(context, {.loaded_only = true}, h);
            solve_contact_columns(context, relax_bias, h);
        }
        hold_touched_groups(context, relaxing);
        recall_borne(context);
        store_joint_columns(context); // for what the next substep makes of their loads
        if (has_particles)
            restitute_particles(context, static_cast<Real>(settings.restitution_threshold));
    }
    store_joints(context);
    store_contact_columns(context);
}

} // namespace

Method soft_step() {
    return {{.name = "soft_step",
             .title = "Soft step",
             .source = "Catto 2024, Solver2D; Macklin et al. 2019, Small Steps",
             .contacts = true,
             .joints = true,
             .springs = true,
             .looks_ahead = true,
             .reads = {SettingGroup::chosen, SettingGroup::sleep, SettingGroup::constraints,
                       SettingGroup::speculative, SettingGroup::kept, SettingGroup::soft,
                       SettingGroup::push, SettingGroup::threshold, SettingGroup::impacts,
                       SettingGroup::gyroscopic},
             .defaults = {.substeps = 4,
                          .max_substeps = 128,
                          .sleep_after = 0.5,
                          .iterations = 1,
                          .contact_damping_ratio = 1}},
            advance_soft_step};
}

} // namespace plumb::inline PLUMB_PRECISION
