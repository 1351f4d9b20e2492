// How many substeps bodies ask for: from the loads of joints and contacts in the last step, and
// from how fast the bodies move for their size.
#include "engine/dynamics/joints/joint_impulse.h"
#include "engine/dynamics/world.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// The rate times the substep that joints' forces may reach: for joints that are solved together,
// and for others (joint_loads.cpp, with some to spare).
constexpr double followed_together = 1.2;
constexpr double followed_alone = 1.1;

// The same for joints that are springs, and for the sideways stiffness of rods under tension: other
// joints at their bodies add to it.
constexpr double followed_swing = 0.6;
constexpr double followed_damping = 16;

// How far a body that touches another may turn in a substep (rad): with the lever arms of another
// pose, impulses do work.
constexpr double followed_roll = 0.4;

// If joints solved together did not follow, the step is repeated with this many times the substeps.
constexpr double finer = 4;

// How far a loaded body may turn on its joints in a substep (rad): its energy loss falls with the
// square of that. Less where a light body may whip past a heavy one.
constexpr double followed_turn = 0.08;
constexpr double followed_whip = 0.04;

std::uint16_t count_of(double substeps) {
    constexpr double most = std::numeric_limits<std::uint16_t>::max();
    // NaN comes from bodies that are about to diverge; they ask for nothing.
    return substeps > 0 ? static_cast<std::uint16_t>(std::ceil(std::min(substeps, most))) : 0;
}

double square(double x) {
    return x * x;
}

double largest(const Vec3 &v) {
    return static_cast<double>(std::max({v.x, v.y, v.z}));
}

// use(body, arm) for each end of a joint; the arm of a, which carries the opposite force, is
// negated.
template <typename Use> void for_ends(const JointConstraint &joint, Use &&use) {
    if (joint.a != Joint::world)
        use(joint.a, -joint.rows.r_a);
    if (joint.b != Joint::world)
        use(joint.b, joint.rows.r_b);
}

bool is_loaded(const JointConstraint &joint) {
    return joint.joint != JointConstraint::grab && joint.rows.kind != RowKind::angular &&
           joint.rows.bounds != RowBounds::motor && !joint.is_spring();
}

// How far moments turn the joints that carry them: such angles add up along a beam. A block that is
// solved with its group is as soft as `factor` makes it, and at rest half of its impulse turns it
// by half of the error that a substep takes back. Joints that have been torn apart stay so at any
// number of substeps, and ask for none.
void note_moment_needs(Scratch &s, const StepSettings &settings, int substeps) {
    const double h = settings.dt / substeps;
    JointSystem &system = *s.solver.joint_system;
    for (const JointGroup &joints : system.groups())
        for (std::uint32_t place = joints.first; joints.is_held && place < joints.last; ++place) {
            const JointConstraint &joint = s.solver.joints[system.block(place)];
            if (joint.rows.kind != RowKind::angular)
                continue;
            Vec3 turned = (system.softening(place) * WideVec3(joint.impulse)).narrow();
            if (joint.bearing == Bearing::motor) // does not give way
                turned.z = Real(0);
            const double turn = h * static_cast<double>(glm::length(turned));
            const double squared = square(substeps) * turn / settings.substep_tolerance;
            for_ends(joint, [&](std::uint32_t body, const Vec3 &) {
                s.wanted_squared[body] = std::max(s.wanted_squared[body], squared);
            });
        }
}

} // namespace

// The loads of joints in their first step are unknown: assume the weight of the whole island on
// each of them. Begun too coarsely they would be stretched, and give that energy back when they are
// stiffened.
void World::guess_needs() {
    Scratch &s = scratch_;
    Islands &islands = s.islands;
    const auto is_first = [&](std::uint32_t body) {
        return islands.needs[islands.root_of(body)].before == 0;
    };
    if (std::ranges::none_of(s.moving, is_first))
        return;
    s.guessed_stiffness.assign(s.bodies.size(), Vec3{Real(0)});
    const auto load = [&](std::uint32_t body, const Vec3 &arm) {
        if (body != Joint::world && model_->bodies[body].kind == BodyKind::dynamic)
            s.guessed_stiffness[body] +=
                greatest_axial_stiffness(arm, model_->bodies[body].inertia);
    };
    for (std::uint32_t i = 0; i < model_->joints.size(); ++i) {
        const Joint &joint = model_->joints[i];
        if (!holds(i) || joint.frequency > Real(0))
            continue;
        load(joint.a, joint.anchor_a_local);
        load(joint.b, joint.anchor_b_local);
    }
    for (const std::uint32_t i : s.moving) {
        const Body &body = model_->bodies[i];
        if (body.kind != BodyKind::dynamic || !is_first(i))
            continue;
        Islands::Needs &needs = islands.needs[islands.root_of(i)];
        // A body that is let go suddenly pulls twice as hard at first.
        const double weight = 2 * needs.weight;
        const double rate = std::sqrt(
            weight * static_cast<double>(squared_rate(s.guessed_stiffness[i], body.inertia)));
        needs.wanted =
            std::max(needs.wanted, int{count_of(rate * settings_.dt / followed_together)});
    }
}

// What falls between two walls that face each other strikes them in turns. Each pass leaves it some
// of its speed, which presses it into them. So it takes as many substeps as it needs to move little
// for its size in each.
void World::gather_wedge_needs() {
    Scratch &s = scratch_;
    constexpr Real facing = Real(-0.5); // the normals' product: 60 degrees between the walls
    constexpr Real little = Real(0.1);  // of its half width
    s.wall_normals.assign(s.bodies.size(), Vec3{Real(0)});
    s.greatest_contact_load.assign(s.bodies.size(), std::numeric_limits<double>::infinity());
    for (const Contact &contact : s.contacts) {
        const bool is_a = moves(contact.key.a);
        if (contact.sensor || contact.manifold.count == 0 || is_a == moves(contact.key.b))
            continue;
        const std::uint32_t body = is_a ? contact.key.a : contact.key.b;
        const Vec3 normal = is_a ? -contact.manifold.normal : contact.manifold.normal;
        Vec3 &first = s.wall_normals[body];
        if (first == Vec3{Real(0)})
            first = normal;
        if (!(glm::dot(first, normal) < facing))
            continue;
        Islands::Needs &needs = s.islands.needs[s.islands.root_of(body)];
        if (!needs.is_joined && !needs.is_driven)
            s.greatest_contact_load[body] = needs.weight;
        const Motion &motion = state_.motions[body];
        const Real speed = glm::length(motion.velocity) + static_cast<Real>(extent_of(body)) *
                                                              glm::length(motion.angular_velocity);
        const Real far = little * least_half_width(model_->bodies[body]);
        needs.wanted =
            std::max(needs.wanted, int{count_of(settings_.dt * static_cast<double>(speed / far))});
    }
}

bool World::is_solved_together(std::uint32_t body) const {
    return scratch_.solver.joint_system->group_of(body) != JointSystem::none;
}

// A soft contact of frequency w under the force F is F / (2 m w^2) deep: the warm start acts in two
// halves, before and after the move. With w = 2 pi ratio n / dt that gives the n below.
void World::note_contact_needs(const IslandGroup &group) {
    Scratch &s = scratch_;
    const double ratio = 2 * std::numbers::pi * settings_.contact_frequency_ratio;
    const auto wanted_of = [&](const Contact &contact) {
        const std::uint32_t a = contact.key.a;
        const std::uint32_t b = contact.key.b;
        // A new contact's impact is not a load yet; but the first step knows nothing else.
        if (contact.is_new && state_.paces[island_body(a, b)].substeps > 0)
            return 0.0;
        double load = 0;
        for (int k = 0; k < contact.manifold.count; ++k)
            load += static_cast<double>(contact.impulses[static_cast<std::size_t>(k)].x);
        const double inverse = largest(s.bodies[a].inv_mass) + largest(s.bodies[b].inv_mass);
        double width = std::numeric_limits<double>::infinity();
        for (const std::uint32_t body : {a, b})
            if (model_->bodies[body].kind == BodyKind::dynamic)
                width = std::min(width,
                                 2 * static_cast<double>(least_half_width(model_->bodies[body])));
        const double depth = settings_.substep_tolerance * width;
        // What is wedged between walls presses on them as hard as it has been driven in. Contacts
        // that much stiffer would only throw it out.
        load = std::min(load, std::min(s.greatest_contact_load[a], s.greatest_contact_load[b]) *
                                  settings_.dt / group.pace.substeps);
        return 0.5 * load * group.pace.substeps * settings_.dt * inverse / (ratio * ratio * depth);
    };
    const auto roll_of = [&](std::uint32_t body) {
        const Vec3 &spin = s.bodies[body].angular_velocity;
        const double roll =
            static_cast<double>(glm::dot(spin, spin)) * square(settings_.dt / followed_roll);
        const bool is_fast = roll > square(settings_.substeps);
        return is_fast && model_->bodies[body].kind == BodyKind::dynamic &&
                       extent_of(body) > Real(0)
                   ? roll
                   : 0.0;
    };
    s.contact_wanted_squared.resize(group.contacts.size());
    for_parts(s.tasks, group.contacts.size(), contacts_a_part,
              [&](std::size_t begin, std::size_t end) {
                  for (std::size_t i = begin; i < end; ++i)
                      s.contact_wanted_squared[i] = wanted_of(s.contacts[group.contacts[i]]);
              });
    for (std::size_t i = 0; i < group.contacts.size(); ++i) {
        const ContactEnds &ends = s.ends[group.contacts[i]];
        for (const std::uint32_t body : {ends.a, ends.b})
            s.wanted_squared[body] =
                std::max({s.wanted_squared[body], s.contact_wanted_squared[i], roll_of(body)});
    }
}

// Needs from joint drift, and from springs that share bodies.
void World::note_joint_needs(const IslandGroup &group) {
    Scratch &s = scratch_;
    const double ratio = 2 * std::numbers::pi * settings_.joint_frequency_ratio;
    const auto ask = [&](const JointConstraint &joint, double squared) {
        for_ends(joint, [&](std::uint32_t body, const Vec3 &) {
            s.wanted_squared[body] = std::max(s.wanted_squared[body], squared);
        });
    };
    for (const std::uint32_t i : group.moving)
        s.stiffness[i] = {};
    for (const JointConstraint &joint : s.solver.joints) {
        if (joint.is_spring()) {
            const double swing =
                2 * std::numbers::pi * static_cast<double>(joint.rows.frequency) * settings_.dt;
            const double slowing = 2 * static_cast<double>(joint.rows.damping_ratio) * swing;
            ask(joint,
                std::max(square(swing / followed_swing), square(slowing / followed_damping)));
        }
        if (!is_loaded(joint))
            continue;
        const double impulse = static_cast<double>(glm::length(joint.impulse)); // of a substep
        double inverse = 0;
        bool is_together = false;
        const Vec3 force = static_cast<Real>(group.pace.substeps / settings_.dt) *
                           world_impulse(joint.rows, joint.impulse);
        for_ends(joint, [&](std::uint32_t body, const Vec3 &arm) {
            s.stiffness[body].add_bound(force, arm);
            if (!is_isotropic(model_->bodies[body].inertia))
                s.stiffness[body].add_tensor(force, arm);
            inverse += largest(s.bodies[body].inv_mass);
            is_together = is_together || is_solved_together(body);
        });
        if (joint.rows.swing_length > Real(0)) {
            // A rod under tension resists sideways motion of its ends, and turns with them.
            const double length = static_cast<double>(joint.rows.swing_length);
            const double tension = impulse * group.pace.substeps / settings_.dt;
            ask(joint, 4 * tension / length * inverse * square(settings_.dt / followed_swing));
        }
        if (is_together)
            continue;
        const double drift = settings_.substep_tolerance * static_cast<double>(joint.size);
        const double squared =
            0.5 * impulse * group.pace.substeps * settings_.dt * inverse / (ratio * ratio * drift);
        ask(joint, squared);
    }
    note_moment_needs(s, settings_, group.pace.substeps);
}

// Needs from how fast joints' forces turn their bodies, and from how fast the bodies turn.
void World::note_turn_needs(const IslandGroup &group) {
    Scratch &s = scratch_;
    for (const std::uint32_t i : group.moving) {
        const Body &body = model_->bodies[i];
        if (body.kind != BodyKind::dynamic || !(s.stiffness[i].most > Real(0)))
            continue;
        const auto squared = static_cast<double>(squared_rate(
            axial_stiffness(s.stiffness[i], body.inertia, s.bodies[i].rotation), body.inertia));
        const double rate =
            settings_.dt / (is_solved_together(i) ? followed_together : followed_alone);
        s.wanted_squared[i] = std::max(s.wanted_squared[i], squared * rate * rate);
    }
    const auto is_uneven = [&](std::uint32_t body) {
        JointSystem &system = *s.solver.joint_system;
        return body != Joint::world && is_solved_together(body) &&
               system.groups()[system.group_of(body)].is_uneven;
    };
    for (const JointConstraint &joint : s.solver.joints) {
        const bool may_whip = is_uneven(joint.a) || is_uneven(joint.b);
        // Else only for joints to something at rest: a chain that whips would be stiffened
        // mid-motion.
        if (!may_whip && moves(joint.a) && moves(joint.b))
            continue;
        const double turn = settings_.dt / (may_whip ? followed_whip : followed_turn);
        for_ends(joint, [&](std::uint32_t body, const Vec3 &) {
            if (model_->bodies[body].kind != BodyKind::dynamic ||
                !(s.stiffness[body].most > Real(0)))
                return;
            const Vec3 &spin = s.bodies[body].angular_velocity;
            s.wanted_squared[body] = std::max(
                s.wanted_squared[body], static_cast<double>(glm::dot(spin, spin)) * turn * turn);
        });
    }
}

// If joints solved together did not follow, the step is repeated with finer substeps. Joints that
// have been torn apart are loaded springs, and are stiffened bit by bit.
void World::note_let_go(const IslandGroup &group) {
    Scratch &s = scratch_;
    const double more = square(round_substeps_up(group.pace.substeps + 1));
    JointSystem &system = *s.solver.joint_system;
    for (const JointGroup &joints : system.groups()) {
        const auto note = [&](std::uint32_t body, const Vec3 &) {
            double &squared = s.wanted_squared[body];
            if (joints.was_let_go) {
                squared = std::max(squared, square(finer * group.pace.substeps));
                s.islands.needs[s.islands.root_of(body)].was_let_go = true;
            } else if (state_.paces[body].substeps > 0) {
                squared = std::min(squared, more);
            }
        };
        for (std::uint32_t place = joints.first; place < joints.last; ++place)
            if (joints.was_let_go || joints.was_torn)
                for_ends(s.solver.joints[system.block(place)], note);
    }
}

// After a group was advanced: the substeps that its loads ask for in the next step.
void World::note_needs(const IslandGroup &group) {
    Scratch &s = scratch_;
    if (group.is_free()) {
        for (const std::uint32_t i : group.moving)
            s.paces[i].wanted = 0;
        return;
    }
    s.wanted_squared.resize(s.bodies.size());
    s.stiffness.resize(s.bodies.size());
    for (const std::uint32_t i : group.moving)
        s.wanted_squared[i] = 0;
    note_contact_needs(group);
    note_joint_needs(group);
    note_turn_needs(group);
    note_let_go(group);
    for (const std::uint32_t i : group.moving)
        s.paces[i].wanted = count_of(std::sqrt(s.wanted_squared[i]));
}

// Joints that are let go once may never be held again, and what hangs on them falls apart: the step
// that is repeated may cost more than others.
int World::finer_budget() const {
    return static_cast<int>(finer) * settings_.substep_budget;
}

bool World::was_any_let_go() const {
    return std::ranges::any_of(scratch_.islands.needs, &Islands::Needs::was_let_go);
}

// Whether bodies that had no pace before asked for more than they got, or joints were let go that
// more substeps may follow.
bool World::went_too_coarsely() const {
    const Scratch &s = scratch_;
    if (!chooses_substeps())
        return false;
    const auto has_begun = [&](std::uint32_t i) {
        return state_.paces[i].substeps == 0 && s.paces[i].wanted > s.paces[i].substeps &&
               s.paces[i].substeps < settings_.max_substeps;
    };
    const auto was_let_go = [&](Islands::Needs needs) {
        needs.wanted = needs.before = static_cast<int>(finer) * needs.pace.substeps;
        return needs.was_let_go && chosen_substeps(needs, finer_budget()) > needs.pace.substeps;
    };
    return std::ranges::any_of(s.moving, has_begun) ||
           std::ranges::any_of(s.islands.needs, was_let_go);
}

} // namespace plumb::inline PLUMB_PRECISION
