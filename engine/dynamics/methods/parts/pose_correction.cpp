#include "engine/dynamics/methods/parts/pose_correction.h"

#include "engine/dynamics/method.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

namespace plumb::inline PLUMB_PRECISION {

Real multiplier(Real error, Real change, Real lambda, Real inverse_mass,
                const Compliance &compliance) {
    const Real k = compliance.stiffness, c = compliance.damping;
    return -(k * error + c * change + lambda) / ((k + c) * inverse_mass + Real(1));
}

Vec3 along(const RowBlock &rows, const Vec3 &row) {
    if (rows.kind == RowKind::point)
        return row;
    return row.x * rows.axes[0] + row.y * rows.axes[1] + row.z * rows.axes[2];
}

Real inverse_effective_mass(const RowBlock &rows, const SolverBody &a, const SolverBody &b,
                            const Vec3 &n) {
    return rows.kind == RowKind::angular ? glm::dot(n, (a.inv_inertia + b.inv_inertia) * n)
                                         : inverse_effective_mass(a, b, rows.r_a, rows.r_b, n);
}

void turn_pose(SolverBody &body, const Vec3 &angle) {
    if (angle == Vec3{Real(0)})
        return;
    const auto turned_by = [&](const Quat &q) {
        return glm::normalize(q + Quat{Real(0), angle.x, angle.y, angle.z} * q * Real(0.5));
    };
    body.rotation = turned_by(body.rotation);
    const Real squared = std::min(glm::dot(body.turned, body.turned), Real(1));
    const Quat whole =
        turned_by(Quat{std::sqrt(Real(1) - squared), body.turned.x, body.turned.y, body.turned.z});
    body.turned = (whole.w < Real(0) ? Real(-1) : Real(1)) * Vec3{whole.x, whole.y, whole.z};
}

void shift_pose(SolverBody &body, const Vec3 &p, const Vec3 &r, Real h) {
    const Vec3 way = body.inv_mass * p;
    body.position += way;
    body.velocity += way / h;
    turn_pose(body, body.inv_inertia * glm::cross(r, p));
}

void shift_poses(SolverBody &a, SolverBody &b, const Vec3 &r_a, const Vec3 &r_b, const Vec3 &p,
                 Real h) {
    shift_pose(a, -p, r_a, h);
    shift_pose(b, p, r_b, h);
}

Vec3 way_of(const SolverBody &body, const Vec3 &r, Real h) {
    const Real w = std::sqrt(std::max(Real(0), Real(1) - glm::dot(body.turned, body.turned)));
    const Vec3 turning = glm::cross(body.turned, r);
    // r - q* r q
    return h * body.velocity + Real(2) * (w * turning - glm::cross(body.turned, turning));
}

Vec3 way_between(const SolverBody &a, const SolverBody &b, const Vec3 &r_a, const Vec3 &r_b,
                 Real h) {
    return way_of(b, r_b, h) - way_of(a, r_a, h);
}

namespace {

// Friction and restitution, shared by body and particle contacts.

// Static friction (sec. 3.5): undoes this substep's tangential displacement if the friction cone
// allows all of it. Returns the change in lambda (kg m), along the surface.
Vec3 static_friction(const Vec3 &way, const Vec3 &normal, const Vec3 &lambda, Real friction,
                     const TangentBasis &tangents, auto &&inverse_mass_along) {
    const Vec3 slid = way - glm::dot(way, normal) * normal;
    const Real size = glm::length(slid);
    if (size == Real(0))
        return Vec3{Real(0)};
    const Real inverse = inverse_mass_along(slid / size);
    if (!(inverse > Real(0)))
        return Vec3{Real(0)};
    const Vec3 change = slid / -inverse;
    const Vec3 total = lambda.y * tangents.t1 + lambda.z * tangents.t2 + change;
    const Real limit = friction * lambda.x;
    return glm::dot(total, total) < limit * limit ? change : Vec3{Real(0)};
}

// Dynamic friction (sec. 3.6): the impulse that stops sliding, clamped to the friction cone.
Vec3 dynamic_friction(const Vec3 &speed, const Vec3 &normal, Real limit,
                      auto &&inverse_mass_along) {
    const Vec3 sliding = speed - glm::dot(speed, normal) * normal;
    const Real size = glm::length(sliding);
    if (size == Real(0) || limit == Real(0))
        return Vec3{Real(0)};
    const Vec3 t = sliding / size;
    const Real inverse = inverse_mass_along(t);
    return inverse > Real(0) ? -std::min(size / inverse, limit) * t : Vec3{Real(0)};
}

// Restitution (sec. 3.6): the target normal speed; 0 where nothing bounces, so that the speed from
// removing penetration is gone again.
Real wanted_speed(Real approach, Real restitution, Real threshold) {
    return approach < -threshold ? -restitution * approach : Real(0);
}

void add_tangential(Vec3 &lambda, const Vec3 &change, const TangentBasis &tangents) {
    lambda.y += glm::dot(change, tangents.t1);
    lambda.z += glm::dot(change, tangents.t2);
}

// Arms at the present poses.
void turn_arms(const StepContext &context, const ContactConstraint &contact,
               ContactPointConstraint &point, const SolverBody &a, const SolverBody &b) {
    const Contact &found = context.contacts[contact.contact];
    const Real rounding_a = found.rounding_a;
    point.r_a = a.rotation * point.core_a + rounding_a * contact.normal;
    point.r_b = b.rotation * point.core_b - (point.rounding - rounding_a) * contact.normal;
}

// Calls use(contact, k, a, b) for each point, with its arms at the present poses, and done(contact)
// after each contact's last point.
template <typename Use, typename Done>
void for_each_point(StepContext &context, Use &&use, Done &&done) {
    for (ContactConstraint &contact : context.scratch.contacts) {
        SolverBody &a = context.bodies[contact.a];
        SolverBody &b = context.bodies[contact.b];
        for (std::size_t k = 0; k < static_cast<std::size_t>(contact.count); ++k) {
            turn_arms(context, contact, contact.points[k], a, b);
            use(contact, k, a, b);
        }
        done(contact);
    }
    context.report.constraint_passes += context.scratch.contacts.size();
}

// The same, calling use(contact, point, a, b).
template <typename Use> void for_each_point(StepContext &context, Use &&use) {
    for_each_point(
        context,
        [&](ContactConstraint &contact, std::size_t k, SolverBody &a, SolverBody &b) {
            use(contact, contact.points[k], a, b);
        },
        [](const ContactConstraint &) {});
}

Vec3 speed_between(const SolverBody &a, const SolverBody &b, const ContactPointConstraint &point) {
    return b.velocity_at(point.r_b) - a.velocity_at(point.r_a);
}

} // namespace

void solve_contact_poses(StepContext &context, Real h) {
    for_each_point(context, [&](const ContactConstraint &contact, ContactPointConstraint &point,
                                SolverBody &a, SolverBody &b) {
        const auto inverse_along = [&](const Vec3 &n) {
            return inverse_effective_mass(a, b, point.r_a, point.r_b, n);
        };
        const Real separation = present_separation(contact, point, a, b);
        const Real inverse = inverse_along(contact.normal);
        if (separation >= Real(0) || !(inverse > Real(0)))
            return;
        const Real change = -separation / inverse;
        shift_poses(a, b, point.r_a, point.r_b, change * contact.normal, h);
        point.impulse.x += change;
    });
    for_each_point(context, [&](const ContactConstraint &contact, ContactPointConstraint &point,
                                SolverBody &a, SolverBody &b) {
        if (point.impulse.x == Real(0) || contact.friction == Real(0))
            return;
        const Vec3 change =
            static_friction(way_between(a, b, point.r_a, point.r_b, h), contact.normal,
                            point.impulse, contact.friction, contact.tangents, [&](const Vec3 &n) {
                                return inverse_effective_mass(a, b, point.r_a, point.r_b, n);
                            });
        shift_poses(a, b, point.r_a, point.r_b, change, h);
        add_tangential(point.impulse, change, contact.tangents);
    });
}

void solve_contact_velocities(StepContext &context, Real h) {
    const auto threshold = static_cast<Real>(context.settings.restitution_threshold);
    std::array<Real, 4> bounced{}; // normal impulse per point of a bouncing contact
    const auto solve = [&](const ContactConstraint &contact, ContactPointConstraint &point,
                           SolverBody &a, SolverBody &b) -> Real {
        if (point.impulse.x == Real(0))
            return Real(0);
        const auto inverse_along = [&](const Vec3 &n) {
            return inverse_effective_mass(a, b, point.r_a, point.r_b, n);
        };
        const auto apply = [&](const Vec3 &impulse) {
            a.apply_impulse(-impulse, point.r_a);
            b.apply_impulse(impulse, point.r_b);
        };
        const Vec3 friction =
            dynamic_friction(speed_between(a, b, point), contact.normal,
                             contact.friction * point.impulse.x / h, inverse_along);
        apply(friction);
        add_tangential(point.impulse, h * friction, contact.tangents);
        const Real wanted = wanted_speed(point.approach, contact.restitution, threshold);
        const Real speed = glm::dot(speed_between(a, b, point), contact.normal);
        const Real change = (wanted - speed) / inverse_along(contact.normal);
        apply(change * contact.normal);
        return wanted > Real(0) ? point.impulse.x / h + change : Real(0);
    };
    for_each_point(
        context,
        [&](ContactConstraint &contact, std::size_t k, SolverBody &a, SolverBody &b) {
            bounced[k] = solve(contact, contact.points[k], a, b);
        },
        [&](const ContactConstraint &contact) {
            if (bounced != std::array<Real, 4>{}) {
                ++context.report.impacts;
                record_impact(context, contact, bounced);
            }
            bounced = {};
        });
}

// ---- particles

namespace {

// What a spring's end is attached to, and how it moves.
struct End {
    StepContext &context;
    const SpringEnd &end;
    Real h = Real(0);
    SpringPoint at;

    End(StepContext &c, const SpringEnd &e, Real substep)
        : context(c), end(e), h(substep), at(spring_point(e, c.bodies, c.particles)) {}
    Real inverse_along(const Vec3 &n) const {
        if (end.kind == SpringEnd::Kind::particle)
            return context.model.particles[end.index].inv_mass;
        if (end.kind == SpringEnd::Kind::world)
            return Real(0);
        const SolverBody &body = context.bodies[end.index];
        const Vec3 turning = glm::cross(at.arm, n);
        return body.inv_mass_along(n) + glm::dot(body.inv_inertia * turning, turning);
    }
    Vec3 way() const {
        if (end.kind == SpringEnd::Kind::particle)
            return h * context.particles[end.index].velocity;
        return end.kind == SpringEnd::Kind::world ? Vec3{Real(0)}
                                                  : way_of(context.bodies[end.index], at.arm, h);
    }
    void correct(const Vec3 &p) const;
};

void shift_particle(StepContext &context, std::uint32_t i, const Vec3 &p, Real h) {
    const Vec3 way = context.model.particles[i].inv_mass * p;
    context.particles[i].position += way;
    context.particles[i].velocity += way / h;
}

void End::correct(const Vec3 &p) const {
    if (end.kind == SpringEnd::Kind::particle)
        shift_particle(context, end.index, p, h);
    else if (end.kind == SpringEnd::Kind::body)
        shift_pose(context.bodies[end.index], p, at.arm, h);
}

// Calls use(contact, row, body) for each particle contact.
template <typename Use> void for_each_particle_contact(StepContext &context, Use &&use) {
    for (ParticleContactConstraint &row : context.scratch.particle_contacts) {
        const ParticleContact &contact = context.particle_contacts[row.contact];
        SolverBody &body = context.bodies[contact.body];
        row.arm = context.particles[contact.particle].position - body.position;
        use(contact, row, body);
    }
    context.report.constraint_passes += context.scratch.particle_contacts.size();
}

Real inverse_along(const StepContext &context, const ParticleContact &contact,
                   const ParticleContactConstraint &row, const SolverBody &body, const Vec3 &n) {
    const Vec3 turning = glm::cross(row.arm, n);
    return context.model.particles[contact.particle].inv_mass + body.inv_mass_along(n) +
           glm::dot(body.inv_inertia * turning, turning);
}

Vec3 speed_between(const StepContext &context, const ParticleContact &contact,
                   const ParticleContactConstraint &row, const SolverBody &body) {
    return context.particles[contact.particle].velocity - body.velocity_at(row.arm);
}

} // namespace

void begin_particle_corrections(StepContext &context) {
    for (SpringConstraint &row : context.scratch.springs)
        row.impulse = Real(0);
    for_each_particle_contact(context, [&](const ParticleContact &contact,
                                           ParticleContactConstraint &row, SolverBody &body) {
        row.impulse = Vec3{Real(0)};
        row.approach = glm::dot(speed_between(context, contact, row, body), contact.normal);
    });
}

void solve_spring_poses(StepContext &context, Real h) {
    for (SpringConstraint &row : context.scratch.springs) {
        const Spring &spring = context.model.springs[row.spring];
        const End a(context, spring.a, h), b(context, spring.b, h);
        const Vec3 line = b.at.position - a.at.position;
        const Real length = glm::length(line);
        if (length == Real(0))
            continue;
        const Vec3 n = line / length;
        const Real change = multiplier(length - spring.rest_length, glm::dot(n, b.way() - a.way()),
                                       row.impulse, a.inverse_along(n) + b.inverse_along(n),
                                       {h * h * spring.stiffness, h * spring.damping});
        row.impulse += change;
        a.correct(-change * n);
        b.correct(change * n);
    }
    context.report.constraint_passes += context.scratch.springs.size();
}

void solve_particle_contact_poses(StepContext &context, Real h) {
    for_each_particle_contact(context, [&](const ParticleContact &contact,
                                           ParticleContactConstraint &row, SolverBody &body) {
        const auto inverse = [&](const Vec3 &n) {
            return inverse_along(context, contact, row, body, n);
        };
        const auto correct = [&](const Vec3 &p) {
            shift_particle(context, contact.particle, p, h);
            shift_pose(body, -p, row.arm, h);
        };
        const Real separation = glm::dot(row.arm - body.rotation * contact.anchor, contact.normal) -
                                context.model.particles[contact.particle].radius;
        if (separation >= Real(0) || !(inverse(contact.normal) > Real(0)))
            return;
        const Real change = -separation / inverse(contact.normal);
        correct(change * contact.normal);
        row.impulse.x += change;
        const Vec3 way =
            h * context.particles[contact.particle].velocity - way_of(body, row.arm, h);
        const Vec3 friction = static_friction(way, contact.normal, row.impulse, contact.friction,
                                              row.tangents, inverse);
        correct(friction);
        add_tangential(row.impulse, friction, row.tangents);
    });
}

void solve_particle_contact_velocities(StepContext &context, Real h) {
    const auto threshold = static_cast<Real>(context.settings.restitution_threshold);
    for_each_particle_contact(context, [&](const ParticleContact &contact,
                                           ParticleContactConstraint &row, SolverBody &body) {
        if (row.impulse.x == Real(0))
            return;
        const auto inverse = [&](const Vec3 &n) {
            return inverse_along(context, contact, row, body, n);
        };
        const auto apply = [&](const Vec3 &impulse) {
            context.particles[contact.particle].velocity +=
                context.model.particles[contact.particle].inv_mass * impulse;
            body.apply_impulse(-impulse, row.arm);
        };
        apply(dynamic_friction(speed_between(context, contact, row, body), contact.normal,
                               contact.friction * row.impulse.x / h, inverse));
        const Real wanted = wanted_speed(row.approach, contact.restitution, threshold);
        const Real speed = glm::dot(speed_between(context, contact, row, body), contact.normal);
        apply((wanted - speed) / inverse(contact.normal) * contact.normal);
        context.report.impacts += wanted > Real(0) ? 1 : 0;
    });
}

} // namespace plumb::inline PLUMB_PRECISION
