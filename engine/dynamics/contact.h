// Contacts: which parts of two bodies touch, and what the solver remembers of them.
#pragma once

#include "engine/geometry/manifold.h"

#include <array>
#include <compare>
#include <cstdint>

namespace plumb::inline PLUMB_PRECISION {

// Names a contact for as long as it lasts: bodies a < b, which collider of each, and which triangle
// when one of them is a surface.
struct ContactKey {
    static constexpr std::uint32_t no_triangle = UINT32_MAX;
    std::uint32_t a = 0;
    std::uint32_t b = 0;
    std::uint16_t child_a = 0;
    std::uint16_t child_b = 0;
    std::uint32_t triangle = no_triangle;
    friend auto operator<=>(const ContactKey &, const ContactKey &) = default;
};

// Two colliders that touch, or are about to, as found in this step.
struct Contact {
    ContactKey key;
    std::uint32_t collider_a = 0; // in the model
    std::uint32_t collider_b = 0;
    Real friction = Real(0);
    Real restitution = Real(0);
    bool sensor = false; // pushes nothing
    Manifold manifold;
    // For each manifold point what the solver remembers of the last substep (N s): along the
    // normal, and along the two vectors of tangent_basis(normal).
    std::array<Vec3, 4> impulses{};
};

// What is remembered of a contact from step to step: the impulses of its loaded points, known by
// feature.
struct ContactMemory {
    ContactKey key;
    std::uint32_t first_point = 0;
    std::uint32_t point_count = 0; // 1..4
};
struct PointMemory {
    std::uint32_t feature = 0;
    Vec3 impulse{Real(0)};
};

} // namespace plumb::inline PLUMB_PRECISION
