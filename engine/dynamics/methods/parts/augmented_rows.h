// Rows as terms of an augmented Lagrangian (Giles, Diaz, Yuksel 2025, "Augmented Vertex Block
// Descent", sec. 3): each pushes with its load minus stiffness times error, within its bounds; the
// load then becomes that force, and the stiffness grows with the error.
#pragma once

#include "engine/dynamics/contacts/contact_constraint.h"
#include "engine/dynamics/joints/joint_constraint.h"
#include "engine/dynamics/methods/parts/penalty.h"

namespace plumb::inline PLUMB_PRECISION {

// How rows stiffen in a substep h. The unit of stiffness is the row's effective mass over h^2, with
// which a pass removes half of an error.
struct Stiffening {
    Real h = Real(0); // s
    Real start = Real(0);
    Real growth = Real(0); // 1/m
    Real limit = Real(0);
    Real kept = Real(0);       // gamma: share of the stiffness kept per substep
    Real kept_error = Real(0); // alpha: share of the initial error left alone

    // A row's stiffness at the start of a substep, eq. (19), and after a pass, eq. (12); `unit` is
    // its unit (N/m).
    Real begun(Real stiffness, Real unit, Real most) const;
    Real grown(Real stiffness, Real unit, Real most, Real error) const;
};

// ---- contacts

// One contact point. `way` is its relative displacement since the substep began, along the normal
// and the two tangents (m).
struct AugmentedPoint {
    PointPenalty penalty;
    Real unit_normal = Real(0); // N/m
    Real unit_tangential = Real(0);
    Real start = Real(0);     // separation counted at the substep's start (m)
    Vec2 start_slip{Real(0)}; // likewise
    Vec3 load{Real(0)};       // lambda: normal, tangential (N, on b)
};

struct PointForce {
    Vec3 force{Real(0)};     // normal, tangential (N, on b)
    Vec3 stiffness{Real(0)}; // likewise (N/m)
    bool holds = false;      // loaded and not sliding
};

void begin_point(AugmentedPoint &point, Real separation, const Stiffening &stiffening);
PointForce force_of(const AugmentedPoint &point, const Vec3 &way, Real friction);
// The dual update (eqs. 11 and 12).
void end_pass(AugmentedPoint &point, const Vec3 &way, Real friction, const Stiffening &stiffening);
// Keeps the slip for the next step where friction holds.
void end_point(AugmentedPoint &point, const Vec3 &way, Real friction);

// ---- joints

// One block of a joint's rows.
struct AugmentedBlock {
    Vec3 stiffness{Real(0)}; // N/m, N m/rad
    Vec3 unit{Real(0)};      // likewise
    Vec3 most{Real(0)};      // upper bound; a spring's own stiffness
    Vec3 damping{Real(0)};   // N s/m, N m s/rad; springs
    Vec3 start{Real(0)};     // the error at the substep's start
    Vec3 load{Real(0)};      // lambda (N, N m, on b)
};

struct BlockForce {
    Vec3 force{Real(0)}; // of each row (N, N m, on b)
    Vec3 stiffness{Real(0)};
    Vec3 error{Real(0)};              // as counted in `force`
    std::array<bool, 3> is_bounded{}; // at a bound: full force, or none
};

// Begins a substep, with the rows at its initial poses.
void begin_block(AugmentedBlock &block, const RowBlock &rows, const SolverBody &a,
                 const SolverBody &b, const Stiffening &stiffening);
// `change` is how far a motor's row has moved in the substep (m or rad); other rows ignore it.
BlockForce force_of(const AugmentedBlock &block, const RowBlock &rows, Real change,
                    const Stiffening &stiffening);
// Returns the force that it pushed with.
Vec3 end_pass(AugmentedBlock &block, const RowBlock &rows, Real change,
              const Stiffening &stiffening);

} // namespace plumb::inline PLUMB_PRECISION
