// Contacts whose arms, normals or points change within a step, in the columns of soft_step: those
// that turn with a body or follow one that rolls, and those of bodies that turn far.
#include "engine/dynamics/colours.h"
#include "engine/dynamics/contacts/approach.h"
#include "engine/dynamics/contacts/contact_columns.h"
#include "engine/dynamics/contacts/rolling_contact.h"
#include "engine/dynamics/islands/bracing.h"
#include "engine/dynamics/method.h"

#include <algorithm>
#include <bit>
#include <optional>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// Sets a point's separation along the present normal at the start of the step; the bodies' motion
// since then is added to it.
void set_start_separation(const StepContext &context, ContactBlock &block, std::size_t lane,
                          std::size_t k) {
    const Contact &contact = context.contacts[block.contacts[lane]];
    const StartArms::Point &arms = context.scratch.schedule.start_arms[block.ahead].points[k];
    const Vec3 between =
        (context.starts[contact.key.b].position - context.starts[contact.key.a].position) +
        (get(arms.core_b, lane) - get(arms.core_a, lane));
    block.points[k].separation.lanes[lane] =
        glm::dot(between, get(block.normal, lane)) -
        (block.rounding_a.lanes[lane] + block.rounding_b.lanes[lane]);
}

// Where a point of a body was at the start of the step, as seen from the centre of mass; `arm`:
// where it is at `rotation`.
Vec3 arm_at_start(const StepContext &context, std::uint32_t body, const Quat &rotation,
                  const Vec3 &arm) {
    return context.starts[body].rotation * (glm::conjugate(rotation) * arm);
}

// A contact some time from now.
struct TurnedContact {
    Motion a, b;
    Vec3 between{Real(0)};         // from a's centre of mass to b's
    std::array<Vec3, 4> cores_a{}; // from these
    std::array<Vec3, 4> cores_b{};
    Quat turn = identity_rotation; // of the normal since it was found
    Vec3 normal{Real(0)};
};
TurnedContact turned_contact(const StepContext &context, const Contact &contact, Real t) {
    TurnedContact turned;
    turned.a = ahead(context.bodies[contact.key.a], t);
    turned.b = ahead(context.bodies[contact.key.b], t);
    turned.between = turned.b.position - turned.a.position;
    Vec3 line{Real(0)};
    for (std::size_t k = 0; k < static_cast<std::size_t>(contact.manifold.count); ++k) {
        turned.cores_a[k] = turned.a.rotation * contact.anchors[k].core_a;
        turned.cores_b[k] = turned.b.rotation * contact.anchors[k].core_b;
        line += turned.between + (turned.cores_b[k] - turned.cores_a[k]);
    }
    turned.turn = contact.turn(turned.a.rotation, turned.b.rotation, line);
    turned.normal = turned.turn * contact.manifold.normal;
    return turned;
}

// Makes another point of a body the one whose distance is a contact point's separation.
void set_core(StepContext &context, const ContactBlock &block, std::size_t lane, std::size_t k,
              bool of_a, const TurnedContact &turned, const Vec3 &core) {
    const ContactKey &key = context.contacts[block.contacts[lane]].key;
    StartArms::Point &point = context.scratch.schedule.start_arms[block.ahead].points[k];
    set(of_a ? point.core_a : point.core_b, lane,
        arm_at_start(context, of_a ? key.a : key.b, (of_a ? turned.a : turned.b).rotation, core));
}

// Moves the point that runs round a rim to where the rim is lowest.
void move_round_rim(StepContext &context, const ContactBlock &block, std::size_t lane,
                    TurnedContact &turned) {
    const Contact &contact = context.contacts[block.contacts[lane]];
    const auto k = static_cast<std::size_t>(contact.rim_point);
    const bool of_a = contact.turns_with_b;
    const Collider &collider =
        context.model.colliders[of_a ? contact.collider_a : contact.collider_b];
    const Quat &rotation = (of_a ? turned.a : turned.b).rotation;
    const std::optional<Vec3> lowest = lowest_on_rim(
        collider.shape, glm::conjugate(rotation) * (of_a ? turned.normal : -turned.normal));
    if (!lowest)
        return; // it lies on its side
    const Vec3 core = rotation * *lowest;
    (of_a ? turned.cores_a : turned.cores_b)[k] = core;
    set_core(context, block, lane, k, of_a, turned, core);
}

// Normal, tangents and arms of one contact as they are t seconds from now, and its separation along
// that normal at the start of the step; the bodies' motion since then is added to it.
void turn_lane(StepContext &context, ContactBlock &block, std::size_t lane, Real t) {
    const Contact &contact = context.contacts[block.contacts[lane]];
    TurnedContact turned = turned_contact(context, contact, t);
    const Vec3 &n = turned.normal;
    const Vec3 &between = turned.between;
    set(block.normal, lane, n);
    set(block.t1, lane, turned.turn * tangent_basis(contact.manifold.normal).t1);
    if (contact.rim_point >= 0)
        move_round_rim(context, block, lane, turned);
    const bool a_moves = is_dynamic(context, contact.key.a);
    const bool b_moves = is_dynamic(context, contact.key.b);
    const Real side = static_cast<Real>((b_moves ? 1 : 0) - (a_moves ? 1 : 0));
    for (std::size_t k = 0; k < static_cast<std::size_t>(contact.manifold.count); ++k) {
        const Vec3 on_a = turned.cores_a[k] + block.rounding_a.lanes[lane] * n;
        const Vec3 on_b = turned.cores_b[k] - block.rounding_b.lanes[lane] * n;
        const Vec3 half = Real(0.5) * glm::dot(between + (on_b - on_a), n) * n;
        Vec3 arm_a = on_a + (Real(1) + side) * half;
        Vec3 arm_b = on_b - (Real(1) - side) * half;
        if (contact.is_braced) {
            const Vec3 shift =
                half_way(between + (arm_b - arm_a), arm_a, arm_b, contacts_meet_within);
            arm_a += shift;
            arm_b -= shift;
        } else if (contact.rolling == Rolling::on_face || contact.is_turning) {
            // What rolls, tips or rides takes the point along, also on the other's face, whose
            // plane is the same at any of its points: with one that is left behind, a plank would
            // float off the barrel it rocks on, and a ball on a turntable would be slowed.
            const bool is_face_of_a = !contact.turns_with_b;
            Vec3 &arm = is_face_of_a ? arm_a : arm_b;
            arm = is_face_of_a ? arm_b + between : arm_a - between;
            const Vec3 &on = is_face_of_a ? on_a : on_b;
            if ((is_face_of_a ? contact.rounding_a : contact.rounding_b) == Real(0) &&
                (is_face_of_a ? a_moves : b_moves))
                set_core(context, block, lane, k, is_face_of_a, turned,
                         arm + glm::dot(on - arm, n) * n);
        }
        set(block.points[k].r_a, lane, arm_a);
        set(block.points[k].r_b, lane, arm_b);
        set_start_separation(context, block, lane, k);
    }
}

// Whether a turn moves a body's corners, and its lever arms, elsewhere, as that of a fast body does
// in a substep. Thin bodies get there sooner: along an arm that has turned by t against a stick, K
// grows by about 3 t^2 / m times its largest over its least inertia, and passes with the effective
// mass of before the turn would push ever harder.
bool is_far_turn(const StepContext &context, std::uint32_t body, const Vec3 &turn,
                 bool was_resolved) {
    constexpr Real far = Real(0.2);
    constexpr Real share = Real(0.1);
    const Real squared = glm::dot(turn, turn);
    if (!(squared > Real(0)) || !is_dynamic(context, body))
        return false;
    const Vec3 &inertia = context.model.bodies[body].inertia;
    const Real least = std::min({inertia.x, inertia.y, inertia.z});
    const Real most = std::max({inertia.x, inertia.y, inertia.z});
    // Bouncing contacts were resolved at impact, but thin bodies cannot be left like that.
    if (was_resolved && least > Real(0.25) * most)
        return false;
    return squared > std::min(far * far, share * least / most);
}
bool has_other_arms(const StepContext &context, std::uint32_t body, bool was_resolved) {
    return is_far_turn(context, body, context.bodies[body].turned, was_resolved);
}

// Whether two bodies have turned so far against each other since the step began that their
// contact's effective masses no longer hold.
bool have_turned_apart(const StepContext &context, const Contact &contact) {
    const Vec3 turn = context.bodies[contact.key.b].turned - context.bodies[contact.key.a].turned;
    return is_far_turn(context, contact.key.a, turn, false) ||
           is_far_turn(context, contact.key.b, turn, false);
}

// Whether a rolling body's core is not at its middle and goes around it: a coin that leans, a ball
// with a heavy side. The arms go around with it. Held for the step, they would drive the core along
// the tangent, outward, and the body would gain energy.
bool goes_round(const StepContext &context, const Contact &contact, bool of_a) {
    const std::uint32_t body = of_a ? contact.key.a : contact.key.b;
    const Real rounding = of_a ? contact.rounding_a : contact.rounding_b;
    const SolverBody &moves = context.bodies[body];
    if (contact.rolling != Rolling::round || !(rounding > Real(0)) || !is_dynamic(context, body))
        return false;
    return contact.way_round(of_a, glm::conjugate(moves.rotation) * moves.turned) > rolling_far;
}
bool has_other_arms(const StepContext &context, const Contact &contact, bool of_a) {
    const Collider &collider =
        context.model.colliders[of_a ? contact.collider_a : contact.collider_b];
    // The ends of a capsule are struck in turns within a step.
    const bool was_resolved = contact.restitution > Real(0) && !(collider.rounding > Real(0));
    return (collider.extent > Real(0) &&
            has_other_arms(context, of_a ? contact.key.a : contact.key.b, was_resolved)) ||
           goes_round(context, contact, of_a);
}
bool has_other_arms(const StepContext &context, const Contact &contact) {
    return !contact.turns() &&
           (has_other_arms(context, contact, true) || has_other_arms(context, contact, false));
}

// Notes which bodies have turned far, so that the contacts of all others need not be looked into;
// returns whether any has.
bool note_far_turns(StepContext &context) {
    std::vector<std::uint8_t> &turned = context.scratch.schedule.turned_far;
    turned.resize(context.bodies.size());
    bool any = false;
    for (const std::uint32_t body : context.moving()) {
        const bool is_far = has_other_arms(context, body, false);
        turned[body] = is_far ? 1 : 0;
        any = any || is_far;
    }
    return any;
}
bool is_between_far_turns(const StepContext &context, const ContactBlock &block, std::size_t lane) {
    const ContactEnds &ends = context.ends[block.contacts[lane]];
    const std::vector<std::uint8_t> &turned = context.scratch.schedule.turned_far;
    return (turned[ends.a] | turned[ends.b]) != 0;
}

// A point's arms on both bodies at the present poses: on the surface of the one that has turned.
struct Arms {
    Vec3 a;
    Vec3 b;
};
Arms present_arms(const StepContext &context, const Contact &contact, std::size_t k) {
    const SolverBody &a = context.bodies[contact.key.a];
    const SolverBody &b = context.bodies[contact.key.b];
    const Vec3 &n = contact.manifold.normal;
    const Vec3 between = b.position - a.position;
    const ContactAnchor &anchor = contact.anchors[k];
    if (has_other_arms(context, contact, true)) {
        const Vec3 arm = a.rotation * anchor.core_a + contact.rounding_a * n;
        return {arm, arm - between};
    }
    const Vec3 arm = b.rotation * anchor.core_b - contact.rounding_b * n;
    return {arm + between, arm};
}

// Finds a contact's one point at the present poses. A body that slides round an edge, or rolls on
// one, is supported along another normal and elsewhere on both bodies; with those from the start of
// the step it would sink in and take angular momentum from nowhere.
void find_again(StepContext &context, ContactBlock &block, std::size_t lane) {
    const Contact &contact = context.contacts[block.contacts[lane]];
    const SolverBody &a = context.bodies[contact.key.a];
    const SolverBody &b = context.bodies[contact.key.b];
    const Collider &on_a = context.model.colliders[contact.collider_a];
    const Collider &on_b = context.model.colliders[contact.collider_b];
    const Vec3 before = get(block.normal, lane);
    const Manifold found =
        collide(placed(on_a.shape, mass_pose(a)), placed(on_b.shape, mass_pose(b)),
                std::min(on_a.half_width, on_b.half_width), before);
    const Vec3 &n = found.normal;
    if (found.count != 1 || !(glm::dot(n, before) > Real(0.5)))
        return;
    const Vec3 t1 = get(block.t1, lane);
    set(block.normal, lane, n);
    set(block.t1, lane, glm::normalize(t1 - glm::dot(t1, n) * n));
    const Vec3 arm_a = found.points[0].position - a.position;
    const Vec3 arm_b = found.points[0].position - b.position;
    set(block.points[0].r_a, lane, arm_a);
    set(block.points[0].r_b, lane, arm_b);
    const Real half = Real(0.5) * found.points[0].separation;
    const auto at_start = [&](std::uint32_t body, const Vec3 &core) {
        return arm_at_start(context, body, context.bodies[body].rotation, core);
    };
    StartArms::Point &cores = context.scratch.schedule.start_arms[block.ahead].points[0];
    set(cores.core_a, lane, at_start(contact.key.a, arm_a - (half + contact.rounding_a) * n));
    set(cores.core_b, lane, at_start(contact.key.b, arm_b + (half + contact.rounding_b) * n));
    set_start_separation(context, block, lane, 0);
}

// Takes back the impulse that pushed the bodies apart, with the arms and normal it was applied
// with, and sets the rest aside (recall_borne): with other arms and normals it would do work.
void take_back_push(StepContext &context, ContactBlock &block, std::size_t lane) {
    const Contact &contact = context.contacts[block.contacts[lane]];
    ContactBlock::Point &point = block.points[0];
    SolverBody &a = context.bodies[contact.key.a];
    SolverBody &b = context.bodies[contact.key.b];
    const Vec3 n = get(block.normal, lane);
    const Vec3 r_a = get(point.r_a, lane);
    const Vec3 r_b = get(point.r_b, lane);
    const Real parting = glm::dot(b.velocity_at(r_b) - a.velocity_at(r_a), n);
    const Real push =
        std::clamp(point.normal_mass.lanes[lane] * parting, Real(0), point.impulse.x.lanes[lane]);
    a.apply_impulse(push * n, r_a);
    b.apply_impulse(-push * n, r_b);
    context.scratch.schedule.borne.push_back(
        {&block, lane, get(point.impulse, lane) - Vec3{push, Real(0), Real(0)}});
    set(point.impulse, lane, Vec3{Real(0)});
}

// Lanes whose point is found again. Where the bodies have not met yet, the point stays where they
// will.
unsigned take_back_pushes(StepContext &context, ContactBlock &block) {
    unsigned lanes = 0;
    for (std::size_t lane = 0; block.found_again != 0 && lane < block.used; ++lane) {
        if ((block.found_again >> lane & 1U) == 0)
            continue;
        const bool bears = block.points[0].impulse.x.lanes[lane] > Real(0);
        if (bears || context.contacts[block.contacts[lane]].found_at == FoundAt::start)
            lanes |= 1U << lane;
        if (bears)
            take_back_push(context, block, lane);
    }
    return lanes;
}

void set_inertias(const StepContext &context, ContactBlock &block, std::size_t lane) {
    const Contact &contact = context.contacts[block.contacts[lane]];
    set(block.inv_inertia_a, lane, context.bodies[contact.key.a].inv_inertia);
    set(block.inv_inertia_b, lane, context.bodies[contact.key.b].inv_inertia);
}

// Turns the lanes of each block whose bits lanes_of(block) has.
template <class LanesOf> void turn_lanes(StepContext &context, Real t, LanesOf &&lanes_of) {
    if (!context.scratch.schedule.any_turning)
        return;
    for_blocks(context.tasks, std::span(context.scratch.schedule.blocks),
               [&](std::span<ContactBlock> blocks) {
                   for (ContactBlock &block : blocks) {
                       bool any_apart = false;
                       for (unsigned left = lanes_of(block); left != 0; left &= left - 1) {
                           const auto lane = static_cast<std::size_t>(std::countr_zero(left));
                           turn_lane(context, block, lane, t);
                           if (have_turned_apart(context, context.contacts[block.contacts[lane]])) {
                               set_inertias(context, block, lane);
                               any_apart = true;
                           }
                       }
                       if (any_apart)
                           kernels::finish(std::span(&block, 1));
                   }
               });
}

// Sets a lane's arms and inertias to those of the present poses.
void rearm_lane(StepContext &context, ContactBlock &block, std::size_t lane) {
    const Contact &contact = context.contacts[block.contacts[lane]];
    set_inertias(context, block, lane);
    if ((block.found_again >> lane & 1U) != 0) {
        find_again(context, block, lane);
        return;
    }
    for (std::size_t k = 0; k < static_cast<std::size_t>(contact.manifold.count); ++k) {
        const Arms arms = present_arms(context, contact, k);
        set(block.points[k].r_a, lane, arms.a);
        set(block.points[k].r_b, lane, arms.b);
    }
}

} // namespace

// Friction turns a rider on a turntable all the time. With the arms from the start of the step it
// would be turned all at once, in the first substep, and friction cannot hold that. The load of a
// braced contact is no rider: ahead of its bodies it would be a couple.
void turn_contact_columns(StepContext &context, Real t) {
    turn_lanes(context, t, [&](const ContactBlock &block) -> unsigned {
        return block.turning & ~(t == Real(0) ? 0U : unsigned{block.braced});
    });
}

void rearm_contact_columns(StepContext &context) {
    if (context.scratch.schedule.blocks.empty())
        return;
    ContactSchedule &schedule = context.scratch.schedule;
    const bool any_far = note_far_turns(context);
    const bool any_round = std::ranges::any_of(
        schedule.blocks, [](const ContactBlock &block) { return block.round != 0; });
    const bool any_again = std::ranges::any_of(
        schedule.blocks, [](const ContactBlock &block) { return block.found_again != 0; });
    if (!any_far && !any_round && !any_again)
        return;
    for (ContactBlock &block : schedule.blocks)
        block.rearmed = static_cast<std::uint16_t>(take_back_pushes(context, block));
    for_blocks(context.tasks, std::span(context.scratch.schedule.blocks),
               [&](std::span<ContactBlock> blocks) {
                   for (ContactBlock &block : blocks) {
                       unsigned may = block.round;
                       for (std::size_t lane = 0; any_far && lane < block.used; ++lane)
                           may |= is_between_far_turns(context, block, lane) ? 1U << lane : 0U;
                       unsigned lanes = block.rearmed;
                       for (may &= ~unsigned{block.found_again}; may != 0; may &= may - 1) {
                           const auto lane = static_cast<std::size_t>(std::countr_zero(may));
                           if (has_other_arms(context, context.contacts[block.contacts[lane]]))
                               lanes |= 1U << lane;
                       }
                       block.rearmed = static_cast<std::uint16_t>(lanes);
                   }
               });
    const auto known = static_cast<std::uint32_t>(schedule.start_arms.size());
    std::uint32_t ahead = known;
    for (ContactBlock &block : schedule.blocks)
        if (block.rearmed != 0 && block.ahead == ContactBlock::none)
            block.ahead = ahead++;
    schedule.start_arms.resize(ahead);
    for_blocks(context.tasks, std::span(context.scratch.schedule.blocks),
               [&](std::span<ContactBlock> blocks) {
                   for (ContactBlock &block : blocks) {
                       if (block.rearmed == 0)
                           continue;
                       if (block.ahead >= known)
                           fill_start_arms(context, block, schedule.start_arms[block.ahead]);
                       for (std::size_t lane = 0; lane < block.used; ++lane)
                           if ((block.rearmed >> lane & 1U) != 0)
                               rearm_lane(context, block, lane);
                       kernels::finish(std::span(&block, 1));
                   }
               });
    // Their impacts, too: the passes would stop for good whatever the impacts do not see coming.
    for (ContactConstraint &struck : context.scratch.contacts) {
        const Contact &contact = context.contacts[struck.contact];
        if (!has_other_arms(context, contact))
            continue;
        for (std::size_t k = 0; k < static_cast<std::size_t>(struck.count); ++k) {
            const Arms arms = present_arms(context, contact, k);
            struck.points[k].r_a = arms.a;
            struck.points[k].r_b = arms.b;
        }
    }
}

// Impulses applied with other arms and normals are remembered with the rest.
void recall_borne(StepContext &context) {
    for (const ContactSchedule::Borne &one : context.scratch.schedule.borne) {
        ContactBlock::Point &point = one.block->points[0];
        set(point.impulse, one.lane, get(point.impulse, one.lane) + one.impulse);
        set(point.remembered, one.lane, get(point.remembered, one.lane) + one.impulse);
    }
    context.scratch.schedule.borne.clear();
}

void meet_contact_columns(StepContext &context) {
    ContactSchedule &schedule = context.scratch.schedule;
    for (ContactConstraint &met : context.scratch.contacts) {
        if (!met.has_met)
            continue;
        met.has_met = false;
        const std::uint32_t place = schedule.place_of[met.contact];
        ContactBlock &block = schedule.blocks[place / column_lanes];
        const std::size_t lane = place % column_lanes;
        if ((block.braced >> lane & 1U) != 0)
            continue; // stays where it is on both bodies
        if (block.ahead == ContactBlock::none) {
            block.ahead = static_cast<std::uint32_t>(schedule.start_arms.size());
            fill_start_arms(context, block, schedule.start_arms.emplace_back());
        }
        const Vec3 before = get(block.normal, lane);
        set(block.normal, lane, met.normal);
        set(block.t1, lane, met.tangents.t1);
        for (std::size_t k = 0; k < static_cast<std::size_t>(met.count); ++k) {
            set(block.points[k].r_a, lane, met.points[k].r_a);
            set(block.points[k].r_b, lane, met.points[k].r_b);
            if (before != met.normal)
                set_start_separation(context, block, lane, k);
        }
        kernels::finish(std::span(&block, 1));
    }
}

} // namespace plumb::inline PLUMB_PRECISION
