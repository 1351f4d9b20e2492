// How stiffly a grab pulls; the same in either precision.
#pragma once

namespace plumb {

// A damped spring, tuned to the mass it holds.
struct GrabSpring {
    double frequency = 5;     // Hz, > 0
    double damping_ratio = 1; // >= 0
};

} // namespace plumb
