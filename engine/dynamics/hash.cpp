// The hash of everything that decides the future.
#include "engine/dynamics/world.h"

#include "engine/geometry/hull_mesh.h"

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

void add(StateHash &hash, const Transform &pose) {
    add(hash, pose.position);
    add(hash, pose.rotation);
}

void add_shape(StateHash &hash, const Sphere &sphere) {
    add(hash, sphere.center);
    hash.add(sphere.radius);
}
void add_shape(StateHash &hash, const Box &box) {
    add(hash, box.center);
    add(hash, box.rotation);
    add(hash, box.half_extents);
}
void add_shape(StateHash &hash, const Capsule &capsule) {
    add(hash, capsule.a);
    add(hash, capsule.b);
    hash.add(capsule.radius);
}
void add_shape(StateHash &hash, const Cylinder &cylinder) {
    add(hash, cylinder.a);
    add(hash, cylinder.b);
    hash.add(cylinder.radius);
}
void add_shape(StateHash &hash, const ConvexHull &hull) {
    add(hash, hull.position);
    add(hash, hull.rotation);
    for (const Vec3 &vertex : hull.mesh->vertices)
        add(hash, vertex);
}
void add_shape(StateHash &hash, const HalfSpace &half_space) {
    add(hash, half_space.normal);
    hash.add(half_space.offset);
}

void add(StateHash &hash, const Collider &collider) {
    if (collider.surface) {
        hash.add(collider.surface->content_hash());
        add(hash, collider.surface_pose);
    } else {
        hash.add(std::uint64_t{collider.shape.index()});
        std::visit([&](const auto &shape) { add_shape(hash, shape); }, collider.shape);
    }
    hash.add(collider.material.friction);
    hash.add(collider.material.restitution);
    hash.add(std::uint64_t{collider.filter.layer} << 32 | collider.filter.ignores);
    hash.add(static_cast<std::uint64_t>(collider.sensor));
}

void add(StateHash &hash, const Body &body) {
    hash.add(static_cast<std::uint64_t>(body.kind));
    add(hash, body.mass_frame);
    hash.add(body.mass);
    add(hash, body.inertia);
    for (const bool locked : body.locked)
        hash.add(static_cast<std::uint64_t>(locked));
    hash.add(body.gravity_scale);
    hash.add(body.linear_damping);
    hash.add(body.angular_damping);
    if (body.has_force || body.has_torque) {
        add(hash, body.force);
        add(hash, body.torque);
    }
}

void add(StateHash &hash, const Motion &motion) {
    add(hash, motion.position);
    add(hash, motion.rotation);
    add(hash, motion.velocity);
    add(hash, motion.angular_velocity);
}

void add(StateHash &hash, const Joint &joint) {
    hash.add(static_cast<std::uint64_t>(joint.type));
    add(hash, joint.anchor_a_local);
    add(hash, joint.anchor_b_local);
    add(hash, joint.frame_a_local);
    add(hash, joint.frame_b_local);
    hash.add(joint.min_length);
    hash.add(joint.max_length);
    const JointLimits limits = joint.limits.value_or(JointLimits{});
    const JointMotor motor = joint.motor.value_or(JointMotor{});
    hash.add(static_cast<std::uint64_t>(joint.limits.has_value()) << 1 |
             static_cast<std::uint64_t>(joint.motor.has_value()));
    for (const Real value : {limits.lower, limits.upper, motor.speed, motor.max_force,
                             joint.frequency, joint.damping_ratio, joint.break_force})
        hash.add(value);
    hash.add(static_cast<std::uint64_t>(joint.collide_connected));
}

// No penalties hash the same as zeros.
template <std::size_t count>
void add_penalties(StateHash &hash, const std::array<Real, count> &penalties) {
    if (penalties != std::array<Real, count>{})
        for (const Real penalty : penalties)
            hash.add(penalty);
}

} // namespace

std::uint64_t World::hash() const {
    StateHash hash;
    hash_settings(hash, settings_);
    for (const char c : method_->info.name)
        hash.add(static_cast<std::uint64_t>(c));
    hash.add(state_.clock.step_count);
    if (state_.clock.steps_before > 0) { // else time follows from the steps
        hash.add(state_.clock.steps_before);
        hash.add(state_.clock.time_before);
    }
    // Bodies are named by their rank among living bodies, so that holes do not count.
    std::vector<std::uint64_t> rank(bodies().size());
    std::uint64_t alive = 0;
    for (std::size_t i = 0; i < bodies().size(); ++i) {
        const Body &body = bodies()[i];
        if (!body.alive)
            continue;
        rank[i] = alive++;
        add(hash, body);
        for (std::uint32_t c = 0; c < body.collider_count; ++c)
            add(hash, model_->colliders[body.first_collider + c]);
        add(hash, state_.motions[i]);
        if (const Pace &pace = state_.paces[i];
            pace.substeps > 0 || pace.wanted > 0 || pace.rested > 0 || pace.struck > 0)
            hash.add(std::uint64_t{pace.struck} << 48 | std::uint64_t{pace.rested} << 32 |
                     std::uint64_t{pace.substeps} << 16 | pace.wanted);
    }
    const auto rank_of = [&](std::uint32_t body) {
        return body == Joint::world ? std::uint64_t{Joint::world} : rank[body];
    };
    for (std::size_t i = 0; i < joints().size(); ++i) {
        const Joint &joint = joints()[i];
        if (!joint.alive)
            continue;
        hash.add(rank_of(joint.a));
        hash.add(rank_of(joint.b));
        add(hash, joint);
        for (const Real impulse : state_.joints[i].impulses)
            hash.add(impulse);
        hash.add(static_cast<std::uint64_t>(state_.joints[i].broken));
        if (i < state_.penalties.joints.size())
            add_penalties(hash, state_.penalties.joints[i]);
    }
    for (const ContactMemory &memory : state_.contacts) {
        hash.add(rank[memory.key.a] << 32 | rank[memory.key.b]);
        hash.add(std::uint64_t{memory.key.child_a} << 48 | std::uint64_t{memory.key.child_b} << 32 |
                 memory.key.triangle);
        add(hash, memory.origin.normal);
        add(hash, memory.origin.offset);
        add(hash, memory.origin.rotation_a);
        add(hash, memory.origin.rotation_b);
        for (std::uint32_t k = 0; k < memory.point_count; ++k) {
            const PointMemory &point = state_.points[memory.first_point + k];
            hash.add(std::uint64_t{point.feature});
            add(hash, point.impulse);
            add(hash, point.core_a);
            add(hash, point.core_b);
            if (!state_.penalties.points.empty()) {
                const PointPenalty &penalty = state_.penalties.points[memory.first_point + k];
                add_penalties(hash, std::array{penalty.normal, penalty.tangential, penalty.slip.x,
                                               penalty.slip.y});
            }
        }
    }
    for (std::size_t i = 0; i < model_->particles.size(); ++i) {
        const Particle &particle = model_->particles[i];
        for (const Real value : {particle.inv_mass, particle.mass, particle.radius,
                                 particle.material.friction, particle.material.restitution})
            hash.add(value);
        add(hash, state_.particles[i].position);
        add(hash, state_.particles[i].velocity);
    }
    for (std::size_t i = 0; i < model_->springs.size(); ++i) {
        if (state_.torn[i] != 0)
            continue; // exerts no force: a hole, like a removed body's
        const Spring &spring = model_->springs[i];
        for (const SpringEnd &end : {spring.a, spring.b}) {
            const bool is_body = end.kind == SpringEnd::Kind::body;
            hash.add(static_cast<std::uint64_t>(end.kind));
            hash.add(is_body ? rank[end.index] : std::uint64_t{end.index});
            add(hash, end.anchor);
        }
        for (const Real value :
             {spring.rest_length, spring.stiffness, spring.damping, spring.tear_strain})
            hash.add(value);
    }
    for (const Attractor &attractor : model_->attractors) {
        add(hash, attractor.position);
        hash.add(attractor.gravitational_parameter);
    }
    if (state_.grab.holds_particle()) {
        hash.add(std::uint64_t{state_.grab.particle});
        add(hash, state_.grab.target);
        hash.add(state_.grab.max_force);
        hash.add(state_.grab.frequency);
        hash.add(state_.grab.damping_ratio);
        hash.add(state_.grab.held_mass);
    }
    if (state_.grab.is_holding()) {
        hash.add(rank[state_.grab.body]);
        add(hash, state_.grab.point_local);
        add(hash, state_.grab.target);
        hash.add(state_.grab.max_force);
        hash.add(state_.grab.frequency);
        hash.add(state_.grab.damping_ratio);
        add(hash, state_.grab.impulse);
    }
    return hash.value();
}

} // namespace plumb::inline PLUMB_PRECISION
