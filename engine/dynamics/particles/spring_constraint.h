// Springs as velocity constraints: soft rows, or impulses before and after the move that keep the
// energy.
#pragma once

#include "engine/dynamics/particles/particles.h"

#include <span>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {

struct Model;
struct SolverBody;
struct StepContext;

// How springs follow the time of a substep. midpoint: each pulls before the move and after it with
// the same impulse, along the mean of its lines before and after, so that the two do the work that
// its length asks for (a discrete gradient, Gonzalez 1996, "Time Integration and Discrete
// Hamiltonian Systems"); what hangs at rest hangs where they hold it, however few the passes are.
// Those that swing too fast for h do less and less of it after the move, down to implicit Euler;
// those so slow that it makes no difference pull at the lengths before and after the move.
enum class SpringRule { implicit_euler, midpoint };

// A spring's part in a substep.
struct SpringTime {
    Real share = Real(1); // of h, at whose end the pull is taken: 1/2 the midpoint rule
    // Of the impulse that the present speed asks for, so much keeps all springs together stable.
    Real guessed = Real(1);
    // midpoint only: whether it makes a difference; and of the damping alone, after the move, what
    // is guessed.
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
    Vec3 pull{Real(0)};        // midpoint: the impulse on b before the move (N s)
    Real softness = Real(0);   // gamma, 1/kg; midpoint: of its damping alone, as are
    Real bias = Real(0);       // beta / h times the error, m/s
    Real mass = Real(0);       // 1 / (K + gamma)
    Real impulse = Real(0);    // accumulated, along the axis on b (N s)
    Real remembered = Real(0); // for warm_start_particles
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
// these are solved by the functions below along with the rows, but for warm_start_springs.
void prepare_springs(StepContext &context, SpringRule rule);
// At the present poses, with what they bear by themselves.
void begin_springs(StepContext &context, Real h, SpringRule rule);
// That soft_step makes over them.
int spring_passes(const StepContext &context);
void solve_springs(StepContext &context, SpringRule rule = SpringRule::implicit_euler);
// Adds a share of what rows remember to their impulses, and applies it.
void warm_start_springs(StepContext &context, Real share);
// After the move, the rest of the substep, along the lines as they are now.
void repeat_particle_springs(StepContext &context, Real h);

} // namespace plumb::inline PLUMB_PRECISION
