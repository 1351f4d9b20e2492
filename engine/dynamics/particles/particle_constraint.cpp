#include "engine/dynamics/particles/particle_constraint.h"

#include "engine/dynamics/bodies/motion.h"
#include "engine/dynamics/method.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

Vec3 relative_velocity(const StepContext &context, const ParticleContact &contact,
                       const ParticleContactConstraint &row) {
    return context.particles[contact.particle].velocity -
           context.bodies[contact.body].velocity_at(row.arm);
}

void apply(StepContext &context, const ParticleContact &contact,
           const ParticleContactConstraint &row, const Vec3 &impulse) {
    context.particles[contact.particle].velocity +=
        context.model.particles[contact.particle].inv_mass * impulse;
    context.bodies[contact.body].apply_impulse(-impulse, row.arm);
}

Real separation_of(const StepContext &context, const ParticleContact &contact) {
    const SolverBody &body = context.bodies[contact.body];
    const Vec3 gap = (context.particles[contact.particle].position - body.position) -
                     body.rotation * contact.anchor;
    return glm::dot(gap, contact.normal) - context.model.particles[contact.particle].radius;
}

// The approach speed at impact, from the speed after `kicked` seconds of gravity and the
// separation: by energy, v^2 - 2 a s, so that a bounce neither gains nor loses energy by when in
// the substep it happens. Semi-implicit Euler, which has added gravity for all of h, follows a
// parabola whose speed is halfway between before and after: for it, too, that is h / 2.
Real approach_of(const StepContext &context, const ParticleContact &contact,
                 const ParticleContactConstraint &row, Real kicked) {
    const Vec3 gravity{context.settings.gravity};
    const auto pull_at = [&](const Vec3 &position) {
        return gravity + attraction(context.model.attractors, position);
    };
    const Real pull = glm::dot(pull_at(context.particles[contact.particle].position) -
                                   pull_on(context.model.bodies[contact.body],
                                           pull_at(context.bodies[contact.body].position)),
                               contact.normal);
    const Real speed =
        glm::dot(relative_velocity(context, contact, row), contact.normal) - kicked * pull;
    const Real squared = speed * speed - Real(2) * pull * std::max(row.separation, Real(0));
    return speed < Real(0) ? -std::sqrt(std::max(squared, Real(0))) : speed;
}

void refresh(StepContext &context, ParticleContactConstraint &row, Real kicked) {
    const ParticleContact &contact = context.particle_contacts[row.contact];
    const SolverBody &body = context.bodies[contact.body];
    const Real inv_mass = context.model.particles[contact.particle].inv_mass;
    row.arm = context.particles[contact.particle].position - body.position;
    row.separation = separation_of(context, contact);
    row.impulse = Vec3{Real(0)};
    const auto coupling = [&](const Vec3 &u, const Vec3 &v) {
        const Real linear = glm::dot(u, body.inv_mass * v) + inv_mass * glm::dot(u, v);
        return linear + glm::dot(body.inv_inertia * glm::cross(row.arm, u), glm::cross(row.arm, v));
    };
    const Real normal = coupling(contact.normal, contact.normal);
    row.normal_mass = normal > Real(0) ? Real(1) / normal : Real(0);
    const Real k11 = coupling(row.tangents.t1, row.tangents.t1);
    const Real k12 = coupling(row.tangents.t1, row.tangents.t2);
    const Real k22 = coupling(row.tangents.t2, row.tangents.t2);
    const Real half = Real(0.5) * (k11 - k22);
    const Real largest = Real(0.5) * (k11 + k22) + std::sqrt(half * half + k12 * k12);
    row.tangent_mass = largest > Real(0) ? Real(1) / largest : Real(0);
    row.approach = approach_of(context, contact, row, kicked);
}

void solve_friction(StepContext &context, const ParticleContact &contact,
                    ParticleContactConstraint &row) {
    const Vec3 v = relative_velocity(context, contact, row);
    Vec2 total{row.impulse.y - row.tangent_mass * glm::dot(v, row.tangents.t1),
               row.impulse.z - row.tangent_mass * glm::dot(v, row.tangents.t2)};
    const Real limit = contact.friction * row.impulse.x;
    const Real length = glm::length(total);
    if (length > limit)
        total *= limit / length;
    const Vec3 change =
        (total.x - row.impulse.y) * row.tangents.t1 + (total.y - row.impulse.z) * row.tangents.t2;
    row.impulse.y = total.x;
    row.impulse.z = total.y;
    apply(context, contact, row, change);
}

} // namespace

void prepare_particles(StepContext &context, SpringRule rule) {
    SolverScratch &s = context.scratch;
    s.springs.clear();
    s.spring_schedule.springs.clear();
    s.particle_contacts.clear();
    if (!context.active.has_particles)
        return;
    prepare_springs(context, rule);
    for (std::uint32_t i = 0; i < context.particle_contacts.size(); ++i) {
        ParticleContactConstraint &row = s.particle_contacts.emplace_back();
        row.contact = i;
        row.tangents = tangent_basis(context.particle_contacts[i].normal);
    }
}

void kick_particles(StepContext &context, const Vec3 &gravity, Real h) {
    if (!context.active.has_particles)
        return;
    for (std::size_t i = 0; i < context.particles.size(); ++i)
        if (context.model.particles[i].inv_mass > Real(0))
            context.particles[i].velocity += h * gravity;
    attract_particles(context, h);
}

void pull_particle(StepContext &context, Real h) {
    const Grab &grab = context.grab;
    if (!grab.holds_particle())
        return;
    ParticleMotion &held = context.particles[grab.particle];
    const Real omega = Real(2) * std::numbers::pi_v<Real> * grab.frequency;
    const Real stiffness = grab.held_mass * omega * omega;
    const Real damping = Real(2) * grab.damping_ratio * grab.held_mass * omega;
    const Real pull = damping + h * stiffness;
    const Real inv_mass = context.model.particles[grab.particle].inv_mass;
    const Vec3 error = held.position - grab.target;
    Vec3 impulse =
        -(held.velocity + (stiffness / pull) * error) / (inv_mass + Real(1) / (h * pull));
    const Real limit = grab.max_force * h;
    const Real length = glm::length(impulse);
    if (length > limit)
        impulse *= limit / length;
    held.velocity += inv_mass * impulse;
}

void refresh_particles(StepContext &context, Real h, SpringRule rule) {
    if (!context.active.has_particles)
        return;
    pull_particle(context, h);
    for (ParticleContactConstraint &row : context.scratch.particle_contacts)
        refresh(context, row, Real(0.5) * h);
    begin_springs(context, h, rule);
}

void solve_particle_contacts(StepContext &context, const ParticlePush &push, Real h) {
    for (ParticleContactConstraint &row : context.scratch.particle_contacts) {
        const ParticleContact &contact = context.particle_contacts[row.contact];
        const bool is_open = row.separation > Real(0);
        if (is_open && push.loaded_only && row.impulse.x == Real(0))
            continue;
        // The least separating speed.
        const Real least =
            is_open ? -row.separation / h : std::min(-push.rate * row.separation, push.velocity);
        const Real speed = glm::dot(relative_velocity(context, contact, row), contact.normal);
        const Real total = std::max(row.impulse.x + row.normal_mass * (least - speed), Real(0));
        apply(context, contact, row, (total - row.impulse.x) * contact.normal);
        row.impulse.x = total;
        if (contact.friction > Real(0))
            solve_friction(context, contact, row);
    }
    context.report.constraint_passes += context.scratch.particle_contacts.size();
}

void warm_start_particles(StepContext &context, Real share) {
    warm_start_springs(context, share);
    for (ParticleContactConstraint &row : context.scratch.particle_contacts) {
        const ParticleContact &contact = context.particle_contacts[row.contact];
        const Vec3 start = share * row.remembered;
        row.impulse += start;
        apply(context, contact, row,
              start.x * contact.normal + start.y * row.tangents.t1 + start.z * row.tangents.t2);
    }
    context.report.constraint_passes += context.scratch.particle_contacts.size();
}

void drift_particles(StepContext &context, Real h) {
    if (!context.active.has_particles)
        return;
    for (ParticleMotion &motion : context.particles)
        motion.position += h * motion.velocity;
    for (ParticleContactConstraint &row : context.scratch.particle_contacts) {
        const ParticleContact &contact = context.particle_contacts[row.contact];
        row.separation = separation_of(context, contact);
        row.arm =
            context.particles[contact.particle].position - context.bodies[contact.body].position;
    }
    context.report.body_passes += context.particles.size();
}

void restitute_particles(StepContext &context, Real threshold) {
    for (ParticleContactConstraint &row : context.scratch.particle_contacts) {
        const ParticleContact &contact = context.particle_contacts[row.contact];
        if (contact.restitution == Real(0) || row.impulse.x == Real(0) || row.approach > -threshold)
            continue;
        const Real speed = glm::dot(relative_velocity(context, contact, row), contact.normal);
        const Real change = row.normal_mass * (-contact.restitution * row.approach - speed);
        if (change <= Real(0))
            continue;
        row.impulse.x += change;
        apply(context, contact, row, change * contact.normal);
        ++context.report.impacts;
    }
}

} // namespace plumb::inline PLUMB_PRECISION
