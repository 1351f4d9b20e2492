// XPBD for rigid bodies: Mueller, Macklin, Chentanez, Jeschke, Kim 2020, "Detailed Rigid Body
// Simulation with Extended Position Based Dynamics", algorithm 2, and Macklin, Mueller, Chentanez
// 2016, "XPBD: Position-Based Simulation of Compliant Constrained Dynamics", eqs. (18) and (26) for
// compliant constraints. Poses are predicted, then corrected by each constraint in turn, along its
// direction at the present poses; velocities follow from the change in pose over the substep and
// are then corrected for dynamic friction and restitution. Nothing is remembered from substep to
// substep.
//
// First order and dissipative: a joint that turns loses energy because its direction is taken at
// the predicted pose, and a spin because it turns by the normalised quaternion. As published
// except: friction's bound is an impulse here (the paper's mixes it with a speed; Catto 2024,
// "Solver2D", notes the same); restitution_threshold replaces the paper's 2 |g| h; gyroscopic spin
// uses the implicit rule that all methods share.
#include "engine/dynamics/bodies/motion.h"
#include "engine/dynamics/method.h"
#include "engine/dynamics/methods/parts/pose_correction.h"

#include <algorithm>
#include <numbers>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

void predict(StepContext &context, Real h) {
    for (const std::uint32_t i : context.moving()) {
        SolverBody &body = context.bodies[i];
        body.position += h * body.velocity;
        body.turned = Vec3{Real(0)};
        turn_pose(body, h * body.angular_velocity);
        const Body &model = context.model.bodies[i];
        if (model.kind == BodyKind::dynamic && !is_isotropic(model.inertia))
            body.inv_inertia = solver_inverse_inertia(model, body.rotation);
    }
    drift_particles(context, h);
    context.report.body_passes += context.moving().size();
}

void derive_spins(StepContext &context, Real h) {
    for (const std::uint32_t i : context.moving()) {
        SolverBody &body = context.bodies[i];
        const Body &model = context.model.bodies[i];
        if (model.kind != BodyKind::dynamic)
            continue;
        body.angular_velocity = Real(2) / h * body.turned;
        for (int axis = 0; axis < 3; ++axis) // turns about the others add up to one about this
            if (model.locked[static_cast<std::size_t>(axis) + 3])
                body.angular_velocity[axis] = Real(0);
    }
    context.report.body_passes += context.moving().size();
}

void correct(const RowBlock &rows, SolverBody &a, SolverBody &b, const Vec3 &p, Real h) {
    if (rows.kind == RowKind::angular) {
        turn_pose(a, -(a.inv_inertia * p));
        turn_pose(b, b.inv_inertia * p);
    } else {
        shift_poses(a, b, rows.r_a, rows.r_b, p, h);
    }
}

// All rigid rows together, along their error: the paper's vector constraints.
void solve_rigid(JointConstraint &joint, SolverBody &a, SolverBody &b, Real h) {
    Vec3 error = joint.rows.error;
    if (joint.rows.bounds == RowBounds::at_least)
        error.x = std::min(error.x, Real(0));
    if (joint.rows.bounds == RowBounds::at_most)
        error.x = std::max(error.x, Real(0));
    const Real size = glm::length(error);
    if (size == Real(0))
        return;
    const Real inverse = inverse_effective_mass(joint.rows, a, b, along(joint.rows, error / size));
    if (!(inverse > Real(0)))
        return;
    const Vec3 change = error / -inverse;
    joint.impulse += change;
    correct(joint.rows, a, b, along(joint.rows, change), h);
}

// One row of a spring; its frequency and damping are those of the mass that it moves.
void solve_spring(JointConstraint &joint, SolverBody &a, SolverBody &b, int row, Real h) {
    const RowBlock &rows = joint.rows;
    const Real error = rows.error[row];
    if ((rows.bounds == RowBounds::at_least && error > Real(0)) ||
        (rows.bounds == RowBounds::at_most && error < Real(0)))
        return; // slack
    Vec3 unit{Real(0)};
    unit[row] = Real(1);
    const Vec3 n = along(rows, unit);
    const Real inverse = inverse_effective_mass(rows, a, b, n);
    if (!(inverse > Real(0)))
        return;
    const Real turn = Real(2) * std::numbers::pi_v<Real> * rows.frequency * h;
    const Compliance compliance{turn * turn / inverse,
                                Real(2) * rows.damping_ratio * turn / inverse};
    const Real change = rows.kind == RowKind::angular
                            ? Real(2) * glm::dot(n, b.turned - a.turned)
                            : glm::dot(n, way_between(a, b, rows.r_a, rows.r_b, h));
    Vec3 total = joint.impulse;
    total[row] += multiplier(error, change, total[row], inverse, compliance);
    const Real limit = rows.max_force * h * h;
    const Real length = glm::length(total);
    if (rows.bounds == RowBounds::pull && length > limit)
        total *= limit / length;
    correct(rows, a, b, along(rows, total - joint.impulse), h);
    joint.impulse = total;
}

// Calls use(joint, a, b, refresh) for each block; refresh() reads its rows at the present poses.
template <typename Use> void for_each_block(StepContext &context, Use &&use) {
    for (std::size_t k = 0; k < joint_count(context); ++k)
        for (JointConstraint &joint : blocks_of(context, k))
            use(joint, context.body(joint.a), context.body(joint.b),
                [&] { refresh_joint(context, k); });
    context.report.constraint_passes += context.scratch.joints.size();
}

void solve_joint_poses(StepContext &context, Real h) {
    for_each_block(context,
                   [&](JointConstraint &joint, SolverBody &a, SolverBody &b, const auto &refresh) {
                       if (joint.rows.bounds == RowBounds::motor)
                           return;
                       if (joint.is_spring()) {
                           for (int row = 0; row < joint.rows.count; ++row) {
                               refresh();
                               solve_spring(joint, a, b, row, h);
                           }
                           return;
                       }
                       refresh();
                       solve_rigid(joint, a, b, h);
                   });
}

// Motors act on velocities, limited to their force over a substep.
void solve_motors(StepContext &context, Real h) {
    for_each_block(context, [&](JointConstraint &joint, SolverBody &a, SolverBody &b,
                                const auto &refresh) {
        if (joint.rows.bounds != RowBounds::motor)
            return;
        refresh();
        const RowBlock &rows = joint.rows;
        const Vec3 &n = rows.axes[0];
        const bool is_angular = rows.kind == RowKind::angular;
        const Real inverse = inverse_effective_mass(rows, a, b, n);
        if (!(inverse > Real(0)))
            return;
        const Vec3 speed = is_angular ? b.angular_velocity - a.angular_velocity
                                      : b.velocity_at(rows.r_b) - a.velocity_at(rows.r_a);
        const Real limit = rows.max_force * h;
        const Real impulse = std::clamp((rows.speed - glm::dot(n, speed)) / inverse, -limit, limit);
        joint.impulse.x = h * impulse;
        if (is_angular) {
            a.apply_angular_impulse(-impulse * n);
            b.apply_angular_impulse(impulse * n);
        } else {
            a.apply_impulse(-impulse * n, rows.r_a);
            b.apply_impulse(impulse * n, rows.r_b);
        }
    });
}

// Clears accumulated impulses and notes approach speeds.
void begin(StepContext &context) {
    remember_joints(context);
    remember_contacts(context);
    note_approach(context);
    begin_particle_corrections(context);
}

// Stores the last substep's lambdas as impulses.
void store(StepContext &context, Real h) {
    for (JointConstraint &joint : context.scratch.joints)
        joint.impulse /= h;
    for (ContactConstraint &contact : context.scratch.contacts)
        for (ContactPointConstraint &point : contact.points)
            point.impulse /= h;
    store_joints(context);
    store_contacts(context);
}

void advance_xpbd(StepContext &context) {
    const StepSettings &settings = context.settings;
    const Real h = context.substep();
    const Vec3 gravity{settings.gravity};

    prepare_contacts(context);
    prepare_joints(context);
    prepare_particles(context);
    for (int substep = 0; substep < settings.substeps; ++substep) {
        kick(context, gravity, h);
        kick_particles(context, gravity, h);
        pull_particle(context, h);
        begin(context);
        predict(context, h);
        for (int i = 0; i < settings.iterations; ++i) {
            solve_joint_poses(context, h);
            solve_spring_poses(context, h);
            solve_particle_contact_poses(context, h);
            solve_contact_poses(context, h);
        }
        derive_spins(context, h);
        solve_motors(context, h);
        solve_particle_contact_velocities(context, h);
        solve_contact_velocities(context, h);
        note_joint_loads(context, Real(1) / h);
    }
    store(context, h);
}

} // namespace

Method xpbd() {
    return {{.name = "xpbd",
             .title = "XPBD",
             .source = "Mueller et al. 2020, Detailed Rigid Body Simulation with XPBD",
             .contacts = true,
             .joints = true,
             .springs = true,
             .reads = {SettingGroup::constraints, SettingGroup::speculative,
                       SettingGroup::threshold, SettingGroup::gyroscopic},
             .defaults = {.substeps = 20, .iterations = 1}},
            advance_xpbd};
}

} // namespace plumb::inline PLUMB_PRECISION
