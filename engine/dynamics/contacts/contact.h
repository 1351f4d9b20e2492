// Contacts: which parts of two bodies touch, and what the solver remembers of them.
#pragma once

#include "engine/dynamics/bodies/body.h"
#include "engine/geometry/manifold.h"

#include <array>
#include <compare>
#include <cstdint>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

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

// Where a contact point is on its bodies.
struct ContactAnchor {
    // The point without the rounding of its surface (Contact), in the mass frames: a round
    // surface keeps its distance when the body rolls, so only the core's point turns with it.
    Vec3 core_a{Real(0)};
    Vec3 core_b{Real(0)};
    // The lever arms, in world axes, as of when the manifold was found.
    Vec3 arm_a{Real(0)};
    Vec3 arm_b{Real(0)};
};

// How far apart the two surfaces are at an anchor's place (m), with the bodies as they are now.
// `rounding` is that of both.
inline Real separation_along(const Vec3 &normal, const Vec3 &core_a, const Vec3 &core_b,
                             Real rounding, const Motion &a, const Motion &b) {
    const Vec3 gap = (b.position - a.position) + (b.rotation * core_b - a.rotation * core_a);
    return glm::dot(gap, normal) - rounding;
}

// How two bodies lay when their manifold was found.
struct ContactOrigin {
    Vec3 normal{Real(0)};
    Vec3 offset{Real(0)}; // from a's centre of mass to b's
    Quat rotation_a = identity_rotation;
    Quat rotation_b = identity_rotation;
};

// start: of the step. touch: where the two will meet.
enum class Moment { start, touch };

// Where the place goes on which something round rolls: straight on, its arms and normal as they
// were; with the face of a body that turns, or with a core that goes around its body's middle, on
// what is not round; or so that only the arms change, once the step shows that they do.
enum class Rolling : std::uint8_t { straight, on_face, round };

// Of an arm's length: how far the core of what rolls, or the face it rolls on, goes around in a
// step before that counts.
inline constexpr Real rolling_far = Real(3e-4);

// Two colliders that touch, or are about to, as found in this step or kept from an earlier one.
// Separations are those of the present poses.
struct Contact {
    ContactKey key;
    std::uint32_t collider_a = 0; // in the model
    std::uint32_t collider_b = 0;
    Real friction = Real(0);
    Real restitution = Real(0);
    bool sensor = false;           // pushes nothing
    bool is_new = false;           // nothing is remembered of it
    Moment moment = Moment::start; // of the step, whose poses its normal and anchors are of
    bool is_turning = false;       // goes through the substeps with a body that the scene turns
    Rolling rolling = Rolling::straight;
    bool turns_with_b = false; // if it turns; else with a
    Manifold manifold;
    ContactOrigin origin;
    // Radius of a surface that rolls: of a ball or capsule, of a cylinder on its side (m).
    Real rounding_a = Real(0);
    Real rounding_b = Real(0);
    std::array<ContactAnchor, 4> anchors{};
    // For each manifold point what the solver remembers of the last substep (N s): along the
    // normal, and along the two vectors of tangent_basis(normal).
    std::array<Vec3, 4> impulses{};

    bool turns() const { return is_turning || rolling == Rolling::on_face; }
    // How far its normal has turned since it was found, where the bodies are so.
    Quat turn(const Quat &rotation_a, const Quat &rotation_b) const {
        return turns_with_b ? rotation_b * glm::conjugate(origin.rotation_b)
                            : rotation_a * glm::conjugate(origin.rotation_a);
    }

    // How far a turn of one body (in its frame) moves a point's core around its middle, at most, in
    // lengths of its arm.
    Real way_round(bool of_a, const Vec3 &turn) const;
};

// What most ask of a contact, in a small place: contacts are large, and there are many.
struct ContactEnds {
    std::uint32_t a = 0; // bodies
    std::uint32_t b = 0;
    std::uint8_t points = 0;
    bool is_sensor = false;
    bool turns = false; // Contact::turns
};

// What is remembered of a loaded contact from step to step: its points, known by feature, with
// their impulses, and where they were found.
struct ContactMemory {
    ContactKey key;
    std::uint32_t first_point = 0;
    std::uint32_t point_count = 0; // 1..4
    ContactOrigin origin;
};
struct PointMemory {
    std::uint32_t feature = 0;
    Vec3 impulse{Real(0)};
    Vec3 core_a{Real(0)}; // ContactAnchor
    Vec3 core_b{Real(0)};
};

} // namespace plumb::inline PLUMB_PRECISION
