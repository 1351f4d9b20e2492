#include "engine/dynamics/methods/parts/smooth_forces.h"

#include "engine/dynamics/method.h"

#include <algorithm>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// Euler's equations in world axes: w' = -I^-1 (w x I w).
Vec3 torque_free(const Body &body, const SolverBody &motion) {
    if (!has_gyroscopic_spin(body))
        return Vec3{Real(0)};
    const Vec3 momentum = spin_momentum(motion.rotation, body.inertia, motion.angular_velocity);
    return -(motion.inv_inertia * glm::cross(motion.angular_velocity, momentum));
}

// A body's place in context.moving(), which is ascending; moving.size() if it is not there.
std::size_t place_of(const StepContext &context, std::uint32_t body) {
    const auto moving = context.moving();
    const auto found = std::ranges::lower_bound(moving, body);
    return found != moving.end() && *found == body
               ? static_cast<std::size_t>(found - moving.begin())
               : moving.size();
}

// Adds a spring's force to whatever its end is attached to.
void add_force(const StepContext &context, const SpringEnd &end, const Vec3 &arm, const Vec3 &force,
               Accelerations &out) {
    if (end.kind == SpringEnd::Kind::particle)
        out.particles[end.index] += context.model.particles[end.index].inv_mass * force;
    if (end.kind != SpringEnd::Kind::body)
        return;
    const std::size_t place = place_of(context, end.index);
    if (place == out.bodies.size())
        return;
    const SolverBody &body = context.bodies[end.index];
    const Vec3 torque = glm::cross(arm, force);
    out.bodies[place].linear += body.inv_mass * force;
    out.bodies[place].torque += torque;
}

void add_springs(StepContext &context, Accelerations &out) {
    for (std::size_t i = 0; i < context.model.springs.size(); ++i) {
        if (context.torn[i] != 0)
            continue;
        const Spring &spring = context.model.springs[i];
        const SpringPoint a = spring_point(spring.a, context.bodies, context.particles);
        const SpringPoint b = spring_point(spring.b, context.bodies, context.particles);
        const Vec3 line = b.position - a.position;
        const Real length = glm::length(line);
        if (!(length > Real(0)))
            continue;
        const Vec3 axis = line / length;
        const Real rate = glm::dot(b.velocity - a.velocity, axis);
        const Vec3 force =
            (spring.stiffness * (length - spring.rest_length) + spring.damping * rate) * axis;
        add_force(context, spring.a, a.arm, force, out);
        add_force(context, spring.b, b.arm, -force, out);
    }
}

} // namespace

void find_linear_accelerations(StepContext &context, Accelerations &out) {
    const Vec3 gravity{context.settings.gravity};
    const auto moving = context.moving();
    out.bodies.resize(moving.size());
    for (std::size_t i = 0; i < moving.size(); ++i) {
        const Body &body = context.model.bodies[moving[i]];
        const SolverBody &motion = context.bodies[moving[i]];
        out.bodies[i] = {};
        if (body.kind == BodyKind::dynamic)
            out.bodies[i].linear =
                pull_on(body, gravity + attraction(context.model.attractors, motion.position)) -
                body.linear_damping * motion.velocity;
        if (body.has_torque)
            out.bodies[i].torque = body.torque;
    }
    context.report.body_passes += moving.size();
    if (!context.active.has_particles)
        return;
    const std::vector<Particle> &particles = context.model.particles;
    out.particles.resize(particles.size());
    for (std::size_t i = 0; i < particles.size(); ++i)
        out.particles[i] =
            particles[i].inv_mass > Real(0)
                ? gravity + attraction(context.model.attractors, context.particles[i].position)
                : Vec3{Real(0)};
    add_springs(context, out);
    context.report.body_passes += particles.size();
    context.report.constraint_passes += context.model.springs.size();
}

void find_accelerations(StepContext &context, Accelerations &out) {
    find_linear_accelerations(context, out);
    const auto moving = context.moving();
    for (std::size_t i = 0; i < moving.size(); ++i) {
        const Body &body = context.model.bodies[moving[i]];
        const SolverBody &motion = context.bodies[moving[i]];
        if (body.kind != BodyKind::dynamic)
            continue;
        out.bodies[i].angular =
            torque_free(body, motion) - body.angular_damping * motion.angular_velocity;
        if (context.active.has_particles || body.has_torque)
            out.bodies[i].angular += motion.inv_inertia * out.bodies[i].torque;
    }
}

void kick_smoothly(StepContext &context, const Accelerations &by, Real h) {
    const auto moving = context.moving();
    for (std::size_t i = 0; i < moving.size(); ++i)
        if (context.model.bodies[moving[i]].kind == BodyKind::dynamic) {
            SolverBody &motion = context.bodies[moving[i]];
            motion.velocity += h * by.bodies[i].linear;
            motion.angular_velocity += h * by.bodies[i].angular;
        }
    if (context.active.has_particles)
        for (std::size_t i = 0; i < context.particles.size(); ++i)
            context.particles[i].velocity += h * by.particles[i];
}

void kick_smoothly(StepContext &context, Real h) {
    Accelerations &now = context.scratch.accelerations[0];
    find_accelerations(context, now);
    kick_smoothly(context, now, h);
}

void drift_smoothly(StepContext &context, Real h) {
    for (const std::uint32_t i : context.moving()) {
        SolverBody &motion = context.bodies[i];
        motion.position += h * motion.velocity;
        motion.rotation = turned(motion.rotation, motion.angular_velocity, h);
        motion.inv_inertia = solver_inverse_inertia(context.model.bodies[i], motion.rotation);
    }
    if (context.active.has_particles)
        for (ParticleMotion &motion : context.particles)
            motion.position += h * motion.velocity;
}

void remember_velocities(StepContext &context) {
    SolverScratch &s = context.scratch;
    s.velocities.clear();
    for (const std::uint32_t i : context.moving())
        s.velocities.push_back({context.bodies[i].velocity, context.bodies[i].angular_velocity});
    s.particle_motions.assign(context.particles.begin(), context.particles.end());
}

void restore_velocities(StepContext &context) {
    const SolverScratch &s = context.scratch;
    for (std::size_t i = 0; i < s.velocities.size(); ++i) {
        SolverBody &motion = context.bodies[context.moving()[i]];
        motion.velocity = s.velocities[i][0];
        motion.angular_velocity = s.velocities[i][1];
    }
    for (std::size_t i = 0; i < s.particle_motions.size(); ++i)
        context.particles[i].velocity = s.particle_motions[i].velocity;
}

bool depend_on_velocities(const StepContext &context) {
    const bool damped_bodies = std::ranges::any_of(context.moving(), [&](std::uint32_t i) {
        const Body &body = context.model.bodies[i];
        return body.kind == BodyKind::dynamic &&
               (body.linear_damping > Real(0) || body.angular_damping > Real(0) ||
                has_gyroscopic_spin(body));
    });
    return damped_bodies || (context.active.has_particles &&
                             std::ranges::any_of(context.model.springs, [](const Spring &spring) {
                                 return spring.damping > Real(0);
                             }));
}

} // namespace plumb::inline PLUMB_PRECISION
