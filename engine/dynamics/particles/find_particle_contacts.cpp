// Finds where particles touch bodies, or may within the step: spheres against the colliders that
// the tree finds near their paths.
#include "engine/dynamics/contacts/approach.h"
#include "engine/dynamics/contacts/surface_contact.h"
#include "engine/dynamics/world.h"
#include "engine/geometry/aabb.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

Aabb around(const Vec3 &middle, Real reach) {
    return {middle - reach, middle + reach};
}

} // namespace

// `manifold` is between the particle's sphere and the collider, with the normal towards the
// collider and the body at `at`.
void World::add_particle_contact(std::uint32_t particle, std::uint32_t collider,
                                 const Manifold &manifold, const Motion &at,
                                 std::vector<ParticleContact> &out) const {
    if (manifold.count == 0)
        return;
    const Collider &what = model_->colliders[collider];
    const Material &own = model_->particles[particle].material;
    const ManifoldPoint &point = manifold.points[0];
    ParticleContact &contact = out.emplace_back();
    contact.particle = particle;
    contact.body = what.body;
    contact.normal = -manifold.normal;
    const Vec3 surface = point.position + (Real(0.5) * point.separation) * manifold.normal;
    contact.anchor = glm::conjugate(at.rotation) * (surface - at.position);
    contact.friction = std::sqrt(own.friction * what.material.friction);
    contact.restitution = std::max(own.restitution, what.material.restitution);
}

// One particle against one collider. A particle that travels farther than its radius in the step
// gets the contact where it will touch: the plane between particle and collider at their present
// positions would stop particles that fly past.
void World::collide_particle(std::uint32_t index, std::uint32_t collider, std::size_t part,
                             std::vector<ParticleContact> &out) const {
    Scratch &s = scratch_;
    const Collider &what = model_->colliders[collider];
    const Body &body = model_->bodies[what.body];
    const Motion &motion = state_.motions[what.body];
    const Particle &particle = model_->particles[index];
    const bool pinned = particle.inv_mass == Real(0);
    if (what.sensor || has_diverged(motion) || (pinned && body.kind != BodyKind::dynamic))
        return;
    const auto dt = static_cast<Real>(settings_.dt);
    const Vec3 pull = pull_on_particle(index);
    const Vec3 falling = pull_on(what.body) - pull;
    const Real near =
        static_cast<Real>(settings_.speculative_distance) + glm::length(falling) * dt * dt;

    Motion going; // of the sphere
    going.position = state_.particles[index].position;
    going.velocity =
        state_.particles[index].velocity + (pinned ? Vec3{Real(0)} : Real(0.5) * dt * pull);
    const Vec3 arm = going.position - motion.position;
    const Real way = dt * glm::length(going.velocity - motion.velocity -
                                      glm::cross(motion.angular_velocity, arm));
    if (!std::isfinite(way))
        return;
    const Sphere own{Vec3{Real(0)}, particle.radius};
    const Shape moving = own;
    const bool is_fast = way > particle.radius;

    const auto meet = [&](const auto &approach_of, const auto &manifold_at) {
        Approach met{Real(0), Real(0)};
        if (is_fast)
            met = approach_of();
        if (met.distance >= near)
            return;
        const Real left = !is_fast                 ? Real(1)
                          : met.distance > Real(0) ? Real(0)
                                                   : Real(1) - met.time / dt;
        const Motion at = is_fast ? ahead(motion, met.time) : motion;
        const Sphere sphere{going.position + met.time * going.velocity, particle.radius};
        add_particle_contact(index, collider, manifold_at(sphere, at, near + left * way), at, out);
    };
    if (!what.surface) {
        meet(
            [&] {
                return approach({&moving, going, Real(0)}, {&what.shape, motion, what.extent}, dt,
                                near);
            },
            [&](const Sphere &sphere, const Motion &at, Real margin) {
                return plumb::collide(
                    Shape{sphere}, placed(what.shape, Transform{at.position, at.rotation}), margin);
            });
        return;
    }
    const Transform pose = surface_pose(what, motion);
    const Vec3 local = to_local_point(pose, going.position);
    const Manifold inside =
        collide_inside(Sphere{going.position, particle.radius}, *what.surface, pose);
    if (inside.count > 0) {
        add_particle_contact(index, collider, inside, motion, out);
        return;
    }
    what.surface->each_touching(
        around(local, particle.radius + near + way), s.near_triangles[part],
        [&](std::uint32_t triangle) {
            meet(
                [&] {
                    return approach({&moving, going, Real(0)},
                                    placed(what.surface->triangle(triangle), what.surface_pose),
                                    motion, what.extent, dt, near);
                },
                [&](const Sphere &sphere, const Motion &at, Real margin) {
                    return plumb::collide(Shape{sphere}, *what.surface, surface_pose(what, at),
                                          triangle, margin);
                });
        });
}

// One particle against all colliders near its path.
void World::collide_particle(std::uint32_t index, std::size_t part,
                             std::vector<ParticleContact> &out) const {
    Scratch &s = scratch_;
    const Particle &particle = model_->particles[index];
    const ParticleMotion &motion = state_.particles[index];
    const auto dt = static_cast<Real>(settings_.dt);
    const Real fall = glm::length(pull_on_particle(index)) * dt * dt;
    const Real reach = particle.radius + dt * glm::length(motion.velocity) + fall +
                       static_cast<Real>(settings_.speculative_distance) / 2;
    const Aabb box = around(motion.position, reach);
    if (!is_finite(box.min) || !is_finite(box.max))
        return; // about to diverge
    std::vector<std::uint32_t> &near = s.near_particle[part];
    near.clear();
    s.tree.query(box, [&](std::uint32_t collider) {
        if (touch(s.swept[collider], box))
            near.push_back(collider);
        return true;
    });
    for (const std::uint32_t plane : model_->half_spaces) {
        const auto &solid = std::get<HalfSpace>(s.placed[plane]);
        const Motion &of_body = state_.motions[model_->colliders[plane].body];
        const Real moves = dt * glm::length(of_body.velocity) +
                           static_cast<Real>(settings_.speculative_distance) / 2;
        if (glm::dot(solid.normal, motion.position) - solid.offset <= reach + moves)
            near.push_back(plane);
    }
    std::ranges::sort(near);
    for (const std::uint32_t collider : near)
        collide_particle(index, collider, part, out);
}

void World::find_particle_contacts() const {
    Scratch &s = scratch_;
    s.particle_contacts.clear();
    if (!needs_particle_contacts())
        return;
    constexpr std::size_t grain = 64;
    const std::size_t count = model_->particles.size();
    const std::size_t parts = part_count(s.tasks, count, grain);
    s.near_particle.resize(std::max(s.near_particle.size(), parts));
    s.near_triangles.resize(s.near_particle.size());
    collect(s.tasks, count, grain, s.particle_contact_parts, s.particle_contacts,
            [&](std::size_t begin, std::size_t end, std::size_t part,
                std::vector<ParticleContact> &out) {
                for (std::size_t i = begin; i < end; ++i)
                    collide_particle(static_cast<std::uint32_t>(i), part, out);
            });
}

} // namespace plumb::inline PLUMB_PRECISION
