// Particles with their springs (spring_constraint.h) and contacts as velocity constraints. These
// functions do nothing where the context has no particles.
#pragma once

#include "engine/dynamics/particles/particles.h"
#include "engine/dynamics/particles/spring_constraint.h"
#include "engine/math/basis.h"

#include <span>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {

struct Model;
struct StepContext;

// One particle against one body: a normal row and two friction rows.
struct ParticleContactConstraint {
    std::uint32_t contact = 0; // index in the context
    TangentBasis tangents;
    // From the body's centre of mass to the particle's centre: both get the impulse on the same
    // line, so that friction too conserves angular momentum.
    Vec3 arm{Real(0)};
    Real separation = Real(0); // m
    Real normal_mass = Real(0);
    Real tangent_mass = Real(0); // as ContactPointConstraint::tangent_mass
    Vec3 impulse{Real(0)};       // accumulated in this substep: normal, t1, t2 (N s)
    Vec3 remembered{Real(0)};    // for warm_start_particles
    Real approach = Real(0);     // relative normal velocity at impact (m/s)
};

// How a pass corrects penetration.
struct ParticlePush {
    Real rate = Real(0);      // 1/s: the share of the depth to correct; 0: none
    Real velocity = Real(0);  // m/s, the fastest correction
    bool loaded_only = false; // skip open contacts without an impulse
};

void prepare_particles(StepContext &context, SpringRule rule = SpringRule::implicit_euler);
void kick_particles(StepContext &context, const Vec3 &gravity, Real h);
// Applies the grab's spring to the particle that it holds, if any; at most max_force.
void pull_particle(StepContext &context, Real h);
// Does that too, then prepares springs and contacts at the present poses, with the impulses they
// start from.
void refresh_particles(StepContext &context, Real h, SpringRule rule);
void solve_particle_contacts(StepContext &context, const ParticlePush &push, Real h);
// Applies a share of the remembered impulses of springs and contacts, and accumulates it.
void warm_start_particles(StepContext &context, Real share);
void drift_particles(StepContext &context, Real h);
// Particles that hit a body in this substep leave at the approach speed times the restitution.
void restitute_particles(StepContext &context, Real threshold);

} // namespace plumb::inline PLUMB_PRECISION
