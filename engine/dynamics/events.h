// What happened within a step.
#pragma once

#include "engine/dynamics/contacts/contact.h"

namespace plumb::inline PLUMB_PRECISION {

// A bounce, or a blow without one: where, along which normal (from a to b), and how hard.
struct Impact {
    ContactKey key;
    Vec3 position{Real(0)}; // world
    Vec3 normal{Real(0)};
    Real impulse = Real(0); // N s
};

} // namespace plumb::inline PLUMB_PRECISION
