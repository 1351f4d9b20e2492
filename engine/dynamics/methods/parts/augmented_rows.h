// Rows as terms of an augmented Lagrangian (Giles, Diaz, Yuksel 2025, "Augmented Vertex Block
// Descent", sec. 3): each pushes with its load less its stiffness times its error, within its
// bounds; the load then becomes what it pushed with, and the stiffness grows with the error.
#pragma once

#include "engine/dynamics/contacts/contact_constraint.h"
#include "engine/dynamics/joints/joint_constraint.h"
#include "engine/dynamics/methods/parts/penalty.h"

namespace plumb::inline PLUMB_PRECISION {

// How rows stiffen, of a substep h: stiffness in units of what would take an error of the masses
// that a row moves back by half.
struct Stiffening {
    Real h = Real(0); // s
    Real start = Real(0);
    Real growth = Real(0); // 1/m
    Real limit = Real(0);
    Real kept = Real(0);       // gamma: of the stiffness, from substep to substep
    Real kept_error = Real(0); // alpha: of the error that was there as the substep began

    // k of a row whose unit is `unit` (N/m), as a substep begins and as a pass ends: eqs. (19) and
    // (12).
    Real begun(Real stiffness, Real unit, Real most) const;
    Real grown(Real stiffness, Real unit, Real most, Real error) const;
};

// ---- contacts

// One contact point. The relative way of its two places is along the normal and the two tangents,
// from where they were as the substep began (m).
struct AugmentedPoint {
    PointPenalty penalty;
    Real unit_normal = Real(0); // N/m
    Real unit_tangential = Real(0);
    Real start = Real(0);     // the separation that is counted as the substep begins (m)
    Vec2 start_slip{Real(0)}; // likewise
    Vec3 load{Real(0)};       // lambda: normal, tangential (N, on b)
};

struct PointForce {
    Vec3 force{Real(0)};     // normal, tangential (N, on b)
    Vec3 stiffness{Real(0)}; // likewise (N/m)
    bool holds = false;      // it bears something and does not slide
};

void begin_point(AugmentedPoint &point, Real separation, const Stiffening &stiffening);
PointForce force_of(const AugmentedPoint &point, const Vec3 &way, Real friction);
// The dual update (eqs. 11 and 12).
void end_pass(AugmentedPoint &point, const Vec3 &way, Real friction, const Stiffening &stiffening);
// What is kept for the next step: where friction holds, the slip.
void end_point(AugmentedPoint &point, const Vec3 &way, Real friction);

// ---- joints

// One block of a joint's rows.
struct AugmentedBlock {
    Vec3 stiffness{Real(0)}; // N/m, N m/rad
    Vec3 unit{Real(0)};      // likewise
    Vec3 most{Real(0)};      // likewise: of springs, their own
    Vec3 damping{Real(0)};   // N s/m, N m s/rad; springs
    Vec3 start{Real(0)};     // the error as the substep began
    Vec3 load{Real(0)};      // lambda (N, N m, on b)
};

struct BlockForce {
    Vec3 force{Real(0)}; // of each row (N, N m, on b)
    Vec3 stiffness{Real(0)};
    Vec3 error{Real(0)};              // that was counted
    std::array<bool, 3> is_bounded{}; // it pushes with all that it may, or with nothing
};

// Of rows at the poses as the substep begins.
void begin_block(AugmentedBlock &block, const RowBlock &rows, const SolverBody &a,
                 const SolverBody &b, const Stiffening &stiffening);
// `change` is how far a motor's row has come in the substep (m or rad); of other rows unused.
BlockForce force_of(const AugmentedBlock &block, const RowBlock &rows, Real change,
                    const Stiffening &stiffening);
// Returns what it pushed with.
Vec3 end_pass(AugmentedBlock &block, const RowBlock &rows, Real change,
              const Stiffening &stiffening);

} // namespace plumb::inline PLUMB_PRECISION
