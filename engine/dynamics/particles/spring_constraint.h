// Springs as velocity constraints: soft rows, or energy-conserving impulses before and after the
// move.
#pragma once

#include "engine/dynamics/particles/particles.h"

#include <span>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {

struct Model;
struct SolverBody;
struct StepContext;

// How springs are integrated over a substep. midpoint: each applies the same impulse before and
// after the move, along the mean of its lines before and after, so that together they do the work
// that its change in length calls for (a discrete gradient, Gonzalez 1996, "Time Integration and
// Discrete Hamiltonian Systems"); loads at rest hang in equilibrium, however few the passes are.
// Springs that swing too fast for h apply less and less after the move, down to implicit Euler;
// springs so slow that it makes no difference pull at their lengths before and after the move.
enum class SpringRule { implicit_euler, midpoint };

// How a spring is integrated over a substep.
struct SpringTime {
    Real share = Real(1); // of h, at whose end the pull is evaluated; 1/2: midpoint rule
    // The share of the impulse that the present speed asks for that keeps all springs together
    // stable.
    Real guessed = Real(1);
    // midpoint only: whether midpoint makes a difference; and the share guessed for the damping
    // alone, after the move.
    bool is_swift = false;
    Real damped = Real(1);
    // implicit_euler only: the row's k and c as softness over h (Catto 2011, "Soft Constraints":
    // gamma = 1 / (h (c + h k)), beta / h = k / (c + h k)):
    Real softness = Real(0);  // gamma, 1/kg; 0: the spring does nothing
    Real bias_rate = Real(0); // beta / h, 1/s
};
SpringTime spring_time(const StepContext &context, const Spring &spring, Real h, SpringRule rule);
// The softness at which e^-x of a row's speed is left, x = damping inverse: exact over any substep
// for a row on its own. (Softness 1 / damping leaves 1 / (1 + x), as implicit Euler does.)
// `inverse`: the row's inverse mass (1/kg); `damping`: over the substep (N s / (m/s)); both > 0.
Real decay_softness(Real inverse, Real damping);

// A damper over a substep in which all else adds up to a constant force: exact on its own, by the
// exponential Euler method (Hochbruck and Ostermann 2010, "Exponential Integrators"), at any
// damping. A damper that slows the velocities after the move only would let heavy loads sink at
// x / 2 coth(x / 2) times the right speed, x = damping inverse.
//
// The speed along its line becomes of_force times what it is without the damper, half of the
// substep's force included, plus of_start times what it was before that half.
struct DamperHalf {
    Real of_force = Real(1);
    Real of_start = Real(0);
};
// In the first half, up to the move, it becomes the mean speed, by which the ends then move; in the
// second half it starts from that. `x` > 0.
DamperHalf damper_before_move(Real x);
DamperHalf damper_after_move(Real x);

// The impulse along the line between two ends separating at `speed`, with inverse mass `inverse`
// (1/kg), that removes the energy `gained` (J) from them, or returns what they lost. It never
// removes more than stops them, and returns only what is small against what they have: otherwise
// each time it could not remove everything would leave a gain.
Real returned_impulse(Real speed, Real inverse, Real gained);

// A spring as a soft row (Catto 2011, "Soft Constraints").
struct SpringConstraint {
    std::uint32_t spring = 0; // index in the model
    Vec3 axis{Real(0)};       // unit, from a to b; 0 for coincident ends
    Vec3 r_a{Real(0)};        // arms on bodies, world
    Vec3 r_b{Real(0)};
    SpringTime time;
    Vec3 line{Real(0)};        // midpoint: from a to b at the start of the substep (m)
    Vec3 pull{Real(0)};        // midpoint: the impulse on b before the move (N s)
    bool is_strong = false;    // midpoint: slowed before the move, too (damper_before_move)
    Real start = Real(0);      // strong: speed along the axis before the present half (m/s)
    Real softness = Real(0);   // gamma, 1/kg; midpoint: for damping only
    Real bias = Real(0);       // beta / h times the error, m/s
    Real mass = Real(0);       // 1 / (K + gamma)
    Real impulse = Real(0);    // accumulated, along the axis on b (N s)
    Real remembered = Real(0); // for warm_start_particles
};

// Upper bounds on how fast the springs at each body (first) or particle (after the bodies) make it
// swing and damp it: sums of stiffness and of damping over its mass (1/s^2, 1/s). Since K <= 2
// diag(K_ii) for a net of springs, no mode swings faster than sqrt(2 x) or decays faster than 2 y,
// with x and y the largest of all. `stiffness`: scratch for the sums.
void find_spring_rates(const Model &model, std::span<const SolverBody> bodies,
                       std::span<const ParticleMotion> particles,
                       std::span<const std::uint8_t> torn, std::vector<Mat3> &stiffness,
                       std::vector<Vec2> &rates);
// With the midpoint rule, springs between particles become columns (spring_columns.h) instead of
// rows. The functions below solve both, except warm_start_springs.
void prepare_springs(StepContext &context, SpringRule rule);
// At the present poses, with the impulses they start from.
void begin_springs(StepContext &context, Real h, SpringRule rule);
// Notes how fast the ends of strong dampers part: before the forces of a substep, and before its
// move.
void note_damper_speeds(StepContext &context);
// The number of passes that soft_step makes over them.
int spring_passes(const StepContext &context);
void solve_springs(StepContext &context, SpringRule rule = SpringRule::implicit_euler);
// Applies a share of the rows' remembered impulses, and accumulates it.
void warm_start_springs(StepContext &context, Real share);
// After the move: the rest of the substep's impulse, along the present lines.
void repeat_particle_springs(StepContext &context, Real h);

} // namespace plumb::inline PLUMB_PRECISION
