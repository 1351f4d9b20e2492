#include "engine/dynamics/contacts/contact_columns.h"

#include "engine/dynamics/colours.h"
#include "engine/dynamics/contacts/friction_patch.h"
#include "engine/dynamics/method.h"

#include <algorithm>
#include <bit>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

constexpr std::uint32_t colours = 64;
constexpr std::uint32_t most_points = 4;
// Contacts that find no free colour are solved one by one.
constexpr std::uint32_t alone = colours * most_points;

// Gives each contact the first colour that neither body has a contact of. The order is that of the
// contacts' keys, so the colours depend only on the state.
void colour(StepContext &context) {
    ContactSchedule &schedule = context.scratch.schedule;
    schedule.lanes.clear();
    schedule.bucket_sizes.assign(alone + 1, 0);
    schedule.colours_of_body.assign(context.bodies.size(), 0);
    // Contacts with immovable bodies take later colours than all others, so that nothing is left
    // moving into a wall by the contacts that push it there.
    std::uint64_t of_others = 0;
    std::uint64_t used = 0;
    const std::vector<std::uint32_t> &active = context.active.contacts;
    const std::size_t count = active.size();
    for (std::size_t turn = 0; turn < 2 * count; ++turn) {
        const std::uint32_t i = active[turn < count ? turn : turn - count];
        const ContactEnds &contact = context.ends[i];
        const bool moves_a = is_dynamic(context, contact.a);
        const bool moves_b = is_dynamic(context, contact.b);
        const bool is_last = !moves_a || !moves_b;
        if (turn == count)
            of_others = used;
        if (is_last != (turn >= count))
            continue;
        schedule.any_turning = schedule.any_turning || contact.turns;
        std::uint64_t &of_a = schedule.colours_of_body[contact.a];
        std::uint64_t &of_b = schedule.colours_of_body[contact.b];
        const std::uint64_t taken = of_others | (moves_a ? of_a : 0) | (moves_b ? of_b : 0);
        const auto chosen = static_cast<std::uint32_t>(std::countr_one(taken));
        std::uint32_t bucket = alone;
        if (chosen < colours) {
            used |= std::uint64_t{1} << chosen;
            of_a |= std::uint64_t{1} << chosen;
            of_b |= std::uint64_t{1} << chosen;
            bucket = chosen * most_points + contact.points - 1U;
        }
        schedule.lanes.push_back({i, bucket});
        ++schedule.bucket_sizes[bucket];
    }
}

// Whether it is the single point of a pair that touches nothing else and does not bounce: such a
// contact is found again in each substep (find_again). Bouncing contacts were resolved at impact.
// Between balls the impulses before and after the touch cancel, so only friction turns them.
bool is_found_again(const StepContext &context, const Contact &contact) {
    return contact.manifold.count == 1 && contact.restitution == Real(0) &&
           touch_nothing_else(context, contact) && !are_balls(context, contact);
}

Real hard_depth(const StepContext &context, const Contact &contact) {
    const Collider &on_a = context.model.colliders[contact.collider_a];
    const Collider &on_b = context.model.colliders[contact.collider_b];
    const Real width = Real(2) * std::min(on_a.half_width, on_b.half_width);
    return static_cast<Real>(hard_depths * context.settings.substep_tolerance) * width;
}

void fill_lane(const StepContext &context, ContactBlock &block, std::size_t lane,
               std::uint32_t index) {
    const Contact &contact = context.contacts[index];
    const SolverBody &a = context.bodies[contact.key.a];
    const SolverBody &b = context.bodies[contact.key.b];
    block.contacts[lane] = index;
    block.body_a.lanes[lane] = static_cast<IndexColumn::Index>(contact.key.a * BodyReals::stride);
    block.body_b.lanes[lane] = static_cast<IndexColumn::Index>(contact.key.b * BodyReals::stride);
    const auto bit = static_cast<std::uint16_t>(1U << lane);
    for (const std::uint32_t body : {contact.key.a, contact.key.b})
        block.inertia_turns =
            block.inertia_turns || !is_isotropic(context.model.bodies[body].inertia);
    if (is_dynamic(context, contact.key.a))
        block.writes_a = static_cast<std::uint16_t>(block.writes_a | bit);
    if (is_dynamic(context, contact.key.b))
        block.writes_b = static_cast<std::uint16_t>(block.writes_b | bit);
    if (is_found_again(context, contact))
        block.found_again = static_cast<std::uint16_t>(block.found_again | bit);
    else if (contact.turns())
        block.turning = static_cast<std::uint16_t>(block.turning | bit);
    else if (contact.rolling == Rolling::round)
        block.round = static_cast<std::uint16_t>(block.round | bit);
    if (contact.is_braced)
        block.braced = static_cast<std::uint16_t>(block.braced | bit);
    set(block.normal, lane, contact.manifold.normal);
    set(block.t1, lane, tangent_basis(contact.manifold.normal).t1);
    block.friction.lanes[lane] = contact.friction;
    block.bounces.lanes[lane] = contact.restitution > Real(0) ? Real(1) : Real(0);
    block.pressed.lanes[lane] = contact.is_pressed ? Real(1) : Real(0);
    const Real spread = patch_spread(context, contact);
    block.spread.lanes[lane] = spread;
    block.spins = block.spins || spread < Real(1);
    if (context.active.pace.hardens)
        block.hard_depth.lanes[lane] = hard_depth(context, contact);
    block.rounding_a.lanes[lane] = contact.rounding_a;
    block.rounding_b.lanes[lane] = contact.rounding_b;
    set(block.inv_mass_a, lane, a.inv_mass);
    set(block.inv_mass_b, lane, b.inv_mass);
    set(block.inv_inertia_a, lane, a.inv_inertia);
    set(block.inv_inertia_b, lane, b.inv_inertia);
    block.is_new = block.is_new || contact.is_new;
    block.points_used = std::max(block.points_used, contact.manifold.count);
    for (std::size_t k = 0; k < static_cast<std::size_t>(contact.manifold.count); ++k) {
        ContactBlock::Point &point = block.points[k];
        set(point.r_a, lane, contact.anchors[k].arm_a);
        set(point.r_b, lane, contact.anchors[k].arm_b);
        point.separation.lanes[lane] = contact.manifold.points[k].separation;
        set(point.impulse, lane, contact.impulses[k]);
        set(point.remembered, lane, contact.impulses[k]);
    }
}

bool is_ahead(const StepContext &context, const ContactBlock &block) {
    return std::any_of(block.contacts, block.contacts + block.used, [&](std::uint32_t contact) {
        return context.contacts[contact].found_at != FoundAt::start ||
               context.contacts[contact].turns();
    });
}

template <class Use> void for_blocks(StepContext &context, Use &&use) {
    for_blocks(context.tasks, std::span(context.scratch.schedule.blocks), use);
}
template <class Use> void for_colours(StepContext &context, Use &&use) {
    ContactSchedule &schedule = context.scratch.schedule;
    for_colours(context.tasks, std::span(schedule.blocks), schedule.colour_ends, use);
}

bool is_blow(const ContactBlock &block, std::size_t lane) {
    return block.struck.lanes[lane] > block.pressed.lanes[lane];
}

// The share of a contact's impulses that is remembered.
Real remembered_share(const ContactBlock &block, std::size_t lane) {
    if (!is_blow(block, lane))
        return Real(1);
    Real sum = Real(0);
    for (int k = 0; k < block.points_used; ++k)
        sum += block.points[k].impulse.x.lanes[lane];
    const Real most = std::max(remembered_blow * sum, growing_blow * block.began.lanes[lane]);
    return sum > most ? most / sum : Real(1);
}

Real share_relaxed_again(const StepContext &context) {
    return context.active.pace.remembers_all() ? relaxed_again : relaxed_again_unbalanced;
}

// The same as in the kernels between substeps (warm_start_impl).
Vec3 next_impulse(const ContactBlock::Point &point, std::size_t lane, Real kept, Real again) {
    Vec3 impulse = get(point.impulse, lane);
    const Real relaxed = again * (impulse.x - point.remembered.x.lanes[lane]);
    impulse *= kept;
    const Real most = relaxed_share * impulse.x;
    impulse.x += std::max(std::min(relaxed, most), -most);
    return impulse;
}

bool any_has_turned_far(const StepContext &context) {
    return std::ranges::any_of(context.moving(), [&](std::uint32_t body) {
        return has_turned_far(context.bodies[body].turned);
    });
}

} // namespace

void fill_start_arms(const StepContext &context, const ContactBlock &block, StartArms &arms) {
    arms = {};
    for (std::size_t lane = 0; lane < block.used; ++lane) {
        const Contact &contact = context.contacts[block.contacts[lane]];
        const Quat &rotation_a = context.starts[contact.key.a].rotation;
        const Quat &rotation_b = context.starts[contact.key.b].rotation;
        for (std::size_t k = 0; k < static_cast<std::size_t>(contact.manifold.count); ++k) {
            set(arms.points[k].core_a, lane, rotation_a * contact.anchors[k].core_a);
            set(arms.points[k].core_b, lane, rotation_b * contact.anchors[k].core_b);
        }
    }
}

void prepare_contact_columns(StepContext &context) {
    ContactSchedule &schedule = context.scratch.schedule;
    schedule.blocks.clear();
    schedule.start_arms.clear();
    schedule.colour_ends.clear();
    schedule.lanes.clear();
    schedule.any_turning = false;
    if (context.active.contacts.empty())
        return;
    colour(context);
    // Each bucket's blocks are contiguous; those of the last bucket have one lane each.
    constexpr auto width = static_cast<std::uint32_t>(column_lanes);
    std::uint32_t block_count = 0;
    std::vector<std::uint32_t> &next = schedule.bucket_sizes; // becomes: the bucket's next lane
    for (std::uint32_t bucket = 0; bucket <= alone; ++bucket) {
        const std::uint32_t size = next[bucket];
        next[bucket] = block_count * width;
        block_count += bucket == alone ? size : (size + width - 1) / width;
        const bool ends_colour = bucket % most_points == most_points - 1;
        if (ends_colour && block_count * width > next[bucket + 1 - most_points])
            schedule.colour_ends.push_back(block_count);
    }
    constexpr std::uint32_t none = UINT32_MAX;
    schedule.contacts.assign(std::size_t{block_count} * width, none);
    schedule.place_of.resize(context.contacts.size());
    for (const ContactSchedule::Lane &lane : schedule.lanes) {
        schedule.contacts[next[lane.bucket]] = lane.contact;
        schedule.place_of[lane.contact] = next[lane.bucket];
        next[lane.bucket] += lane.bucket == alone ? width : 1;
    }
    schedule.blocks.resize(block_count);
    for_blocks(context, [&](std::span<ContactBlock> blocks) {
        const std::uint32_t *contact =
            schedule.contacts.data() + (blocks.data() - schedule.blocks.data()) * width;
        for (ContactBlock &block : blocks) {
            // Unused lanes, and points that a lane does not have, are zeros: no mass.
            block = ContactBlock{};
            for (std::uint32_t lane = 0; lane < width; ++lane, ++contact)
                if (*contact != none)
                    fill_lane(context, block, block.used++, *contact);
        }
        kernels::finish(blocks);
    });
    std::uint32_t ahead = 0;
    for (ContactBlock &block : schedule.blocks)
        if (is_ahead(context, block))
            block.ahead = ahead++;
    schedule.start_arms.resize(ahead);
    if (ahead > 0)
        for_blocks(context, [&](std::span<const ContactBlock> blocks) {
            for (const ContactBlock &block : blocks)
                if (block.ahead != ContactBlock::none)
                    fill_start_arms(context, block, schedule.start_arms[block.ahead]);
        });
    turn_contact_columns(context, Real(0));
}

void warm_start_contact_columns(StepContext &context, Real share, bool remember_first) {
    if (context.scratch.schedule.blocks.empty())
        return;
    const BodyReals bodies = reals_of(context.bodies);
    const Real again = share_relaxed_again(context);
    for_colours(context, [&](std::span<ContactBlock> blocks) {
        kernels::warm_start(blocks, bodies, share, remember_first, again);
    });
    context.report.constraint_passes += context.scratch.schedule.lanes.size();
}

void solve_contact_columns(StepContext &context, const ContactBias &bias, Real h) {
    if (context.scratch.schedule.blocks.empty())
        return;
    const BodyReals bodies = reals_of(context.bodies);
    const bool any_far = any_has_turned_far(context);
    const std::span<const StartArms> start_arms = context.scratch.schedule.start_arms;
    for_colours(context, [&](std::span<ContactBlock> blocks) {
        kernels::solve(blocks, start_arms, bodies, bias, Real(1) / h, any_far);
    });
    context.report.constraint_passes += context.scratch.schedule.lanes.size();
}

Real striking_mass_ratio(const StepContext &context, Real changed) {
    const auto inverse_mass = [](const Columns3 &columns, std::size_t lane) {
        const Vec3 masses = get(columns, lane); // 0 along locked axes
        return std::max({masses.x, masses.y, masses.z});
    };
    const auto ratio_of = [&](const ContactBlock &block, std::size_t lane) {
        const Real a = inverse_mass(block.inv_mass_a, lane);
        const Real b = inverse_mass(block.inv_mass_b, lane);
        return std::min(a, b) > Real(0) ? std::max(a, b) / std::min(a, b) : Real(1);
    };
    Real greatest = Real(0);
    for (const ContactBlock &block : context.scratch.schedule.blocks)
        for (std::size_t lane = 0; lane < block.used; ++lane) {
            const bool is_struck = is_blow(block, lane);
            if (!is_struck && !(block.corrected.lanes[lane] > changed))
                continue;
            const Real ratio = ratio_of(block, lane);
            if (is_struck || ratio > unlike_masses)
                greatest = std::max(greatest, ratio);
        }
    return greatest;
}

bool any_is_corrected(const StepContext &context, Real speed) {
    return std::ranges::any_of(context.scratch.schedule.blocks, [&](const ContactBlock &block) {
        return std::ranges::any_of(std::span(block.corrected.lanes).first(block.used),
                                   [&](Real corrected) { return corrected > speed; });
    });
}

void store_contact_columns(StepContext &context) {
    const Real again = share_relaxed_again(context);
    for_blocks(context, [&](std::span<ContactBlock> blocks) {
        for (const ContactBlock &block : blocks)
            for (std::size_t lane = 0; lane < block.used; ++lane) {
                Contact &contact = context.contacts[block.contacts[lane]];
                contact.is_struck = block.struck.lanes[lane] > Real(0);
                const Real kept = remembered_share(block, lane);
                for (std::size_t k = 0; k < static_cast<std::size_t>(contact.manifold.count); ++k)
                    contact.impulses[k] = next_impulse(block.points[k], lane, kept, again);
            }
    });
}

} // namespace plumb::inline PLUMB_PRECISION
