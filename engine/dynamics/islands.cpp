#include "engine/dynamics/islands.h"

#include "engine/dynamics/world.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// An island goes down by one number in so many steps, at the most.
constexpr std::uint64_t steps_to_go_down = 4;

// The part of wanted substeps by which an island must be better off before it goes down.
constexpr double spare = 1.25;

// Rates times substep that joints' forces may reach: of joints that are solved together, and of
// others (joint_loads.cpp, with some to spare).
constexpr double followed_together = 1.2;
constexpr double followed_alone = 1.1;

// Rates times substep of joints that are springs, and of what rods under tension hold back aside:
// others at their bodies add to them.
constexpr double followed_swing = 0.6;
constexpr double followed_damping = 16;

// How far a body that touches another may turn in a substep (rad): with lever arms that are those
// of another pose, impulses do work.
constexpr double followed_roll = 0.4;

// How far a body under load may turn on its joints in a substep (rad): what it loses of its energy
// falls with the square of that.
constexpr double followed_turn = 0.08;

std::uint16_t count_of(double substeps) {
    constexpr double most = std::numeric_limits<std::uint16_t>::max();
    // Not a number comes of what is about to diverge: that asks for nothing.
    return substeps > 0 ? static_cast<std::uint16_t>(std::ceil(std::min(substeps, most))) : 0;
}

double least_of(const Vec3 &v) {
    return static_cast<double>(std::min({v.x, v.y, v.z}));
}

double square(double x) {
    return x * x;
}

double largest(const Vec3 &v) {
    return static_cast<double>(std::max({v.x, v.y, v.z}));
}

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

// Whether a joint is there, whole, and between what moves.
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

std::uint32_t World::island_body(std::uint32_t a, std::uint32_t b) const {
    const auto is = [&](std::uint32_t body, BodyKind kind) {
        return body != Joint::world && model_->bodies[body].kind == kind;
    };
    const bool is_b = is(b, BodyKind::dynamic) && !is(a, BodyKind::dynamic);
    return is_b || is(a, BodyKind::fixed) || a == Joint::world ? b : a;
}

void World::gather_needs() {
    Scratch &s = scratch_;
    Islands &islands = s.islands;
    islands.needs.assign(islands.parent.size(), {});
    for (const std::uint32_t i : s.moving) {
        Islands::Needs &needs = islands.needs[islands.root_of(i)];
        needs.wanted = std::max(needs.wanted, int{s.paces[i].wanted});
        needs.before = std::max(needs.before, int{s.paces[i].substeps});
        const Real fast = static_cast<Real>(settings_.substep_tolerance / settings_.dt) *
                          least_half_width(model_->bodies[i]);
        const Vec3 &velocity = state_.motions[i].velocity;
        needs.rests = needs.rests && glm::dot(velocity, velocity) <= fast * fast;
    }
    for (const ContactEnds &contact : s.ends)
        if (!contact.is_sensor)
            ++islands.needs[islands.root_of(island_body(contact.a, contact.b))].work;
    for (std::uint32_t i = 0; i < model_->joints.size(); ++i) {
        const Joint &joint = model_->joints[i];
        if (!holds(i))
            continue;
        ++islands.needs[islands.root_of(island_body(joint.a, joint.b))].work;
    }
    if (model_->has_particles())
        gather_particle_needs();
}

// What joints will bear in their first step is not known: as much as if all of the island hung on
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
    s.stiffness.assign(s.bodies.size(), 0.0);
    for (std::uint32_t i = 0; i < model_->joints.size(); ++i) {
        const Joint &joint = model_->joints[i];
        if (!holds(i) || joint.frequency > Real(0))
            continue;
        if (joint.a != Joint::world)
            s.stiffness[joint.a] += static_cast<double>(glm::length(joint.anchor_a_local));
        if (joint.b != Joint::world)
            s.stiffness[joint.b] += static_cast<double>(glm::length(joint.anchor_b_local));
    }
    for (const std::uint32_t i : s.moving)
        islands.needs[islands.root_of(i)].mass += static_cast<double>(model_->bodies[i].mass);
    for (const std::uint32_t i : s.moving) {
        const Body &body = model_->bodies[i];
        if (body.kind != BodyKind::dynamic || !is_first(i))
            continue;
        Islands::Needs &needs = islands.needs[islands.root_of(i)];
        // What is let go suddenly pulls twice as hard at first.
        const double weight = 2 * needs.mass * glm::length(settings_.gravity);
        const double rate = std::sqrt(weight * s.stiffness[i] / least_of(body.inertia));
        needs.wanted =
            std::max(needs.wanted, int{count_of(rate * settings_.dt / followed_together)});
    }
}

// Up at once; down slowly and at rest: what stretched softly while it moved and is stiffened again
// gains energy by it, and a tall stack would rock itself to pieces.
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

// Each island may take as much of the budget as any other; as much as keeps all of them to it.
void World::share_budget() {
    Scratch &s = scratch_;
    std::vector<std::uint32_t> &roots = s.islands.roots;
    roots.clear();
    for (std::uint32_t i = 0; i < s.islands.needs.size(); ++i) {
        s.islands.needs[i].substeps = settings_.substeps;
        if (s.islands.needs[i].work > 0)
            roots.push_back(i);
    }
    std::int64_t work = 0;
    int each = settings_.substep_budget;
    do {
        work = 0;
        for (const std::uint32_t root : roots) {
            Islands::Needs &needs = s.islands.needs[root];
            needs.substeps = chosen_substeps(needs, each);
            if (needs.substeps > settings_.substeps)
                work += std::int64_t{needs.work} * needs.substeps;
        }
        each = fewer_substeps(each);
    } while (work > settings_.substep_budget);
}

// Remembered impulses stay as they are, though they are of one substep: scaled to the new number of
// substeps they changed no stack, pyramid or pile that was tried, and chains gained energy.
void World::choose_substeps() {
    Scratch &s = scratch_;
    const bool chooses = chooses_substeps();
    if (s.contacts.empty() && model_->alive_joints == 0 && !s.grab.is_holding() &&
        !model_->has_particles()) { // each by itself
        group_freely();
        const int substeps = chooses ? settings_.substeps : 0;
        for (const std::uint32_t i : s.moving)
            s.paces[i].substeps = static_cast<std::uint16_t>(substeps);
        return;
    }
    if (chooses) {
        find_islands();
        gather_needs();
        guess_needs();
        share_budget();
    }
    group_islands();
    for (const std::uint32_t i : s.moving)
        s.paces[i].substeps =
            chooses ? static_cast<std::uint16_t>(s.islands.needs[s.islands.root_of(i)].substeps)
                    : std::uint16_t{0};
}

// All that moves in one group.
void World::group_freely() {
    Scratch &s = scratch_;
    s.group_count = s.moving.empty() ? 0 : 1;
    if (s.groups.empty())
        s.groups.emplace_back();
    IslandGroup &group = s.groups.front();
    group.substeps = settings_.substeps;
    group.moving.assign(s.moving.begin(), s.moving.end());
    group.contacts.clear();
    group.joints.clear();
    group.holds_grab = false;
    group.has_particles = false;
}

// In the order of their substeps.
void World::group_islands() {
    Scratch &s = scratch_;
    s.group_count = 0;
    const auto group_with = [&](int substeps) -> IslandGroup & {
        for (std::size_t i = 0; i < s.group_count; ++i)
            if (s.groups[i].substeps == substeps)
                return s.groups[i];
        if (s.groups.size() == s.group_count)
            s.groups.emplace_back();
        IslandGroup &group = s.groups[s.group_count++];
        group.substeps = substeps;
        // As if all were in each, so that nothing is allocated when islands change groups.
        group.moving.clear();
        group.moving.reserve(s.moving.size());
        group.contacts.clear();
        group.contacts.reserve(s.contacts.capacity());
        group.joints.clear();
        group.joints.reserve(model_->alive_joints);
        group.holds_grab = false;
        group.has_particles = false;
        return group;
    };
    const bool chooses = chooses_substeps();
    const auto group_of = [&](std::uint32_t body) -> IslandGroup & {
        return group_with(chooses ? s.islands.needs[s.islands.root_of(body)].substeps
                                  : settings_.substeps);
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
    if (s.joint_systems.size() < s.group_count)
        s.joint_systems.resize(s.group_count);
}

// The depth of a soft contact of frequency w under the force F is F / (2 m w^2): the warm start
// acts in two halves, before and after the move. With w = 2 pi ratio n / dt that is the n below.
void World::note_contact_needs(const IslandGroup &group) {
    Scratch &s = scratch_;
    const double ratio = 2 * std::numbers::pi * settings_.contact_frequency_ratio;
    const auto wanted_of = [&](const Contact &contact) {
        const std::uint32_t a = contact.key.a;
        const std::uint32_t b = contact.key.b;
        // What is struck is not loaded yet; but the first step knows nothing else.
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
        return 0.5 * load * group.substeps * settings_.dt * inverse / (ratio * ratio * depth);
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
    constexpr std::size_t contacts_a_part = 256;
    s.contact_loads.resize(group.contacts.size());
    for_parts(s.tasks, group.contacts.size(), contacts_a_part,
              [&](std::size_t begin, std::size_t end) {
                  for (std::size_t i = begin; i < end; ++i)
                      s.contact_loads[i] = wanted_of(s.contacts[group.contacts[i]]);
              });
    for (std::size_t i = 0; i < group.contacts.size(); ++i) {
        const ContactEnds &ends = s.ends[group.contacts[i]];
        for (const std::uint32_t body : {ends.a, ends.b})
            s.loads[body] = std::max({s.loads[body], s.contact_loads[i], roll_of(body)});
    }
}

void World::note_joint_needs(const IslandGroup &group) {
    Scratch &s = scratch_;
    const SolverScratch &solver = s.solver;
    const double ratio = 2 * std::numbers::pi * settings_.joint_frequency_ratio;
    for (const std::uint32_t i : group.moving)
        s.stiffness[i] = 0;
    const auto for_ends = [](const JointConstraint &joint, auto &&use) {
        if (joint.a != Joint::world)
            use(joint.a, static_cast<double>(glm::length(joint.rows.r_a)));
        if (joint.b != Joint::world)
            use(joint.b, static_cast<double>(glm::length(joint.rows.r_b)));
    };
    const auto is_loaded = [](const JointConstraint &joint) {
        return joint.joint != JointConstraint::grab && joint.rows.kind != RowKind::angular &&
               joint.rows.bounds != RowBounds::motor && !joint.is_spring();
    };
    const auto ask = [&](const JointConstraint &joint, double squared) {
        for_ends(joint, [&](std::uint32_t body, double) {
            s.loads[body] = std::max(s.loads[body], squared);
        });
    };
    for (const JointConstraint &joint : solver.joints) {
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
        for_ends(joint, [&](std::uint32_t body, double arm) {
            s.stiffness[body] += impulse * arm * group.substeps / settings_.dt;
            inverse += largest(s.bodies[body].inv_mass);
            is_together = is_together || solver.joint_system.group_of(body) != JointSystem::none;
        });
        if (joint.rows.swing_length > Real(0)) {
            // A rod under tension holds what is at its ends back aside, and turns with them.
            const double length = static_cast<double>(joint.rows.swing_length);
            const double tension = impulse * group.substeps / settings_.dt;
            ask(joint, 4 * tension / length * inverse * square(settings_.dt / followed_swing));
        }
        if (is_together)
            continue;
        const double drift = settings_.substep_tolerance * static_cast<double>(size_of(joint.rows));
        const double squared =
            0.5 * impulse * group.substeps * settings_.dt * inverse / (ratio * ratio * drift);
        ask(joint, squared);
    }
    // And the rate sqrt(sum F r / I) that they make, and how fast their bodies turn.
    for (const JointConstraint &joint : solver.joints)
        for_ends(joint, [&](std::uint32_t body, double) {
            if (model_->bodies[body].kind != BodyKind::dynamic || s.stiffness[body] == 0)
                return;
            const double least = least_of(model_->bodies[body].inertia);
            const bool is_together = solver.joint_system.group_of(body) != JointSystem::none;
            const double rate = settings_.dt / (is_together ? followed_together : followed_alone);
            // Only about what stands still: a chain that whips would be stiffened in the midst of
            // it.
            const double turn = moves(joint.a) && moves(joint.b) ? 0 : settings_.dt / followed_turn;
            const Vec3 &spin = s.bodies[body].angular_velocity;
            s.loads[body] = std::max({s.loads[body], s.stiffness[body] / least * rate * rate,
                                      static_cast<double>(glm::dot(spin, spin)) * turn * turn});
        });
}

// After a group was advanced: what its loads ask of the next step.
void World::note_needs(const IslandGroup &group) {
    Scratch &s = scratch_;
    if (group.is_free()) {
        for (const std::uint32_t i : group.moving)
            s.paces[i].wanted = 0;
        return;
    }
    s.loads.resize(s.bodies.size());
    s.stiffness.resize(s.bodies.size());
    for (const std::uint32_t i : group.moving)
        s.loads[i] = 0;
    note_contact_needs(group);
    note_joint_needs(group);
    for (const std::uint32_t i : group.moving)
        s.paces[i].wanted = count_of(std::sqrt(s.loads[i]));
}

// Whether bodies that had no pace before asked for more than they got.
bool World::began_too_coarsely() const {
    const Scratch &s = scratch_;
    if (!chooses_substeps())
        return false;
    return std::ranges::any_of(s.moving, [&](std::uint32_t i) {
        return state_.paces[i].substeps == 0 && s.paces[i].wanted > s.paces[i].substeps &&
               s.paces[i].substeps < settings_.max_substeps;
    });
}

} // namespace plumb::inline PLUMB_PRECISION
