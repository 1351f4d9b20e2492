// What can be read off a world: energies, momenta, errors, and the hash of its state.
#include "engine/dynamics/world.h"

#include "engine/dynamics/motion.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

void add(StateHash &hash, const Vec3 &v) {
    hash.add(v.x);
    hash.add(v.y);
    hash.add(v.z);
}

void add(StateHash &hash, const Quat &q) {
    hash.add(q.w);
    hash.add(q.x);
    hash.add(q.y);
    hash.add(q.z);
}

void add(StateHash &hash, const Shape &shape) {
    hash.add(std::uint64_t{shape.index()});
    if (const auto *sphere = std::get_if<Sphere>(&shape)) {
        add(hash, sphere->center);
        hash.add(sphere->radius);
    } else if (const auto *box = std::get_if<Box>(&shape)) {
        add(hash, box->center);
        add(hash, box->rotation);
        add(hash, box->half_extents);
    } else if (const auto *capsule = std::get_if<Capsule>(&shape)) {
        add(hash, capsule->a);
        add(hash, capsule->b);
        hash.add(capsule->radius);
    } else {
        const auto &half_space = std::get<HalfSpace>(shape);
        add(hash, half_space.normal);
        hash.add(half_space.offset);
    }
}

} // namespace

// Kinetic energy of translation and rotation, and potential energy in gravity; dynamic bodies.
double World::energy_of(const Body &body, const Motion &motion) const {
    if (body.kind != BodyKind::dynamic || !body.alive)
        return 0;
    const glm::dvec3 v{motion.velocity};
    const glm::dvec3 spin =
        glm::dquat{glm::conjugate(motion.rotation)} * glm::dvec3{motion.angular_velocity};
    const double mass = body.mass;
    return 0.5 * mass * glm::dot(v, v) + 0.5 * glm::dot(glm::dvec3{body.inertia} * spin, spin) -
           mass * glm::dot(settings_.gravity, glm::dvec3{motion.position});
}

Measures World::measure() const {
    Measures m;
    m.time = time();
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        const Body &body = bodies_[i];
        if (!body.alive || body.kind != BodyKind::dynamic)
            continue;
        const Motion &motion = motions_[i];
        const double mass = body.mass;
        const glm::dvec3 x{motion.position};
        const glm::dvec3 v{motion.velocity};
        const glm::dquat rotation{motion.rotation};
        const glm::dvec3 spin = glm::conjugate(rotation) * glm::dvec3{motion.angular_velocity};
        const glm::dvec3 spin_momentum = glm::dvec3{body.inertia} * spin;
        const double potential = -mass * glm::dot(settings_.gravity, x);
        m.kinetic_energy += 0.5 * mass * glm::dot(v, v) + 0.5 * glm::dot(spin_momentum, spin);
        m.potential_energy += potential;
        m.linear_momentum += mass * v;
        m.angular_momentum += mass * glm::cross(x, v) + rotation * spin_momentum;
    }
    // The pairs of the last step, at the poses that it led to.
    double depth_sum = 0;
    int depth_count = 0;
    for (const Contact &contact : contacts_) {
        const auto shape_of = [&](std::uint32_t body) {
            return placed(bodies_[body].shape,
                          Transform{motions_[body].position, motions_[body].rotation});
        };
        if (has_diverged(motions_[contact.a]) || has_diverged(motions_[contact.b]))
            continue;
        const Manifold manifold = plumb::collide(shape_of(contact.a), shape_of(contact.b), Real(0));
        for (int k = 0; k < manifold.count; ++k) {
            const double depth =
                -static_cast<double>(manifold.points[static_cast<std::size_t>(k)].separation);
            if (depth <= 0)
                continue;
            m.max_penetration = std::max(m.max_penetration, depth);
            depth_sum += depth;
            ++depth_count;
        }
    }
    if (depth_count > 0)
        m.mean_penetration = depth_sum / depth_count;
    double drift_sum = 0;
    int drift_count = 0;
    for (const Joint &joint : joints_)
        if (joint.alive) {
            const double drift = joint_drift(joint);
            m.max_joint_drift = std::max(m.max_joint_drift, drift);
            drift_sum += drift;
            ++drift_count;
        }
    if (drift_count > 0)
        m.mean_joint_drift = drift_sum / drift_count;
    return m;
}

Vec3 World::anchor_a(const Joint &joint) const {
    if (joint.a == Joint::world)
        return joint.anchor_a_local;
    const Motion &motion = motions_[joint.a];
    return motion.position + motion.rotation * joint.anchor_a_local;
}

Vec3 World::anchor_b(const Joint &joint) const {
    if (joint.b == Joint::world)
        return joint.anchor_b_local;
    const Motion &motion = motions_[joint.b];
    return motion.position + motion.rotation * joint.anchor_b_local;
}

Real World::joint_drift(const Joint &joint) const {
    const Real distance = glm::distance(anchor_a(joint), anchor_b(joint));
    switch (joint.type) {
    case JointType::ball:
        return distance;
    case JointType::distance:
        return std::abs(distance - joint.length);
    case JointType::hinge:
    case JointType::slider:
    case JointType::fixed:
        break; // the world takes none
    }
    return Real(0);
}

std::uint64_t World::hash() const {
    StateHash hash;
    hash_settings(hash, settings_);
    for (const char c : method_->info.name)
        hash.add(static_cast<std::uint64_t>(c));
    hash.add(step_count_);
    // Bodies are named by their rank among the living, so that holes do not count.
    std::vector<std::uint64_t> rank(bodies_.size());
    std::uint64_t alive = 0;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        if (!bodies_[i].alive)
            continue;
        rank[i] = alive++;
        const Body &body = bodies_[i];
        hash.add(static_cast<std::uint64_t>(body.kind));
        add(hash, body.shape);
        hash.add(body.material.friction);
        hash.add(body.material.restitution);
        hash.add(body.mass);
        const Motion &motion = motions_[i];
        add(hash, motion.position);
        add(hash, motion.rotation);
        add(hash, motion.velocity);
        add(hash, motion.angular_velocity);
    }
    for (const Joint &joint : joints_)
        if (joint.alive) {
            hash.add(joint.a == Joint::world ? std::uint64_t{Joint::world} : rank[joint.a]);
            hash.add(joint.b == Joint::world ? std::uint64_t{Joint::world} : rank[joint.b]);
            hash.add(static_cast<std::uint64_t>(joint.type));
            add(hash, joint.anchor_a_local);
            add(hash, joint.anchor_b_local);
            hash.add(joint.length);
            hash.add(std::uint64_t{joint.collide_connected ? 1U : 0U});
            add(hash, joint.impulse);
        }
    // A point that bears no load is not remembered.
    for (const Contact &contact : contacts_)
        for (int k = 0; k < contact.manifold.count; ++k) {
            const auto index = static_cast<std::size_t>(k);
            if (contact.impulses[index] == Vec3{Real(0)})
                continue;
            hash.add(rank[contact.a] << 32 | rank[contact.b]);
            hash.add(std::uint64_t{contact.manifold.points[index].feature});
            add(hash, contact.impulses[index]);
        }
    return hash.value();
}

} // namespace plumb::inline PLUMB_PRECISION
