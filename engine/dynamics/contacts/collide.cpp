// The narrow phase: where the candidates touch, and what is remembered of it.
#include "engine/dynamics/bodies/solid.h"
#include "engine/dynamics/contacts/rolling_contact.h"
#include "engine/dynamics/contacts/surface_contact.h"
#include "engine/dynamics/world.h"

#include <algorithm>
#include <cmath>
#include <concepts>
#include <optional>
#include <variant>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// The farthest that speculative_distance and kept_travel go, as shares of the smaller body's width:
// a margin that is small for a crate may be more than the thickness of a match.
constexpr Real speculative_share = Real(0.2);
constexpr Real kept_share = Real(0.05);

// Carries the solver's impulses over to the points with the same feature ids. Those of lost points
// are shared among the new ones, so that a rocking box keeps its load while its corners pass from
// one edge to the next.
void carry_over(std::span<const PointMemory> from, Contact &to) {
    std::array<bool, 4> found{};
    Vec3 lost{Real(0)};
    int fresh = to.manifold.count;
    for (const PointMemory &old : from) {
        bool gone = true;
        for (int k = 0; k < to.manifold.count && gone; ++k) {
            const auto index = static_cast<std::size_t>(k);
            if (found[index] || old.feature != to.manifold.points[index].feature)
                continue;
            to.impulses[index] = old.impulse;
            found[index] = true;
            gone = false;
            --fresh;
        }
        if (gone)
            lost += old.impulse;
    }
    if (fresh == 0)
        return;
    const Vec3 share = lost / static_cast<Real>(fresh);
    for (int k = 0; k < to.manifold.count; ++k)
        if (!found[static_cast<std::size_t>(k)])
            to.impulses[static_cast<std::size_t>(k)] = share;
}

const ContactMemory *find_memory(const State &state, const ContactKey &key) {
    const auto found = std::ranges::lower_bound(state.contacts, key, {}, &ContactMemory::key);
    return found != state.contacts.end() && found->key == key ? &*found : nullptr;
}

// The angle between two rotations, for small ones (rad).
Real turn_between(const Quat &from, const Quat &to) {
    const Quat turn = glm::conjugate(from) * to;
    return Real(2) * glm::length(Vec3{turn.x, turn.y, turn.z});
}

ContactOrigin origin_of(const Vec3 &normal, const Motion &a, const Motion &b) {
    return {normal, b.position - a.position, a.rotation, b.rotation};
}

bool touches(const Manifold &manifold, Real within) {
    for (int k = 0; k < manifold.count; ++k)
        if (manifold.points[static_cast<std::size_t>(k)].separation <= within)
            return true;
    return false;
}
// What rolls on a rim may be a hair above the other body between two steps (m).
constexpr Real rolling_gap = Real(2e-4);

// A body that rolls on a rim stands where it will in the middle of the step; `half_turn`: of a
// against b. `follows_a`, `follows_b`: whether its point may then follow the rim. Not on triangles:
// where it runs over their edges, more of what tumbles down hills would gain energy.
void lead_rims(const StaticPiece &a, const StaticPiece &b, const Vec3 &half_turn, bool follows_a,
               bool follows_b, FoundManifold &found) {
    const auto lead = [&](const StaticPiece &piece, const StaticPiece &other, const Vec3 &out,
                          const Vec3 &turn, bool follows) -> std::optional<std::uint32_t> {
        const Shape *solid = std::get_if<Shape>(&piece);
        if (solid == nullptr)
            return std::nullopt;
        const auto point = lead_along_rim(found.manifold, *solid, other, out, turn,
                                          follows ? followed_rim_sine : least_rim_sine);
        return follows ? point : std::nullopt;
    };
    const Vec3 normal = found.manifold.normal;
    found.on_rim_a = lead(a, b, normal, half_turn, follows_a);
    found.on_rim_b = lead(b, a, -normal, -half_turn, follows_b);
}

// The corners for the middle of the step and for its end.
void add_next_corners(const Shape &a, const Shape &b, const Vec3 &half_turn, Manifold &manifold) {
    const Vec3 normal = manifold.normal;
    for (const Real share : {Real(1), Real(2)}) {
        if (const auto *hull = std::get_if<ConvexHull>(&a))
            add_next_corner(manifold, *hull, b, normal, share * half_turn);
        if (const auto *hull = std::get_if<ConvexHull>(&b))
            add_next_corner(manifold, *hull, a, -normal, -share * half_turn);
    }
}

// How far two solids move against each other in a step before their turning around each other on
// the way matters: their distance then changes by way^2 / (2 width).
Real predicted_from(const Collider &a, const Collider &b) {
    return Real(0.02) * std::min(a.half_width, b.half_width);
}

} // namespace

// How far apart two colliders may be and still meet within the step although they do not move: what
// gravity adds, and a little. Two bodies that feel the same gravity fall together.
Real World::contact_reach(const Candidate &candidate) const {
    const auto dt = static_cast<Real>(settings_.dt);
    const Vec3 falling =
        scratch_.reach[candidate.collider_b].pull - scratch_.reach[candidate.collider_a].pull;
    return std::min(static_cast<Real>(settings_.speculative_distance),
                    speculative_share * moving_width(candidate)) +
           glm::length(falling) * dt * dt;
}

// The least width of the pair's colliders on dynamic bodies.
Real World::moving_width(const Candidate &candidate) const {
    Real width = std::numeric_limits<Real>::infinity();
    for (const auto &[body, collider] : {std::pair{candidate.key.a, candidate.collider_a},
                                         std::pair{candidate.key.b, candidate.collider_b}})
        if (model_->bodies[body].kind == BodyKind::dynamic)
            width = std::min(width, 2 * model_->colliders[collider].half_width);
    return width;
}

// How far apart the two colliders may be and still meet within the step; NaN if they are about to
// diverge.
Real World::contact_margin(const Candidate &candidate) const {
    const ColliderReach &a = scratch_.reach[candidate.collider_a];
    const ColliderReach &b = scratch_.reach[candidate.collider_b];
    return contact_reach(candidate) +
           glm::length(b.velocity - a.velocity) * static_cast<Real>(settings_.dt) + a.turning +
           b.turning;
}

// Where between the two surfaces a contact acts: -1 on a's, 1 on b's, 0 midway. On the dynamic
// body's if the other is not dynamic, so that a ball rolls on its own radius even if it sinks in a
// little.
Real World::acting_side(const ContactKey &key) const {
    const bool a_moves = model_->bodies[key.a].kind == BodyKind::dynamic;
    const bool b_moves = model_->bodies[key.b].kind == BodyKind::dynamic;
    return static_cast<Real>((b_moves ? 1 : 0) - (a_moves ? 1 : 0));
}

namespace {

// Needs the contact's origin.
void set_rounding(Contact &contact, const Model &model) {
    const ContactOrigin &origin = contact.origin;
    contact.rounding_a =
        rounding_along(model.colliders[contact.collider_a], origin.rotation_a, origin.normal);
    contact.rounding_b =
        rounding_along(model.colliders[contact.collider_b], origin.rotation_b, origin.normal);
}

} // namespace

// A contact without its manifold.
Contact &World::begin_contact(const Candidate &candidate, std::uint32_t triangle,
                              std::vector<Contact> &out) const {
    Contact &contact = out.emplace_back();
    contact.key = candidate.key;
    contact.key.triangle = triangle;
    contact.collider_a = candidate.collider_a;
    contact.collider_b = candidate.collider_b;
    const Collider &a = model_->colliders[candidate.collider_a];
    const Collider &b = model_->colliders[candidate.collider_b];
    contact.friction = std::sqrt(a.material.friction * b.material.friction);
    contact.restitution = std::max(a.material.restitution, b.material.restitution);
    contact.sensor = a.sensor || b.sensor;
    return contact;
}

// Sets the anchor of a manifold point, which was found with the bodies at `a` and `b`.
void World::set_anchor(Contact &contact, std::size_t k, const Motion &a, const Motion &b) const {
    const Vec3 &normal = contact.manifold.normal;
    const ManifoldPoint &point = contact.manifold.points[k];
    ContactAnchor &anchor = contact.anchors[k];
    const Real side = acting_side(contact.key);
    // The midpoint lies half the separation off either surface.
    const Real half = Real(0.5) * point.separation;
    anchor.arm_a = point.position - a.position;
    anchor.arm_b = point.position - b.position;
    anchor.core_a =
        glm::conjugate(a.rotation) * (anchor.arm_a - (half + contact.rounding_a) * normal);
    anchor.core_b =
        glm::conjugate(b.rotation) * (anchor.arm_b + (half + contact.rounding_b) * normal);
    anchor.arm_a += side * half * normal;
    anchor.arm_b += side * half * normal;
}

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
    if (contact.moment == Moment::touch && glm::length(glm::cross(normal, line)) > askew * length)
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
    if (!method_->info.looks_ahead ||
        (!rolls_freely(contact.key.a) && !rolls_freely(contact.key.b)))
        return Rolling::straight;
    if (!is_a && !is_b)
        return turns_over_b(contact) ? Rolling::on_face : Rolling::straight;
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
    if (may_turn && glm::length(state_.motions[flat].angular_velocity) * dt > rolling_far)
        return Rolling::on_face;
    const Motion &motion = state_.motions[round];
    if (!rolls_freely(round) || otherwise == Rolling::straight)
        return otherwise;
    const Vec3 turn = dt * (glm::conjugate(motion.rotation) * motion.angular_velocity);
    const Real way = contact.way_round(is_a, turn);
    // Arms held for the step brake limbs that rock slowly: otherwise a figure on its back would
    // roll its legs for ever, as nothing in the model resists rolling.
    const Real far = model_->bodies[round].joint_count > 0 ? rolling_far : least;
    return way > far && way < much * static_cast<Real>(substeps_of(round)) ? Rolling::on_face
                                                                           : otherwise;
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

Real World::separation_now(const Contact &contact, std::size_t k) const {
    const ContactAnchor &anchor = contact.anchors[k];
    return separation_along(contact.manifold.normal, anchor.core_a, anchor.core_b,
                            contact.rounding_a + contact.rounding_b, state_.motions[contact.key.a],
                            state_.motions[contact.key.b]);
}

void World::add_contact(const Candidate &candidate, std::uint32_t triangle,
                        const ContactMemory *before, const FoundManifold &found,
                        std::vector<Contact> &out) const {
    if (found.manifold.count == 0)
        return;
    Contact &contact = begin_contact(candidate, triangle, out);
    contact.manifold = found.manifold;
    contact.moment = found.moment;
    contact.is_turning = found.is_turning;
    contact.origin = origin_of(contact.manifold.normal, found.a, found.b);
    set_rounding(contact, *model_);
    follow_rim(found, contact);
    if (found.hollow > Real(0)) {
        contact.hollow = found.hollow;
        const bool solid_first = !model_->colliders[contact.collider_a].surface;
        (solid_first ? contact.rounding_b : contact.rounding_a) =
            -(found.hollow + (solid_first ? contact.rounding_a : contact.rounding_b));
    }
    contact.is_new = before == nullptr;
    for (int k = 0; k < contact.manifold.count; ++k) {
        const auto index = static_cast<std::size_t>(k);
        set_anchor(contact, index, found.a, found.b);
    }
    if (!contact.is_new)
        carry_over(std::span(state_.points).subspan(before->first_point, before->point_count),
                   contact);
    if (contact.rim_point >= 0)
        contact.rolling = Rolling::on_face;
    else if (!contact.is_turning && !(contact.hollow > Real(0)))
        contact.rolling = rolling_of(contact);
    const bool is_round = contact.rounding_a > Real(0) || contact.rounding_b > Real(0);
    contact.turns_with_b = contact.rim_point >= 0 ? found.on_rim_a.has_value()
                           : contact.is_turning
                               ? model_->bodies[contact.key.a].kind == BodyKind::dynamic
                           : is_round ? contact.rounding_a > Real(0)
                                      : turns_over_b(contact).value_or(false);
    for (int k = 0; k < contact.manifold.count; ++k) {
        const auto index = static_cast<std::size_t>(k);
        if (found.moment != Moment::start || contact.turns())
            contact.manifold.points[index].separation = separation_now(contact, index);
    }
}

// A step that is tried again begins as before, with the impulses that the last step left.
void World::recall_impulses() {
    Scratch &s = scratch_;
    constexpr std::size_t contacts_a_part = 256;
    for_parts(s.tasks, s.contacts.size(), contacts_a_part, [&](std::size_t begin, std::size_t end) {
        for (Contact &contact : std::span(s.contacts).subspan(begin, end - begin)) {
            contact.impulses = {};
            if (contact.is_new)
                continue;
            const ContactMemory &memory = *find_memory(state_, contact.key);
            carry_over(std::span(state_.points).subspan(memory.first_point, memory.point_count),
                       contact);
        }
    });
}

// Whether a body's loads ask for more substeps than its island has: its contacts are then softer
// than they should be. With far too few it sinks in and does not stand at all.
bool World::gets_too_few_substeps(std::uint32_t body) const {
    constexpr int far_too_few = 10; // times: contacts are 100 times as deep as they should be
    const Pace &pace = state_.paces[body]; // no substeps: nothing is chosen
    return pace.wanted > pace.substeps && pace.wanted < far_too_few * pace.substeps;
}

// While two bodies have hardly moved against each other since their manifold was found, it is kept:
// normal and lever arms stay, separations follow the poses. That saves finding it again, and makes
// the contact linear about the poses where it was found: otherwise a column of contacts, each as
// soft as the step lets it be, buckles under its own weight. After Box3D (Catto), which names
// PhysX's persistent manifolds as the source. Contacts that are softer than they should be buckle
// sooner, and are kept longer: without that a pyramid of base 100 falls after 10 s.
bool World::keep_contact(const Candidate &candidate, const ContactMemory *before,
                         std::vector<Contact> &out) const {
    if (before == nullptr || before->point_count < 2)
        return false;
    const Motion &motion_a = state_.motions[candidate.key.a];
    const Motion &motion_b = state_.motions[candidate.key.b];
    const ContactOrigin &origin = before->origin;
    const auto points = std::span(state_.points).subspan(before->first_point, before->point_count);
    Real arm_a = Real(0);
    Real arm_b = Real(0);
    for (const PointMemory &point : points) {
        arm_a = std::max(arm_a, glm::dot(point.core_a, point.core_a));
        arm_b = std::max(arm_b, glm::dot(point.core_b, point.core_b));
    }
    const Real travel = glm::length((motion_b.position - motion_a.position) - origin.offset) +
                        std::sqrt(arm_a) * turn_between(origin.rotation_a, motion_a.rotation) +
                        std::sqrt(arm_b) * turn_between(origin.rotation_b, motion_b.rotation);
    const auto usual = static_cast<Real>(settings_.kept_travel);
    // A full face has no omitted corners that could come to touch.
    const bool stays_longer =
        before->point_count == 4 && way_of(candidate) <= usual &&
        (gets_too_few_substeps(candidate.key.a) || gets_too_few_substeps(candidate.key.b));
    if (method_->info.looks_ahead && rolls_off(candidate, origin))
        return false;
    const Real share = kept_share * moving_width(candidate);
    const Real most = stays_longer ? share : std::min(usual, share);
    if (!(travel <= most))
        return false;
    Contact &contact = begin_contact(candidate, ContactKey::no_triangle, out);
    contact.origin = origin;
    set_rounding(contact, *model_);
    const Real side = acting_side(candidate.key);
    const Vec3 &normal = origin.normal;
    const Mat3 then_a = glm::mat3_cast(origin.rotation_a);
    const Mat3 then_b = glm::mat3_cast(origin.rotation_b);
    const Mat3 now_a = glm::mat3_cast(motion_a.rotation);
    const Mat3 now_b = glm::mat3_cast(motion_b.rotation);
    const Vec3 offset = motion_b.position - motion_a.position;
    contact.manifold.normal = normal;
    contact.manifold.count = static_cast<int>(before->point_count);
    for (std::size_t k = 0; k < points.size(); ++k) {
        const PointMemory &point = points[k];
        contact.impulses[k] = point.impulse;
        ContactAnchor &anchor = contact.anchors[k];
        anchor.core_a = point.core_a;
        anchor.core_b = point.core_b;
        const Vec3 surface_a = then_a * point.core_a + contact.rounding_a * normal;
        const Vec3 surface_b = then_b * point.core_b - contact.rounding_b * normal;
        const Vec3 half =
            Real(0.5) * glm::dot(origin.offset + (surface_b - surface_a), normal) * normal;
        anchor.arm_a = surface_a + (Real(1) + side) * half;
        anchor.arm_b = surface_b - (Real(1) - side) * half;
        ManifoldPoint &to = contact.manifold.points[k];
        const Vec3 core_a = now_a * point.core_a;
        const Vec3 core_b = now_b * point.core_b;
        to.feature = point.feature;
        to.separation = glm::dot(offset + (core_b - core_a), normal) -
                        (contact.rounding_a + contact.rounding_b);
        to.position =
            motion_a.position + core_a + (contact.rounding_a + Real(0.5) * to.separation) * normal;
    }
    contact.rolling = rolling_of(contact);
    if (contact.rolling != Rolling::on_face && !misses_corner(candidate, contact.manifold) &&
        !stands_wider(candidate, contact.manifold))
        return true;
    out.pop_back();
    return false;
}

// How far a turns against b in half a step.
Vec3 World::half_turn_of(const Candidate &candidate) const {
    return (Real(0.5) * static_cast<Real>(settings_.dt)) *
           (expected_motion(candidate.key.a).angular_velocity -
            expected_motion(candidate.key.b).angular_velocity);
}

// Whether either body rolls on a rim and will get lower there than where it stood.
bool World::rolls_off(const Candidate &candidate, const ContactOrigin &origin) const {
    constexpr Real much = Real(1e-6); // of its width
    const Collider &a = model_->colliders[candidate.collider_a];
    const Collider &b = model_->colliders[candidate.collider_b];
    if (!has_rim(a, b))
        return false;
    const Vec3 half_turn = half_turn_of(candidate);
    return rolled_depth(a.shape, origin.rotation_a, state_.motions[candidate.key.a].rotation,
                        origin.normal, half_turn) > much * a.half_width ||
           rolled_depth(b.shape, origin.rotation_b, state_.motions[candidate.key.b].rotation,
                        -origin.normal, -half_turn) > much * b.half_width;
}

// Whether a hull rolls off its contact's points onto corners that the contact does not have.
bool World::misses_corner(const Candidate &candidate, const Manifold &manifold) const {
    constexpr Real much = Real(1e-6); // of its width
    const auto misses = [&](std::uint32_t collider, const Vec3 &out, const Vec3 &turn) {
        const auto *hull = std::get_if<ConvexHull>(&scratch_.placed[collider]);
        return hull != nullptr && missed_depth(manifold, *hull, out, turn) >
                                      much * model_->colliders[collider].half_width;
    };
    const Vec3 turn = Real(2) * half_turn_of(candidate);
    return method_->info.looks_ahead && (misses(candidate.collider_a, manifold.normal, turn) ||
                                         misses(candidate.collider_b, -manifold.normal, -turn));
}

bool World::keeps_contacts() const {
    return settings_.kept_travel > 0 &&
           std::ranges::find(method_->info.reads, SettingGroup::kept) != method_->info.reads.end();
}

void World::collide_candidate(const Candidate &candidate, std::vector<Contact> &out,
                              std::vector<std::uint32_t> &triangles) const {
    const Real margin = candidate.margin;
    const Collider &a = model_->colliders[candidate.collider_a];
    const Collider &b = model_->colliders[candidate.collider_b];
    const std::uint32_t i = candidate.collider_a;
    const std::uint32_t j = candidate.collider_b;
    const Motion &motion_a = state_.motions[candidate.key.a];
    const Motion &motion_b = state_.motions[candidate.key.b];
    const bool is_predicted = method_->info.looks_ahead && !a.sensor && !b.sensor &&
                              way_of(candidate) > predicted_from(a, b);
    const bool is_turning = is_turned(candidate);
    const bool leads = method_->info.looks_ahead && !is_turning;
    const Real gap = has_rim(a, b) ? rolling_gap : Real(0);
    if (!a.surface && !b.surface) {
        const ContactMemory *before = find_memory(state_, candidate.key);
        if (!is_turning && keeps_contacts() && keep_contact(candidate, before, out))
            return;
        const Vec3 guess = before == nullptr ? Vec3{Real(0)} : before->origin.normal;
        FoundManifold found{plumb::collide(scratch_.placed[i], scratch_.placed[j], margin, guess),
                            motion_a, motion_b};
        if (const std::optional<Vec3> load = load_off_centre(candidate, found.manifold))
            found.manifold = collide_under(scratch_.placed[i], scratch_.placed[j], margin,
                                           found.manifold.normal, *load);
        if (touches(found.manifold, gap)) {
            if (leads) {
                const Vec3 half_turn = half_turn_of(candidate);
                if (has_rim(a, b))
                    lead_rims(scratch_.placed[i], scratch_.placed[j], half_turn,
                              rolls_freely(a.body), rolls_freely(b.body), found);
                add_next_corners(scratch_.placed[i], scratch_.placed[j], half_turn, found.manifold);
            }
            if (is_predicted)
                guard_middle(candidate, scratch_.placed[i], scratch_.placed[j], found.manifold);
        } else if (found.manifold.count > 0 && is_predicted) {
            found = predicted_manifold(candidate, found.manifold);
        }
        found.is_turning = is_turning;
        drop_inner_edges(candidate, ContactKey::no_triangle, found);
        add_contact(candidate, ContactKey::no_triangle, before, found, out);
        return;
    }
    if (a.surface && b.surface)
        return; // surfaces are never dynamic
    const bool solid_first = !a.surface;
    const Shape &solid = scratch_.placed[solid_first ? i : j];
    if (std::holds_alternative<HalfSpace>(solid))
        return;
    const Collider &surface = solid_first ? b : a;
    const Transform pose = surface_pose(surface, state_.motions[surface.body]);
    FoundManifold inside{collide_inside(solid, *surface.surface, pose), motion_a, motion_b};
    if (inside.manifold.count > 0) {
        if (!solid_first)
            inside.manifold.normal = -inside.manifold.normal;
        ContactKey key = candidate.key;
        key.triangle = 0; // for all of the surface
        add_contact(candidate, key.triangle, find_memory(state_, key), inside, out);
        return;
    }
    // The solid's box in the surface's frame.
    const Aabb box = bounds(solid);
    const Box around{Real(0.5) * (box.min + box.max), identity_rotation,
                     Real(0.5) * (box.max - box.min) + margin};
    const Transform back{glm::conjugate(pose.rotation) * -pose.position,
                         glm::conjugate(pose.rotation)};
    surface.surface->each_touching(
        bounds(placed(around, back)), triangles, [&](std::uint32_t triangle) {
            FoundManifold found{plumb::collide(solid, *surface.surface, pose, triangle, margin),
                                motion_a, motion_b};
            if (!solid_first)
                found.manifold.normal = -found.manifold.normal;
            if (const std::optional<Vec3> load = load_off_centre(candidate, found.manifold)) {
                found.manifold =
                    plumb::collide(solid, *surface.surface, pose, triangle, margin, &*load);
                if (!solid_first)
                    found.manifold.normal = -found.manifold.normal;
            }
            if (is_predicted && !touches(found.manifold, gap))
                found = predicted_manifold(candidate, found.manifold.normal, triangle);
            else if (leads && has_rim(a, b) && touches(found.manifold, gap)) {
                const Triangle there = placed(surface.surface->triangle(triangle), pose);
                const Vec3 half_turn = half_turn_of(candidate);
                if (solid_first)
                    lead_rims(solid, there, half_turn, false, false, found);
                else
                    lead_rims(there, solid, half_turn, false, false, found);
            }
            found.is_turning = is_turning;
            if (leads)
                follow_hollow(candidate, triangle, found);
            drop_inner_edges(candidate, triangle, found);
            ContactKey key = candidate.key;
            key.triangle = triangle;
            add_contact(candidate, triangle, find_memory(state_, key), found, out);
        });
}

// Manifolds of all candidates, with the impulses of known contacts.
void World::collide() const {
    Scratch &s = scratch_;
    // About 20 microseconds of work in a part: enough to pay for handing it out.
    constexpr std::size_t grain = 64;
    const std::size_t count = s.candidates.size();
    s.triangles.resize(std::max(s.triangles.size(), part_count(s.tasks, count, grain)));
    collect(s.tasks, count, grain, s.contact_parts, s.contacts,
            [&](std::size_t begin, std::size_t end, std::size_t part, std::vector<Contact> &out) {
                for (std::size_t i = begin; i < end; ++i)
                    collide_candidate(s.candidates[i], out, s.triangles[part]);
            });
}

} // namespace plumb::inline PLUMB_PRECISION
