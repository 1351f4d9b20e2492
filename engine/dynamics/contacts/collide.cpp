// The narrow phase: where the candidates touch, and what is remembered of it.
#include "engine/dynamics/contacts/rolling_contact.h"
#include "engine/dynamics/contacts/surface_contact.h"
#include "engine/dynamics/world.h"

#include <algorithm>
#include <cmath>
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
void lead_rims(const FloorPiece &a, const FloorPiece &b, const Vec3 &half_turn, bool follows_a,
               bool follows_b, FoundManifold &found) {
    const auto lead = [&](const FloorPiece &piece, const FloorPiece &other, const Vec3 &out,
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
    contact.found_at = found.found_at;
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
    if (contact.rim_point >= 0) {
        contact.rolling = Rolling::on_face;
        contact.turns_with_b = found.on_rim_a.has_value();
    } else if (contact.is_turning) {
        contact.turns_with_b = model_->bodies[contact.key.a].kind == BodyKind::dynamic;
    } else if (!(contact.hollow > Real(0))) {
        choose_rolling(contact);
    }
    for (int k = 0; k < contact.manifold.count; ++k) {
        const auto index = static_cast<std::size_t>(k);
        if (found.found_at != FoundAt::start || contact.turns())
            contact.manifold.points[index].separation = separation_now(contact, index);
    }
}

// A step that is tried again begins as before, with the impulses that the last step left.
void World::recall_impulses() {
    Scratch &s = scratch_;
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
    choose_rolling(contact);
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
                guard_middle(candidate, scratch_.placed[i], scratch_.placed[j], found);
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
        key.triangle = ContactKey::inside;
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
