// Unconstrained rigid motion over one substep.
#pragma once

#include "engine/dynamics/attractor.h"
#include "engine/dynamics/bodies/body.h"

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

// The inverse inertia tensor in world axes.
Mat3 world_inverse_inertia(const Quat &rotation, const Vec3 &inv_inertia);

// R I R^T w: angular momentum (kg m^2/s, world) about the centre of mass.
Vec3 spin_momentum(const Quat &rotation, const Vec3 &inertia, const Vec3 &angular_velocity);

// `rotation` after turning at constant world `angular_velocity` for `h` seconds; exact (exponential
// map).
Quat turned(const Quat &rotation, const Vec3 &angular_velocity, Real h);

// Turns a body at its own angular velocity; what rounds off is carried over to the next turn.
void turn(Motion &motion, RoundedOff &rounded_off, Real h);

// A rotation taken the shorter way round: axis times angle (rad, at most pi).
Vec3 rotation_vector(const Quat &rotation);

// Whether a turn (a rotation vector, rad) is too far for second-order tracking: the error is
// third-order, here a millionth of the arm.
inline constexpr Real far_turn = Real(0.02);
inline bool has_turned_far(const Vec3 &turn) {
    return turn.x * turn.x + turn.y * turn.y + turn.z * turn.z > far_turn * far_turn;
}

// The body-frame angular velocity after `h` seconds of torque-free spin, from `spin` in principal
// axes: Euler's equations I w' = -w x I w by the implicit midpoint rule, which keeps kinetic energy
// and the length of the angular momentum at any step size (quadratic invariants; Hairer, Lubich,
// Wanner 2006, "Geometric Numerical Integration", thm IV.2.1). Solved with `iterations` Newton
// steps: three converge to round-off up to a third of a radian per step; where they do not
// converge, beyond a radian or so, the result is scaled to keep the energy, which also bounds the
// angular momentum.
Vec3 gyroscopic_spin(const Vec3 &inertia, const Vec3 &spin, Real h, int iterations);

// When a substep's gravity and gyroscopic torque are added to the velocities that a solver works
// on: all before it (semi-implicit Euler), or half before and half after the move (velocity
// Verlet).
enum class Kick { before, around };

// An acceleration without its parts along a body's locked axes.
inline Vec3 along_free_axes(const Body &body, Vec3 acceleration) {
    for (int i = 0; body.has_locks && i < 3; ++i)
        if (body.locked[static_cast<std::size_t>(i)])
            acceleration[i] = Real(0);
    return acceleration;
}

// The gravity that acts on a body: 0 unless it is dynamic, and 0 along locked axes.
inline Vec3 gravity_on(const Body &body, const Vec3 &gravity) {
    if (body.kind != BodyKind::dynamic)
        return Vec3{Real(0)};
    return along_free_axes(body, body.gravity_scale * gravity);
}

// The acceleration (m/s^2) by gravity and by the body's own constant force.
inline Vec3 pull_on(const Body &body, const Vec3 &gravity) {
    const Vec3 pull = gravity_on(body, gravity);
    return body.has_force ? pull + along_free_axes(body, body.force / body.mass) : pull;
}

// How much a body is pulled at most (m/s^2), by gravity of this size and its own force.
inline Real greatest_pull(const Body &body, Real gravity) {
    return body.has_force ? gravity + glm::length(body.force) / body.mass : gravity;
}

// Adds h seconds of the attractors' pull at the body's position to its velocity.
inline void attract(Motion &motion, const Body &body, std::span<const Attractor> attractors,
                    Real h) {
    motion.velocity += h * gravity_on(body, attraction(attractors, motion.position));
}

// Whether all three moments are equal, so that a free body's spin is constant.
inline bool is_isotropic(const Vec3 &inertia) {
    return inertia.x == inertia.y && inertia.y == inertia.z;
}

// The inverse inertia in world axes for principal moments other than the body's own, without locked
// rotations.
Mat3 solver_inverse_inertia(const Body &body, const Vec3 &inv_inertia, const Quat &rotation);
// For the body's own moments.
inline Mat3 solver_inverse_inertia(const Body &body, const Quat &rotation) {
    if (!body.has_locks && is_isotropic(body.inv_inertia))
        return Mat3{body.inv_inertia.x};
    return solver_inverse_inertia(body, body.inv_inertia, rotation);
}

// Adds h seconds of the body's own constant torque to its spin, at its present rotation.
inline void twist(Motion &motion, const Body &body, Real h) {
    if (body.has_torque)
        motion.angular_velocity +=
            h * (solver_inverse_inertia(body, motion.rotation) * body.torque);
}

// Whether a torque-free body's spin is more than a constant world vector. Bodies with a locked
// rotation are limited to their remaining axes.
bool has_gyroscopic_spin(const Body &body);

// One body's substep, with a constraint solver's velocity changes in the middle:
//
//   FreeFlight flight = begin_flight(...)   velocities for the solver to start from
//   ... the solver changes motion.velocity and motion.angular_velocity, or not ...
//   move(...)                               the pose after h
//   end_flight(...)                         velocities at the end of h
//
// A body whose velocities come back unchanged flew free: its path is then exact under gravity and a
// constant force, x + v h + g h^2 / 2, or with damping the closed form of v' = g - c v, and its
// torque-free turn keeps energy and world angular momentum. Otherwise the pose follows the solver's
// velocities, which is what the constraints were solved for; between the two half kicks the
// gyroscopic torque is then that of the spin that the solver left, or spinning tops would sink.
struct FreeFlight {
    Vec3 velocity{Real(0)};         // as given to the solver
    Vec3 angular_velocity{Real(0)}; // as given to the solver
    Vec3 mean_velocity{Real(0)};    // over the substep, in free flight
    Vec3 late_velocity{Real(0)};    // the part of gravity's kick applied after the move
    // Body frame, for bodies with unequal moments: at the start of the substep, including the
    // solver's changes; the mean over the substep; and at its end.
    Vec3 start_spin{Real(0)};
    Vec3 mean_spin{Real(0)};
    Vec3 end_spin{Real(0)};
    Vec3 late_spin{Real(0)}; // the part of damping applied after the move, world
    bool free = false;       // set by move
    // Set by move: the pose turns by the Cayley map of mean_spin, which keeps the world angular
    // momentum together with end_spin.
    bool turns_by_mean = false;
    bool loaded = false; // turned by impulses that it also had before (flight_columns.h)
};

FreeFlight begin_flight(SolverBody &motion, const Body &body, const Vec3 &gravity, Real h,
                        Kick kick, int gyroscopic_iterations);
// Along the velocities that the solver left. With Kick::around: move_held, which also redoes the
// torque-free turn of a body that is held.
void move(SolverBody &motion, RoundedOff &rounded_off, const Body &body, FreeFlight &flight,
          Real h);
// What holds a body besides contacts.
struct HeldBy {
    bool joints = false;
    bool springs = false;
};
void move_held(SolverBody &motion, RoundedOff &rounded_off, const Body &body, FreeFlight &flight,
               Real h, int gyroscopic_iterations, HeldBy held_by);
// Recomputes motion.turned from the poses where it has turned too far to be a sum of turns.
void track_turn(SolverBody &motion, const Motion &start);
void end_flight(SolverBody &motion, const Body &body, const FreeFlight &flight, Kick kick);

// Adds h seconds of the attractors' pull and of the bodies' own torques to all velocities.
struct StepContext;
void attract_and_twist(StepContext &context, Real h);
// The flights of all moving bodies with Kick::before, kept in the context. Those with Kick::around
// are in columns (flight_columns.h).
void begin_flights(StepContext &context, const Vec3 &gravity, Real h);
void end_flights(StepContext &context, Real h); // moves them, then ends the flights
// All substeps of bodies that nothing holds or touches; in one go where their flight has a closed
// form.
void fly_freely(StepContext &context, const Vec3 &gravity);

// The plain substep: gravity, damping and gyroscopic torque on the velocities and, after the
// solver, the move at its velocities (semi-implicit Euler; Hairer, Lubich, Wanner 2003, eq. 1.5).
void kick(StepContext &context, const Vec3 &gravity, Real h);
void drift(StepContext &context, Real h);

} // namespace plumb::inline PLUMB_PRECISION
