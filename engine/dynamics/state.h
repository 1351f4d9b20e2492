// Everything that survives a step.
#pragma once

#include "engine/dynamics/bodies/body.h"
#include "engine/dynamics/contacts/contact.h"
#include "engine/dynamics/islands/islands.h"
#include "engine/dynamics/joints/joint.h"
#include "engine/dynamics/methods/parts/penalty.h"
#include "engine/dynamics/particles/particles.h"

#include <vector>

namespace plumb::inline PLUMB_PRECISION {

struct StateClock {
    std::uint64_t step_count = 0;
    // Simulated time is the number of steps times dt, for each dt that was set, not a running sum.
    double time_before = 0; // s, when dt was last changed
    std::uint64_t steps_before = 0;
};

// Flat arrays of plain values: a save is a copy, and a copy continues bit for bit.
struct State {
    std::vector<Motion> motions;         // one for each body of the model
    std::vector<Pace> paces;             // one for each body of the model
    std::vector<JointMemory> joints;     // one for each joint of the model
    std::vector<ContactMemory> contacts; // ascending by key
    std::vector<PointMemory> points;
    Penalties penalties;
    std::vector<ParticleMotion> particles; // one for each particle of the model
    std::vector<std::uint8_t> torn;        // one for each spring of the model
    Grab grab;
    StateClock clock;
};

} // namespace plumb::inline PLUMB_PRECISION
