// Bodies that a try of the step shows to have gone deep where no contact stopped them: impacts
// within the step had given them a spin that could not be known before.
#include "engine/dynamics/contacts/rolling_contact.h"
#include "engine/dynamics/contacts/surface_contact.h"
#include "engine/dynamics/world.h"
#include "engine/geometry/aabb.h"
#include "engine/math/rigid.h"

#include <algorithm>
#include <cmath>
#include <span>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// How deep two bodies may be in each other after a step at a place that is as far from all of their
// contact's points, as a share of the thinner one's half width. Finding such points means trying
// the step again.
constexpr Real missed_share = Real(0.25);
// The same for a solid and a surface: a body that rolls over a ridge has a point on one face, and
// comes down on the other with its far end.
constexpr Real passed_share = Real(0.05);

// Cosine between unit normals that face about the same way.
constexpr Real same_side = Real(0.4);

// A solid before and after a step, in the frame of a surface.
struct Passage {
    Transform before; // of its body
    Transform after;
    Aabb bounds_before;
    Shape solid_after;

    // How far any of its points may have gone (m); `extent`: the distance of the farthest one (m).
    Real way(Real extent) const {
        const Quat turn = glm::conjugate(before.rotation) * after.rotation;
        return glm::distance(before.position, after.position) +
               Real(2) * glm::length(Vec3{turn.x, turn.y, turn.z}) * extent;
    }
};

// The parts of the solid that have gone through a triangle from the side where its middle was: of
// the points deepest behind the plane those deeper than `deep`, and the middle, without which
// nothing would hold the solid any more (surface_contact.h). A point's path is taken as straight.
// In the surface's frame; the normal points away from the solid.
Manifold passed_points(const Passage &passage, const Collider &solid, const Triangle &triangle,
                       Sides sides, Real deep) {
    Manifold passed;
    const Vec3 cross = glm::cross(triangle.b - triangle.a, triangle.c - triangle.a);
    const Real doubled_area = glm::length(cross);
    if (!(doubled_area > Real(0)))
        return passed;
    const Vec3 front = cross / doubled_area;
    const bool was_behind = is_behind(passage.bounds_before, triangle);
    if (was_behind && sides != Sides::both)
        return passed;
    const Vec3 face = was_behind ? -front : front;
    passed.normal = -face;
    const auto height_of = [&](const Vec3 &point) { return glm::dot(face, point - triangle.a); };
    const auto is_through = [&](const Vec3 &to) {
        const Vec3 from = to_world_point(passage.before, to_local_point(passage.after, to));
        const Real height = height_of(from);
        if (height < -deep)
            return false; // was there before
        const Real share = height > Real(0) ? height / (height - height_of(to)) : Real(0);
        const Vec3 through = from + share * (to - from);
        // Within rounding of an edge it is through both triangles.
        constexpr Real rounding = Real(1e-4);
        const auto is_beyond = [&](const Vec3 &corner, const Vec3 &next) {
            return glm::dot(glm::cross(next - corner, through - corner), front) <
                   -rounding * doubled_area;
        };
        return !is_beyond(triangle.a, triangle.b) && !is_beyond(triangle.b, triangle.c) &&
               !is_beyond(triangle.c, triangle.a);
    };
    const auto add = [&](const ManifoldPoint &point) {
        passed.points[static_cast<std::size_t>(passed.count++)] = point;
    };
    constexpr std::uint32_t middle_feature = 0xFFFFFFFDU;
    const Vec3 middle = middle_of(bounds(passage.solid_after));
    if (height_of(middle) < Real(0) && is_through(middle)) {
        // Its core is the middle itself, so turning does not move it.
        const Real rounding = rounding_along(solid, passage.after.rotation, passed.normal);
        add({middle - (rounding + Real(0.5) * height_of(middle)) * face, height_of(middle),
             middle_feature});
    }
    const HalfSpace behind{face, glm::dot(face, triangle.a)};
    const Manifold lowest = collide(passage.solid_after, Shape{behind}, Real(0));
    for (int k = 0; k < lowest.count && passed.count < 4; ++k) {
        const ManifoldPoint &point = lowest.points[static_cast<std::size_t>(k)];
        if (point.separation <= -deep &&
            is_through(point.position + Real(0.5) * point.separation * face))
            add(point);
    }
    return passed;
}

} // namespace

// Adds those points, found at the poses after the try, that have no other point of the contact
// within `deep`. Returns whether there were any. If there are four points already, the one farthest
// apart gives way in contacts with a triangle or a rim; the four of two other solids are a face's,
// and stay.
bool World::add_missed(const Manifold &now, Real deep, Contact &contact) const {
    const SolverBody &at_a = scratch_.bodies[contact.key.a];
    const SolverBody &at_b = scratch_.bodies[contact.key.b];
    // On a rim, four points leave arcs between them.
    const bool may_replace =
        contact.key.triangle != ContactKey::no_triangle ||
        has_rim(model_->colliders[contact.collider_a], model_->colliders[contact.collider_b]);
    const auto separation_then = [&](const ContactAnchor &anchor) {
        return separation_along(contact.manifold.normal, anchor.core_a, anchor.core_b,
                                contact.rounding_a + contact.rounding_b, at_a, at_b);
    };
    bool any = false;
    for (int k = 0; k < now.count; ++k) {
        const ManifoldPoint &point = now.points[static_cast<std::size_t>(k)];
        const auto count = static_cast<std::size_t>(contact.manifold.count);
        std::size_t place = count;
        if (count == contact.anchors.size()) {
            const auto farthest = std::ranges::max_element(contact.anchors, {}, separation_then);
            if (!may_replace || separation_then(*farthest) < point.separation)
                continue;
            place = static_cast<std::size_t>(farthest - contact.anchors.begin());
        }
        Contact with = contact;
        with.manifold.points[place] = point;
        set_anchor(with, place, at_a, at_b);
        const ContactAnchor &anchor = with.anchors[place];
        const auto is_beside = [&](const ContactAnchor &other) {
            return glm::distance(other.core_a, anchor.core_a) <= deep ||
                   glm::distance(other.core_b, anchor.core_b) <= deep;
        };
        if (std::ranges::any_of(std::span(contact.anchors).first(count), is_beside))
            continue; // the contact has it already
        with.manifold.points[place].separation = separation_now(with, place);
        with.impulses[place] = Vec3{Real(0)};
        with.found_at = FoundAt::touch;
        with.manifold.count = static_cast<int>(std::max(count, place + 1));
        contact = with;
        any = true;
    }
    return any;
}

// Finds where two solids that touch in one place have turned deep into each other in another.
bool World::find_missed_points(Contact &contact) const {
    const Collider &a = model_->colliders[contact.collider_a];
    const Collider &b = model_->colliders[contact.collider_b];
    const Real deep = missed_share * std::min(a.half_width, b.half_width);
    const SolverBody &at_a = scratch_.bodies[contact.key.a];
    const SolverBody &at_b = scratch_.bodies[contact.key.b];
    const Real turning = glm::length(at_a.turned) * a.extent + glm::length(at_b.turned) * b.extent;
    if (!(turning > deep) || (contact.manifold.count == 4 && !has_rim(a, b)))
        return false;
    Manifold now =
        plumb::collide(placed(a.shape, mass_pose(at_a)), placed(b.shape, mass_pose(at_b)), Real(0),
                       contact.manifold.normal);
    if (!(glm::dot(now.normal, contact.manifold.normal) > same_side))
        return false;
    int kept = 0;
    for (int k = 0; k < now.count; ++k) {
        const ManifoldPoint &point = now.points[static_cast<std::size_t>(k)];
        if (point.separation <= -deep)
            now.points[static_cast<std::size_t>(kept++)] = point;
    }
    now.count = kept;
    return add_missed(now, deep, contact);
}

// Finds where a solid has gone through a surface: through any triangle, with or without a contact.
// New contacts go to `more`.
bool World::find_passed_points(const Candidate &candidate) {
    Scratch &s = scratch_;
    const Collider &a = model_->colliders[candidate.collider_a];
    const Collider &b = model_->colliders[candidate.collider_b];
    if (!a.surface == !b.surface || a.is_half_space() || b.is_half_space() || a.sensor ||
        b.sensor || is_turned(candidate))
        return false;
    const bool solid_first = !a.surface;
    const Collider &solid = solid_first ? a : b;
    const Collider &surface = solid_first ? b : a;
    if (s.paces[solid.body].is_asleep())
        return false;
    const Transform pose = surface_pose(surface, s.bodies[surface.body]);
    Passage passage;
    passage.before = compose(inverse(surface_pose(surface, state_.motions[surface.body])),
                             mass_pose(state_.motions[solid.body]));
    passage.after = compose(inverse(pose), mass_pose(s.bodies[solid.body]));
    const Real deep = passed_share * solid.half_width;
    if (!(passage.way(solid.extent) > deep))
        return false;
    passage.bounds_before = bounds(placed(solid.shape, passage.before));
    passage.solid_after = placed(solid.shape, passage.after);
    const Aabb around = joined(passage.bounds_before, bounds(passage.solid_after));
    bool any = false;
    surface.surface->each_touching(around, s.triangles.front(), [&](std::uint32_t triangle) {
        Manifold passed = passed_points(passage, solid, surface.surface->triangle(triangle),
                                        surface.surface->sides(), deep);
        if (passed.count == 0)
            return;
        passed.normal = to_world_vector(pose, solid_first ? passed.normal : -passed.normal);
        for (ManifoldPoint &point : passed.points)
            point.position = to_world_point(pose, point.position);
        ContactKey key = candidate.key;
        key.triangle = triangle;
        const auto known = std::ranges::lower_bound(s.contacts, key, {}, &Contact::key);
        if (known != s.contacts.end() && known->key == key) {
            any = (glm::dot(known->manifold.normal, passed.normal) > same_side &&
                   add_missed(passed, deep, *known)) ||
                  any;
            return;
        }
        const FoundManifold found{passed, s.bodies[key.a], s.bodies[key.b], FoundAt::touch};
        add_contact(candidate, triangle, nullptr, found, s.more);
        any = true;
    });
    return any;
}

// After a try of the step: whether contacts got points, or new contacts were found, that may stop
// in the next try whatever went too deep in this one; `of_solids`: also between two solids, not
// only between a solid and a surface.
bool World::find_missed_points(bool of_solids) {
    if (!method_->info.looks_ahead)
        return false;
    Scratch &s = scratch_;
    const auto have_diverged = [&](const ContactKey &key) {
        return has_diverged(s.bodies[key.a]) || has_diverged(s.bodies[key.b]);
    };
    bool any = false;
    for (Contact &contact : s.contacts)
        if (of_solids && contact.key.triangle == ContactKey::no_triangle && !contact.sensor &&
            !contact.is_turning && !have_diverged(contact.key))
            any = find_missed_points(contact) || any;
    s.more.clear();
    for (const Candidate &candidate : s.candidates)
        if (!have_diverged(candidate.key))
            any = find_passed_points(candidate) || any;
    if (!s.more.empty()) {
        s.contacts.insert(s.contacts.end(), s.more.begin(), s.more.end());
        std::ranges::sort(s.contacts, {}, &Contact::key);
    }
    return any;
}

} // namespace plumb::inline PLUMB_PRECISION
