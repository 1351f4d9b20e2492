// Sequential impulses: projected Gauss-Seidel on velocities with accumulated, warm-started
// impulses, and Baumgarte's bias against drift. Catto 2005, "Iterative Dynamics with Temporal
// Coherence"; Catto 2006, "Fast and Simple Physics using Sequential Impulses".
//
// Bodies are pushed apart by pseudo velocities: the bias is solved for by itself, from zero, moves
// the bodies and is forgotten (Cline and Pai 2003, "Post-Stabilization for Rigid Body Simulation
// with Contact and Constraints"; Box2D has tried it beside Baumgarte's). In the velocities it would
// be recalled in the next step as if it were load. Passes that cut a mode's error by a share s a
// step, with a bias of beta, then follow, in units of the step, y' = v, v' = u,
// u' = -s (u + v + beta y) for penetration, velocity and load, which grows wherever s < beta: with
// four corners a contact, five cubes rocked for ever at ten passes, and without slop at fifty.
#include "engine/dynamics/method.h"
#include "engine/dynamics/motion.h"

namespace plumb::inline PLUMB_PRECISION {

namespace {

// Pseudo velocities stand in the velocities' place, their impulses in that of the impulses: both
// are put back. They leave joints as they are.
void push_apart(StepContext &context, const ContactBias &bias, Real h) {
    if (context.scratch.contacts.empty())
        return;
    std::vector<std::array<Vec3, 2>> &velocities = context.scratch.velocities;
    velocities.clear();
    for (const std::uint32_t i : context.moving()) {
        SolverBody &body = context.bodies[i];
        velocities.push_back({body.velocity, body.angular_velocity});
        body.velocity = body.angular_velocity = Vec3{Real(0)};
    }
    refresh_joints(context);
    remember_joints(context);
    remember_contacts(context);
    const JointPass holding{.softness = {}, .h = h, .springs = Springs::skip, .skips_motors = true};
    for (int i = 0; i < context.settings.iterations; ++i) {
        solve_joints(context, holding);
        solve_contacts(context, bias, h);
    }
    drift(context, h);
    for (JointConstraint &joint : context.scratch.joints)
        joint.impulse = joint.remembered;
    for (ContactConstraint &contact : context.scratch.contacts)
        for (ContactPointConstraint &point : contact.points)
            point.impulse = point.remembered;
    for (std::size_t i = 0; i < velocities.size(); ++i) {
        SolverBody &body = context.bodies[context.moving()[i]];
        body.velocity = velocities[i][0];
        body.angular_velocity = velocities[i][1];
    }
}

void advance(StepContext &context) {
    const StepSettings &settings = context.settings;
    const auto h = static_cast<Real>(settings.dt / settings.substeps);
    const Vec3 gravity{settings.gravity};
    const Softness rigid{static_cast<Real>(settings.baumgarte) / h, Real(1), Real(0)};
    const ContactBias push{.softness = rigid,
                           .push_velocity = static_cast<Real>(settings.push_velocity),
                           .slop = static_cast<Real>(settings.penetration_slop),
                           .frictionless = true};
    const ParticlePush particle_push{rigid.bias_rate, push.push_velocity};
    const JointPass joint_pass{.softness = rigid, .h = h, .spring_time = h};

    prepare_contacts(context);
    prepare_joints(context);
    prepare_particles(context);
    for (int substep = 0; substep < settings.substeps; ++substep) {
        resolve_impacts(context, h);
        begin_flights(context, gravity, h, Kick::before);
        refresh_joints(context);
        remember_joints(context);
        remember_contacts(context);
        recall_joints(context, Real(1), Springs::solve);
        recall_contacts(context, Real(1));
        kick_particles(context, gravity, h);
        refresh_particles(context, h, SpringRule::implicit_euler);
        for (int i = 0; i < settings.iterations; ++i) {
            solve_joints(context, joint_pass);
            solve_springs(context);
            solve_particle_contacts(context, particle_push, h);
            solve_contacts(context, ContactBias{}, h);
        }
        end_flights(context, h, Kick::before);
        drift_particles(context, h);
        // Speeds that only took penetration back end with the substep.
        solve_particle_contacts(context, {.loaded_only = true}, h);
        restitute_particles(context, static_cast<Real>(settings.restitution_threshold));
        push_apart(context, push, h);
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
             .springs = true,
             .reads = {SettingGroup::constraints, SettingGroup::baumgarte, SettingGroup::impacts,
                       SettingGroup::gyroscopic},
             .defaults = {.substeps = 1, .iterations = 10}},
            advance};
}

} // namespace plumb::inline PLUMB_PRECISION
