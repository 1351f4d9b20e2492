// How forces at the ends of arms stiffen a body against turning.
#pragma once

#include "engine/math/types.h"

namespace plumb::inline PLUMB_PRECISION {

// A sum over forces that keep their direction while the body turns. A force F at an arm r has the
// potential -F (R r), whose second derivative by a turn is (F r) 1 - (F r^T + r F^T) / 2: a pull
// along a stick does not stiffen it about its own axis, however thin it is.
struct GeometricStiffness {
    Mat3 tensor{Real(0)}; // world, N m
    Real most = Real(0);  // the sum of |F| |r|: no eigenvalue is larger (N m)

    void add(const Vec3 &force, const Vec3 &arm) {
        add_bound(force, arm);
        add_tensor(force, arm);
    }
    // In parts: for a ball, or where `most` is little enough, that does.
    void add_bound(const Vec3 &force, const Vec3 &arm);
    void add_tensor(const Vec3 &force, const Vec3 &arm);
};

// About each of a body's principal axes, of which `inertia` are the moments (kg m^2) and `rotation`
// the frame (N m): a bound.
// An explicit rule that follows the rate w h = f follows the body if
// h^2 times these is nowhere above f^2 times its inertia, or times larger inertia that it is given.
// Gershgorin's circles, scaled by the square roots of the moments.
Vec3 axial_stiffness(const GeometricStiffness &stiffness, const Vec3 &inertia,
                     const Quat &rotation);

// The same for a force of 1 N at an arm, whatever its direction; both in the principal frame.
Vec3 greatest_axial_stiffness(const Vec3 &arm, const Vec3 &inertia);

// The square of the largest rate (rad^2/s^2) that axial_stiffness makes; none of what cannot turn.
Real squared_rate(const Vec3 &axial, const Vec3 &inertia);

} // namespace plumb::inline PLUMB_PRECISION
