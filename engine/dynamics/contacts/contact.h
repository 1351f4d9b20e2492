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
// when one of them is a surface, or `inside` while the other is inside that.
struct ContactKey {
    static constexpr std::uint32_t no_triangle = UINT32_MAX;
    static constexpr std::uint32_t inside = UINT32_MAX - 1;
    std::uint32_t a = 0;
    std::uint32_t b = 0;
    std::uint16_t child_a = 0;
    std::uint16_t child_b = 0;
    std::uint32_t triangle = no_triangle;
    friend auto operator<=>(const ContactKey &, const ContactKey &) = default;
};

// Where a contact point is on its bodies.
struct ContactAnchor {
    // The point less the rounding of its surface (Contact), in the mass frames: a round surface
    // keeps its distance when the body rolls, so only the core's point turns with it.
    Vec3 core_a{Real(0)};
    Vec3 core_b{Real(0)};
    // The lever arms, in world axes, from when the manifold was found.
    Vec3 arm_a{Real(0)};
    Vec3 arm_b{Real(0)};
};

// The separation of the two surfaces at an anchor (m), with the bodies at `a` and `b`. `rounding`
// is the sum of both.
inline Real separation_along(const Vec3 &normal, const Vec3 &core_a, const Vec3 &core_b,
                             Real rounding, const Motion &a, const Motion &b) {
    const Vec3 gap = (b.position - a.position) + (b.rotation * core_b - a.rotation * core_a);
    return glm::dot(gap, normal) - rounding;
}

// The bodies' relative placement when their manifold was found.
struct ContactOrigin {
    Vec3 normal{Real(0)};
    Vec3 offset{Real(0)}; // from a's centre of mass to b's
    Quat rotation_a = identity_rotation;
    Quat rotation_b = identity_rotation;
};

// start: of the step. touch: where the bodies will meet.
enum class FoundAt { start, touch };

// How a contact point moves while a body rolls, tips, or rides on another. straight: arms and
// normal stay as they were. on_face: in each substep it follows the face of a turning body, the
// corners on which a body tips, a core that goes around its body's middle on a body that is not
// round, the line between two round surfaces, or the lowest point of a rim. round: only the arms
// change, once the step shows that they do.
enum class Rolling : std::uint8_t { straight, on_face, round };

// How far the core of a rolling body, or the face it rolls on, must go around in a step to count,
// as a share of an arm's length.
inline constexpr Real rolling_far = Real(3e-4);

// Two colliders that touch, or are about to, as found in this step or kept from an earlier one.
// Separations are at the present poses.
struct Contact {
    ContactKey key;
    std::uint32_t collider_a = 0; // in the model
    std::uint32_t collider_b = 0;
    Real friction = Real(0);
    Real restitution = Real(0);
    bool sensor = false;               // pushes nothing
    bool is_new = false;               // nothing is remembered of it
    bool is_struck = false;            // in the last substep (ContactBlock)
    bool is_pressed = false;           // struck for so long that it carries a load
    FoundAt found_at = FoundAt::start; // at whose poses its normal and anchors were found
    bool is_turning = false;           // turns through the substeps with a kinematic body
    bool is_braced = false;            // acts at one place on both bodies and turns (bracing.h)
    Rolling rolling = Rolling::straight;
    bool turns_with_b = false; // if it turns; else with a
    // Which point runs round a rim: of a if it turns with b, else of b. Below 0: none.
    int rim_point = -1;
    Manifold manifold;
    ContactOrigin origin;
    // Radius of a surface that rolls: of a ball or capsule, or of a cylinder on its side (m).
    Real rounding_a = Real(0);
    Real rounding_b = Real(0);
    std::array<ContactAnchor, 4> anchors{};
    // Per manifold point, the impulse that the solver remembers from the last substep (N s): along
    // the normal and along the two vectors of tangent_basis(normal).
    std::array<Vec3, 4> impulses{};

    // In a hollow of a surface: the radius of the arc that the solid's core points follow (m). The
    // surface then counts as a round body seen from inside: its rounding is minus the sum of this
    // and the solid's rounding. 0: no arc.
    Real hollow = Real(0);

    bool turns() const {
        return is_turning || is_braced || rolling == Rolling::on_face || hollow > Real(0);
    }
    // Between two round surfaces, one of which rolls or slides over the other.
    bool goes_round_the_other() const {
        return rolling == Rolling::on_face && rounding_a > Real(0) && rounding_b > Real(0);
    }
    // How far its normal has turned since it was found, with the bodies at these rotations: with
    // one of them, or, between two round surfaces or in a hollow, with the line between their
    // cores. `line`: from a's cores to b's, the sum over all points.
    Quat turn(const Quat &rotation_a, const Quat &rotation_b, const Vec3 &line) const;
    Vec3 line_between_cores(const Motion &a, const Motion &b) const;

    // How far a turn of one body (in its frame) moves a point's core around the body's middle at
    // most, as a share of its arm.
    Real way_round(bool of_a, const Vec3 &turn) const;
};

// What most code asks of a contact, kept small: contacts are large, and there are many.
struct ContactEnds {
    std::uint32_t a = 0; // bodies
    std::uint32_t b = 0;
    std::uint8_t points = 0;
    bool is_sensor = false;
    bool turns = false; // Contact::turns
};

// What is remembered of a loaded contact from step to step: its points, by feature id, with their
// impulses, and where they were found.
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
