// Which contacts turn, and how their points move, within a step: those of bodies that roll, tip
// over an edge, or ride on another that turns. What they do in each substep: turning_columns.cpp.
#include "engine/dynamics/bodies/solid.h"
#include "engine/dynamics/contacts/rolling_contact.h"
#include "engine/dynamics/world.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <variant>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

namespace plumb::inline PLUMB_PRECISION {

// Whether the body's island takes the fewest substeps or the most and asks for clearly more: it is
// too large for its budget, or its loads for any. It gets slightly fewer whenever it speeds up.
bool World::is_crowded(std::uint32_t body) const {
    const Pace &pace = state_.paces[body]; // no substeps: none are chosen
    const bool is_bounded =
        pace.substeps == settings_.substeps || pace.substeps == settings_.max_substeps;
    return is_bounded && 4 * pace.wanted > 5 * pace.substeps;
}

Vec3 Contact::line_between_cores(const Motion &a, const Motion &b) const {
    Vec3 line{Real(0)};
    for (std::size_t k = 0; k < static_cast<std::size_t>(manifold.count); ++k)
        line += (b.position - a.position) +
                (b.rotation * anchors[k].core_b - a.rotation * anchors[k].core_a);
    return line;
}

Quat Contact::turn(const Quat &rotation_a, const Quat &rotation_b, const Vec3 &line) const {
    if (hollow > Real(0)) { // the line goes to the middle of the hollow, against the normal
        const Real length = glm::length(line);
        const Real along = -glm::dot(line, manifold.normal);
        if (!(along > Real(0.5) * length))
            return identity_rotation;
        const Vec3 across = glm::cross(line, manifold.normal);
        return glm::normalize(Quat(length + along, across.x, across.y, across.z));
    }
    if (!(rounding_a > Real(0)) || !(rounding_b > Real(0)))
        return turns_with_b ? rotation_b * glm::conjugate(origin.rotation_b)
                            : rotation_a * glm::conjugate(origin.rotation_a);
    const Real length = glm::length(line);
    const Real along = glm::dot(line, manifold.normal);
    // Deep inside each other, the cores have no line between them.
    if (!(along > Real(0.5) * length))
        return identity_rotation;
    const Vec3 across = glm::cross(manifold.normal, line);
    return glm::normalize(Quat(length + along, across.x, across.y, across.z));
}

Real Contact::way_round(bool of_a, const Vec3 &turn) const {
    Real most = Real(0);
    for (int k = 0; k < manifold.count; ++k) {
        const ContactAnchor &anchor = anchors[static_cast<std::size_t>(k)];
        const Vec3 &arm = of_a ? anchor.arm_a : anchor.arm_b;
        const Vec3 way = glm::cross(turn, of_a ? anchor.core_a : anchor.core_b);
        if (way != Vec3{Real(0)})
            most = std::max(most, glm::dot(way, way) / glm::dot(arm, arm));
    }
    return std::sqrt(most);
}

// Whether the line between two round surfaces turns: as one rolls or slides over the other, its
// normal turns with it. With the normal held for the step, a ball that rolls over another would
// follow the tangents, hop, and not come off where it should.
bool World::rolls_over_the_other(const Contact &contact) const {
    constexpr Real askew = Real(1e-2);
    const auto dt = static_cast<Real>(settings_.dt);
    const Motion &a = state_.motions[contact.key.a];
    const Motion &b = state_.motions[contact.key.b];
    const Vec3 &normal = contact.manifold.normal;
    const Vec3 line = contact.line_between_cores(a, b);
    const Vec3 velocity = b.velocity - a.velocity;
    const Real length = glm::length(line);
    if (contact.found_at == FoundAt::touch &&
        glm::length(glm::cross(normal, line)) > askew * length)
        return false; // they meet later in the step
    const Real slow = dt * static_cast<Real>(glm::length(settings_.gravity));
    if (contact.is_new && std::abs(glm::dot(velocity, normal)) >= slow)
        return false; // they hit
    const Vec3 turn = static_cast<Real>(contact.manifold.count) * dt * glm::cross(normal, velocity);
    const Real way = glm::length(turn);
    // Along an axis the contact moves, and the line between the same two points is no normal.
    const auto is_along = [&](std::uint32_t collider, const Quat &rotation) {
        const std::optional<Vec3> axis = axis_of(model_->colliders[collider].shape);
        return axis &&
               glm::length(glm::cross(rotation * *axis, turn)) > askew * way * glm::length(*axis);
    };
    return way > rolling_far * length && !is_along(contact.collider_a, a.rotation) &&
           !is_along(contact.collider_b, b.rotation);
}

// Whether its contacts may follow it as it rolls. In a crowd that costs more than it is worth.
bool World::rolls_freely(std::uint32_t body) const {
    return model_->bodies[body].kind == BodyKind::dynamic && !is_crowded(body);
}

// Whether a body turns on a corner or an edge over one that does not turn: the arms turn with it.
// Held for the step, they would lag behind by half of it, and whatever rocks would lose two or
// three times the energy that its impacts take.
bool World::tips(const Contact &contact, bool is_a) const {
    // In a step, what does not count and what passes over several corners; in a substep, what is
    // too far to predict.
    constexpr Real least = Real(1e-5), several = Real(0.1), much = Real(0.05);
    const auto turn = [&](std::uint32_t body) {
        return static_cast<Real>(settings_.dt) * glm::length(state_.motions[body].angular_velocity);
    };
    const std::uint32_t body = is_a ? contact.key.a : contact.key.b;
    const std::uint32_t other = is_a ? contact.key.b : contact.key.a;
    const Real far = model_->bodies[body].joint_count > 0 ? rolling_far : least;
    if (contact.is_new || !rolls_freely(body) || !(turn(body) > std::max(far, turn(other))) ||
        turn(other) > rolling_far)
        return false;
    const Real most = much * static_cast<Real>(substeps_of(body));
    const bool has_many_corners =
        is_wide(model_->colliders[is_a ? contact.collider_a : contact.collider_b]);
    if (!(turn(body) < (has_many_corners ? std::min(several, most) : most)))
        return false;
    const auto loaded = std::ranges::count_if(
        contact.impulses, [](const Vec3 &impulse) { return impulse.x > Real(0); });
    return loaded == 1 || loaded == 2;
}

// Whether two bodies turn together, or about the normal. With arms and normal held for the step,
// whatever rides on a turntable would leave along the tangent, and a swing with a box on it would
// lose its energy.
bool World::rides(const Contact &contact) const {
    constexpr Real far = Real(1e-3); // rad in a step: stacks sway more slowly
    const Motion &a = state_.motions[contact.key.a];
    const Motion &b = state_.motions[contact.key.b];
    const Vec3 &normal = contact.manifold.normal;
    const auto dt = static_cast<Real>(settings_.dt);
    if (!rolls_freely(contact.key.a) || !rolls_freely(contact.key.b) ||
        dt * glm::length(glm::cross(normal, b.angular_velocity - a.angular_velocity)) > rolling_far)
        return false;
    const auto spins = [&](const Motion &motion) {
        return dt * std::abs(glm::dot(motion.angular_velocity, normal)) > rolling_far;
    };
    const auto goes_round = [&](const Motion &motion) {
        return dt * glm::length(motion.angular_velocity) > far;
    };
    return spins(a) || spins(b) || goes_round(a) || goes_round(b);
}

// Of a contact between two bodies that are not round there: whether its arms turn, and whether its
// normal then turns with b.
std::optional<bool> World::turns_over_b(const Contact &contact) const {
    if (tips(contact, true))
        return true;
    if (tips(contact, false))
        return false;
    if (!rides(contact))
        return std::nullopt;
    return model_->bodies[contact.key.a].mass <= model_->bodies[contact.key.b].mass;
}

// A coin that leans, a ball with a heavy side, a plank on a barrel: with arms and normal held for
// the step they would be driven apart along the tangents and swing ever wider.
Rolling World::rolling_of(const Contact &contact) const {
    // Of an arm: in a step, what does not count; in a substep, what is too far to predict.
    constexpr Real least = Real(1e-5), much = Real(0.05);
    const bool is_a = contact.rounding_a > Real(0);
    const bool is_b = contact.rounding_b > Real(0);
    if (is_a && is_b && rolls_over_the_other(contact))
        return Rolling::on_face;
    // Frictionless bodies that hit in space and slide past each other do not roll, nor do those
    // that bounce off a wall.
    if (contact.friction == Real(0) &&
        (contact.restitution > Real(0) ||
         (rolls_freely(contact.key.a) && rolls_freely(contact.key.b))))
        return Rolling::straight;
    const auto goes_round = [&](bool rolls, std::uint32_t collider) {
        return rolls && model_->colliders[collider].extent > Real(0);
    };
    const Rolling otherwise =
        goes_round(is_a, contact.collider_a) || goes_round(is_b, contact.collider_b)
            ? Rolling::round
            : Rolling::straight;
    if (is_a == is_b || contact.is_new)
        return otherwise;
    const std::uint32_t round = is_a ? contact.key.a : contact.key.b;
    const std::uint32_t flat = is_a ? contact.key.b : contact.key.a;
    const auto dt = static_cast<Real>(settings_.dt);
    const bool may_turn = rolls_freely(flat) || model_->bodies[flat].kind == BodyKind::kinematic;
    const auto turn_of = [&](std::uint32_t body) {
        return dt * glm::length(state_.motions[body].angular_velocity);
    };
    // Arms held for the step brake limbs that rock slowly: otherwise a figure on its back would
    // roll its legs for ever, as nothing in the model resists rolling.
    const auto far_of = [&](std::uint32_t body) {
        return model_->bodies[body].joint_count > 0 ? rolling_far : least;
    };
    const bool rocks = turn_of(flat) > std::max(far_of(flat), turn_of(round));
    if (may_turn && (rocks || turn_of(flat) > rolling_far))
        return Rolling::on_face;
    const Motion &motion = state_.motions[round];
    if (!rolls_freely(round) || otherwise == Rolling::straight)
        return otherwise;
    const Vec3 turn = dt * (glm::conjugate(motion.rotation) * motion.angular_velocity);
    const Real way = contact.way_round(is_a, turn);
    return way > far_of(round) && way < much * static_cast<Real>(substeps_of(round))
               ? Rolling::on_face
               : otherwise;
}

void World::choose_rolling(Contact &contact) const {
    const bool is_round = contact.rounding_a > Real(0) || contact.rounding_b > Real(0);
    contact.turns_with_b = contact.rounding_a > Real(0);
    contact.rolling = Rolling::straight;
    if (!method_->info.looks_ahead ||
        (!rolls_freely(contact.key.a) && !rolls_freely(contact.key.b)))
        return;
    if (is_round) {
        contact.rolling = rolling_of(contact);
    } else if (const std::optional<bool> over_b = turns_over_b(contact)) {
        contact.rolling = Rolling::on_face;
        contact.turns_with_b = *over_b;
    }
}

// A cylinder that stands on its rim alone is not round there: its point follows the rim.
void World::follow_rim(const FoundManifold &found, Contact &contact) const {
    if (found.on_rim_a.has_value() == found.on_rim_b.has_value())
        return;
    const bool is_a = found.on_rim_a.has_value();
    const Shape &shape = model_->colliders[is_a ? contact.collider_a : contact.collider_b].shape;
    contact.rim_point =
        plumb::follow_rim(contact.manifold, is_a ? *found.on_rim_a : *found.on_rim_b,
                          std::get<Cylinder>(shape).radius);
    if (contact.rim_point >= 0)
        (is_a ? contact.rounding_a : contact.rounding_b) = Real(0);
}

} // namespace plumb::inline PLUMB_PRECISION
