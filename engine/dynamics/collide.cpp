// The narrow phase: where the candidates touch, and what is remembered of it.
#include "engine/dynamics/surface_contact.h"
#include "engine/dynamics/world.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// What the solver remembered, point by point of the same features. What points bore that are gone
// is shared out among those that are new, so that a rocking box keeps its load while its corners
// pass from one edge to the next.
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

} // namespace

// How far apart the two may be and still meet within the step; NaN when they are about to diverge.
Real World::contact_margin(const Candidate &candidate) const {
    const auto dt = static_cast<Real>(settings_.dt);
    const Motion &a = state_.motions[candidate.key.a];
    const Motion &b = state_.motions[candidate.key.b];
    const Vec3 gravity{settings_.gravity};
    // What gravity adds within the step; two bodies that feel the same fall together.
    const Vec3 falling = gravity_on(model_->bodies[candidate.key.b], gravity) -
                         gravity_on(model_->bodies[candidate.key.a], gravity);
    return static_cast<Real>(settings_.speculative_distance) +
           glm::length(b.velocity - a.velocity) * dt + glm::length(falling) * dt * dt;
}

void World::add_contact(const Candidate &candidate, std::uint32_t triangle,
                        const Manifold &manifold, std::vector<Contact> &out) const {
    if (manifold.count == 0)
        return;
    Contact &contact = out.emplace_back();
    contact.key = candidate.key;
    contact.key.triangle = triangle;
    contact.collider_a = candidate.collider_a;
    contact.collider_b = candidate.collider_b;
    contact.manifold = manifold;
    const Collider &a = model_->colliders[candidate.collider_a];
    const Collider &b = model_->colliders[candidate.collider_b];
    contact.friction = std::sqrt(a.material.friction * b.material.friction);
    contact.restitution = std::max(a.material.restitution, b.material.restitution);
    contact.sensor = a.sensor || b.sensor;
    const auto before =
        std::ranges::lower_bound(state_.contacts, contact.key, {}, &ContactMemory::key);
    if (before != state_.contacts.end() && before->key == contact.key)
        carry_over(std::span(state_.points).subspan(before->first_point, before->point_count),
                   contact);
}

void World::collide_candidate(const Candidate &candidate, std::vector<Contact> &out,
                              std::vector<std::uint32_t> &triangles) const {
    const Real margin = contact_margin(candidate);
    if (!std::isfinite(margin)) // about to diverge: speeds whose square is infinite
        return;
    const Collider &a = model_->colliders[candidate.collider_a];
    const Collider &b = model_->colliders[candidate.collider_b];
    const std::uint32_t i = candidate.collider_a;
    const std::uint32_t j = candidate.collider_b;
    if (!a.surface && !b.surface) {
        add_contact(candidate, ContactKey::no_triangle,
                    plumb::collide(scratch_.placed[i], scratch_.placed[j], margin), out);
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
    // The solid's box in the surface's frame.
    const Aabb box = bounds(solid);
    const Box around{Real(0.5) * (box.min + box.max), identity_rotation,
                     Real(0.5) * (box.max - box.min) + margin};
    const Transform back{glm::conjugate(pose.rotation) * -pose.position,
                         glm::conjugate(pose.rotation)};
    surface.surface->each_touching(
        bounds(placed(around, back)), triangles, [&](std::uint32_t triangle) {
            Manifold manifold = plumb::collide(solid, *surface.surface, pose, triangle, margin);
            if (!solid_first)
                manifold.normal = -manifold.normal;
            add_contact(candidate, triangle, manifold, out);
        });
}

// Manifolds of all candidates, with the impulses of those that were contacts before.
void World::collide(TaskPool *tasks) const {
    Scratch &s = scratch_;
    // About 20 microseconds of work in a part: enough to pay for handing it out.
    constexpr std::size_t grain = 64;
    const std::size_t count = s.candidates.size();
    const bool in_parts = tasks != nullptr && tasks->threads() > 1 && count > grain;
    const std::size_t part_count = in_parts ? (count + grain - 1) / grain : 1;
    if (s.parts.size() < part_count) {
        s.parts.resize(part_count);
        s.triangles.resize(part_count);
    }
    const auto collide_part = [&](std::size_t begin, std::size_t end) {
        const std::size_t part = begin / grain;
        s.parts[part].clear();
        for (std::size_t i = begin; i < end; ++i)
            collide_candidate(s.candidates[i], s.parts[part], s.triangles[part]);
    };
    s.contacts.clear();
    if (!in_parts) {
        collide_part(0, count);
        std::swap(s.contacts, s.parts.front());
        return;
    }
    tasks->for_parts(count, grain, std::ref(collide_part)); // by reference: nothing is allocated
    for (std::size_t part = 0; part < part_count; ++part)
        s.contacts.insert(s.contacts.end(), s.parts[part].begin(), s.parts[part].end());
}

} // namespace plumb::inline PLUMB_PRECISION
