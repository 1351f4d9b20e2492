// Unconstrained rigid motion over one substep.
#pragma once

#include "engine/dynamics/attractor.h"
#include "engine/dynamics/bodies/body.h"

namespace plumb::inline PLUMB_PRECISION {

// The inverse inertia tensor in world axes.
Mat3 world_inverse_inertia(const Quat &rotation, const Vec3 &inv_inertia);

// R I R^T w: angular momentum (kg m^2/s, world) about the centre of mass.
Vec3 spin_momentum(const Quat &rotation, const Vec3 &inertia, const Vec3 &angular_velocity);

// `rotation` after turning with constant world `angular_velocity` for `h` seconds: exact
// (exponential map).
Quat turned(const Quat &rotation, const Vec3 &angular_velocity, Real h);

// The same of a body with its own spin, less what rounding leaves out, which it is given back next
// time.
void turn(Motion &motion, RoundedOff &rounded_off, Real h);

// The shorter way round of a rotation: its axis times its angle (rad, at most pi).
Vec3 rotation_vector(const Quat &rotation);

// Whether a turn (a rotation vector, rad) is too far for what keeps it to second order: its error
// is of the third, a millionth of the arm here.
inline bool has_turned_far(const Vec3 &turn) {
    constexpr Real far = Real(0.02);
    return turn.x * turn.x + turn.y * turn.y + turn.z * turn.z > far * far;
}

// The body-frame angular velocity after `h` seconds of torque-free spin, from `spin` in the body's
// principal axes: Euler's equations I w' = -w x I w by the implicit midpoint rule, which keeps
// kinetic energy and the length of the angular momentum for any step (quadratic invariants; Hairer,
// Lubich, Wanner 2006, "Geometric Numerical Integration", thm IV.2.1). Solved by `iterations`
// Newton steps: three reach rounding up to a third of a radian a step; where they do not, beyond a
// radian or so, the result is scaled to the energy, and the angular momentum is bounded by it.
Vec3 gyroscopic_spin(const Vec3 &inertia, const Vec3 &spin, Real h, int iterations);

// When a substep's gravity and gyroscopic torque reach the velocities that a solver works on:
// all before it (semi-implicit Euler), or half before and half after the move (velocity Verlet).
enum class Kick { before, around };

// The acceleration of gravity that a body feels: none unless it is dynamic, and none along locked
// axes.
inline Vec3 gravity_on(const Body &body, const Vec3 &gravity) {
    if (body.kind != BodyKind::dynamic)
        return Vec3{Real(0)};
    Vec3 felt = body.gravity_scale * gravity;
    for (int i = 0; body.has_locks && i < 3; ++i)
        if (body.locked[static_cast<std::size_t>(i)])
            felt[i] = Real(0);
    return felt;
}

// Its velocity after h seconds of what attractors do to it where it is.
inline void attract(Motion &motion, const Body &body, std::span<const Attractor> attractors,
                    Real h) {
    motion.velocity += h * gravity_on(body, attraction(attractors, motion.position));
}

// Whether all three moments are the same, so that a free body's spin is constant.
inline bool is_isotropic(const Vec3 &inertia) {
    return inertia.x == inertia.y && inertia.y == inertia.z;
}

// The inverse inertia in world axes, without what a locked rotation keeps from turning; with other
// principal moments than the body's.
Mat3 solver_inverse_inertia(const Body &body, const Vec3 &inv_inertia, const Quat &rotation);
// With its own.
inline Mat3 solver_inverse_inertia(const Body &body, const Quat &rotation) {
    if (!body.has_locks && is_isotropic(body.inv_inertia))
        return Mat3{body.inv_inertia.x};
    return solver_inverse_inertia(body, body.inv_inertia, rotation);
}

// Whether the spin of a body on which nothing acts is more than a constant world vector. One with a
// locked rotation is held to the axes that it has left.
bool has_gyroscopic_spin(const Body &body);

// One body's substep, with a constraint solver's velocity changes in the middle:
//
//   FreeFlight flight = begin_flight(...)   velocities for the solver to start from
//   ... the solver changes motion.velocity and motion.angular_velocity, or not ...
//   move(...)                               the pose after h
//   end_flight(...)                         velocities at the end of h
//
// A body whose velocities come back untouched flew free: its path is then exact under gravity,
// x + v h + g h^2 / 2, or with damping v' = g - c v the closed form of that, and its torque-free
// turn keeps energy and world angular momentum. Otherwise the pose follows the solver's velocities,
// which is what the constraints were solved for; between two halves of a kick, the gyroscopic
// torque is that of the spin that the solver left, or tops would sink.
struct FreeFlight {
    Vec3 velocity{Real(0)};         // what the solver was given
    Vec3 angular_velocity{Real(0)}; // likewise
    Vec3 mean_velocity{Real(0)};    // over the substep, in free flight
    Vec3 late_velocity{Real(0)};    // the part of gravity's change that comes after the move
    // Body frame, for bodies with unequal inertias: at the substep's start, with what the solver
    // has done to it; the mean over the substep; and at its end.
    Vec3 start_spin{Real(0)};
    Vec3 mean_spin{Real(0)};
    Vec3 end_spin{Real(0)};
    Vec3 late_spin{Real(0)}; // the part of damping that comes after the move, world
    bool free = false;       // set by move
    bool loaded = false;     // something turns it that did so before (note_lasting_loads)
};

FreeFlight begin_flight(SolverBody &motion, const Body &body, const Vec3 &gravity, Real h,
                        Kick kick, int gyroscopic_iterations);
void move(SolverBody &motion, RoundedOff &rounded_off, const Body &body, FreeFlight &flight,
          Real h);
void end_flight(SolverBody &motion, const Body &body, const FreeFlight &flight, Kick kick);

// The same for all moving bodies, with the flights kept in the context.
struct StepContext;
void begin_flights(StepContext &context, const Vec3 &gravity, Real h, Kick kick);
// Once what is remembered has been applied: which bodies that turns.
void note_lasting_loads(StepContext &context);
void end_flights(StepContext &context, Real h, Kick kick); // moves them, then ends the flights
// All substeps of bodies that nothing holds or touches: at once where closed forms say how they
// fly.
void fly_freely(StepContext &context, const Vec3 &gravity);

// The plain substep: gravity, damping and gyroscopic torque on the velocities, and, once the solver
// is done, the move with the velocities that it left (semi-implicit Euler; Hairer, Lubich, Wanner
// 2003, eq. 1.5).
void kick(StepContext &context, const Vec3 &gravity, Real h);
void drift(StepContext &context, Real h);

} // namespace plumb::inline PLUMB_PRECISION
