#include "engine/dynamics/methods/parts/descent.h"

#include "engine/core/renew.h"
#include "engine/dynamics/bodies/motion.h"
#include "engine/dynamics/method.h"
#include "engine/dynamics/methods/parts/pose_correction.h"
#include "engine/dynamics/methods/parts/rigid_block.h"
#include "engine/math/rigid.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

constexpr std::uint32_t nowhere = UINT32_MAX;

// Of all rotation vectors for the turn, the one closest to free flight's.
Vec3 turned_since_start(const DescentBody &own, Real h) {
    const AxisAngle about = axis_angle(own.turn);
    constexpr Real whole = Real(2) * std::numbers::pi_v<Real>;
    const Real free = h * glm::dot(own.free_spin, about.axis);
    return (about.angle + whole * std::round((free - about.angle) / whole)) * about.axis;
}

// ---- what acts on what

// Calls of_body(body, use) or of_particle(particle, use) for each body or particle of every joint,
// spring and contact, in a fixed order.
template <typename OfBody, typename OfParticle>
void for_each_use(StepContext &context, OfBody &&of_body, OfParticle &&of_particle) {
    SolverScratch &s = context.scratch;
    const auto both = [&](DescentUse::Kind kind, std::size_t index, std::uint32_t a,
                          std::uint32_t b) {
        of_body(a, DescentUse{kind, false, static_cast<std::uint32_t>(index)});
        of_body(b, DescentUse{kind, true, static_cast<std::uint32_t>(index)});
    };
    for (std::size_t k = 0; k < joint_count(context); ++k)
        if (const auto blocks = blocks_of(context, k); !blocks.empty())
            both(DescentUse::Kind::joint, k, blocks.front().a, blocks.front().b);
    for (std::size_t i = 0; i < s.springs.size(); ++i) {
        const Spring &spring = context.model.springs[s.springs[i].spring];
        for (const SpringEnd *end : {&spring.a, &spring.b}) {
            const DescentUse use{DescentUse::Kind::spring, end == &spring.b,
                                 static_cast<std::uint32_t>(i)};
            if (end->kind == SpringEnd::Kind::body)
                of_body(end->index, use);
            if (end->kind == SpringEnd::Kind::particle)
                of_particle(end->index, use);
        }
    }
    for (std::size_t i = 0; i < s.particle_contacts.size(); ++i) {
        const ParticleContact &contact = context.particle_contacts[s.particle_contacts[i].contact];
        const auto index = static_cast<std::uint32_t>(i);
        of_body(contact.body, DescentUse{DescentUse::Kind::particle_contact, false, index});
        of_particle(contact.particle, DescentUse{DescentUse::Kind::particle_contact, true, index});
    }
    for (std::size_t i = 0; i < s.contacts.size(); ++i)
        both(DescentUse::Kind::contact, i, s.contacts[i].a, s.contacts[i].b);
}

} // namespace

void gather_uses(StepContext &context) {
    Descent &d = context.scratch.descent;
    d.bodies.clear();
    renew(d.place, context.model.bodies.size(), nowhere);
    for (const std::uint32_t i : context.moving())
        if (context.model.bodies[i].kind == BodyKind::dynamic) {
            d.place[i] = static_cast<std::uint32_t>(d.bodies.size());
            d.bodies.emplace_back().body = i;
        }
    const auto place_of = [&](std::uint32_t body) {
        return body == Joint::world ? nowhere : d.place[body];
    };
    const std::size_t particles = context.active.has_particles ? context.particles.size() : 0;
    renew(d.body_uses.first, d.bodies.size() + 1, std::uint32_t{0});
    renew(d.particle_uses.first, particles + 1, std::uint32_t{0});
    for_each_use(
        context,
        [&](std::uint32_t body, const DescentUse &) {
            if (place_of(body) != nowhere)
                ++d.body_uses.first[place_of(body) + 1];
        },
        [&](std::uint32_t particle, const DescentUse &) { ++d.particle_uses.first[particle + 1]; });
    for (DescentUses *uses : {&d.body_uses, &d.particle_uses}) {
        for (std::size_t i = 1; i < uses->first.size(); ++i)
            uses->first[i] += uses->first[i - 1];
        uses->all.resize(uses->first.back());
    }
    // Filling advances each start to its end, where the next one starts.
    const auto put = [](DescentUses &uses, std::uint32_t at, const DescentUse &use) {
        uses.all[uses.first[at]++] = use;
    };
    for_each_use(
        context,
        [&](std::uint32_t body, const DescentUse &use) {
            if (place_of(body) != nowhere)
                put(d.body_uses, place_of(body), use);
        },
        [&](std::uint32_t particle, const DescentUse &use) {
            put(d.particle_uses, particle, use);
        });
    for (DescentUses *uses : {&d.body_uses, &d.particle_uses}) {
        std::shift_right(uses->first.begin(), uses->first.end(), 1);
        uses->first.front() = 0;
    }
}

std::span<const DescentUse> uses_of(const DescentUses &uses, std::size_t i) {
    return std::span(uses.all).subspan(uses.first[i], uses.first[i + 1] - uses.first[i]);
}

namespace {

// ---- rows at the present poses

// Displacement of a body's point at `arm` in the substep, to first order in the rotation.
Vec3 way_at(const SolverBody &body, const Vec3 &arm, Real h) {
    return h * body.velocity + glm::cross(body.turned, arm);
}

// Along the normal and the tangents.
Vec3 in_basis(const Vec3 &v, const Vec3 &normal, const TangentBasis &tangents) {
    return {glm::dot(v, normal), glm::dot(v, tangents.t1), glm::dot(v, tangents.t2)};
}

} // namespace

Vec3 way_of(const StepContext &context, const ContactConstraint &contact,
            const ContactPointConstraint &point, Real h) {
    return in_basis(way_at(context.bodies[contact.b], point.r_b, h) -
                        way_at(context.bodies[contact.a], point.r_a, h),
                    contact.normal, contact.tangents);
}

Vec3 way_of(const StepContext &context, const ParticleContactConstraint &row, Real h) {
    const ParticleContact &contact = context.particle_contacts[row.contact];
    return in_basis(h * context.particles[contact.particle].velocity -
                        way_at(context.bodies[contact.body], row.arm, h),
                    contact.normal, row.tangents);
}

AugmentedBlock &augmented(StepContext &context, const JointConstraint &joint) {
    SolverScratch &s = context.scratch;
    return s.descent.blocks[static_cast<std::size_t>(&joint - s.joints.data())];
}

Real driven(StepContext &context, const JointConstraint &joint, Real h) {
    if (joint.rows.bounds != RowBounds::motor)
        return Real(0);
    const SolverBody &a = context.body(joint.a);
    const SolverBody &b = context.body(joint.b);
    return glm::dot(joint.rows.axes[0],
                    joint.rows.kind == RowKind::angular
                        ? b.turned - a.turned
                        : way_at(b, joint.rows.r_b, h) - way_at(a, joint.rows.r_a, h));
}

namespace {

// A spring's force towards its rest length, and its stiffness along and across its line.
struct SpringPull {
    Vec3 axis{Real(0)}; // unit, from a to b
    Vec3 arm_a{Real(0)};
    Vec3 arm_b{Real(0)};
    Real force = Real(0); // N, along the axis on b
    Real stiffness = Real(0);
    Real aside = Real(0); // |f| / length: factor of 1 - n n^T in its second derivative
};

// The lengths of the columns of 1 - n n^T.
Vec3 aside_of(const Vec3 &n) {
    return glm::sqrt(glm::max(Vec3{Real(1)} - n * n, Vec3{Real(0)}));
}

SpringPull pull_of(const StepContext &context, std::size_t i, Real h) {
    const Spring &spring = context.model.springs[context.scratch.springs[i].spring];
    const SpringPoint a = spring_point(spring.a, context.bodies, context.particles);
    const SpringPoint b = spring_point(spring.b, context.bodies, context.particles);
    const Vec3 line = b.position - a.position;
    const Real length = glm::length(line);
    if (length == Real(0))
        return {};
    SpringPull pull{.axis = line / length, .arm_a = a.arm, .arm_b = b.arm};
    const Real damping = spring.damping / h;
    pull.force = -spring.stiffness * (length - spring.rest_length) -
                 damping * (length - context.scratch.descent.start_lengths[i]);
    pull.stiffness = spring.stiffness + damping;
    pull.aside = std::abs(pull.force) / length;
    return pull;
}

// ---- the primal update

void add_point(RigidBlock &block, const PointForce &force, const Vec3 &normal,
               const TangentBasis &tangents, const Vec3 &arm, Real side) {
    const std::array rows{side * normal, side * tangents.t1, side * tangents.t2};
    for (int i = 0; i < 3; ++i) {
        const Vec3 &row = rows[static_cast<std::size_t>(i)];
        if (force.stiffness[i] > Real(0))
            block.add_row(row, glm::cross(arm, row), force.stiffness[i], force.force[i]);
    }
}

void add_contact(const StepContext &context, RigidBlock &block, const DescentUse &use, Real h) {
    const ContactConstraint &contact = context.scratch.contacts[use.index];
    for (std::size_t k = 0; k < static_cast<std::size_t>(contact.count); ++k) {
        const ContactPointConstraint &point = contact.points[k];
        const PointForce force = force_of(context.scratch.descent.contacts[use.index][k],
                                          way_of(context, contact, point, h), contact.friction);
        add_point(block, force, contact.normal, contact.tangents, use.is_b ? point.r_b : point.r_a,
                  use.is_b ? Real(1) : Real(-1));
    }
}

void add_joint(StepContext &context, RigidBlock &block, const DescentUse &use,
               const Stiffening &stiffening) {
    refresh_joint(context, use.index);
    const Real side = use.is_b ? Real(1) : Real(-1);
    for (const JointConstraint &joint : blocks_of(context, use.index)) {
        const RowBlock &rows = joint.rows;
        const BlockForce force = force_of(augmented(context, joint), rows,
                                          driven(context, joint, stiffening.h), stiffening);
        const Vec3 &arm = use.is_b ? rows.r_b : rows.r_a;
        for (int i = 0; i < rows.count; ++i) {
            Vec3 unit{Real(0)};
            unit[i] = side;
            const Vec3 row = along(rows, unit);
            if (rows.kind == RowKind::angular)
                block.add_row(Vec3{Real(0)}, row, force.stiffness[i], force.force[i]);
            else
                block.add_row(row, glm::cross(arm, row), force.stiffness[i], force.force[i]);
        }
        if (rows.kind == RowKind::angular)
            continue;
        block.add_turn_stiffness(turn_stiffness(along(rows, force.force), arm));
        if (rows.swing_length > Real(0)) {
            const Vec3 aside = std::abs(force.force.x) / rows.swing_length * aside_of(rows.axes[0]);
            for (int i = 0; i < 3; ++i) {
                Vec3 axis{Real(0)};
                axis[i] = Real(1);
                block.add_row(axis, glm::cross(arm, axis), aside[i], Real(0));
            }
        }
    }
}

void add_spring(const StepContext &context, RigidBlock &block, const DescentUse &use, Real h) {
    const SpringPull pull = pull_of(context, use.index, h);
    const Vec3 row = use.is_b ? pull.axis : -pull.axis;
    const Vec3 &arm = use.is_b ? pull.arm_b : pull.arm_a;
    block.add_row(row, glm::cross(arm, row), pull.stiffness - pull.aside, pull.force);
    block.add_turn_stiffness(turn_stiffness(pull.force * row, arm));
    for (int i = 0; i < 3; ++i) {
        Vec3 axis{Real(0)};
        axis[i] = Real(1);
        block.add_row(axis, glm::cross(arm, axis), pull.aside, Real(0));
    }
}

void solve_body(StepContext &context, std::size_t i, const Stiffening &stiffening) {
    Descent &d = context.scratch.descent;
    DescentBody &own = d.bodies[i];
    SolverBody &body = context.bodies[own.body];
    const Body &model = context.model.bodies[own.body];
    const Real h = stiffening.h;
    const std::span<const DescentUse> uses = uses_of(d.body_uses, i);
    if (uses.empty())
        return;
    const Real squared = Real(1) / (h * h);
    const Vec3 excess = rotation_vector(own.turn * glm::conjugate(own.free_turn));
    RigidBlock block(Vec3{squared * model.mass}, squared * own.inertia,
                     (model.mass / h) * (own.free_velocity - body.velocity),
                     -squared * (own.inertia * excess));
    for (const DescentUse &use : uses)
        switch (use.kind) {
        case DescentUse::Kind::joint:
            add_joint(context, block, use, stiffening);
            break;
        case DescentUse::Kind::spring:
            add_spring(context, block, use, h);
            break;
        case DescentUse::Kind::particle_contact: {
            const ParticleContactConstraint &row = context.scratch.particle_contacts[use.index];
            const ParticleContact &contact = context.particle_contacts[row.contact];
            add_point(
                block,
                force_of(d.particle_contacts[use.index], way_of(context, row, h), contact.friction),
                contact.normal, row.tangents, row.arm, Real(-1));
            break;
        }
        case DescentUse::Kind::contact:
            add_contact(context, block, use, h);
            break;
        }
    for (std::size_t axis = 0; axis < 6 && model.has_locks; ++axis)
        if (model.locked[axis])
            block.lock(axis);
    const RigidBlock::Step step = block.solve();
    body.position += step.way;
    body.velocity += step.way / h;
    own.turn = turned(own.turn, step.turn, Real(1));
    body.turned = turned_since_start(own, h);
    body.rotation = glm::normalize(own.turn * own.start);
}

void solve_particle(StepContext &context, std::uint32_t i, Real h) {
    const Descent &d = context.scratch.descent;
    const std::span<const DescentUse> uses = uses_of(d.particle_uses, i);
    const Particle &model = context.model.particles[i];
    ParticleMotion &motion = context.particles[i];
    if (uses.empty() || model.inv_mass == Real(0))
        return;
    Vec3 force = (model.mass / h) * (d.free_velocities[i] - motion.velocity);
    Mat3 stiffness{model.mass / (h * h)};
    const auto add = [&](const Vec3 &row, Real k, Real along) {
        force += along * row;
        for (int j = 0; j < 3; ++j)
            stiffness[j] += (k * row[j]) * row;
    };
    for (const DescentUse &use : uses)
        if (use.kind == DescentUse::Kind::spring) {
            const SpringPull pull = pull_of(context, use.index, h);
            add(use.is_b ? pull.axis : -pull.axis, pull.stiffness - pull.aside, pull.force);
            for (int j = 0; j < 3; ++j)
                stiffness[j][j] += pull.aside;
        } else {
            const ParticleContactConstraint &row = context.scratch.particle_contacts[use.index];
            const ParticleContact &contact = context.particle_contacts[row.contact];
            const PointForce pushed =
                force_of(d.particle_contacts[use.index], way_of(context, row, h), contact.friction);
            const std::array rows{contact.normal, row.tangents.t1, row.tangents.t2};
            for (int j = 0; j < 3; ++j)
                add(rows[static_cast<std::size_t>(j)], pushed.stiffness[j], pushed.force[j]);
        }
    const Vec3 way = glm::inverse(stiffness) * force;
    motion.position += way;
    motion.velocity += way / h;
}

} // namespace

void descend(StepContext &context, const Stiffening &stiffening) {
    const Descent &d = context.scratch.descent;
    for (std::size_t i = 0; i < d.bodies.size(); ++i)
        solve_body(context, i, stiffening);
    for (std::uint32_t i = 0; i < d.free_velocities.size(); ++i)
        solve_particle(context, i, stiffening.h);
}

} // namespace plumb::inline PLUMB_PRECISION
