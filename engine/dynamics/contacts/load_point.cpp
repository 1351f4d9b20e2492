// Where one body presses on another: of a round or many-cornered face a contact has only four
// points, and a body tips over if its load is not between them.
#include "engine/dynamics/contacts/rolling_contact.h"
#include "engine/dynamics/world.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// Of the distance between the contact's points: the least room that a load has where points found
// without it will do, and the least that it has in a contact that is kept.
constexpr Real roomy = Real(0.12);
constexpr Real tight = Real(0.01);

// The longest distance from the first point.
Real size_of(const Manifold &manifold) {
    Real size = Real(0);
    for (int k = 1; k < manifold.count; ++k)
        size = std::max(size, glm::distance(manifold.points[static_cast<std::size_t>(k)].position,
                                            manifold.points[0].position));
    return size;
}

// Whether it stands on all points, or would if the loaded ones were less soft.
bool is_flat(const Manifold &manifold, Real size) {
    constexpr Real sag = Real(1e-4);
    constexpr Real slope = Real(2e-3);
    const auto [low, high] = std::ranges::minmax_element(
        std::span(manifold.points).first(static_cast<std::size_t>(manifold.count)), {},
        &ManifoldPoint::separation);
    return high->separation - low->separation <= sag + slope * size;
}

// Whether the faces slide, turn or rock on each other faster than `slow` (m/s). Then the points
// stand for the friction of the whole face and must not all be on one side of it, and a body that
// rolls on its rim needs the deepest point.
bool slides_or_rocks(const Manifold &manifold, Real size, const Motion &a, const Motion &b,
                     Real slow) {
    const Vec3 &at = manifold.points[0].position;
    const Vec3 velocity = (b.velocity + glm::cross(b.angular_velocity, at - b.position)) -
                          (a.velocity + glm::cross(a.angular_velocity, at - a.position));
    const Real turning = glm::length(b.angular_velocity - a.angular_velocity);
    return !(glm::length(glm::cross(velocity, manifold.normal)) + turning * size <= slow);
}

// Half of what gravity adds in a step (m/s).
Real slow_for(const StepSettings &settings) {
    return static_cast<Real>(0.5 * settings.dt * glm::length(settings.gravity));
}

} // namespace

// Whether two bodies stand on each other, flat and at rest, on a face of which four points are too
// few.
bool World::stands_on_wide_face(const Candidate &candidate, const Manifold &manifold) const {
    if (manifold.count <= 2 || !(is_wide(model_->colliders[candidate.collider_a]) ||
                                 is_wide(model_->colliders[candidate.collider_b])))
        return false;
    const Real size = size_of(manifold);
    return is_flat(manifold, size) &&
           !slides_or_rocks(manifold, size, state_.motions[candidate.key.a],
                            state_.motions[candidate.key.b], slow_for(settings_));
}

// Where the two bodies of a contact through `at` press on each other: in line with the centre of
// mass of the upper one, which does not tremble as impulses do. None if the impulses of the last
// step were elsewhere: then something else presses or pulls, or it rocks on its rim.
std::optional<Vec3> World::load_on(const Candidate &candidate, const Vec3 &normal,
                                   const Vec3 &at) const {
    constexpr Real steepest = Real(0.1);   // cosine
    constexpr Real same_face = Real(0.9);  // cosine
    constexpr Real elsewhere = Real(0.25); // of the width
    const Motion &a = state_.motions[candidate.key.a];
    const Motion &b = state_.motions[candidate.key.b];
    const Vec3 pull{settings_.gravity};
    const Real along = glm::dot(pull, normal);
    const bool is_a_above = along > Real(0);
    std::optional<Vec3> below;
    if (std::abs(along) > steepest * glm::length(pull) &&
        model_->bodies[is_a_above ? candidate.key.a : candidate.key.b].kind == BodyKind::dynamic) {
        const Vec3 &from = (is_a_above ? a : b).position;
        below = from + (glm::dot(at - from, normal) / along) * pull;
    }
    const auto face_of = [](ContactKey key) {
        key.triangle = 0;
        return key;
    };
    Vec3 sum{Real(0)};
    Real whole = Real(0);
    const ContactKey face = face_of(candidate.key);
    for (auto memory = std::ranges::lower_bound(state_.contacts, face, {}, &ContactMemory::key);
         memory != state_.contacts.end() && face_of(memory->key) == face; ++memory) {
        if (glm::dot(memory->origin.normal, normal) < same_face)
            continue;
        for (const PointMemory &point :
             std::span(state_.points).subspan(memory->first_point, memory->point_count)) {
            sum += point.impulse.x * (a.rotation * point.core_a);
            whole += point.impulse.x;
        }
    }
    if (!below || !(whole > Real(0)))
        return below;
    const Vec3 pressed = a.position + sum / whole;
    return glm::distance(pressed, *below) <= elsewhere * moving_width(candidate) ? below
                                                                                 : std::nullopt;
}

// The load, if a flat contact on a wide face leaves it too little room.
std::optional<Vec3> World::load_off_centre(const Candidate &candidate,
                                           const Manifold &manifold) const {
    constexpr Real central = Real(0.15); // of the width
    if (!stands_on_wide_face(candidate, manifold))
        return std::nullopt;
    const Real size = size_of(manifold);
    const Vec3 &normal = manifold.normal;
    const std::optional<Vec3> load = load_on(candidate, normal, manifold.points[0].position);
    if (!load || room_around(manifold, *load) >= roomy * size)
        return std::nullopt;
    // On a mesh no triangle may reach all around it.
    const bool is_mesh = model_->colliders[candidate.collider_a].surface ||
                         model_->colliders[candidate.collider_b].surface;
    const bool is_a = model_->bodies[candidate.key.a].kind == BodyKind::dynamic;
    const Vec3 arm = *load - state_.motions[is_a ? candidate.key.a : candidate.key.b].position;
    if (is_mesh && glm::length(glm::cross(arm, normal)) <= central * moving_width(candidate))
        return std::nullopt;
    return load;
}

// Whether the load of a contact that might be kept is on the border of its points, and other points
// of the two faces would leave it clearly more room.
bool World::stands_wider(const Candidate &candidate, const Manifold &manifold) const {
    constexpr Real clearly = Real(0.03); // of the width
    if (!stands_on_wide_face(candidate, manifold))
        return false;
    const std::optional<Vec3> load =
        load_on(candidate, manifold.normal, manifold.points[0].position);
    if (!load)
        return false;
    const Real room = room_around(manifold, *load);
    if (!(room < tight * size_of(manifold)))
        return false;
    const Manifold other =
        collide_under(scratch_.placed[candidate.collider_a], scratch_.placed[candidate.collider_b],
                      candidate.margin, manifold.normal, *load);
    return room_around(other, *load) > room + clearly * moving_width(candidate);
}

} // namespace plumb::inline PLUMB_PRECISION
