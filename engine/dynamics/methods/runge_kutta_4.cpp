// The classical fourth-order Runge-Kutta method for free bodies, particles and springs (Kutta 1901;
// Hairer, Norsett, Wanner 1993, "Solving Ordinary Differential Equations I", table II.1.2), on
// position, velocity, orientation and spin.
#include "engine/dynamics/bodies/motion.h"
#include "engine/dynamics/method.h"

#include <array>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// Here a Motion is the state of one free body, or its rate of change, with the spin in the body's
// principal axes, where the inertia is constant.
Motion operator+(const Motion &state, const Motion &change) {
    return {state.position + change.position, state.rotation + change.rotation,
            state.velocity + change.velocity, state.angular_velocity + change.angular_velocity};
}

Motion operator*(Real scale, const Motion &rate) {
    return {scale * rate.position, scale * rate.rotation, scale * rate.velocity,
            scale * rate.angular_velocity};
}

ParticleMotion operator+(const ParticleMotion &state, const ParticleMotion &change) {
    return {state.position + change.position, state.velocity + change.velocity};
}

ParticleMotion operator*(Real scale, const ParticleMotion &rate) {
    return {scale * rate.position, scale * rate.velocity};
}

Motion rate_of(const Motion &state, const Body &body, const Vec3 &acceleration) {
    const Vec3 &spin = state.angular_velocity;
    const Vec3 torque_free = has_gyroscopic_spin(body)
                                 ? -body.inv_inertia * glm::cross(spin, body.inertia * spin)
                                 : Vec3{Real(0)};
    // q' = q (0, w) / 2 with w in the body's axes.
    const Quat turning = Real(0.5) * (state.rotation * Quat{Real(0), spin.x, spin.y, spin.z});
    return {state.velocity, turning, acceleration, torque_free - body.angular_damping * spin};
}

// The state at the substep's start, the present stage, its rate, and the weighted sum of rates.
template <typename Item> struct Stages {
    std::vector<Item> &items;
    std::size_t count;
    Item &start(std::size_t i) { return items[i]; }
    Item &stage(std::size_t i) { return items[count + i]; }
    Item &rate(std::size_t i) { return items[2 * count + i]; }
    Item &sum(std::size_t i) { return items[3 * count + i]; }
    Stages(std::vector<Item> &memory, std::size_t n) : items(memory), count(n) {
        items.resize(4 * n);
    }
    void begin(std::size_t i, const Item &now) { start(i) = stage(i) = now; }
    void add(std::size_t i, bool first, Real weight) {
        sum(i) = first ? rate(i) : sum(i) + weight * rate(i);
    }
};

struct Coefficients {
    Real reach;  // time from the start to where the rate is taken, in h
    Real weight; // of that rate, in h / 6
};
constexpr std::array<Coefficients, 4> tableau{
    {{Real(0), Real(1)}, {Real(0.5), Real(2)}, {Real(0.5), Real(2)}, {Real(1), Real(1)}}};

// Sets the motion at which forces are evaluated.
void place(SolverBody &motion, const Motion &stage, const Body &body) {
    motion.position = stage.position;
    motion.velocity = stage.velocity;
    motion.rotation = glm::normalize(stage.rotation);
    motion.angular_velocity = rotated(motion.rotation, stage.angular_velocity);
    for (std::size_t axis = 0; axis < 3 && body.has_locks; ++axis)
        if (body.locked[3 + axis]) // but for rounding
            motion.angular_velocity[static_cast<int>(axis)] = Real(0);
    motion.inv_inertia = solver_inverse_inertia(body, motion.rotation);
}

void take_substep(StepContext &context, Real h) {
    const auto moving = context.moving();
    const bool has_particles = context.active.has_particles;
    // Otherwise no force depends on positions.
    const bool reads_places =
        has_particles || !context.model.attractors.empty() || context.model.bodies_with_torque > 0;
    Accelerations &now = context.scratch.accelerations[0];
    Stages<Motion> bodies(context.scratch.motions, moving.size());
    Stages<ParticleMotion> particles(context.scratch.particle_motions,
                                     has_particles ? context.particles.size() : 0);
    for (std::size_t i = 0; i < moving.size(); ++i) {
        Motion start = context.bodies[moving[i]];
        if (context.model.bodies[moving[i]].kind == BodyKind::dynamic)
            start.angular_velocity =
                rotated(glm::conjugate(start.rotation), start.angular_velocity);
        bodies.begin(i, start);
    }
    for (std::size_t i = 0; i < particles.count; ++i)
        particles.begin(i, context.particles[i]);

    for (const Coefficients &at : tableau) {
        const bool first = at.reach == Real(0);
        for (std::size_t i = 0; !first && i < moving.size(); ++i) {
            const Body &body = context.model.bodies[moving[i]];
            SolverBody &motion = context.bodies[moving[i]];
            if (body.kind == BodyKind::dynamic) {
                bodies.stage(i) = bodies.start(i) + (at.reach * h) * bodies.rate(i);
                if (reads_places)
                    place(motion, bodies.stage(i), body);
                else
                    motion.velocity = bodies.stage(i).velocity;
            } else if (has_particles) {
                const Motion &start = bodies.start(i);
                motion.position = start.position + (at.reach * h) * start.velocity;
                motion.rotation = turned(start.rotation, start.angular_velocity, at.reach * h);
            }
        }
        for (std::size_t i = 0; !first && i < particles.count; ++i)
            context.particles[i] = particles.start(i) + (at.reach * h) * particles.rate(i);

        find_linear_accelerations(context, now);
        for (std::size_t i = 0; i < moving.size(); ++i) {
            const Body &body = context.model.bodies[moving[i]];
            if (body.kind != BodyKind::dynamic)
                continue;
            bodies.rate(i) = rate_of(bodies.stage(i), body, now.bodies[i].linear);
            if (has_particles || body.has_torque) {
                const SolverBody &motion = context.bodies[moving[i]];
                bodies.rate(i).angular_velocity += rotated(
                    glm::conjugate(motion.rotation), motion.inv_inertia * now.bodies[i].torque);
            }
            bodies.add(i, first, at.weight);
        }
        for (std::size_t i = 0; i < particles.count; ++i) {
            particles.rate(i) = {context.particles[i].velocity, now.particles[i]};
            particles.add(i, first, at.weight);
        }
    }

    for (std::size_t i = 0; i < moving.size(); ++i) {
        const Body &body = context.model.bodies[moving[i]];
        SolverBody &motion = context.bodies[moving[i]];
        if (body.kind == BodyKind::dynamic) {
            place(motion, bodies.start(i) + (h / 6) * bodies.sum(i), body);
            continue;
        }
        const Motion &start = bodies.start(i);
        motion.position = start.position + h * start.velocity;
        motion.rotation = turned(start.rotation, start.angular_velocity, h);
    }
    for (std::size_t i = 0; i < particles.count; ++i)
        context.particles[i] = particles.start(i) + (h / 6) * particles.sum(i);
}

void advance_runge_kutta_4(StepContext &context) {
    const StepSettings &settings = context.settings;
    const Real h = context.substep();
    for (int substep = 0; substep < settings.substeps; ++substep)
        take_substep(context, h);
}

} // namespace

Method rk4() {
    return {{.name = "rk4",
             .title = "Runge-Kutta 4",
             .source = "Kutta 1901",
             .contacts = false,
             .joints = false,
             .springs = true,
             .reads = {},
             .defaults = {.substeps = 1, .iterations = 1}},
            advance_runge_kutta_4};
}

} // namespace plumb::inline PLUMB_PRECISION
