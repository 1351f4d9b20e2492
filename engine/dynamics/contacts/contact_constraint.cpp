#include "engine/dynamics/contacts/contact_constraint.h"

#include "engine/dynamics/method.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

Vec3 relative_velocity(const SolverBody &a, const SolverBody &b,
                       const ContactPointConstraint &point) {
    return b.velocity_at(point.r_b) - a.velocity_at(point.r_a);
}

void apply_pair_impulse(SolverBody &a, SolverBody &b, const ContactPointConstraint &point,
                        const Vec3 &impulse) {
    a.apply_impulse(-impulse, point.r_a);
    b.apply_impulse(impulse, point.r_b);
}

// K between two directions: u^T K v (Baraff 1996, "Linear-Time Dynamics using Lagrange
// Multipliers").
Real coupling(const SolverBody &a, const SolverBody &b, const ContactPointConstraint &point,
              const Vec3 &u, const Vec3 &v) {
    const Vec3 ua = glm::cross(point.r_a, u);
    const Vec3 ub = glm::cross(point.r_b, u);
    const Real linear = a.has_locked_translation || b.has_locked_translation
                            ? glm::dot(u, (a.inv_mass + b.inv_mass) * v)
                            : (a.inv_mass.x + b.inv_mass.x) * glm::dot(u, v);
    return linear + glm::dot(a.inv_inertia * ua, glm::cross(point.r_a, v)) +
           glm::dot(b.inv_inertia * ub, glm::cross(point.r_b, v));
}

} // namespace

bool is_dynamic(const StepContext &context, std::uint32_t body) {
    return context.model.bodies[body].kind == BodyKind::dynamic;
}

bool are_both_dynamic(const StepContext &context, const Contact &contact) {
    return is_dynamic(context, contact.key.a) && is_dynamic(context, contact.key.b);
}

bool are_balls(const StepContext &context, const Contact &contact) {
    const auto is_ball = [&](std::uint32_t collider) {
        return std::holds_alternative<Sphere>(context.model.colliders[collider].shape);
    };
    return contact.rounding_a > Real(0) && contact.rounding_b > Real(0) &&
           is_ball(contact.collider_a) && is_ball(contact.collider_b);
}

void find_partners(StepContext &context) {
    constexpr std::uint32_t none = UINT32_MAX;
    constexpr std::uint32_t several = none - 1;
    std::vector<std::uint32_t> &partners = context.scratch.partners;
    partners.resize(context.bodies.size());
    for (const std::uint32_t i : context.active.contacts)
        partners[context.ends[i].a] = partners[context.ends[i].b] = none;
    const auto meet = [&](std::uint32_t body, std::uint32_t other) {
        partners[body] = partners[body] == none || partners[body] == other ? other : several;
    };
    for (const std::uint32_t i : context.active.contacts) {
        meet(context.ends[i].a, context.ends[i].b);
        meet(context.ends[i].b, context.ends[i].a);
    }
    const auto is_held = [&](std::uint32_t body) {
        if (body != Joint::world)
            partners[body] = several;
    };
    for (const std::uint32_t i : context.active.joints) {
        is_held(context.model.joints[i].a);
        is_held(context.model.joints[i].b);
    }
    if (context.active.holds_grab)
        is_held(context.grab.body);
}

bool touch_nothing_else(const StepContext &context, const Contact &contact) {
    const std::vector<std::uint32_t> &partners = context.scratch.partners;
    return partners[contact.key.a] == contact.key.b && partners[contact.key.b] == contact.key.a &&
           are_both_dynamic(context, contact);
}

Real inverse_effective_mass(const SolverBody &a, const SolverBody &b, const Vec3 &r_a,
                            const Vec3 &r_b, const Vec3 &direction) {
    const Vec3 ra = glm::cross(r_a, direction);
    const Vec3 rb = glm::cross(r_b, direction);
    return a.inv_mass_along(direction) + b.inv_mass_along(direction) +
           glm::dot(a.inv_inertia * ra, ra) + glm::dot(b.inv_inertia * rb, rb);
}

void solve_friction(const ContactConstraint &contact, ContactPointConstraint &point, SolverBody &a,
                    SolverBody &b, Real limit) {
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

Real tangent_mass_of(const ContactPointConstraint &point, const TangentBasis &tangents,
                     const SolverBody &a, const SolverBody &b) {
    const Real k11 = coupling(a, b, point, tangents.t1, tangents.t1);
    const Real k12 = coupling(a, b, point, tangents.t1, tangents.t2);
    const Real k22 = coupling(a, b, point, tangents.t2, tangents.t2);
    const Real half_difference = Real(0.5) * (k11 - k22);
    const Real k_largest =
        Real(0.5) * (k11 + k22) + std::sqrt(half_difference * half_difference + k12 * k12);
    return k_largest > Real(0) ? Real(1) / k_largest : Real(0);
}

void prepare_contacts(StepContext &context, Prepare which) {
    std::vector<ContactConstraint> &constraints = context.scratch.contacts;
    constraints.clear();
    for (const std::uint32_t i : context.active.contacts) {
        const Contact &contact = context.contacts[i];
        const bool strikes =
            contact.restitution > Real(0) ||
            (contact.found_at == FoundAt::touch && touch_nothing_else(context, contact));
        if (which == Prepare::striking && !strikes)
            continue;
        ContactConstraint &out = constraints.emplace_back();
        const SolverBody &a = context.bodies[contact.key.a];
        const SolverBody &b = context.bodies[contact.key.b];
        const Real rounding = contact.rounding_a + contact.rounding_b;
        out.contact = i;
        out.a = contact.key.a;
        out.b = contact.key.b;
        out.normal = contact.manifold.normal;
        out.tangents = tangent_basis(out.normal);
        out.friction = contact.friction;
        out.restitution = contact.restitution;
        out.strikes = strikes;
        out.count = contact.manifold.count;
        for (int k = 0; k < out.count; ++k) {
            const auto index = static_cast<std::size_t>(k);
            const ContactAnchor &from = contact.anchors[index];
            ContactPointConstraint &point = out.points[index];
            point.r_a = from.arm_a;
            point.r_b = from.arm_b;
            point.core_a = from.core_a;
            point.core_b = from.core_b;
            point.rounding = rounding;
            point.impulse = contact.impulses[index];

            const Real k_normal = inverse_effective_mass(a, b, point.r_a, point.r_b, out.normal);
            point.normal_mass = k_normal > Real(0) ? Real(1) / k_normal : Real(0);
            point.tangent_mass = tangent_mass_of(point, out.tangents, a, b);
        }
    }
}

Real present_separation(const ContactConstraint &contact, const ContactPointConstraint &point,
                        const SolverBody &a, const SolverBody &b) {
    return separation_along(contact.normal, point.core_a, point.core_b, point.rounding, a, b);
}

void remember_contacts(StepContext &context) {
    for (ContactConstraint &contact : context.scratch.contacts)
        for (int k = 0; k < contact.count; ++k) {
            ContactPointConstraint &point = contact.points[static_cast<std::size_t>(k)];
            point.remembered = point.impulse;
            point.impulse = Vec3{Real(0)};
        }
}

void warm_start_contacts(StepContext &context, Real share) {
    for (ContactConstraint &contact : context.scratch.contacts) {
        SolverBody &a = context.bodies[contact.a];
        SolverBody &b = context.bodies[contact.b];
        for (int k = 0; k < contact.count; ++k) {
            ContactPointConstraint &point = contact.points[static_cast<std::size_t>(k)];
            const Vec3 start = share * point.remembered;
            point.impulse += start;
            apply_pair_impulse(a, b, point,
                               start.x * contact.normal + start.y * contact.tangents.t1 +
                                   start.z * contact.tangents.t2);
        }
    }
    context.report.constraint_passes += context.scratch.contacts.size();
}

void refresh_separations(StepContext &context) {
    for (ContactConstraint &contact : context.scratch.contacts) {
        const SolverBody &a = context.bodies[contact.a];
        const SolverBody &b = context.bodies[contact.b];
        for (int k = 0; k < contact.count; ++k) {
            ContactPointConstraint &point = contact.points[static_cast<std::size_t>(k)];
            point.separation = present_separation(contact, point, a, b);
        }
    }
}

void solve_contacts(StepContext &context, const ContactBias &bias, Real h) {
    context.report.constraint_passes += context.scratch.contacts.size();
    for (ContactConstraint &contact : context.scratch.contacts) {
        SolverBody &a = context.bodies[contact.a];
        SolverBody &b = context.bodies[contact.b];
        const bool is_on_static = a.inv_mass == Vec3{Real(0)} || b.inv_mass == Vec3{Real(0)};
        const Softness &softness = is_on_static ? bias.stiff : bias.softness;
        for (int i = 0; i < contact.count; ++i) {
            const int k = bias.backwards ? contact.count - 1 - i : i;
            ContactPointConstraint &point = contact.points[static_cast<std::size_t>(k)];
            const Real separation = point.separation;
            Real target = Real(0); // bias added to the relative normal velocity
            Real mass_scale = Real(1);
            Real impulse_scale = Real(0);
            if (separation > Real(0)) {
                target = separation / h;
            } else if (bias.push_velocity > Real(0)) {
                const Real depth = std::min(separation + bias.slop, Real(0));
                target = std::max(softness.bias_rate * depth, -bias.push_velocity);
                mass_scale = softness.mass_scale;
                impulse_scale = softness.impulse_scale;
            }
            const Real speed = glm::dot(relative_velocity(a, b, point), contact.normal);
            const Real change = -point.normal_mass * mass_scale * (speed + target) -
                                impulse_scale * point.impulse.x;
            const Real total = std::max(point.impulse.x + change, Real(0));
            apply_pair_impulse(a, b, point, (total - point.impulse.x) * contact.normal);
            point.impulse.x = total;
        }
        if (contact.friction > Real(0) && !bias.frictionless)
            for (int k = 0; k < contact.count; ++k) {
                ContactPointConstraint &point = contact.points[static_cast<std::size_t>(k)];
                solve_friction(contact, point, a, b, contact.friction * point.impulse.x);
            }
    }
}

void store_contacts(StepContext &context) {
    for (const ContactConstraint &contact : context.scratch.contacts)
        for (int k = 0; k < contact.count; ++k) {
            const auto index = static_cast<std::size_t>(k);
            context.contacts[contact.contact].impulses[index] = contact.points[index].impulse;
        }
}

void note_approach(StepContext &context) {
    for (ContactConstraint &contact : context.scratch.contacts)
        for (int k = 0; k < contact.count; ++k) {
            ContactPointConstraint &point = contact.points[static_cast<std::size_t>(k)];
            point.approach = glm::dot(
                relative_velocity(context.bodies[contact.a], context.bodies[contact.b], point),
                contact.normal);
        }
}

void note_loads(StepContext &context) {
    for (ContactConstraint &contact : context.scratch.contacts)
        for (int k = 0; k < contact.count; ++k) {
            ContactPointConstraint &point = contact.points[static_cast<std::size_t>(k)];
            point.pushed += point.impulse.x;
        }
}

void restitute(StepContext &context, Real threshold) {
    for (ContactConstraint &contact : context.scratch.contacts) {
        if (contact.restitution == Real(0))
            continue;
        SolverBody &a = context.bodies[contact.a];
        SolverBody &b = context.bodies[contact.b];
        bool bounced = false;
        std::array<Real, 4> normal_impulse{}; // over the whole step
        for (int k = 0; k < contact.count; ++k) {
            const auto index = static_cast<std::size_t>(k);
            ContactPointConstraint &point = contact.points[index];
            if (point.approach > -threshold || point.pushed == Real(0))
                continue;
            const Real speed = glm::dot(relative_velocity(a, b, point), contact.normal);
            const Real change = -point.normal_mass * (speed + contact.restitution * point.approach);
            const Real total = std::max(point.impulse.x + change, Real(0));
            apply_pair_impulse(a, b, point, (total - point.impulse.x) * contact.normal);
            normal_impulse[index] = point.pushed + (total - point.impulse.x);
            point.impulse.x = total;
            bounced = true;
        }
        if (bounced) {
            ++context.report.impacts;
            record_impact(context, contact, normal_impulse);
        }
    }
}

} // namespace plumb::inline PLUMB_PRECISION
