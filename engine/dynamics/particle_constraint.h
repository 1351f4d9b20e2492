// Springs and contacts of particles as velocity constraints. All do nothing where the context has
// no particles.
#pragma once

#include "engine/dynamics/particles.h"
#include "engine/math/basis.h"

#include <span>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {

struct Model;
struct StepContext;

// How springs follow the time of a substep. midpoint: each pulls before the move and after it with
// the same impulse, along the mean of its lines before and after, so that the two do the work that
// its length asks for (a discrete gradient, Gonzalez 1996, "Time Integration and Discrete
// Hamiltonian Systems"); what hangs at rest hangs where they hold it, however few the passes are.
// Those that swing too fast for h do less and less of it after the move, down to implicit Euler.
enum class SpringRule { implicit_euler, midpoint };

// A spring's part in a substep.
struct SpringTime {
    Real share = Real(1); // of h, at whose end the pull is taken: 1/2 the midpoint rule
    // Of the impulse that the present speed asks for, so much keeps all springs together stable.
    Real guessed = Real(1);
    // midpoint only: whether that is too little by itself; and of the damping alone, after the
    // move, what is guessed.
    bool is_swift = false;
    Real damped = Real(1);
    // implicit_euler only, whose row is k and c as softness over h (Catto 2011, "Soft Constraints":
    // gamma = 1 / (h (c + h k)), beta / h = k / (c + h k)):
    Real softness = Real(0);  // gamma, 1/kg; 0: the spring does nothing
    Real bias_rate = Real(0); // beta / h, 1/s
};
SpringTime spring_time(const StepContext &context, const Spring &spring, Real h, SpringRule rule);
// So soft that of a speed along a row e^-x is left, x = damping inverse: exact over any substep
// where the row is alone. (Softness 1 / damping leaves 1 / (1 + x), as implicit Euler does.)
// `inverse`: of the row's mass (1/kg), `damping`: over the substep (N s / (m/s)); both > 0.
Real decay_softness(Real inverse, Real damping);

// The impulse along the line between two ends that part at `speed`, whose response is `inverse`
// (1/kg), that takes `gained` (J) from their energy, or gives them back what they lost. It takes no
// more than stops them, and gives back only what is little of what they have: else each time that
// it cannot take all would leave a gain.
Real returned_impulse(Real speed, Real inverse, Real gained);

// A spring as a soft row (Catto 2011, "Soft Constraints").
struct SpringConstraint {
    std::uint32_t spring = 0; // index in the model
    Vec3 axis{Real(0)};       // unit, from a to b; 0 where they are at one point
    Vec3 r_a{Real(0)};        // arms on bodies, world
    Vec3 r_b{Real(0)};
    SpringTime time;
    Vec3 line{Real(0)};        // midpoint: from a to b as the substep began (m)
    Real softness = Real(0);   // gamma, 1/kg; midpoint: of its damping alone
    Real bias = Real(0);       // beta / h times the error, m/s
    Real mass = Real(0);       // 1 / (K + gamma); midpoint: see SpringBlock::answer
    Real impulse = Real(0);    // accumulated, along the axis on b (N s)
    Real remembered = Real(0); // for recall_particles
};

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
    Vec3 remembered{Real(0)};    // for recall_particles
    Real approach = Real(0);     // relative normal velocity as the substep began (m/s)
};

// What a pass does about penetration.
struct ParticlePush {
    Real rate = Real(0);      // 1/s: the part of the depth that is taken back; 0: left alone
    Real velocity = Real(0);  // m/s, the fastest
    bool loaded_only = false; // contacts that are open and bear nothing are left alone
};

// How fast all springs at a body (first) or particle (behind them) swing it and slow it down, at
// the most: sums of stiffness and of damping over its mass (1/s^2, 1/s). With K <= 2 diag(K_ii) for
// a net of springs no mode swings faster than sqrt(2 x), nor slows down faster than 2 y, x and y
// the largest of all. `stiffness`: memory for what is summed.
void find_spring_rates(const Model &model, std::span<const SolverBody> bodies,
                       std::span<const ParticleMotion> particles,
                       std::span<const std::uint8_t> torn, std::vector<Mat3> &stiffness,
                       std::vector<Vec2> &rates);
// By the midpoint rule springs between particles become columns (spring_columns.h) instead of rows:
// these are solved by the functions below along with the rows, but for recall_particles.
void prepare_particles(StepContext &context, SpringRule rule = SpringRule::implicit_euler);
void kick_particles(StepContext &context, const Vec3 &gravity, Real h);
// The hand's spring on the particle that it holds, if it holds one; never stronger than max_force.
void pull_particle(StepContext &context, Real h);
// Pulls so; then rows and contacts at the present poses; begins both with what they bear by
// themselves.
void refresh_particles(StepContext &context, Real h, SpringRule rule);
// That soft_step makes over them.
int spring_passes(const StepContext &context);
void solve_springs(StepContext &context, SpringRule rule = SpringRule::implicit_euler);
void solve_particle_contacts(StepContext &context, const ParticlePush &push, Real h);
// Adds a share of what springs and contacts remember to their impulses, and applies it.
void recall_particles(StepContext &context, Real share);
void drift_particles(StepContext &context, Real h);
// After the move, the rest of the springs' substep, along the lines as they are now.
void repeat_particle_springs(StepContext &context, Real h);
// Particles that struck a body in this substep leave it at the restitution's share of the speed.
void restitute_particles(StepContext &context, Real threshold);

} // namespace plumb::inline PLUMB_PRECISION
