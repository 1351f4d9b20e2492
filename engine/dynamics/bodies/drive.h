// What moves a body on which nothing acts but gravity, its own constant force and its damping.
#pragma once

#include "engine/dynamics/bodies/body.h"

namespace plumb::inline PLUMB_PRECISION {

// v' = g - c v over h, in closed form: how much of v is left at the end and in the mean over h, and
// how much g adds to each (with c h -> 0: 1, 1, h / 2 and h).
struct Damped {
    Real kept = Real(1);        // e^(-c h)
    Real mean_kept = Real(1);   // (1 - e^(-c h)) / (c h)
    Real gained = Real(0);      // times g: at the end
    Real mean_gained = Real(0); // times g: mean
};

Damped strongly_damped(Real rate, Real h);

// Most bodies have no damping.
inline Damped damped(Real rate, Real h) {
    return rate == Real(0) ? Damped{Real(1), Real(1), h, Real(0.5) * h} : strongly_damped(rate, h);
}

// The same in each substep of a step. The mean velocity is `mean_kept` times the initial one plus
// `mean_gain`; by the end `late_kept` and `late_gain` are added.
struct Drive {
    Real mean_kept = Real(1);
    Real late_kept = Real(0);
    Vec3 mean_gain{Real(0)}; // m/s, by gravity
    Vec3 late_gain{Real(0)};
    Vec3 gain{Real(0)}; // the whole gain
    Real kept = Real(1);
    Damped angular;
    bool is_dynamic = false;
    bool is_gyroscopic = false;
};

Drive drive_of(const Body &body, const Vec3 &gravity, Real h);

} // namespace plumb::inline PLUMB_PRECISION
