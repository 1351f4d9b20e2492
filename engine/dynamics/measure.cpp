// Measurements of a world: energies, momenta, errors, loads.
#include "engine/dynamics/contacts/surface_contact.h"
#include "engine/dynamics/world.h"
#include "engine/math/basis.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// Energies and momenta of one dynamic body.
struct BodyMeasure {
    double kinetic = 0;
    double potential = 0;
    glm::dvec3 momentum{0};
    glm::dvec3 angular_momentum{0}; // about the world's origin
};

BodyMeasure measure_of(const Body &body, const Motion &motion, const glm::dvec3 &gravity,
                       std::span<const Attractor> attractors) {
    const double mass = static_cast<double>(body.mass);
    const glm::dvec3 x{motion.position};
    const glm::dvec3 v{motion.velocity};
    const glm::dquat rotation{motion.rotation};
    const glm::dvec3 spin = glm::conjugate(rotation) * glm::dvec3{motion.angular_velocity};
    const glm::dvec3 spin_momentum = glm::dvec3{body.inertia} * spin;
    return {0.5 * mass * glm::dot(v, v) + 0.5 * glm::dot(spin_momentum, spin),
            mass * static_cast<double>(body.gravity_scale) *
                    (attraction_potential(attractors, x) - glm::dot(gravity, x)) -
                (body.has_force ? glm::dot(glm::dvec3{body.force}, x) : 0),
            mass * v, mass * glm::cross(x, v) + rotation * spin_momentum};
}

// See Measures. `rate`: substeps per second, which turns impulses into forces.
void add_residuals(const Contact &contact, const Motion &a, const Motion &b, double rate,
                   Measures &m) {
    const glm::dvec3 normal{contact.manifold.normal};
    const TangentBasis basis = tangent_basis(contact.manifold.normal);
    for (std::size_t k = 0; k < static_cast<std::size_t>(contact.manifold.count); ++k) {
        const Vec3 &impulse = contact.impulses[k];
        if (impulse == Vec3{Real(0)})
            continue;
        const double push = rate * static_cast<double>(impulse.x);
        const glm::dvec3 friction = rate * glm::dvec3{impulse.y * basis.t1 + impulse.z * basis.t2};
        const ContactAnchor &anchor = contact.anchors[k];
        const glm::dvec3 velocity{b.velocity_at(anchor.arm_b) - a.velocity_at(anchor.arm_a)};
        const double separating = glm::dot(velocity, normal);
        const glm::dvec3 sliding = velocity - separating * normal;
        const double most = static_cast<double>(contact.friction) * push;
        const double rubbing = glm::dot(friction, sliding);
        m.signorini_residual = std::max(m.signorini_residual, std::abs(push * separating));
        m.cone_residual = std::max(m.cone_residual, glm::length(friction) - most);
        m.dissipation_residual =
            std::max(m.dissipation_residual, most * glm::length(sliding) + rubbing);
        m.contact_power += push * separating + rubbing;
    }
}

} // namespace

double World::energy() const {
    double sum = 0;
    for (std::size_t i = 0; i < bodies().size(); ++i)
        if (bodies()[i].alive && bodies()[i].kind == BodyKind::dynamic) {
            const BodyMeasure one =
                measure_of(bodies()[i], state_.motions[i], settings_.gravity, model_->attractors);
            sum += one.kinetic + one.potential;
        }
    if (model_->has_particles())
        sum += particle_energy();
    return sum;
}

// A contact's manifold at the present poses.
Manifold World::present_manifold(const Contact &contact) const {
    const auto place = [&](std::uint32_t collider, std::uint32_t body) {
        const Motion &motion = state_.motions[body];
        return placed(model_->colliders[collider].shape, mass_pose(motion));
    };
    const auto against = [&](const Shape &solid, const Collider &surface, std::uint32_t body) {
        const Transform pose = surface_pose(surface, state_.motions[body]);
        return contact.key.triangle == ContactKey::inside
                   ? collide_inside(solid, *surface.surface, pose)
                   : plumb::collide(solid, *surface.surface, pose, contact.key.triangle, Real(0));
    };
    const Collider &a = model_->colliders[contact.collider_a];
    const Collider &b = model_->colliders[contact.collider_b];
    if (a.surface)
        return against(place(contact.collider_b, contact.key.b), a, contact.key.a);
    if (b.surface)
        return against(place(contact.collider_a, contact.key.a), b, contact.key.b);
    return plumb::collide(place(contact.collider_a, contact.key.a),
                          place(contact.collider_b, contact.key.b), Real(0),
                          contact.manifold.normal);
}

Measures World::measure() const {
    Measures m;
    m.time = time();
    bool is_finite_world = true;
    for (std::size_t i = 0; i < bodies().size(); ++i) {
        if (!bodies()[i].alive || bodies()[i].kind != BodyKind::dynamic)
            continue;
        const BodyMeasure one =
            measure_of(bodies()[i], state_.motions[i], settings_.gravity, model_->attractors);
        m.kinetic_energy += one.kinetic;
        m.potential_energy += one.potential;
        m.linear_momentum += one.momentum;
        m.angular_momentum += one.angular_momentum;
        is_finite_world = is_finite_world && std::isfinite(one.kinetic + one.potential);
    }
    // The pairs of the last step, at the poses it led to.
    double depth_sum = 0;
    int depth_count = 0;
    if (is_finite_world)
        for (const Contact &contact : contacts()) {
            if (contact.sensor || has_diverged(state_.motions[contact.key.a]) ||
                has_diverged(state_.motions[contact.key.b]))
                continue;
            add_residuals(contact, state_.motions[contact.key.a], state_.motions[contact.key.b],
                          substeps_of(island_body(contact.key.a, contact.key.b)) / settings_.dt, m);
            const Manifold manifold = present_manifold(contact);
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
    for (std::uint32_t i = 0; i < joints().size(); ++i)
        if (joints()[i].alive && !state_.joints[i].broken) {
            const double drift = static_cast<double>(joint_error(i));
            m.max_joint_drift = std::max(m.max_joint_drift, drift);
            drift_sum += drift;
            ++drift_count;
        }
    if (drift_count > 0)
        m.mean_joint_drift = drift_sum / drift_count;
    if (model_->has_particles())
        add_particles(m);
    return m;
}

const Motion &World::joint_motion(std::uint32_t body) const {
    static const Motion world;
    return body == Joint::world ? world : state_.motions[body];
}

Vec3 World::anchor_a(const Joint &joint) const {
    const Motion &motion = joint_motion(joint.a);
    return motion.position + motion.rotation * joint.anchor_a_local;
}

Vec3 World::anchor_b(const Joint &joint) const {
    const Motion &motion = joint_motion(joint.b);
    return motion.position + motion.rotation * joint.anchor_b_local;
}

JointError World::joint_errors(std::uint32_t joint) const {
    const Joint &one = joints()[joint];
    return plumb::joint_error(one, joint_motion(one.a), joint_motion(one.b));
}

Real World::joint_error(std::uint32_t joint) const {
    const JointError error = joint_errors(joint);
    return std::sqrt(error.linear * error.linear + error.angular * error.angular);
}

World::JointLoad World::joint_load(std::uint32_t joint) const {
    const Joint &one = joints()[joint];
    const JointMemory &memory = state_.joints[joint];
    std::vector<RowBlock> blocks;
    NewRows writer(blocks);
    emit_rows(one, joint_motion(one.a), joint_motion(one.b), writer);
    JointLoad load;
    const auto rate = static_cast<Real>(substeps_of(island_body(one.a, one.b)) / settings_.dt);
    for (const RowBlock &block : blocks)
        for (int i = 0; i < block.count; ++i) {
            const auto index = static_cast<std::size_t>(i);
            const Real amount = rate * memory.impulses[block.first_memory + index];
            Vec3 axis = block.axes[index];
            if (block.kind == RowKind::point) {
                axis = Vec3{Real(0)};
                axis[i] = Real(1);
            }
            (block.kind == RowKind::angular ? load.torque : load.force) += amount * axis;
        }
    return load;
}

} // namespace plumb::inline PLUMB_PRECISION
