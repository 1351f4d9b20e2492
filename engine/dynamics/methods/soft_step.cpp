// Soft step: small substeps, soft constraints, and a relaxation pass that removes the softness push
// from the velocities. Catto 2024, "Solver2D" (there TGS Soft); Macklin et al. 2019, "Small Steps
// in Physics Simulation", for why substeps beat iterations.
//
// This is not the method that article calls Soft Step. What differs: gravity is applied in two
// halves, before and after the move, each with half of the remembered impulses; joints are solved
// for the poses at the substep's end and relaxed with the lever arms there. That is the order of
// RATTLE (Andersen 1983), a second-order scheme, at the cost of one more pass over the bodies: a
// pendulum keeps its energy, which the plain scheme loses at the rate omega^2 h.
//
// Also, connected joints are solved together with their loaded limits, unless they close too many
// loops, as long as the substep can follow them, and once more after their bodies' contacts.
// Resting bodies keep their contacts as found (kept_travel); bodies that move fast for their size
// are collided where they will be (looks_ahead). Where substeps are too few, corners that bear the
// load of a face are stiffer (hard_share). All contacts are solved in columns.
#include "engine/dynamics/bodies/flight_columns.h"
#include "engine/dynamics/joints/joint_groups.h"
#include "engine/dynamics/method.h"

#include <algorithm>
#include <limits>

namespace plumb::inline PLUMB_PRECISION {

namespace {

int holding_passes(const StepContext &context) {
    return context.settings.iterations + context.active.pace.more_passes;
}

// Up to how many relaxation passes a substep takes in all: as long as the last one changed the
// speed of some contact point by more than `until_change` (m/s).
struct HitPasses {
    int most = 0;
    Real until_change = Real(0);
};

// One pass removes only part of the push from the velocities of stacked bodies: a stack would
// bounce back up on landing, and a heavy slab would be launched by whatever it lands on. So a hit
// gets up to two passes for each contact that it may travel through, times the ratio of the masses
// that meet: between a heavy body and the ground, a light one gives the heavy one only its own
// share of the masses in each pass. A hit lasts only a few steps, so its passes may cost a multiple
// of the budget. If that affords only a few, they do nothing for a tall stack of alike bodies; but
// in a crowd that lands on others they keep those beneath from being pressed deep into each other,
// as long as the blows are hard.
//
// Where there are joints, only between unlike masses, and no longer than a single blow lasts: a
// rope under a light cage in which heavy balls strike each other all the time would stretch without
// end, as these passes hold what the next substep then does not remember.
HitPasses passes_after_hit(const StepContext &context, Real struck_speed) {
    constexpr std::size_t for_each_contact = 2, most = 512, least = 24, budgets = 16;
    constexpr int in_a_crowd = 8;
    constexpr Real changed = Real(0.2), changed_much = Real(20); // of struck_speed
    constexpr Real infinity = std::numeric_limits<Real>::infinity();
    const StepSettings &settings = context.settings;
    const IslandPace &pace = context.active.pace;
    if (pace.is_struck_long)
        return {};
    // Without a pull any speed is a blow, and nothing presses together what is pushed apart: the
    // push may leave some speed.
    const bool is_pulled = struck_speed > Real(0);
    const Real mass_ratio = is_pulled ? striking_mass_ratio(context, changed * struck_speed)
                                      : std::min(striking_mass_ratio(context, infinity), Real(1));
    if (mass_ratio == Real(0) || (pace.is_joined && mass_ratio <= unlike_masses))
        return {};
    const auto affordable =
        static_cast<std::size_t>(settings.substep_budget / settings.substeps) * budgets;
    // Each group gets a share of the budget in proportion to its contacts.
    const std::size_t passes =
        affordable / (context.contacts.size() + context.active.joints.size() + 1);
    if (passes < least && mass_ratio <= unlike_masses)
        return {in_a_crowd, changed_much * struck_speed};
    const std::size_t wanted = for_each_contact * context.active.contacts.size() *
                               static_cast<std::size_t>(std::min(mass_ratio, Real(most)));
    return {static_cast<int>(std::min({passes, wanted, most})), changed * struck_speed};
}

// How much any body is pulled at most (m/s^2).
Real strongest_pull(const StepContext &context) {
    const Real gravity = glm::length(Vec3{context.settings.gravity});
    Real greatest = gravity;
    if (context.model.bodies_with_force > 0)
        for (const std::uint32_t i : context.moving())
            greatest = std::max(greatest, greatest_pull(context.model.bodies[i], gravity));
    return greatest;
}

// The passes of a substep: first for the poses at its end, then for the velocities there.
struct Passes {
    ContactBias contact_bias;
    ContactBias relax_bias;
    ParticlePush particle_push;
    // With half of the forces and the first half of the springs' midpoint rule.
    JointPass holding;
    JointPass relaxing;
};

Passes passes_of(const StepContext &context, Real h) {
    const StepSettings &settings = context.settings;
    const Real rate = Real(1) / h;
    const auto contact_softness = [&](Real stiffer) {
        return make_soft(stiffer * static_cast<Real>(settings.contact_frequency_ratio) * rate,
                         static_cast<Real>(settings.contact_damping_ratio), h);
    };
    const auto push_velocity = static_cast<Real>(settings.push_velocity);
    Passes passes;
    ContactBias &contact_bias = passes.contact_bias;
    contact_bias.softness = contact_softness(Real(1));
    // Twice as stiff against immovable bodies: the ground carries everything that stands on it
    // (Catto 2024, Solver2D). From 2.25 times up, some bodies that carry several times their own
    // weight rock and walk away.
    contact_bias.stiff = contact_softness(Real(2));
    contact_bias.hardens = context.active.pace.hardens;
    // A light floor under heavy balls that have sunk into it would be pushed down as fast as deep
    // contacts push, hit the beams beneath as if it had fallen on them, and forget its loads
    // (remembered_blow): the balls would sink right through.
    constexpr Real calm_push = Real(0.5); // m/s
    contact_bias.push_velocity =
        context.active.pace.is_shaken ? std::min(push_velocity, calm_push) : push_velocity;
    passes.relax_bias.loaded_only = true;
    contact_bias.struck_speed = passes.relax_bias.struck_speed =
        strongest_pull(context) * static_cast<Real>(settings.dt);
    passes.particle_push = {contact_bias.softness.bias_rate, push_velocity};

    passes.holding = {.softness =
                          make_soft(static_cast<Real>(settings.joint_frequency_ratio) * rate,
                                    static_cast<Real>(settings.joint_damping_ratio), h),
                      .held_share = Real(0.5),
                      // More than four substeps push no faster than four: bodies resting on the
                      // joints are pushed too, and not all of that speed is removed again.
                      .push_share = std::min(Real(1), Real(4) * h / static_cast<Real>(settings.dt)),
                      .push_velocity = push_velocity,
                      .h = h,
                      .at_the_end = true,
                      .springs = Springs::midpoint,
                      .force_share = Real(0.5)};
    passes.relaxing = {.softness = {}, .h = h, .springs = Springs::skip, .loaded_only = true};
    return passes;
}

void prepare(StepContext &context, const Vec3 &gravity, Real h) {
    prepare_flight_columns(context, gravity, h);
    find_partners(context);
    prepare_contact_columns(context);
    prepare_contacts(context, Prepare::striking); // for their impacts
    prepare_joints(context);
    prepare_particles(context, SpringRule::midpoint);
    context.scratch.joint_system->arrange(context);
    prepare_joint_columns(context);
}

// Impacts, and the first half of the forces and remembered loads.
void begin_substep(StepContext &context, const Vec3 &gravity, Real h, bool is_first) {
    follow_loads(context, h);
    if (is_first)
        weigh_joints(context);
    else // poses are still those of the previous substep
        weigh_changed_joints(context);
    resolve_impacts(context, h);
    meet_contact_columns(context);
    if (context.active.has_particles)
        note_damper_speeds(context);
    begin_flight_columns(context, gravity, h);
    remember_joints(context);
    warm_start_joints(context, Real(0.5), Springs::midpoint);
    warm_start_contact_columns(context, Real(0.5), true);
    // Each half of the load pushes where it acts at that time; in between, friction carries a
    // rider along the chord. That is the same backwards in time, so what rolls or rocks keeps its
    // energy. With the first half in the middle it would lose some in each substep.
    turn_contact_columns(context, Real(0.5) * h);
    note_lasting_loads(context);
    if (context.active.has_particles) {
        kick_particles(context, gravity, Real(0.5) * h);
        refresh_particles(context, h, SpringRule::midpoint);
    }
}

// For the poses at the substep's end.
void hold(StepContext &context, const Passes &passes, Real h) {
    const bool has_particles = context.active.has_particles;
    push_groups(context, passes.holding);
    for (int i = 0; i < holding_passes(context); ++i) {
        solve_joints(context, passes.holding);
        for (int k = 0; has_particles && k < spring_passes(context); ++k) {
            solve_springs(context, SpringRule::midpoint);
            solve_particle_contacts(context, passes.particle_push, h);
        }
        solve_contact_columns(context, passes.contact_bias, h);
    }
    // Contacts give way, joints solved together do not: jointed bodies would be pulled apart by
    // whatever they rest on, and never come to rest.
    hold_touched_groups(context, passes.holding);
}

// The move, and the second half of the forces and loads.
void move_bodies(StepContext &context, const Vec3 &gravity, Real h) {
    const bool has_particles = context.active.has_particles;
    if (has_particles)
        note_damper_speeds(context);
    end_flight_columns(context, h);
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
}

// For the velocities there.
void relax(StepContext &context, const Passes &passes, Real h) {
    const auto once = [&] {
        solve_joints(context, passes.relaxing);
        if (context.active.has_particles)
            solve_particle_contacts(context, {.loaded_only = true}, h);
        solve_contact_columns(context, passes.relax_bias, h);
    };
    const int usual = holding_passes(context) + context.active.pace.more_relaxing;
    for (int i = 0; i < usual; ++i)
        once();
    const HitPasses after_hit = passes_after_hit(context, passes.relax_bias.struck_speed);
    for (int i = usual; i < after_hit.most && any_is_corrected(context, after_hit.until_change);
         ++i) {
        hold_touched_groups(context, passes.relaxing);
        once();
    }
    hold_touched_groups(context, passes.relaxing);
}

void end_substep(StepContext &context) {
    recall_borne(context);
    store_joint_columns(context); // the next substep's follow_loads reads them
    note_joint_loads(context);
    if (context.active.has_particles)
        restitute_particles(context, static_cast<Real>(context.settings.restitution_threshold));
}

void advance_soft_step(StepContext &context) {
    const Vec3 gravity{context.settings.gravity};
    if (context.active.is_free()) { // nothing to solve
        fly_freely(context, gravity);
        return;
    }
    const Real h = context.substep();
    Passes passes = passes_of(context, h);
    prepare(context, gravity, h);
    for (int substep = 0; substep < context.settings.substeps; ++substep) {
        // Forwards then backwards, in the next substep the other way round: a pass leaves most to
        // the points visited last, and if those were always the same they would feed slow swaying:
        // a pyramid of base 25 would never come to rest, and heavy bodies on light ones would walk.
        const bool alternates = context.active.pace.alternates;
        passes.contact_bias.backwards = alternates && substep % 2 == 1;
        passes.relax_bias.backwards = alternates && substep % 2 == 0;
        begin_substep(context, gravity, h, substep == 0);
        hold(context, passes, h);
        move_bodies(context, gravity, h);
        relax(context, passes, h);
        end_substep(context);
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
