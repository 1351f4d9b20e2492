// Particles and springs: point masses for cloth, ropes and nets.
//
// A particle is a point mass. Against bodies it is a sphere of its radius; particles do not collide
// with each other. A spring pulls two points together or pushes them apart along the line between
// them; each is a particle, a point of a body, or a point of the world.
#pragma once

#include "engine/dynamics/bodies/body.h"

#include <cstdint>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

struct ParticleDef {
    Vec3 position{Real(0)};   // world
    Vec3 velocity{Real(0)};   // m/s
    Real mass = Real(1);      // kg, > 0
    Real radius = Real(0.02); // m, > 0
    bool pinned = false;      // never moves
    Material material;        // against bodies
};

// What does not change about a particle.
struct Particle {
    Real inv_mass = Real(1); // 1/kg; 0: pinned
    Real mass = Real(1);     // kg
    Real radius = Real(0.02);
    Material material;
};

// How a particle moves.
struct ParticleMotion {
    Vec3 position{Real(0)};
    Vec3 velocity{Real(0)};
};

struct SpringEnd {
    enum class Kind : std::uint8_t { world, particle, body };
    Kind kind = Kind::world;
    std::uint32_t index = 0; // of the particle or body
    // body: in its own frame (in the model: in its mass frame); world: the point; particle: unused.
    Vec3 anchor{Real(0)};
};

// A force along the line between the ends, towards each other: stiffness (length - rest_length) +
// damping (rate of the length). Coincident ends have no line, and no force.
struct SpringDef {
    SpringEnd a;
    SpringEnd b;
    Real rest_length = Real(0); // m, >= 0
    Real stiffness = Real(0);   // N/m, >= 0
    Real damping = Real(0);     // N s/m, >= 0
    // Tears at the end of a step if longer than (1 + tear_strain) rest_length; 0: never.
    Real tear_strain = Real(0);
    bool torn = false; // carries no load any more
};

// A spring in the model; whether it is torn is part of the state.
struct Spring {
    SpringEnd a;
    SpringEnd b;
    Real rest_length = Real(0);
    Real stiffness = Real(0);
    Real damping = Real(0);
    Real tear_strain = Real(0);
};

// A spring end's position, velocity and arm from the body's centre of mass (0 if not on a body).
struct SpringPoint {
    Vec3 position{Real(0)};
    Vec3 velocity{Real(0)};
    Vec3 arm{Real(0)};
};

// `bodies` and `particles` are arrays of types derived from Motion and ParticleMotion.
template <typename Bodies, typename Particles>
SpringPoint spring_point(const SpringEnd &end, const Bodies &bodies, const Particles &particles) {
    if (end.kind == SpringEnd::Kind::particle)
        return {particles[end.index].position, particles[end.index].velocity, Vec3{Real(0)}};
    if (end.kind == SpringEnd::Kind::world)
        return {end.anchor, Vec3{Real(0)}, Vec3{Real(0)}};
    const Motion &motion = bodies[end.index];
    const Vec3 arm = motion.rotation * end.anchor;
    return {motion.position + arm, motion.velocity + glm::cross(motion.angular_velocity, arm), arm};
}

// Where a particle's sphere touches a body, or may within the step. The contact plane stays fixed
// to the body for the whole step.
struct ParticleContact {
    std::uint32_t particle = 0;
    std::uint32_t body = 0;
    Vec3 normal{Real(0)}; // unit, from the body to the particle
    Vec3 anchor{Real(0)}; // on the body's surface, in its mass frame
    Real friction = Real(0);
    Real restitution = Real(0);
};

} // namespace plumb::inline PLUMB_PRECISION
