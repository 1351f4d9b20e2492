#include "engine/dynamics/islands/islands.h"

#include "engine/core/renew.h"
#include "engine/dynamics/world.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// An island goes down by at most one number in this many steps.
constexpr std::uint64_t steps_to_go_down = 4;

// An island goes down only if this multiple of the substeps it wants is still less than it takes.
constexpr double spare = 1.25;
// An island that wants more than this many times the substeps it gets visits its contact points in
// one order. Alternating feeds waves in pyramids of base 75 and up, which the passes balance only
// in part; a single order feeds them in those of base 45 to 70, which then never come to rest.
constexpr double most_wanted_in_turns = 6.25;
// Beyond this many times, where the order alternates, its passes balance its loads only in part
// (relaxed_again_unbalanced). In a single order they need all of it: with half, the top of a
// pyramid of base 100 strays by 0.8 m in half a minute instead of 0.4 m.
constexpr int most_wanted_in_balance = 2;
// Contacts of a small island.
constexpr int most_small = 32;
// A single blow may take a few steps.
constexpr double blow_lasts = 0.04; // s
// Struck in each step for so long, a body is shaken by others that are so many times as heavy.
constexpr double shaken_after = 0.1; // s
constexpr Real shaken_by = Real(2);
// Bodies are slow below this share of what gravity adds in a step.
constexpr double slow_share = 0.35;
// What stands on contacts and has joints takes up to so many more passes.
constexpr int most_standing_passes = 3;

} // namespace

int round_substeps_up(int n) {
    const auto digits = static_cast<int>(std::bit_width(static_cast<unsigned>(std::max(n, 0))));
    const int step = 1 << std::max(digits - 3, 0);
    return (n + step - 1) / step * step;
}

int round_substeps_down(int n) {
    const int up = round_substeps_up(n);
    return up > n ? fewer_substeps(up) : n;
}

int fewer_substeps(int n) {
    const auto digits = static_cast<int>(std::bit_width(static_cast<unsigned>(n - 1)));
    return n - (1 << std::max(digits - 3, 0));
}

bool World::chooses_substeps() const {
    return settings_.max_substeps > settings_.substeps && method_->info.chooses_substeps();
}

int World::substeps_of(std::uint32_t body) const {
    const int own = state_.paces[body].substeps;
    return own > 0 ? own : settings_.substeps;
}

bool World::moves(std::uint32_t body) const {
    return body != Joint::world && scratch_.still[body] == 0;
}

// Whether a joint exists, is whole, and has a body that moves.
bool World::holds(std::uint32_t joint) const {
    const Joint &one = model_->joints[joint];
    return one.alive && !scratch_.joints[joint].broken && (moves(one.a) || moves(one.b));
}

void World::find_islands() {
    Scratch &s = scratch_;
    Islands &islands = s.islands;
    islands.start(model_->bodies.size());
    for (const ContactEnds &contact : s.ends)
        if (!contact.is_sensor && moves(contact.a) && moves(contact.b))
            islands.join(contact.a, contact.b);
    for (std::uint32_t i = 0; i < model_->joints.size(); ++i) {
        const Joint &joint = model_->joints[i];
        if (holds(i) && moves(joint.a) && moves(joint.b))
            islands.join(joint.a, joint.b);
    }
    if (model_->has_particles())
        join_particles();
}

// Finds the braced islands and their contacts.
void World::find_braced() {
    Scratch &s = scratch_;
    std::vector<std::uint8_t> &braced = s.solver.braced;
    const auto is_dynamic = [&](std::uint32_t body) {
        return body != Joint::world && model_->bodies[body].kind == BodyKind::dynamic;
    };
    renew(s.islands.bracing, s.islands.parent.size());
    const auto bracing_of = [&](std::uint32_t body) -> Islands::Bracing & {
        return s.islands.bracing[s.islands.root_of(body)];
    };
    for (const ContactEnds &contact : s.ends)
        if (!contact.is_sensor && is_dynamic(contact.a) && is_dynamic(contact.b))
            ++bracing_of(contact.a).loops;
    for (std::uint32_t i = 0; i < model_->joints.size(); ++i) {
        const Joint &joint = model_->joints[i];
        if (!holds(i))
            continue;
        if (is_dynamic(joint.a) && is_dynamic(joint.b)) {
            ++bracing_of(joint.a).loops;
            bracing_of(joint.a).has_joints = true;
        } else if (is_dynamic(joint.a) || is_dynamic(joint.b)) {
            const std::uint32_t body = is_dynamic(joint.a) ? joint.a : joint.b;
            Islands::Bracing &bracing = bracing_of(body);
            bracing.is_bridge =
                bracing.is_bridge || (bracing.hung != UINT32_MAX && bracing.hung != body);
            bracing.hung = body;
        }
    }
    for (const std::uint32_t i : s.moving)
        if (is_dynamic(i))
            --bracing_of(i).loops;
    renew(braced, model_->bodies.size());
    for (const std::uint32_t i : s.moving)
        braced[i] = is_dynamic(i) && bracing_of(i).is_braced() ? 1 : 0;
    for (std::size_t i = 0; i < s.contacts.size(); ++i) {
        Contact &contact = s.contacts[i];
        contact.is_braced =
            braced[contact.key.a] != 0 && braced[contact.key.b] != 0 && !contact.sensor;
        if (contact.is_braced)
            contact.turns_with_b = contact.rounding_b == Real(0);
        s.ends[i].turns = contact.turns();
    }
}

std::uint32_t World::island_body(std::uint32_t a, std::uint32_t b) const {
    const auto is = [&](std::uint32_t body, BodyKind kind) {
        return body != Joint::world && model_->bodies[body].kind == kind;
    };
    if (b == Joint::world)
        return a;
    const bool is_b = is(b, BodyKind::dynamic) && !is(a, BodyKind::dynamic);
    return is_b || is(a, BodyKind::static_body) || a == Joint::world ? b : a;
}

void World::gather_needs() {
    Scratch &s = scratch_;
    Islands &islands = s.islands;
    islands.needs.assign(islands.parent.size(), {});
    const double gravity = glm::length(settings_.gravity);
    const auto is_shaken = [&](std::uint32_t light, std::uint32_t heavy) {
        return moves(light) && state_.paces[light].struck * settings_.dt >= shaken_after &&
               model_->bodies[heavy].mass >= shaken_by * model_->bodies[light].mass;
    };
    for (const std::uint32_t i : s.moving) {
        const double pull =
            model_->bodies[i].has_force
                ? static_cast<double>(greatest_pull(model_->bodies[i], static_cast<Real>(gravity)))
                : gravity;
        const auto slow = static_cast<Real>(slow_share * pull * settings_.dt);
        Islands::Needs &needs = islands.needs[islands.root_of(i)];
        needs.weight += static_cast<double>(model_->bodies[i].mass) * pull;
        needs.is_driven = needs.is_driven || model_->bodies[i].kind != BodyKind::dynamic ||
                          model_->bodies[i].has_torque || !model_->attractors.empty();
        needs.wanted = std::max(needs.wanted, int{s.paces[i].wanted});
        needs.before = std::max(needs.before, int{s.paces[i].substeps});
        needs.is_struck_long =
            needs.is_struck_long || state_.paces[i].struck * settings_.dt >= blow_lasts;
        const Real fast = static_cast<Real>(settings_.substep_tolerance / settings_.dt) *
                          least_half_width(model_->bodies[i]);
        const Vec3 &velocity = state_.motions[i].velocity;
        needs.rests = needs.rests && glm::dot(velocity, velocity) <= fast * fast;
        const Vec3 &spin = state_.motions[i].angular_velocity;
        const auto turns = static_cast<Real>(extent_of(i));
        needs.is_slow = needs.is_slow && glm::dot(velocity, velocity) <= slow * slow &&
                        turns * turns * glm::dot(spin, spin) <= slow * slow;
    }
    for (const ContactEnds &contact : s.ends)
        if (!contact.is_sensor) {
            Islands::Needs &needs =
                islands.needs[islands.root_of(island_body(contact.a, contact.b))];
            ++needs.work;
            needs.touches = true;
            needs.is_shaken = needs.is_shaken || is_shaken(contact.a, contact.b) ||
                              is_shaken(contact.b, contact.a);
        }
    for (std::uint32_t i = 0; i < model_->joints.size(); ++i) {
        const Joint &joint = model_->joints[i];
        if (!holds(i))
            continue;
        Islands::Needs &needs = islands.needs[islands.root_of(island_body(joint.a, joint.b))];
        ++needs.work;
        needs.is_joined = true;
    }
    if (s.grab.is_holding())
        islands.needs[islands.root_of(s.grab.body)].is_driven = true;
    if (model_->has_particles())
        gather_particle_needs();
    gather_wedge_needs();
}

// Up immediately; down slowly and at rest: bodies that stretched softly while they moved and are
// stiffened again gain energy, and a tall stack would rock itself to pieces.
int World::chosen_substeps(const Islands::Needs &needs, int budget) const {
    const int least = settings_.substeps;
    const int affordable = needs.work > 0 ? budget / needs.work : least;
    const int most =
        std::max(least, round_substeps_down(std::min(settings_.max_substeps, affordable)));
    const auto rounded = [&](double wanted) {
        const int up =
            wanted < most ? round_substeps_up(static_cast<int>(std::ceil(wanted))) : most;
        return std::clamp(up, least, most);
    };
    const int wanted = rounded(needs.wanted);
    if (wanted >= needs.before)
        return wanted;
    const bool may_go_down = state_.clock.step_count % steps_to_go_down == 0 && needs.rests &&
                             rounded(spare * needs.wanted) < needs.before;
    return std::clamp(may_go_down ? fewer_substeps(needs.before) : needs.before, least, most);
}

// Gives every island the same share of the budget, as large as keeps all of them together within
// it.
void World::share_budget() {
    Scratch &s = scratch_;
    std::vector<std::uint32_t> &roots = s.islands.roots;
    roots.clear();
    for (std::uint32_t i = 0; i < s.islands.needs.size(); ++i) {
        s.islands.needs[i].pace.substeps = settings_.substeps;
        if (s.islands.needs[i].work > 0)
            roots.push_back(i);
    }
    std::int64_t work = 0;
    const int budget = s.was_let_go ? finer_budget() : settings_.substep_budget;
    int each = budget;
    do {
        work = 0;
        for (const std::uint32_t root : roots) {
            Islands::Needs &needs = s.islands.needs[root];
            needs.pace.substeps = chosen_substeps(needs, each);
            if (needs.pace.substeps > settings_.substeps)
                work += std::int64_t{needs.work} * needs.pace.substeps;
        }
        each = fewer_substeps(each);
    } while (work > budget);
    for (const std::uint32_t root : roots) {
        const Islands::Needs &needs = s.islands.needs[root];
        IslandPace &pace = s.islands.needs[root].pace;
        pace.alternates = needs.wanted <= most_wanted_in_turns * pace.substeps;
        pace.hardens = needs.wanted > most_wanted_in_balance * pace.substeps;
        pace.is_joined = needs.is_joined;
        pace.is_struck_long = needs.is_joined && needs.is_struck_long;
        pace.is_shaken = needs.is_shaken && pace.substeps >= far_more_substeps * settings_.substeps;
    }
    settle_slow_islands();
    settle_joined_islands();
}

// With one pass slow sways grow in tall and thin piles, which would never sleep, or even fall. Slow
// islands take more until they have been at rest for long enough to sleep, as long as the budget
// affords it: small ones another pass of each sort, as thin things need, larger ones two more
// relaxation passes. Those damp a long sway almost three times as much; one more of each sort, at
// the same cost, only a third more (the eigenvalues of a substep's map, for a stack of 20).
void World::settle_slow_islands() {
    Scratch &s = scratch_;
    const auto may_settle = [](const Islands::Needs &needs) {
        return needs.touches && !needs.is_joined && needs.is_slow;
    };
    const auto is_small = [](const Islands::Needs &needs) { return needs.work <= most_small; };
    std::int64_t work = 0, work_of_small = 0;
    for (const std::uint32_t root : s.islands.roots) {
        const Islands::Needs &needs = s.islands.needs[root];
        const std::int64_t own =
            may_settle(needs) ? std::int64_t{needs.work} * needs.pace.substeps : 0;
        work += own;
        work_of_small += is_small(needs) ? own : 0;
    }
    const std::uint16_t enough = steps_to_sleep();
    for (const std::uint32_t i : s.moving) {
        Islands::Needs &needs = s.islands.needs[s.islands.root_of(i)];
        if (!may_settle(needs) || s.paces[i].rested >= enough)
            continue;
        if (is_small(needs))
            needs.pace.more_passes = 2 * work_of_small <= settings_.substep_budget ? 1 : 0;
        else
            needs.pace.more_relaxing = work <= settings_.substep_budget ? 2 : 0;
    }
}

// A contact's pass knows only the body that it touches; the joints, solved together afterwards, add
// the mass of all that the body carries, and take away what the contact had reached. With one pass
// a heavy body welded onto a light foot topples, and a table or a cart trembles for ever. With
// three more such things stand still: up to a hundred times the foot's mass was tried.
void World::settle_joined_islands() {
    Scratch &s = scratch_;
    const auto stands = [](const Islands::Needs &needs) {
        return needs.touches && needs.is_joined;
    };
    std::int64_t work = 0;
    for (const std::uint32_t root : s.islands.roots) {
        const Islands::Needs &needs = s.islands.needs[root];
        work += stands(needs) ? std::int64_t{needs.work} * needs.pace.substeps : 0;
    }
    int passes = most_standing_passes;
    while (passes * work > settings_.substep_budget)
        --passes;
    for (const std::uint32_t root : s.islands.roots)
        if (stands(s.islands.needs[root]))
            s.islands.needs[root].pace.more_passes = passes;
}

// Remembered impulses are left as they are, though they belong to one substep: scaling them to the
// new number of substeps changed no stack, pyramid or pile that was tried, and chains gained
// energy.
void World::choose_substeps() {
    Scratch &s = scratch_;
    if (s.contacts.empty() && model_->alive_joints == 0 && !s.grab.is_holding() &&
        !model_->has_particles()) {
        group_freely();
        return;
    }
    const bool chooses = chooses_substeps();
    s.solver.has_spring_rates = chooses && model_->has_particles(); // by gather_needs
    const bool may_be_braced = method_->info.looks_ahead && model_->alive_joints > 0;
    if (chooses || may_be_braced)
        find_islands();
    s.solver.braced.clear();
    if (may_be_braced)
        find_braced();
    if (chooses) {
        gather_needs();
        guess_needs();
        share_budget();
    }
    group_islands();
    for (const std::uint32_t i : s.moving)
        s.paces[i].substeps =
            chooses
                ? static_cast<std::uint16_t>(s.islands.needs[s.islands.root_of(i)].pace.substeps)
                : std::uint16_t{0};
}

// All moving bodies in one group, when each is by itself.
void World::group_freely() {
    Scratch &s = scratch_;
    s.islands.needs.clear();
    const int substeps = chooses_substeps() ? settings_.substeps : 0;
    for (const std::uint32_t i : s.moving)
        s.paces[i].substeps = static_cast<std::uint16_t>(substeps);
    s.group_count = s.moving.empty() ? 0 : 1;
    if (s.groups.empty())
        s.groups.emplace_back();
    IslandGroup &group = s.groups.front();
    group.pace = {.substeps = settings_.substeps};
    group.clear();
    group.moving.assign(s.moving.begin(), s.moving.end());
}

// Groups islands of the same pace, in the order in which their bodies come.
void World::group_islands() {
    Scratch &s = scratch_;
    s.group_count = 0;
    const auto empty = [&](IslandGroup &group) {
        // Room for everything in each group, so that nothing is allocated when islands change
        // groups.
        group.clear();
        group.moving.reserve(s.moving.size());
        group.contacts.reserve(s.contacts.capacity());
        group.joints.reserve(model_->alive_joints);
    };
    const auto group_with = [&](const IslandPace &pace) -> IslandGroup & {
        for (std::size_t i = 0; i < s.group_count; ++i)
            if (s.groups[i].pace == pace)
                return s.groups[i];
        if (s.groups.size() == s.group_count)
            s.groups.emplace_back();
        IslandGroup &group = s.groups[s.group_count++];
        group.pace = pace;
        empty(group);
        return group;
    };
    const bool chooses = chooses_substeps();
    const auto group_of = [&](std::uint32_t body) -> IslandGroup & {
        if (!chooses)
            return group_with({.substeps = settings_.substeps});
        return group_with(s.islands.needs[s.islands.root_of(body)].pace);
    };
    for (const std::uint32_t i : s.moving)
        group_of(i).moving.push_back(i);
    for (std::uint32_t i = 0; i < s.ends.size(); ++i)
        if (!s.ends[i].is_sensor)
            group_of(island_body(s.ends[i].a, s.ends[i].b)).contacts.push_back(i);
    for (std::uint32_t i = 0; i < model_->joints.size(); ++i)
        if (holds(i))
            group_of(island_body(model_->joints[i].a, model_->joints[i].b)).joints.push_back(i);
    if (s.grab.is_holding())
        group_of(s.grab.body).holds_grab = true;
    if (model_->has_particles()) {
        const auto particles = static_cast<std::uint32_t>(model_->bodies.size());
        group_of(particles).has_particles = true;
    }
    // One to spare, for when one of several islands settles.
    if (s.groups.size() == s.group_count)
        empty(s.groups.emplace_back());
    if (s.joint_systems.size() < s.group_count)
        s.joint_systems.resize(s.group_count);
}

} // namespace plumb::inline PLUMB_PRECISION
