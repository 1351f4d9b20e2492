#include "engine/dynamics/contact_constraint.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// The part of a shape's surface distance that turning the body does not change.
Real rounding_radius(const Shape &shape) {
    if (const auto *sphere = std::get_if<Sphere>(&shape))
        return sphere->radius;
    if (const auto *capsule = std::get_if<Capsule>(&shape))
        return capsule->radius;
    return Real(0);
}

Vec3 relative_velocity(const Motion &a, const Motion &b, const ContactPointConstraint &point) {
    return b.velocity_at(point.r_b) - a.velocity_at(point.r_a);
}

void apply_pair_impulse(Motion &a, Motion &b, const ContactPointConstraint &point,
                        const Vec3 &impulse) {
    a.apply_impulse(-impulse, point.r_a);
    b.apply_impulse(impulse, point.r_b);
}

// K between two directions: u^T K v (Baraff 1996, "Linear-Time Dynamics using Lagrange
// Multipliers").
Real coupling(const Motion &a, const Motion &b, const ContactPointConstraint &point, const Vec3 &u,
              const Vec3 &v) {
    const Vec3 ua = glm::cross(point.r_a, u);
    const Vec3 ub = glm::cross(point.r_b, u);
    return (a.inv_mass + b.inv_mass) * glm::dot(u, v) +
           glm::dot(a.inv_inertia * ua, glm::cross(point.r_a, v)) +
           glm::dot(b.inv_inertia * ub, glm::cross(point.r_b, v));
}

} // namespace

Softness make_soft(Real frequency, Real damping_ratio, Real h) {
    const Real omega = Real(2) * std::numbers::pi_v<Real> * frequency;
    const Real a1 = Real(2) * damping_ratio + h * omega;
    const Real a2 = h * omega * a1;
    const Real a3 = Real(1) / (Real(1) + a2);
    return {omega / a1, a2 * a3, a3};
}

Real inverse_effective_mass(const Motion &a, const Motion &b, const Vec3 &r_a, const Vec3 &r_b,
                            const Vec3 &direction) {
    const Vec3 ra = glm::cross(r_a, direction);
    const Vec3 rb = glm::cross(r_b, direction);
    return a.inv_mass + b.inv_mass + glm::dot(a.inv_inertia * ra, ra) +
           glm::dot(b.inv_inertia * rb, rb);
}

void solve_friction(const ContactConstraint &contact, ContactPointConstraint &point, Motion &a,
                    Motion &b, Real limit) {
    const Vec3 v = relative_velocity(a, b, point);
    Real new_1 = point.impulse.y - point.tangent_mass * glm::dot(v, contact.tangents.t1);
    Real new_2 = point.impulse.z - point.tangent_mass * glm::dot(v, contact.tangents.t2);
    const Real length = std::sqrt(new_1 * new_1 + new_2 * new_2);
    if (length > limit) {
        const Real scale = limit / length;
        new_1 *= scale;
        new_2 *= scale;
    }
    const Vec3 impulse = (new_1 - point.impulse.y) * contact.tangents.t1 +
                         (new_2 - point.impulse.z) * contact.tangents.t2;
    point.impulse.y = new_1;
    point.impulse.z = new_2;
    apply_pair_impulse(a, b, point, impulse);
}

std::vector<ContactConstraint> prepare_contacts(StepContext &context) {
    std::vector<ContactConstraint> constraints(context.contacts.size());
    for (std::size_t i = 0; i < constraints.size(); ++i) {
        const Contact &contact = context.contacts[i];
        ContactConstraint &out = constraints[i];
        const Motion &a = context.motions[contact.a];
        const Motion &b = context.motions[contact.b];
        const Real rounding_a = rounding_radius(context.bodies[contact.a].shape);
        const Real rounding_b = rounding_radius(context.bodies[contact.b].shape);
        out.a = contact.a;
        out.b = contact.b;
        out.normal = contact.manifold.normal;
        out.tangents = tangent_basis(out.normal);
        out.friction = contact.friction;
        out.restitution = contact.restitution;
        out.count = contact.manifold.count;
        for (int k = 0; k < out.count; ++k) {
            const auto index = static_cast<std::size_t>(k);
            const ManifoldPoint &from = contact.manifold.points[index];
            ContactPointConstraint &point = out.points[index];
            point.r_a = from.position - a.position;
            point.r_b = from.position - b.position;
            // The midpoint lies half the separation off either surface.
            const Vec3 half = (Real(0.5) * from.separation) * out.normal;
            const Vec3 surface_core_a = point.r_a - half - rounding_a * out.normal;
            const Vec3 surface_core_b = point.r_b + half + rounding_b * out.normal;
            point.core_a = glm::conjugate(a.rotation) * surface_core_a;
            point.core_b = glm::conjugate(b.rotation) * surface_core_b;
            point.rounding = -(rounding_a + rounding_b);
            point.impulse = contact.impulses[index];

            const Real k_normal = inverse_effective_mass(a, b, point.r_a, point.r_b, out.normal);
            point.normal_mass = k_normal > Real(0) ? Real(1) / k_normal : Real(0);
            const Real k11 = coupling(a, b, point, out.tangents.t1, out.tangents.t1);
            const Real k12 = coupling(a, b, point, out.tangents.t1, out.tangents.t2);
            const Real k22 = coupling(a, b, point, out.tangents.t2, out.tangents.t2);
            const Real half_difference = Real(0.5) * (k11 - k22);
            const Real k_largest =
                Real(0.5) * (k11 + k22) + std::sqrt(half_difference * half_difference + k12 * k12);
            point.tangent_mass = k_largest > Real(0) ? Real(1) / k_largest : Real(0);
        }
    }
    return constraints;
}

Real present_separation(const ContactConstraint &contact, const ContactPointConstraint &point,
                        const Motion &a, const Motion &b) {
    const Vec3 gap =
        (b.position - a.position) + (b.rotation * point.core_b - a.rotation * point.core_a);
    return glm::dot(gap, contact.normal) + point.rounding;
}

void remember_contacts(std::span<ContactConstraint> contacts) {
    for (ContactConstraint &contact : contacts)
        for (int k = 0; k < contact.count; ++k) {
            ContactPointConstraint &point = contact.points[static_cast<std::size_t>(k)];
            point.remembered = point.impulse;
            point.impulse = Vec3{Real(0)};
        }
}

void recall_contacts(StepContext &context, std::span<ContactConstraint> contacts, Real share) {
    for (ContactConstraint &contact : contacts) {
        Motion &a = context.motions[contact.a];
        Motion &b = context.motions[contact.b];
        for (int k = 0; k < contact.count; ++k) {
            ContactPointConstraint &point = contact.points[static_cast<std::size_t>(k)];
            const Vec3 recalled = share * point.remembered;
            point.impulse += recalled;
            apply_pair_impulse(a, b, point,
                               recalled.x * contact.normal + recalled.y * contact.tangents.t1 +
                                   recalled.z * contact.tangents.t2);
        }
    }
}

void solve_contacts(StepContext &context, std::span<ContactConstraint> contacts,
                    const ContactBias &bias, Real h) {
    for (ContactConstraint &contact : contacts) {
        Motion &a = context.motions[contact.a];
        Motion &b = context.motions[contact.b];
        for (int k = 0; k < contact.count; ++k) {
            ContactPointConstraint &point = contact.points[static_cast<std::size_t>(k)];
            const Real separation = present_separation(contact, point, a, b);
            if (bias.loaded_only && separation > Real(0) && point.impulse.x == Real(0))
                continue;
            Real target = Real(0); // velocity to be added to the relative normal velocity
            Real mass_scale = Real(1);
            Real impulse_scale = Real(0);
            if (separation > Real(0)) {
                target = separation / h;
            } else if (bias.push_velocity > Real(0)) {
                const Real depth = std::min(separation + bias.slop, Real(0));
                target = std::max(bias.softness.bias_rate * depth, -bias.push_velocity);
                mass_scale = bias.softness.mass_scale;
                impulse_scale = bias.softness.impulse_scale;
            }
            const Real speed = glm::dot(relative_velocity(a, b, point), contact.normal);
            const Real change = -point.normal_mass * mass_scale * (speed + target) -
                                impulse_scale * point.impulse.x;
            const Real total = std::max(point.impulse.x + change, Real(0));
            apply_pair_impulse(a, b, point, (total - point.impulse.x) * contact.normal);
            point.impulse.x = total;
        }
        if (contact.friction > Real(0))
            for (int k = 0; k < contact.count; ++k) {
                ContactPointConstraint &point = contact.points[static_cast<std::size_t>(k)];
                solve_friction(contact, point, a, b, contact.friction * point.impulse.x);
            }
    }
}

void store_contacts(StepContext &context, std::span<const ContactConstraint> contacts) {
    for (std::size_t i = 0; i < contacts.size(); ++i)
        for (int k = 0; k < contacts[i].count; ++k) {
            const auto index = static_cast<std::size_t>(k);
            context.contacts[i].impulses[index] = contacts[i].points[index].impulse;
        }
}

} // namespace plumb::inline PLUMB_PRECISION
