// Bodies: their definitions, their constant properties, and how they move.
#pragma once

#include "engine/dynamics/islands/islands.h"
#include "engine/dynamics/kinds.h"
#include "engine/geometry/hull_mesh.h"
#include "engine/geometry/shapes.h"
#include "engine/space/triangle_surface.h"

#include <array>
#include <compare>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

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

// Two colliders collide unless one of them ignores the other's layer.
struct Filter {
    std::uint32_t layer = 0;   // 0..31
    std::uint32_t ignores = 0; // bit n: layer n
    friend bool operator==(const Filter &, const Filter &) = default;
};
inline bool may_collide(const Filter &a, const Filter &b) {
    return (a.ignores >> b.layer & 1U) == 0 && (b.ignores >> a.layer & 1U) == 0;
}

// One of the shapes of a body: a solid, or a surface of triangles.
struct ColliderDef {
    Shape shape = Sphere{Vec3{Real(0)}, Real(0.5)}; // in the body's frame
    std::shared_ptr<const HullMesh> hull;           // keeps the mesh of a ConvexHull
    std::shared_ptr<const TriangleSurface>
        surface;            // instead of `shape`; bodies that are not dynamic
    Transform surface_pose; // in the body's frame
    Material material;
    Filter filter;
    bool sensor = false;    // is touched, pushes nothing
    Real density = Real(0); // kg/m^3; 0: 1000
};

// What a body is made from. A dynamic body without `mass` gets it from its colliders' densities.
// Centre of mass and moments come from the colliders unless given.
struct BodyDef {
    BodyKind kind = BodyKind::dynamic;
    std::vector<ColliderDef> colliders; // at least one; at most 65,535
    std::optional<Real> mass;           // kg, > 0; dynamic bodies only
    std::optional<Vec3> center_of_mass; // in the body's frame
    std::optional<Vec3> inertia; // kg m^2, about the body's axes through the centre of mass; > 0
    Transform pose;              // of the body's frame
    std::optional<Transform> mass_pose; // centre of mass and principal axes, bit-exact, instead of
                                        // `pose`; for continuing a saved world
    Vec3 velocity{Real(0)};             // of the centre of mass, m/s
    Vec3 angular_velocity{Real(0)};     // rad/s, world
    // Which translations, then which rotations, are locked, about the world axes.
    std::array<bool, 6> locked{};
    Real gravity_scale = Real(1);
    // Constant, in world axes, wherever the body is and however it turns; dynamic bodies only.
    Vec3 force{Real(0)};            // N, at the centre of mass
    Vec3 torque{Real(0)};           // N m
    Real linear_damping = Real(0);  // 1/s, >= 0: v' = -c v
    Real angular_damping = Real(0); // 1/s, >= 0
};

// A collider in the model: its shape placed in the body's mass frame.
struct Collider {
    Shape shape;
    std::shared_ptr<const HullMesh> hull;
    std::shared_ptr<const TriangleSurface> surface;
    Transform surface_pose;
    Material material;
    Filter filter;
    bool sensor = false;
    // The rounding radius of a sphere or capsule: the part of the surface's distance that turning
    // the body does not change.
    Real rounding = Real(0);
    Real extent = Real(0);     // the farthest its surface moves per radian that the body turns (m)
    Real half_width = Real(0); // half its least width (m); infinite for surfaces
    std::uint32_t body = UINT32_MAX; // none: an unused slot
    std::uint16_t child = 0;         // which of the body's colliders

    bool is_half_space() const { return !surface && std::holds_alternative<HalfSpace>(shape); }
};

inline constexpr std::uint32_t no_body = UINT32_MAX;

// What does not change while a body lives.
struct Body {
    BodyKind kind = BodyKind::static_body;
    bool alive = false;
    std::uint32_t generation = 0;
    std::uint32_t first_collider = 0;
    std::uint32_t collider_count = 0;
    std::uint32_t collider_room = 0; // slots from the first, counting unused ones
    // The centre of mass and the principal axes, in the body's frame. The identity for bodies that
    // are not dynamic.
    Transform mass_frame;
    bool has_mass_frame = false; // not the identity
    Real mass = Real(0);         // kg; 0 for static and kinematic
    Vec3 inertia{Real(0)};       // kg m^2, principal; 0 for static and kinematic
    Vec3 inv_inertia{Real(0)};   // 1 / inertia, or 0
    std::array<bool, 6> locked{};
    bool has_locks = false;
    Real gravity_scale = Real(1);
    Vec3 force{Real(0)};  // see BodyDef; 0 for static and kinematic
    Vec3 torque{Real(0)}; // the same
    bool has_force = false;
    bool has_torque = false;
    Real linear_damping = Real(0);
    Real angular_damping = Real(0);
    std::uint32_t joint_count = 0; // of alive joints that hold it
};

// How a body moves: the world's state, one per body in the same order.
struct Motion {
    Vec3 position{Real(0)};            // of the centre of mass
    Quat rotation = identity_rotation; // of the principal axes
    Vec3 velocity{Real(0)};            // of the centre of mass
    Vec3 angular_velocity{Real(0)};    // world

    // Velocity of a point at r from the centre of mass (world).
    Vec3 velocity_at(const Vec3 &r) const { return velocity + glm::cross(angular_velocity, r); }
};

// Pose of the centre of mass and the principal axes.
inline Transform mass_pose(const Motion &motion) {
    return {motion.position, motion.rotation};
}

// World pose of a collider's surface.
inline Transform surface_pose(const Collider &collider, const Motion &motion) {
    return {motion.position + motion.rotation * collider.surface_pose.position,
            motion.rotation * collider.surface_pose.rotation};
}

// A body as the methods see it: its motion and what derives from it. Two cache lines in single
// precision.
struct alignas(64) SolverBody : Motion {
    Vec3 inv_mass{Real(0)};    // along the world axes; they differ where one is locked
    Mat3 inv_inertia{Real(0)}; // world; follows the rotation
    Vec3 moved{Real(0)};       // since the step began (m)
    Vec3 turned{Real(0)};      // since the step began, as a rotation vector (rad, world)
    bool has_locked_translation = false;
    bool has_locks = false; // of translation or rotation

    // `impulse` (N s) acts at `r` from the centre of mass, all in world axes.
    void apply_impulse(const Vec3 &impulse, const Vec3 &r) {
        velocity += inv_mass * impulse;
        angular_velocity += inv_inertia * glm::cross(r, impulse);
    }
    void apply_angular_impulse(const Vec3 &impulse) { angular_velocity += inv_inertia * impulse; }
    // 1 / mass along a unit vector.
    Real inv_mass_along(const Vec3 &unit) const {
        return has_locked_translation ? glm::dot(unit, inv_mass * unit) : inv_mass.x;
    }
};

// Motion since the step began that was rounded off the pose (Kahan 1965). Without it a body far
// from the origin, or in many substeps, would stand still at a speed that its contacts see, and
// creep or never come to rest.
struct RoundedOff {
    Vec3 position{Real(0)};
    Quat rotation{Real(0), Real(0), Real(0), Real(0)};
};

// A diverged body has no pose and collides with nothing.
inline bool has_diverged(const Motion &motion) {
    return !is_finite(motion.position) || !is_unit(glm::dot(motion.rotation, motion.rotation));
}

} // namespace plumb::inline PLUMB_PRECISION
