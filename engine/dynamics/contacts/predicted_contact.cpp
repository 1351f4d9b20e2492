// Contacts of bodies that do not touch yet, found where they will touch within the step, or come
// closest. The present nearest points say little about that: a ball that flies past another has the
// other's side in front of it, and would be stopped by the plane through it.
#include "engine/dynamics/bodies/solid.h"
#include "engine/dynamics/contacts/approach.h"
#include "engine/dynamics/contacts/inner_edges.h"
#include "engine/dynamics/contacts/rolling_contact.h"
#include "engine/dynamics/contacts/surface_contact.h"
#include "engine/dynamics/world.h"

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>
#include <optional>
#include <span>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

// How a body is expected to move in this step: as at its start, until a try shows otherwise.
const Motion &World::expected_motion(std::uint32_t body) const {
    return scratch_.deflected.empty() ? state_.motions[body] : scratch_.deflected_motions[body];
}

// How far two colliders may move against each other in a step (m).
Real World::way_of(const Candidate &candidate) const {
    const Motion &a = expected_motion(candidate.key.a);
    const Motion &b = expected_motion(candidate.key.b);
    const Real turning =
        glm::length(a.angular_velocity) * model_->colliders[candidate.collider_a].extent +
        glm::length(b.angular_velocity) * model_->colliders[candidate.collider_b].extent;
    return (glm::length(b.velocity - a.velocity) + turning) * static_cast<Real>(settings_.dt);
}

// How far a body's parts may go by its spin alone in a step, if that is much for its size (m): no
// farther than to its other side.
Real World::turning_reach(std::uint32_t index) const {
    if (!method_->info.looks_ahead)
        return Real(0);
    const Real spin =
        glm::length(expected_motion(index).angular_velocity) * static_cast<Real>(settings_.dt);
    if (spin == Real(0))
        return Real(0);
    const Real extent = extent_of(index);
    return spin * extent > Real(0.5) * least_half_width(model_->bodies[index])
               ? std::min(spin, Real(2)) * extent
               : Real(0);
}

Real World::extent_of(std::uint32_t index) const {
    const Body &body = model_->bodies[index];
    Real extent = Real(0);
    for (std::uint32_t c = 0; c < body.collider_count; ++c)
        extent = std::max(extent, model_->colliders[body.first_collider + c].extent);
    return extent;
}

namespace {

// A body that strikes with a corner is spun so fast that other corners could pass the contact plane
// within the step, and the whole body with them: the guard keeps at least its middle in front.
// `normal` points from the solid to the body it strikes, `plane` is a point of that. The point's
// core is the middle itself, so turning does not move it.
ManifoldPoint guard(const Vec3 &middle, Real half_width, Real rounding, const Vec3 &plane,
                    const Vec3 &normal) {
    constexpr std::uint32_t guard_feature = 0xFFFFFFFEU;
    const Real separation = glm::dot(plane - middle, normal) - half_width;
    return {middle + (rounding + Real(0.5) * separation) * normal, separation, guard_feature};
}

// Adds a solid's guard to its manifold with another solid, if that lies beneath the middle. `sign`
// is 1 if the manifold's normal points away from the solid.
void add_guard(Manifold &manifold, const Shape &solid, Real half_width, Real rounding,
               const Shape &other, Real sign) {
    const std::optional<Vec3> middle = middle_if_turning_shows(solid);
    if (manifold.count == 0 || !middle)
        return;
    const Vec3 normal = sign * manifold.normal;
    const ManifoldPoint &first = manifold.points[0];
    const Vec3 plane = first.position + (Real(0.5) * first.separation) * normal;
    const Vec3 beneath = *middle + glm::dot(plane - *middle, normal) * normal;
    if (distance_to(other, beneath) > Real(0.1) * half_width)
        return;
    const ManifoldPoint point = guard(*middle, half_width, rounding, plane, normal);
    if (manifold.count < 4)
        manifold.points[static_cast<std::size_t>(manifold.count++)] = point;
    else
        *std::ranges::max_element(manifold.points, {}, &ManifoldPoint::separation) = point;
}

} // namespace

// Guards the smaller of two solids, if they approach far for its size in a step.
void World::guard_middle(const Candidate &candidate, const Shape &solid_a, const Shape &solid_b,
                         FoundManifold &found) const {
    const Vec3 &normal = found.manifold.normal;
    const Real way =
        static_cast<Real>(settings_.dt) * glm::dot(expected_motion(candidate.key.a).velocity -
                                                       expected_motion(candidate.key.b).velocity,
                                                   normal);
    const Collider &a = model_->colliders[candidate.collider_a];
    const Collider &b = model_->colliders[candidate.collider_b];
    const bool a_moves = model_->bodies[candidate.key.a].kind == BodyKind::dynamic;
    const bool b_moves = model_->bodies[candidate.key.b].kind == BodyKind::dynamic;
    const bool is_a = a_moves && (!b_moves || a.half_width <= b.half_width);
    if (is_a && way > a.half_width)
        add_guard(found.manifold, solid_a, a.half_width,
                  rounding_along(a, found.a.rotation, normal), solid_b, Real(1));
    else if (!is_a && way > b.half_width)
        add_guard(found.manifold, solid_b, b.half_width,
                  rounding_along(b, found.b.rotation, normal), solid_a, Real(-1));
}

namespace {

// Of solids that do not touch.
Gap gap_of(const Manifold &manifold) {
    Gap gap{std::numeric_limits<Real>::infinity(), manifold.normal};
    for (int k = 0; k < manifold.count; ++k)
        gap.distance =
            std::min(gap.distance, manifold.points[static_cast<std::size_t>(k)].separation);
    return gap;
}

} // namespace

FoundManifold World::predicted_manifold(const Candidate &candidate, const Manifold &now) const {
    const Collider &a = model_->colliders[candidate.collider_a];
    const Collider &b = model_->colliders[candidate.collider_b];
    const Motion &motion_a = expected_motion(candidate.key.a);
    const Motion &motion_b = expected_motion(candidate.key.b);
    const auto dt = static_cast<Real>(settings_.dt);
    const Real near = contact_reach(candidate);
    // Other shapes' gaps are found at next to no cost.
    const bool are_hulls =
        std::holds_alternative<ConvexHull>(a.shape) && std::holds_alternative<ConvexHull>(b.shape);
    const Approach met =
        approach({&a.shape, motion_a, a.extent}, {&b.shape, motion_b, b.extent}, dt, near,
                 now.normal, are_hulls ? std::optional(gap_of(now)) : std::nullopt);
    if (met.distance >= near)
        return {};
    const Motion at_a = ahead(motion_a, met.time);
    const Motion at_b = ahead(motion_b, met.time);
    // Bodies that touch go on against each other for the rest of the step.
    const Real left = met.distance > Real(0) ? Real(0) : Real(1) - met.time / dt;
    const Shape solid_a = placed(a.shape, mass_pose(at_a));
    const Shape solid_b = placed(b.shape, mass_pose(at_b));
    FoundManifold found{
        plumb::collide(solid_a, solid_b, near + left * way_of(candidate), now.normal), at_a, at_b,
        FoundAt::touch};
    guard_middle(candidate, solid_a, solid_b, found);
    return found;
}

FoundManifold World::predicted_manifold(const Candidate &candidate, const Vec3 &normal,
                                        std::uint32_t triangle) const {
    const bool solid_first = !model_->colliders[candidate.collider_a].surface;
    const std::uint32_t solid_body = solid_first ? candidate.key.a : candidate.key.b;
    const std::uint32_t surface_body = solid_first ? candidate.key.b : candidate.key.a;
    const Collider &solid =
        model_->colliders[solid_first ? candidate.collider_a : candidate.collider_b];
    const Collider &surface =
        model_->colliders[solid_first ? candidate.collider_b : candidate.collider_a];
    const Motion &motion = expected_motion(solid_body);
    const Motion &surface_motion = expected_motion(surface_body);
    const auto dt = static_cast<Real>(settings_.dt);
    const Real near = contact_reach(candidate);
    const Triangle local = surface.surface->triangle(triangle);
    const Approach met =
        approach({&solid.shape, motion, solid.extent}, placed(local, surface.surface_pose),
                 surface_motion, surface.extent, dt, near, solid_first ? normal : -normal);
    if (met.distance >= near)
        return {};
    const Motion at_solid = ahead(motion, met.time);
    const Motion at_surface = ahead(surface_motion, met.time);
    const Real left = met.distance > Real(0) ? Real(0) : Real(1) - met.time / dt;
    const Shape solid_then = placed(solid.shape, mass_pose(at_solid));
    const Transform pose_then = surface_pose(surface, at_surface);
    // A solid that another triangle will stop has crossed this one's plane by then, and would touch
    // it from the other side.
    const auto was_behind = is_behind(
        bounds(scratch_.placed[solid_first ? candidate.collider_a : candidate.collider_b]),
        placed(local, surface_pose(surface, state_.motions[surface_body])));
    if (was_behind != is_behind(bounds(solid_then), placed(local, pose_then)))
        return {};
    Manifold manifold = plumb::collide(solid_then, *surface.surface, pose_then, triangle,
                                       near + left * way_of(candidate));
    if (solid_first)
        return {manifold, at_solid, at_surface, FoundAt::touch};
    manifold.normal = -manifold.normal;
    return {manifold, at_surface, at_solid, FoundAt::touch};
}

Real World::least_half_width(const Body &body) const {
    Real least = std::numeric_limits<Real>::infinity();
    for (std::uint32_t c = 0; c < body.collider_count; ++c)
        least = std::min(least, model_->colliders[body.first_collider + c].half_width);
    return least;
}

// After a try of the step: whether struck bodies went far, for their size, where nothing was looked
// for, and met something there. Their contacts are added, and the step must be tried again.
bool World::find_contacts_of_deflected() {
    if (!method_->info.looks_ahead)
        return false;
    Scratch &s = scratch_;
    const auto dt = static_cast<Real>(settings_.dt);
    bool any = false;
    for (const std::uint32_t i : s.moving) {
        const Body &body = model_->bodies[i];
        if (body.kind != BodyKind::dynamic || has_diverged(s.bodies[i]))
            continue;
        const Vec3 way = s.bodies[i].position - state_.motions[i].position;
        const Real enough = Real(0.5) * least_half_width(body);
        if (!(glm::length(way) > enough) ||
            !(glm::length(way - dt * expected_motion(i).velocity) > enough))
            continue;
        if (s.deflected.empty()) {
            s.deflected.assign(state_.motions.size(), 0);
            s.deflected_motions = state_.motions;
        }
        s.deflected[i] = 1;
        s.deflected_motions[i].velocity = way / dt;
        s.deflected_motions[i].angular_velocity = s.bodies[i].angular_velocity;
        any = true;
    }
    if (!any)
        return false;
    const std::vector<Candidate> expected = s.candidates;
    find_pairs();
    s.more.clear();
    for (const Candidate &candidate : s.candidates)
        collide_candidate(candidate, s.more, s.triangles.front());
    // find_missed_points looks at both.
    s.candidates.insert(s.candidates.end(), expected.begin(), expected.end());
    std::ranges::sort(s.candidates, {}, &Candidate::key);
    const auto is_same = [](const Candidate &a, const Candidate &b) { return a.key == b.key; };
    s.candidates.erase(std::unique(s.candidates.begin(), s.candidates.end(), is_same),
                       s.candidates.end());
    std::erase_if(s.more, [&](const Contact &contact) {
        return std::ranges::binary_search(s.contacts, contact.key, {}, &Contact::key);
    });
    if (s.more.empty())
        return false;
    if (wake_touched(s.more)) {
        s.deflected.clear();
        find_contacts();
        return true;
    }
    s.contacts.insert(s.contacts.end(), s.more.begin(), s.more.end());
    std::ranges::sort(s.contacts, {}, &Contact::key);
    return true;
}

} // namespace plumb::inline PLUMB_PRECISION
