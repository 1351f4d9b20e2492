// Constraints as corrections of poses (Mueller et al. 2020, "Detailed Rigid Body Simulation with
// Extended Position Based Dynamics"; Macklin, Mueller, Chentanez 2016, "XPBD: Position-Based
// Simulation of Compliant Constrained Dynamics"): contacts, springs and particle contacts, on the
// same constraint structs as the velocity solvers. Their accumulated impulses are the papers'
// lambda here: impulse times time (kg m).
//
// Velocities computed as pose differences would lose digits. So each correction, divided by h, is
// added to the velocity immediately, and a body's displacement in the substep is h times its
// velocity; SolverBody::turned is the vector part of the substep's quaternion.
#pragma once

#include "engine/dynamics/bodies/body.h"
#include "engine/dynamics/contacts/contact_constraint.h"
#include "engine/dynamics/joints/joint_rows.h"

namespace plumb::inline PLUMB_PRECISION {

struct StepContext;

// A compliant constraint of stiffness k and damping c over a substep h: k h^2 and c h. In these
// terms (26) also holds for k = 0.
struct Compliance {
    Real stiffness = Real(0); // kg; 0 and 0: rigid
    Real damping = Real(0);   // kg
};

// Eqs. (18) and (26) of Macklin et al.: the change of lambda (kg m) for a constraint whose error is
// `error` (m or rad) and has changed by `change` in this substep, with the inverse effective mass
// `inverse_mass`.
Real multiplier(Real error, Real change, Real lambda, Real inverse_mass,
                const Compliance &compliance);

// A vector in row coordinates, turned into world axes.
Vec3 along(const RowBlock &rows, const Vec3 &row);
// 1 / the mass (or moment) that a row along (or about) n moves.
Real inverse_effective_mass(const RowBlock &rows, const SolverBody &a, const SolverBody &b,
                            const Vec3 &n);

// q += 1/2 [angle, 0] q, normalised: eqs. (8) and (9) of Mueller et al., and algorithm 2's
// prediction.
void turn_pose(SolverBody &body, const Vec3 &angle);
// `p` is a lambda along its direction (kg m), at r from the centre of mass; h is the substep.
void shift_pose(SolverBody &body, const Vec3 &p, const Vec3 &r, Real h);
void shift_poses(SolverBody &a, SolverBody &b, const Vec3 &r_a, const Vec3 &r_b, const Vec3 &p,
                 Real h);
// Displacement of a body's point at r in this substep (m); b's relative to a's.
Vec3 way_of(const SolverBody &body, const Vec3 &r, Real h);
Vec3 way_between(const SolverBody &a, const SolverBody &b, const Vec3 &r_a, const Vec3 &r_b,
                 Real h);

// One pass over the poses: penetration, then static friction. Once velocities match the poses:
// dynamic friction and restitution.
void solve_contact_poses(StepContext &context, Real h);
void solve_contact_velocities(StepContext &context, Real h);

// The same for particles, and their springs.
void begin_particle_corrections(StepContext &context);
void solve_spring_poses(StepContext &context, Real h);
void solve_particle_contact_poses(StepContext &context, Real h);
void solve_particle_contact_velocities(StepContext &context, Real h);

} // namespace plumb::inline PLUMB_PRECISION
