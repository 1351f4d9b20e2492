// Particles with their springs (spring_constraint.h) and contacts as velocity constraints. All do
// nothing where the context has no particles.
#pragma once

#include "engine/dynamics/particles/particles.h"
#include "engine/dynamics/particles/spring_constraint.h"
#include "engine/math/basis.h"

#include <span>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {

struct Model;
struct StepContext;

// One particle against one body: a row along the normal, two of friction.
struct ParticleContactConstraint {
    std::uint32_t contact = 0; // index in the context
    TangentBasis tangents;
    // From the body's centre of mass to the particle's: both feel the impulse on one line, so that
    // friction, too, keeps the angular momentum.
    Vec3 arm{Real(0)};
    Real separation = Real(0); // m
    Real normal_mass = Real(0);
    Real tangent_mass = Real(0); // as ContactPointConstraint::tangent_mass
    Vec3 impulse{Real(0)};       // accumulated in this substep: normal, t1, t2 (N s)
    Vec3 remembered{Real(0)};    // for warm_start_particles
    Real approach = Real(0);     // relative normal velocity when they meet (m/s)
};

// What a pass does about penetration.
struct ParticlePush {
    Real rate = Real(0);      // 1/s: the part of the depth that is taken back; 0: left alone
    Real velocity = Real(0);  // m/s, the fastest
    bool loaded_only = false; // contacts that are open and bear nothing are left alone
};

void prepare_particles(StepContext &context, SpringRule rule = SpringRule::implicit_euler);
void kick_particles(StepContext &context, const Vec3 &gravity, Real h);
// The hand's spring on the particle that it holds, if it holds one; never stronger than max_force.
void pull_particle(StepContext &context, Real h);
// Pulls so; then springs and contacts at the present poses; begins both with what they bear by
// themselves.
void refresh_particles(StepContext &context, Real h, SpringRule rule);
void solve_particle_contacts(StepContext &context, const ParticlePush &push, Real h);
// Adds a share of what springs and contacts remember to their impulses, and applies it.
void warm_start_particles(StepContext &context, Real share);
void drift_particles(StepContext &context, Real h);
// Particles that struck a body in this substep leave it at the restitution's share of the speed.
void restitute_particles(StepContext &context, Real threshold);

} // namespace plumb::inline PLUMB_PRECISION
