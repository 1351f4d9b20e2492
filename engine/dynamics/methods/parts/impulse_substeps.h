// The step that methods share which solve for impulses by repeated passes over all rows:
// what overlaps is pushed apart and what has come apart is pulled together, by pseudo velocities or
// through the velocities. How the passes are put together is the method's.
//
// By pseudo velocities (split_impulse): the bias is solved for by itself, from zero, moves the
// bodies and is forgotten (Cline and Pai 2003, "Post-Stabilization for Rigid Body Simulation
// with Contact and Constraints"; Box2D has tried it beside Baumgarte's). In the velocities it would
// be warm started in the next step as if it were load. Passes that cut a mode's error by a share s
// a step, with a bias of beta, then follow, in units of the step, y' = v, v' = u, u' = -s (u + v +
// beta y) for penetration, velocity and load, which grows wherever s < beta: with four corners a
// contact, six cubes rock for ever at ten passes.
//
// Joints are corrected through the velocities all the same, unless asked, at about half the cost.
// So that a chain whose joints propagate errors slowly does not gain the more energy the shorter
// the step, beta shrinks with a step of less than a 60th of a second: Baumgarte's rate (1972) does
// not grow. What anchors are to leave their circles by is taken off beforehand (foresee_turns), not
// waited for: a bias alone holds a pendulum where its drift has grown enough to make up for it.
// Beside pseudo velocities nothing is foreseen: no chain gains energy then, but what swings, pulled
// back along chords, loses three times as much.
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

// Pseudo velocities stand in the velocities' place, their impulses in that of the impulses: both
// are put back. Springs, motors and particles know nothing of them. They start from zero each time,
// so that no order of points lasts: turned round as well, ten cubes fell after 50 s.
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

// Of the settings, in `advance_by_impulses`.
inline std::vector<SettingGroup> read_by_impulses() {
    return {SettingGroup::constraints, SettingGroup::speculative, SettingGroup::baumgarte,
            SettingGroup::split,       SettingGroup::push,        SettingGroup::threshold,
            SettingGroup::impacts,     SettingGroup::gyroscopic};
}

// `solve` is called with a pass over all rows, and may do it as often as it likes, with the points
// of each contact in either order.
template <typename Solve> void advance_by_impulses(StepContext &context, Solve &&solve) {
    const StepSettings &settings = context.settings;
    const Real h = context.substep();
    const Vec3 gravity{settings.gravity};
    const Softness rigid{static_cast<Real>(settings.baumgarte) / h, Real(1), Real(0)};
    constexpr Real baumgarte_time = Real(1) / Real(60); // s
    const Softness gentle{static_cast<Real>(settings.baumgarte) / std::max(h, baumgarte_time),
                          Real(1), Real(0)};
    const bool splits = settings.split_impulse >= 1;
    const bool splits_joints = settings.split_impulse == 2;
    const ContactBias push{.softness = rigid,
                           .push_velocity = static_cast<Real>(settings.push_velocity),
                           .slop = static_cast<Real>(settings.penetration_slop),
                           .frictionless = splits,
                           .on_static = rigid};
    const ParticlePush particle_push{rigid.bias_rate, push.push_velocity};
    const JointPass joint_pass{.softness = splits_joints ? Softness{} : gentle, .h = h};
    const ContactBias contact_bias = splits ? ContactBias{} : push;

    prepare_contacts(context);
    prepare_joints(context);
    prepare_particles(context);
    for (int substep = 0; substep < settings.substeps; ++substep) {
        resolve_impacts(context, h);
        begin_flights(context, gravity, h, Kick::before);
        refresh_joints(context);
        remember_joints(context);
        remember_contacts(context);
        warm_start_joints(context, Real(1), Springs::at_the_end);
        warm_start_contacts(context, Real(1));
        if (!splits_joints)
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
        end_flights(context, h, Kick::before);
        drift_particles(context, h);
        // Speeds that only took penetration back end with the substep.
        solve_particle_contacts(context, {.loaded_only = true}, h);
        restitute_particles(context, static_cast<Real>(settings.restitution_threshold));
        if (splits)
            correct_poses(context, push, splits_joints ? rigid : Softness{}, h, solve);
    }
    store_joints(context);
    store_contacts(context);
}

} // namespace plumb::inline PLUMB_PRECISION
