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
//
// Joints are made of the same two parts: impulses that start from zero in each substep (limits and
// motors bound their sum), and linear projection, which also turns bodies back where rows are
// angular. The book has none between bodies, only rods between particles (chapter 16, "Distance
// joint"), which are corrected in the same way.
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

// The error that a row may not have: of a limit, only what is beyond it.
Real error_to_correct(const RowBlock &rows, int row) {
    const Real error = rows.error[row];
    switch (rows.bounds) {
    case RowBounds::equal:
        return error;
    case RowBounds::at_least:
        return std::min(error, Real(0));
    case RowBounds::at_most:
        return std::max(error, Real(0));
    case RowBounds::motor:
    case RowBounds::pull:
        break;
    }
    return Real(0);
}

// Moves two bodies along a row, or turns them about it, by a share of its error.
void project_row(SolverBody &a, SolverBody &b, RowKind kind, const Vec3 &axis, Real correction) {
    if (kind == RowKind::angular) {
        const Real inverse = glm::dot(axis, (a.inv_inertia + b.inv_inertia) * axis);
        if (!(inverse > Real(0)))
            return;
        const Vec3 turn = (correction / inverse) * axis;
        a.rotation = turned(a.rotation, a.inv_inertia * turn, Real(-1));
        b.rotation = turned(b.rotation, b.inv_inertia * turn, Real(1));
        return;
    }
    const Real inverse = a.inv_mass_along(axis) + b.inv_mass_along(axis);
    if (!(inverse > Real(0)))
        return;
    const Vec3 move = (correction / inverse) * axis;
    a.position -= a.inv_mass * move;
    b.position += b.inv_mass * move;
}

// The same for joints that are rigid.
void project_joints(StepContext &context) {
    const auto part = static_cast<Real>(context.settings.baumgarte);
    refresh_joints(context);
    for (const JointConstraint &joint : context.scratch.joints) {
        const RowBlock &rows = joint.rows;
        if (joint.is_spring())
            continue;
        for (int row = 0; row < rows.count; ++row) {
            Vec3 axis{Real(0)};
            if (rows.kind == RowKind::point)
                axis[row] = Real(1);
            else
                axis = rows.axes[static_cast<std::size_t>(row)];
            project_row(context.body(joint.a), context.body(joint.b), rows.kind, axis,
                        -part * error_to_correct(rows, row));
        }
    }
    context.report.constraint_passes += context.scratch.joints.size();
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
    prepare_joints(context);
    for (int substep = 0; substep < settings.substeps; ++substep) {
        refresh_joints(context);
        remember_joints(context);
        remember_contacts(context); // both start from zero
        for (int i = 0; i < settings.iterations; ++i) {
            solve_joints(context, {.softness = {}, .h = h});
            strike_all(context);
        }
        record_bounces(context);
        note_joint_loads(context);
        project(context);
        project_joints(context);
        kick(context, gravity, h);
        drift(context, h);
    }
    store_joints(context);   // for display and breaking
    store_contacts(context); // for display only
}

} // namespace

Method naive_impulses() {
    return {
        {.name = "naive_impulses",
         .title = "Naive impulses",
         .source = "Szauer 2017, Game Physics Cookbook, chapter 15",
         .contacts = true,
         .joints = true,
         .reads = {SettingGroup::speculative, SettingGroup::constraints, SettingGroup::baumgarte,
                   SettingGroup::gyroscopic},
         .defaults = {.substeps = 1, .iterations = 5, .penetration_slop = 0.01, .baumgarte = 0.45}},
        advance_naive_impulses};
}

} // namespace plumb::inline PLUMB_PRECISION
