// Contacts as they persist in the world.
#pragma once

#include "engine/geometry/manifold.h"

#include <array>
#include <cstdint>

namespace plumb::inline PLUMB_PRECISION {

// Two bodies that touch, or are about to. a < b.
struct Contact {
    std::uint32_t a = 0;
    std::uint32_t b = 0;
    Real friction = Real(0);
    Real restitution = Real(0);
    Manifold manifold;
    // For each manifold point what the solver remembers of the last substep (N s): along the
    // normal, and along the two vectors of tangent_basis(normal).
    std::array<Vec3, 4> impulses{};

    std::uint64_t key() const { return pair_key(a, b); }
    static std::uint64_t pair_key(std::uint32_t a, std::uint32_t b) {
        return a < b ? (std::uint64_t{a} << 32 | b) : (std::uint64_t{b} << 32 | a);
    }
};

} // namespace plumb::inline PLUMB_PRECISION
