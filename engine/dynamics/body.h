// Bodies: what they are, and how they move.
#pragma once

#include "engine/dynamics/kinds.h"
#include "engine/geometry/shapes.h"
#include "engine/space/dynamic_tree.h"

#include <compare>
#include <cstdint>

namespace plumb::inline PLUMB_PRECISION {

// Stays valid until the body is removed; a removed body's id never names another body.
struct BodyId {
    std::uint32_t index = UINT32_MAX;
    std::uint32_t generation = 0;
    friend auto operator<=>(const BodyId &, const BodyId &) = default;
};

// Friction of a pair: the geometric mean; restitution of a pair: the larger.
struct Material {
    Real friction = Real(0.5);  // Coulomb, >= 0
    Real restitution = Real(0); // Newton, 0..1
};

// What a body is made from.
struct BodyDef {
    BodyKind kind = BodyKind::dynamic;
    Shape shape;         // in the body's frame, centred on its origin
    Real mass = Real(1); // kg, > 0; dynamic bodies only
    Material material;
    Transform pose;
    Vec3 velocity{Real(0)};         // m/s
    Vec3 angular_velocity{Real(0)}; // rad/s, world
};

// What stays the same while a body lives, and its place in the broad phase.
struct Body {
    BodyKind kind = BodyKind::dynamic;
    Shape shape;
    Material material;
    Real mass = Real(0);                        // kg; 0 for static and kinematic
    Vec3 inertia{Real(0)};                      // kg m^2, principal; 0 for static and kinematic
    Vec3 inv_inertia{Real(0)};                  // 1 / inertia, or 0
    DynamicTree::Leaf leaf = DynamicTree::none; // half-spaces have none
    std::uint32_t generation = 0;
    bool alive = false;
};

// How a body moves: what the methods read and write. One for each body, in the same order.
struct Motion {
    Vec3 position{Real(0)}; // centre of mass
    Quat rotation = identity_rotation;
    Vec3 velocity{Real(0)};
    Vec3 angular_velocity{Real(0)}; // world
    Real inv_mass = Real(0);
    Mat3 inv_inertia{Real(0)}; // world; follows the rotation

    Vec3 velocity_at(const Vec3 &r) const { return velocity + glm::cross(angular_velocity, r); }
    // `impulse` (N s) acts at `r` from the centre of mass, all in world axes.
    void apply_impulse(const Vec3 &impulse, const Vec3 &r) {
        velocity += inv_mass * impulse;
        angular_velocity += inv_inertia * glm::cross(r, impulse);
    }
};

// Such a body is nowhere, and collides with nothing.
inline bool has_diverged(const Motion &motion) {
    return !is_finite(motion.position) || !is_unit(glm::dot(motion.rotation, motion.rotation));
}

} // namespace plumb::inline PLUMB_PRECISION
