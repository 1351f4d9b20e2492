// How forces at the ends of lever arms stiffen a body against turning.
#pragma once

#include "engine/math/types.h"

namespace plumb::inline PLUMB_PRECISION {

// Sum over forces that keep their direction while the body turns. A force F at an arm r has the
// potential -F (R r), whose second derivative with respect to rotation is (F r) 1 - (F r^T + r
// F^T) / 2: pulling along a stick does not stiffen it about its own axis, however thin it is.
struct GeometricStiffness {
    Mat3 tensor{Real(0)}; // world, N m
    Real most = Real(0);  // the sum of |F| |r|: no eigenvalue is larger (N m)

    void add(const Vec3 &force, const Vec3 &arm) {
        add_bound(force, arm);
        add_tensor(force, arm);
    }
    // Separately, for balls, or where a small `most` makes the tensor unnecessary.
    void add_bound(const Vec3 &force, const Vec3 &arm);
    void add_tensor(const Vec3 &force, const Vec3 &arm);
};

// An upper bound on the stiffness about each principal axis of a body (N m), given its principal
// moments `inertia` (kg m^2) and principal frame `rotation`. An explicit integrator that is good
// for rates up to w h = f follows the body if h^2 times this bound nowhere exceeds f^2 times the
// body's inertia (or an inertia raised to suit). Gershgorin circles, scaled by the square roots of
// the moments.
Vec3 axial_stiffness(const GeometricStiffness &stiffness, const Vec3 &inertia,
                     const Quat &rotation);

// The same for a 1 N force of any direction at an arm; arm and result in the principal frame.
Vec3 greatest_axial_stiffness(const Vec3 &arm, const Vec3 &inertia);

// The square of the largest rate (rad^2/s^2) due to axial_stiffness; 0 for axes that cannot turn.
Real squared_rate(const Vec3 &axial, const Vec3 &inertia);

} // namespace plumb::inline PLUMB_PRECISION
