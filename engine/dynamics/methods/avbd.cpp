// AVBD, augmented vertex block descent: Giles, Diaz, Yuksel 2025, "Augmented Vertex Block Descent",
// over Chen, Liu, Yang, Yuksel 2024, "Vertex Block Descent". An implicit Euler substep is the
// minimum of an energy: inertia about the body's free-flight pose, plus one augmented Lagrangian
// term per row (augmented_rows.h). A pass goes from body to body and moves each to the minimum of
// the energy as a function of its pose alone, with the others held (eqs. 4 to 6, 13 and 17); then
// each row's load becomes the force it pushed with, and its stiffness grows with its error (eqs.
// 11, 12 and 16). Loads and stiffnesses are remembered (eq. 19), and part of an error that was
// there before is left alone (eq. 18), so that correcting it does not turn into speed. Velocities
// follow from the change in pose.
//
// First order and dissipative, like implicit Euler. As published except: stiffness is relative to
// the mass that a row moves (settings.h: penalty_start), not in N/m, so that the same settings fit
// grams and tons; a particle's springs start with their own stiffness, as in VBD, and its contacts
// with nothing remembered; for the first guess, a body's fall is computed from gravity and the
// remembered loads; bounces, which the paper lacks, are TGS Soft's; gyroscopic spin uses the
// implicit rule that all methods share.
#include "engine/core/renew.h"
#include "engine/dynamics/bodies/motion.h"
#include "engine/dynamics/method.h"
#include "engine/dynamics/methods/parts/pose_correction.h"

#include <algorithm>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

void stiffen(StepContext &context, const Stiffening &stiffening) {
    SolverScratch &s = context.scratch;
    Descent &d = s.descent;
    for (std::size_t k = 0; k < joint_count(context); ++k) {
        if (blocks_of(context, k).empty())
            continue;
        refresh_joint(context, k);
        for (JointConstraint &joint : blocks_of(context, k))
            joint.impulse = end_pass(augmented(context, joint), joint.rows,
                                     driven(context, joint, stiffening.h), stiffening);
    }
    for (std::size_t i = 0; i < s.particle_contacts.size(); ++i) {
        const ParticleContactConstraint &row = s.particle_contacts[i];
        end_pass(d.particle_contacts[i], way_of(context, row, stiffening.h),
                 context.particle_contacts[row.contact].friction, stiffening);
    }
    for (std::size_t i = 0; i < s.contacts.size(); ++i)
        for (std::size_t k = 0; k < static_cast<std::size_t>(s.contacts[i].count); ++k)
            end_pass(d.contacts[i][k],
                     way_of(context, s.contacts[i], s.contacts[i].points[k], stiffening.h),
                     s.contacts[i].friction, stiffening);
}

// ---- the substep

// Starts from the last step's loads and stiffnesses.
void warm_start(StepContext &context, Real h) {
    SolverScratch &s = context.scratch;
    Descent &d = s.descent;
    renew(d.blocks, s.joints.size());
    for (JointConstraint &joint : s.joints) {
        AugmentedBlock &block = augmented(context, joint);
        joint.impulse /= h;
        block.load = joint.impulse;
        if (joint.joint != JointConstraint::grab)
            for (int i = 0; i < joint.rows.count; ++i)
                block.stiffness[i] =
                    context.joint_penalties[joint.joint]
                                           [joint.rows.first_memory + static_cast<std::size_t>(i)];
    }
    renew(d.contacts, s.contacts.size());
    for (std::size_t i = 0; i < s.contacts.size(); ++i)
        for (std::size_t k = 0; k < static_cast<std::size_t>(s.contacts[i].count); ++k) {
            const ContactPointConstraint &from = s.contacts[i].points[k];
            d.contacts[i][k] = {.penalty = context.point_penalties[s.contacts[i].contact][k],
                                .unit_normal = from.normal_mass / (h * h),
                                .unit_tangential = from.tangent_mass / (h * h),
                                .load = from.impulse / h};
        }
    d.particle_contacts.resize(s.particle_contacts.size());
}

// Each body's acceleration from the loads.
void accelerate(StepContext &context, std::vector<Vec3> &accelerations) {
    SolverScratch &s = context.scratch;
    renew(accelerations, context.bodies.size(), Vec3{Real(0)});
    const auto push = [&](std::uint32_t body, const Vec3 &force) {
        if (body != Joint::world)
            accelerations[body] += context.bodies[body].inv_mass * force;
    };
    for (const JointConstraint &joint : s.joints) {
        if (joint.rows.kind == RowKind::angular)
            continue;
        const Vec3 force = along(joint.rows, joint.impulse);
        push(joint.a, -force);
        push(joint.b, force);
    }
    for (std::size_t i = 0; i < s.contacts.size(); ++i)
        for (const AugmentedPoint &point : s.descent.contacts[i]) {
            const Vec3 force = point.load.x * s.contacts[i].normal +
                               point.load.y * s.contacts[i].tangents.t1 +
                               point.load.z * s.contacts[i].tangents.t2;
            push(s.contacts[i].a, -force);
            push(s.contacts[i].b, force);
        }
}

// Begins all rows at the present poses.
void begin_rows(StepContext &context, const Stiffening &stiffening) {
    SolverScratch &s = context.scratch;
    Descent &d = s.descent;
    for (std::size_t k = 0; k < joint_count(context); ++k) {
        if (blocks_of(context, k).empty())
            continue;
        refresh_joint(context, k);
        for (JointConstraint &joint : blocks_of(context, k))
            begin_block(augmented(context, joint), joint.rows, context.body(joint.a),
                        context.body(joint.b), stiffening);
    }
    d.start_lengths.clear();
    for (const SpringConstraint &row : s.springs) {
        const Spring &spring = context.model.springs[row.spring];
        d.start_lengths.push_back(
            glm::distance(spring_point(spring.a, context.bodies, context.particles).position,
                          spring_point(spring.b, context.bodies, context.particles).position));
    }
    for (std::size_t i = 0; i < s.particle_contacts.size(); ++i) {
        ParticleContactConstraint &row = s.particle_contacts[i];
        const ParticleContact &contact = context.particle_contacts[row.contact];
        const SolverBody &body = context.bodies[contact.body];
        const ParticleMotion &particle = context.particles[contact.particle];
        row.arm = particle.position - body.position;
        row.approach = glm::dot(particle.velocity - body.velocity_at(row.arm), contact.normal);
        const Vec3 turning = glm::cross(row.arm, contact.normal);
        const Real inverse = context.model.particles[contact.particle].inv_mass +
                             body.inv_mass_along(contact.normal) +
                             glm::dot(body.inv_inertia * turning, turning);
        row.normal_mass = inverse > Real(0) ? Real(1) / inverse : Real(0);
        const Real unit = row.normal_mass / (stiffening.h * stiffening.h);
        d.particle_contacts[i] = {.penalty = {}, .unit_normal = unit, .unit_tangential = unit};
        begin_point(d.particle_contacts[i],
                    glm::dot(row.arm - body.rotation * contact.anchor, contact.normal) -
                        context.model.particles[contact.particle].radius,
                    stiffening);
    }
    for (std::size_t i = 0; i < s.contacts.size(); ++i)
        for (std::size_t k = 0; k < static_cast<std::size_t>(s.contacts[i].count); ++k)
            begin_point(d.contacts[i][k],
                        present_separation(s.contacts[i], s.contacts[i].points[k],
                                           context.bodies[s.contacts[i].a],
                                           context.bodies[s.contacts[i].b]),
                        stiffening);
}

// Moves everything to the first guess. Gravity counts only as far as the body fell with it in the
// last substep (Chen et al. 2024, sec. 3.7, adaptive initialisation).
void predict(StepContext &context, const std::vector<Vec3> &accelerations, const Vec3 &gravity,
             Real h) {
    Descent &d = context.scratch.descent;
    for (const std::uint32_t i : context.moving()) {
        SolverBody &body = context.bodies[i];
        const Body &model = context.model.bodies[i];
        if (model.kind == BodyKind::dynamic) {
            DescentBody &own = d.bodies[d.place[i]];
            own.free_velocity = body.velocity;
            own.free_spin = body.angular_velocity;
            own.start = body.rotation;
            own.turn = own.free_turn = turned(identity_rotation, body.angular_velocity, h);
            const Vec3 pull = pull_on(model, gravity);
            const Real squared = glm::dot(pull, pull);
            if (squared > Real(0) && !uses_of(d.body_uses, d.place[i]).empty()) {
                const Real felt = glm::dot(pull + accelerations[i], pull) / squared;
                body.velocity -= (Real(1) - std::clamp(felt, Real(0), Real(1))) * h * pull;
            }
        }
        body.position += h * body.velocity;
        body.turned = h * body.angular_velocity;
        body.rotation = turned(body.rotation, body.angular_velocity, h);
        if (model.kind == BodyKind::dynamic)
            d.bodies[d.place[i]].inertia = world_inverse_inertia(body.rotation, model.inertia);
    }
    d.free_velocities.clear();
    if (context.active.has_particles)
        for (ParticleMotion &motion : context.particles) {
            d.free_velocities.push_back(motion.velocity);
            motion.position += h * motion.velocity;
        }
    context.report.body_passes += context.moving().size() + d.free_velocities.size();
}

void end(StepContext &context, Real h) {
    SolverScratch &s = context.scratch;
    Descent &d = s.descent;
    for (std::size_t i = 0; i < d.bodies.size(); ++i) {
        DescentBody &own = d.bodies[i];
        SolverBody &body = context.bodies[own.body];
        const Body &model = context.model.bodies[own.body];
        if (uses_of(d.body_uses, i).empty())
            body.angular_velocity = own.free_spin;
        else
            body.angular_velocity = body.turned / h;
        for (int axis = 0; axis < 3; ++axis)
            if (model.locked[static_cast<std::size_t>(axis) + 3])
                body.angular_velocity[axis] = Real(0);
        if (!is_isotropic(model.inertia))
            body.inv_inertia = solver_inverse_inertia(model, body.rotation);
    }
    for (std::size_t i = 0; i < s.contacts.size(); ++i)
        for (std::size_t k = 0; k < static_cast<std::size_t>(s.contacts[i].count); ++k) {
            ContactPointConstraint &point = s.contacts[i].points[k];
            end_point(d.contacts[i][k], way_of(context, s.contacts[i], point, h),
                      s.contacts[i].friction);
            point.impulse = h * d.contacts[i][k].load;
        }
    for (std::size_t i = 0; i < s.particle_contacts.size(); ++i)
        s.particle_contacts[i].impulse = h * d.particle_contacts[i].load;
    context.report.body_passes += d.bodies.size();
}

void store(StepContext &context, Real h) {
    SolverScratch &s = context.scratch;
    for (JointConstraint &joint : s.joints) {
        joint.impulse *= h;
        if (joint.joint != JointConstraint::grab)
            for (int i = 0; i < joint.rows.count; ++i)
                context.joint_penalties[joint.joint]
                                       [joint.rows.first_memory + static_cast<std::size_t>(i)] =
                    augmented(context, joint).stiffness[i];
    }
    for (std::size_t i = 0; i < s.contacts.size(); ++i)
        for (std::size_t k = 0; k < static_cast<std::size_t>(s.contacts[i].count); ++k)
            context.point_penalties[s.contacts[i].contact][k] = s.descent.contacts[i][k].penalty;
    store_joints(context);
    store_contacts(context);
}

void advance_avbd(StepContext &context) {
    const StepSettings &settings = context.settings;
    const Real h = context.substep();
    const Vec3 gravity{settings.gravity};
    const auto threshold = static_cast<Real>(settings.restitution_threshold);
    const Stiffening stiffening{.h = h,
                                .start = static_cast<Real>(settings.penalty_start),
                                .growth = static_cast<Real>(settings.penalty_growth),
                                .limit = static_cast<Real>(settings.penalty_limit),
                                .kept = static_cast<Real>(settings.penalty_kept),
                                .kept_error = static_cast<Real>(settings.error_kept)};
    SolverScratch &s = context.scratch;

    prepare_contacts(context);
    prepare_joints(context);
    prepare_particles(context);
    gather_uses(context);
    warm_start(context, h);
    note_approach(context);
    for (int substep = 0; substep < settings.substeps; ++substep) {
        accelerate(context, s.contact_impulses);
        begin_rows(context, stiffening);
        kick(context, gravity, h);
        kick_particles(context, gravity, h);
        pull_particle(context, h);
        predict(context, s.contact_impulses, gravity, h);
        for (int i = 0; i < settings.iterations; ++i) {
            descend(context, stiffening);
            stiffen(context, stiffening);
            context.report.constraint_passes +=
                s.contacts.size() + s.joints.size() + s.springs.size() + s.particle_contacts.size();
        }
        end(context, h);
        note_joint_loads(context, h);
        restitute_particles(context, threshold);
        note_loads(context);
    }
    store(context, h);
    restitute(context, threshold);
}

} // namespace

Method avbd() {
    return {{.name = "avbd",
             .title = "AVBD",
             .source = "Giles, Diaz, Yuksel 2025, Augmented Vertex Block Descent",
             .contacts = true,
             .joints = true,
             .springs = true,
             .reads = {SettingGroup::constraints, SettingGroup::speculative,
                       SettingGroup::threshold, SettingGroup::gyroscopic, SettingGroup::penalty},
             .defaults = {.substeps = 1, .iterations = 10}},
            advance_avbd};
}

} // namespace plumb::inline PLUMB_PRECISION
