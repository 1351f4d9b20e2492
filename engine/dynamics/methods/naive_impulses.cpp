// Naive impulses with linear projection, as in the Game Physics Cookbook (Szauer 2017, chapter 15,
// "Linear impulse", "Angular impulse" and PhysicsSystem::Update; the numbers are from its code:
// five passes, 45 % of the depth beyond 1 cm). It shows what warm starting, accumulated impulses
// and corrections that also rotate are for: nothing is remembered, each pass computes each
// contact's impulse from scratch and shares it evenly among the points, friction is clamped by that
// one impulse alone, gravity comes after the impulses, and overlapping bodies are moved apart
// without rotating. So resting bodies fall a little in each step, and stacks sink.
//
// Only contacts that overlap at the start of the step count. The book takes the lesser of two
// bodies' restitutions; here a pair's restitution, like free spin, is as in all other methods.
#include "engine/dynamics/bodies/motion.h"
#include "engine/dynamics/method.h"

#include <algorithm>
#include <array>
#include <span>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

template <typename Contact> auto points_of(Contact &contact) {
    return std::span(contact.points).first(static_cast<std::size_t>(contact.count));
}

// leave_out_what_is_apart zeroes the mass of points that are apart at the start of the step.
bool point_touches(const ContactPointConstraint &point) {
    return point.normal_mass > Real(0);
}

void apply(SolverBody &a, SolverBody &b, const ContactPointConstraint &point, const Vec3 &impulse) {
    a.apply_impulse(-impulse, point.r_a);
    b.apply_impulse(impulse, point.r_b);
}

// Applies one point's share of the normal impulse that its approach calls for, then of friction,
// both for the velocity read at the start.
void strike(const ContactConstraint &contact, ContactPointConstraint &point, SolverBody &a,
            SolverBody &b, Real share) {
    const Vec3 &n = contact.normal;
    const Vec3 speed = b.velocity_at(point.r_b) - a.velocity_at(point.r_a);
    const Real along = glm::dot(speed, n);
    if (along > Real(0))
        return;
    const Real normal = -(Real(1) + contact.restitution) * along * point.normal_mass / share;
    apply(a, b, point, normal * n);
    point.impulse.x += normal;

    const Vec3 sliding = speed - along * n;
    const Real size = glm::length(sliding);
    if (size == Real(0))
        return;
    const Vec3 t = sliding / size;
    const Real k = inverse_effective_mass(a, b, point.r_a, point.r_b, t);
    if (!(k > Real(0)))
        return;
    const Real friction = std::min(size / (k * share), contact.friction * normal);
    apply(a, b, point, -friction * t);
    point.impulse.y -= friction * glm::dot(t, contact.tangents.t1);
    point.impulse.z -= friction * glm::dot(t, contact.tangents.t2);
}

// Moves each pair apart along its normal by a share of its greatest depth beyond the slop.
void project(StepContext &context) {
    const auto part = static_cast<Real>(context.settings.baumgarte);
    const auto slop = static_cast<Real>(context.settings.penetration_slop);
    for (const ContactConstraint &contact : context.scratch.contacts) {
        SolverBody &a = context.bodies[contact.a];
        SolverBody &b = context.bodies[contact.b];
        Real depth = Real(0);
        for (const ContactPointConstraint &point : points_of(contact))
            if (point_touches(point))
                depth = std::max(depth, -present_separation(contact, point, a, b));
        const Real inverse = a.inv_mass_along(contact.normal) + b.inv_mass_along(contact.normal);
        if (depth <= slop || !(inverse > Real(0)))
            continue;
        const Vec3 correction = (part * (depth - slop) / inverse) * contact.normal;
        a.position -= a.inv_mass * correction;
        b.position += b.inv_mass * correction;
    }
    context.report.constraint_passes += context.scratch.contacts.size();
}

void leave_out_what_is_apart(StepContext &context) {
    for (ContactConstraint &contact : context.scratch.contacts) {
        const Manifold &manifold = context.contacts[contact.contact].manifold;
        for (std::size_t k = 0; k < static_cast<std::size_t>(contact.count); ++k)
            if (manifold.points[k].separation > Real(0))
                contact.points[k].normal_mass = Real(0);
    }
}

// One pass: each point's impulse is divided by its contact's number of touching points.
void strike_all(StepContext &context) {
    for (ContactConstraint &contact : context.scratch.contacts) {
        const auto share =
            static_cast<Real>(std::ranges::count_if(points_of(contact), point_touches));
        for (ContactPointConstraint &point : points_of(contact))
            if (point_touches(point))
                strike(contact, point, context.bodies[contact.a], context.bodies[contact.b], share);
    }
    context.report.constraint_passes += context.scratch.contacts.size();
}

// Records elastic contacts that were hit in this substep: they bounce however slow they are.
void record_bounces(StepContext &context) {
    for (const ContactConstraint &contact : context.scratch.contacts) {
        if (contact.restitution == Real(0))
            continue;
        std::array<Real, 4> normal_impulse{};
        for (std::size_t k = 0; k < static_cast<std::size_t>(contact.count); ++k)
            normal_impulse[k] = contact.points[k].impulse.x;
        if (normal_impulse == std::array<Real, 4>{})
            continue;
        ++context.report.impacts;
        record_impact(context, contact, normal_impulse);
    }
}

void advance_naive_impulses(StepContext &context) {
    const StepSettings &settings = context.settings;
    const Real h = context.substep();
    const Vec3 gravity{settings.gravity};

    prepare_contacts(context);
    leave_out_what_is_apart(context);
    for (int substep = 0; substep < settings.substeps; ++substep) {
        remember_contacts(context); // start from zero
        for (int i = 0; i < settings.iterations; ++i)
            strike_all(context);
        record_bounces(context);
        project(context);
        kick(context, gravity, h);
        drift(context, h);
    }
    store_contacts(context); // for display only
}

} // namespace

Method naive_impulses() {
    return {
        {.name = "naive_impulses",
         .title = "Naive impulses",
         .source = "Szauer 2017, Game Physics Cookbook, chapter 15",
         .contacts = true,
         .reads = {SettingGroup::speculative, SettingGroup::constraints, SettingGroup::baumgarte,
                   SettingGroup::gyroscopic},
         .defaults = {.substeps = 1, .iterations = 5, .penetration_slop = 0.01, .baumgarte = 0.45}},
        advance_naive_impulses};
}

} // namespace plumb::inline PLUMB_PRECISION
