// The step shared by methods that solve for impulses in repeated passes over all rows. Penetration
// is pushed out and joint drift pulled in, by pseudo velocities or through the velocities. How the
// passes are combined is up to the method.
//
// By pseudo velocities (split_impulse): the bias is solved for separately, from zero, moves the
// bodies and is then forgotten (Cline and Pai 2003, "Post-Stabilization for Rigid Body Simulation
// with Contact and Constraints"; Box2D has tried it beside Baumgarte's). In the velocities it would
// be warm started in the next step like a load. Passes that cut a mode's error by a share s per
// step, with a bias of beta, then follow y' = v, v' = u, u' = -s (u + v + beta y), in units of the
// step, for penetration, velocity and load. That grows wherever s < beta: with four corners per
// contact, six cubes rock for ever at ten passes.
//
// Joints are still corrected through the velocities unless split_impulse is 2, at about half the
// cost. For steps shorter than baumgarte_time, beta shrinks with the step, so that Baumgarte's rate
// (1972) does not grow: otherwise a chain whose joints propagate errors slowly would gain more
// energy the shorter the step. The distance by which anchors would leave their circles is removed
// beforehand (foresee_turns): with a bias alone a pendulum hangs where its drift has grown enough
// to balance it. With pseudo velocities for joints nothing is foreseen: no chain gains energy then,
// but swinging bodies, pulled back along chords, lose three times as much.
#pragma once

#include "engine/dynamics/bodies/motion.h"
#include "engine/dynamics/method.h"

#include <algorithm>
#include <cstdint>

namespace plumb::inline PLUMB_PRECISION {

enum class PointOrder : std::uint8_t { forwards, backwards };

inline ContactBias in_order(ContactBias bias, PointOrder order) {
    bias.backwards = order == PointOrder::backwards;
    return bias;
}

// Pseudo velocities and their impulses temporarily replace the real ones, which are restored at the
// end. Springs, motors and particles are left out. They start from zero each time, so the effect of
// a point order does not build up: with alternating orders here, too, ten cubes fell after 50 s.
template <typename Solve>
void correct_poses(StepContext &context, const ContactBias &bias, const Softness &pull, Real h,
                   Solve &&solve) {
    SolverScratch &s = context.scratch;
    if (s.contacts.empty() && (s.joints.empty() || pull.bias_rate == Real(0)))
        return;
    s.velocities.clear();
    s.joint_impulses.clear();
    s.contact_impulses.clear();
    for (const std::uint32_t i : context.moving()) {
        SolverBody &body = context.bodies[i];
        s.velocities.push_back({body.velocity, body.angular_velocity});
        body.velocity = body.angular_velocity = Vec3{Real(0)};
    }
    refresh_joints(context);
    for (JointConstraint &joint : s.joints) {
        s.joint_impulses.push_back(joint.impulse);
        joint.impulse = Vec3{Real(0)};
        joint.turning = Vec3{Real(0)};
    }
    for (ContactConstraint &contact : s.contacts)
        for (ContactPointConstraint &point : contact.points) {
            s.contact_impulses.push_back(point.impulse);
            point.impulse = Vec3{Real(0)};
        }
    const JointPass pulling{
        .softness = pull, .h = h, .springs = Springs::skip, .skips_motors = true};
    refresh_separations(context);
    solve([&](PointOrder) {
        solve_joints(context, pulling);
        solve_contacts(context, bias, h);
    });
    drift(context, h);
    auto joint_impulse = s.joint_impulses.begin();
    for (JointConstraint &joint : s.joints)
        joint.impulse = *joint_impulse++;
    auto contact_impulse = s.contact_impulses.begin();
    for (ContactConstraint &contact : s.contacts)
        for (ContactPointConstraint &point : contact.points)
            point.impulse = *contact_impulse++;
    for (std::size_t i = 0; i < s.velocities.size(); ++i) {
        SolverBody &body = context.bodies[context.moving()[i]];
        body.velocity = s.velocities[i][0];
        body.angular_velocity = s.velocities[i][1];
    }
}

// The settings that advance_by_impulses reads.
inline std::vector<SettingGroup> read_by_impulses() {
    return {SettingGroup::constraints, SettingGroup::speculative, SettingGroup::baumgarte,
            SettingGroup::split,       SettingGroup::additions,   SettingGroup::push,
            SettingGroup::threshold,   SettingGroup::impacts,     SettingGroup::gyroscopic};
}

// The velocities that gravity and spin alone lead to; and what is left of the substep after the
// solver.
inline void begin_motion(StepContext &context, const Vec3 &gravity, Real h) {
    if (context.settings.closed_form_flight != 0)
        begin_flights(context, gravity, h);
    else
        kick(context, gravity, h);
}
inline void end_motion(StepContext &context, Real h) {
    if (context.settings.closed_form_flight != 0)
        end_flights(context, h);
    else
        drift(context, h);
}

// `solve` gets a pass over all rows and may call it any number of times, with each contact's points
// in either order.
template <typename Solve> void advance_by_impulses(StepContext &context, Solve &&solve) {
    const StepSettings &settings = context.settings;
    const Real h = context.substep();
    const Vec3 gravity{settings.gravity};
    const Softness rigid{static_cast<Real>(settings.baumgarte) / h, Real(1), Real(0)};
    const Softness gentle{static_cast<Real>(settings.baumgarte) /
                              std::max(h, static_cast<Real>(settings.baumgarte_time)),
                          Real(1), Real(0)};
    const bool splits = settings.split_impulse >= 1;
    const bool splits_joints = settings.split_impulse == 2;
    const bool foresees = settings.foresee_turns != 0 && !splits_joints;
    const bool bounces_at_the_end = settings.impact_sweeps == 0;
    const ContactBias push{.softness = rigid,
                           .push_velocity = static_cast<Real>(settings.push_velocity),
                           .slop = static_cast<Real>(settings.penetration_slop),
                           .frictionless = splits,
                           .stiff = rigid};
    const ParticlePush particle_push{rigid.bias_rate, push.push_velocity};
    const JointPass joint_pass{.softness = splits_joints ? Softness{} : gentle, .h = h};
    const ContactBias contact_bias = splits ? ContactBias{} : push;

    prepare_contacts(context);
    prepare_joints(context);
    prepare_particles(context);
    if (bounces_at_the_end)
        note_approach(context);
    for (int substep = 0; substep < settings.substeps; ++substep) {
        resolve_impacts(context, h);
        begin_motion(context, gravity, h);
        refresh_joints(context);
        remember_joints(context);
        remember_contacts(context);
        warm_start_joints(context, Real(1), Springs::at_the_end);
        warm_start_contacts(context, Real(1));
        if (foresees)
            foresee_turns(context, h);
        kick_particles(context, gravity, h);
        refresh_particles(context, h, SpringRule::implicit_euler);
        refresh_separations(context);
        solve([&](PointOrder order) {
            solve_joints(context, joint_pass);
            solve_springs(context);
            solve_particle_contacts(context, particle_push, h);
            solve_contacts(context, in_order(contact_bias, order), h);
        });
        note_joint_loads(context);
        end_motion(context, h);
        drift_particles(context, h);
        // Speeds that only removed penetration end with the substep.
        solve_particle_contacts(context, {.loaded_only = true}, h);
        restitute_particles(context, static_cast<Real>(settings.restitution_threshold));
        if (splits)
            correct_poses(context, push, splits_joints ? rigid : Softness{}, h, solve);
        if (bounces_at_the_end)
            note_loads(context);
    }
    if (bounces_at_the_end)
        restitute(context, static_cast<Real>(settings.restitution_threshold));
    store_joints(context);
    store_contacts(context);
}

} // namespace plumb::inline PLUMB_PRECISION
