// The broad phase: which colliders may touch within a step.
#include "engine/dynamics/world.h"

#include "engine/core/check.h"
#include "engine/core/radix_sort.h"
#include "engine/geometry/aabb.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// Whether a box reaches below a plane.
bool touch(const Aabb &box, const HalfSpace &half_space) {
    const Vec3 lowest = glm::mix(box.max, box.min, glm::greaterThan(half_space.normal, Vec3{0}));
    return glm::dot(half_space.normal, lowest) <= half_space.offset;
}

// Whether two boxes are within `distance` of each other.
bool are_within(Real distance, const Aabb &a, const Aabb &b) {
    const Vec3 gap = glm::max(glm::max(a.min - b.max, b.min - a.max), Vec3{Real(0)});
    return glm::dot(gap, gap) <= distance * distance;
}

bool is_finite_box(const Aabb &box) {
    return std::isfinite(box.min.x + box.min.y + box.min.z + box.max.x + box.max.y + box.max.z);
}

Aabb surface_bounds(const Collider &collider, const Motion &motion) {
    const Aabb &local = collider.surface->bounds();
    const Transform pose = surface_pose(collider, motion);
    return bounds(placed(Box{Real(0.5) * (local.min + local.max), identity_rotation,
                             Real(0.5) * (local.max - local.min)},
                         pose));
}

// How many steps ahead the tree's boxes reach along a body's way, so that fast bodies change their
// place in the tree less often.
constexpr Real expected_steps = Real(2);

// Far more than any pile has. In a world that flies apart every body reaches all others in one
// step, and memory would run out first. Little is stored for pairs that are merely near each other.
constexpr std::size_t most_near_pairs = 100'000'000;
constexpr std::size_t most_candidates = 6'000'000;

void refuse_more_than(std::size_t limit, std::size_t pairs) {
    PLUMB_CHECK(pairs <= limit, "more than " << limit << " pairs of shapes may touch");
}

// A few microseconds of work.
constexpr std::size_t colliders_a_part = 128;
constexpr std::size_t pairs_a_part = 512;

// By bodies, then by children. Two bodies have few pairs.
void sort_candidates(std::vector<Candidate> &list, std::vector<Candidate> &scratch) {
    const auto bodies = [](const Candidate &candidate) {
        return std::uint64_t{candidate.key.a} << 32 | candidate.key.b;
    };
    if (std::ranges::is_sorted(list, {}, &Candidate::key))
        return;
    radix_sort(list, scratch, bodies);
    for (auto first = list.begin(); first != list.end();) {
        const auto last = std::find_if(first, list.end(), [&](const Candidate &other) {
            return bodies(other) != bodies(*first);
        });
        std::ranges::sort(first, last, {}, &Candidate::key);
        first = last;
    }
}

} // namespace

// A world of one body, a world whose bodies all ignore each other, and a method without contacts
// pay for no collision detection.
bool World::needs_contacts() const {
    return method_->info.contacts && model_->dynamic_bodies > 0 && model_->alive_bodies >= 2 &&
           (model_->layers & model_->heeded_layers) != 0;
}

// Bounds of everything that a collider with this box may reach in this step, plus half the distance
// at which contacts are made.
Aabb World::swept_bounds(const Aabb &box, const ColliderReach &of) const {
    const auto dt = static_cast<Real>(settings_.dt);
    const Real reach = static_cast<Real>(settings_.speculative_distance) / 2 +
                       glm::length(of.velocity) * dt + of.turning + glm::length(of.pull) * dt * dt;
    return {box.min - reach, box.max + reach};
}

// Whether pairs with that body are looked for. Once some bodies were seen to go another way than
// expected, only their pairs are.
bool World::is_asked(std::uint32_t body) const {
    return scratch_.deflected.empty() || scratch_.deflected[body] != 0;
}

// Whether there is nothing that a collider may collide with. Particles collide with every layer.
bool World::meets_nothing(const Collider &collider) const {
    return model_->particles.empty() && model_->ignores_all(collider.filter);
}

// Places a collider and sweeps its box. Returns whether the tree must be updated.
bool World::place_collider(std::uint32_t i) const {
    Scratch &s = scratch_;
    const Collider &collider = model_->colliders[i];
    if (collider.body == no_body || !is_asked(collider.body))
        return false;
    if (meets_nothing(collider)) { // for now; it may move meanwhile
        s.stays[i] = 0;
        return false;
    }
    const bool is_still = s.still[collider.body] != 0;
    if (is_still && s.stays[i] != 0 && s.leaves[i] != DynamicTree::none)
        return false;
    s.stays[i] = is_still ? 1 : 0;
    const Motion &motion = state_.motions[collider.body];
    if (has_diverged(motion)) { // diverged: the report says so; nothing to collide
        s.boxes[i] = s.swept[i] = Aabb{};
        return false;
    }
    const Body &body = model_->bodies[collider.body];
    s.reach[i] = {};
    if (body.kind != BodyKind::static_body)
        s.reach[i] = {expected_motion(collider.body).velocity, pull_on(collider.body),
                      turning_reach(collider.body)};
    if (!collider.surface)
        s.placed[i] = placed(collider.shape, mass_pose(motion));
    if (collider.is_half_space())
        return false;
    s.boxes[i] = collider.surface ? surface_bounds(collider, motion) : bounds(s.placed[i]);
    s.swept[i] = swept_bounds(s.boxes[i], s.reach[i]);
    if (!is_finite_box(s.swept[i])) { // about to diverge
        s.boxes[i] = s.swept[i] = Aabb{};
        return false;
    }
    return s.leaves[i] == DynamicTree::none || !s.tree.holds(s.leaves[i], s.swept[i]);
}

// Places the colliders and notes which left their fat box. Returns whether any did.
bool World::place_colliders() const {
    Scratch &s = scratch_;
    const std::size_t count = model_->colliders.size();
    s.placed.resize(count);
    s.boxes.resize(count);
    s.swept.resize(count);
    s.reach.resize(count);
    s.leaves.resize(count, DynamicTree::none);
    s.moved.resize(count);
    s.stays.resize(count, 0);
    for_parts(s.tasks, count, colliders_a_part, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            s.moved[i] = place_collider(static_cast<std::uint32_t>(i)) ? 1 : 0;
    });
    bool any_moved = false;
    for (std::uint32_t i = 0; i < count; ++i) {
        if (s.moved[i] == 0)
            continue;
        any_moved = true;
        const Motion &motion = state_.motions[model_->colliders[i].body];
        const Vec3 way = expected_steps * static_cast<Real>(settings_.dt) * motion.velocity;
        if (s.leaves[i] == DynamicTree::none)
            s.leaves[i] = s.tree.insert(s.swept[i], i);
        else
            s.tree.update(s.leaves[i], s.swept[i], way);
    }
    return any_moved;
}

// Whether two colliders can ever matter to each other.
bool World::may_touch(std::uint32_t i, std::uint32_t j) const {
    const Collider &a = model_->colliders[i];
    const Collider &b = model_->colliders[j];
    return a.body != b.body &&
           (model_->bodies[a.body].kind == BodyKind::dynamic ||
            model_->bodies[b.body].kind == BodyKind::dynamic) &&
           may_collide(a.filter, b.filter);
}

// Whether two colliders may be within `distance` of each other: by their boxes, and by the spheres
// around their bodies' centres of mass that enclose them.
bool World::may_be_within(Real distance, std::uint32_t i, std::uint32_t j) const {
    const Collider &a = model_->colliders[i];
    const Collider &b = model_->colliders[j];
    if (a.is_half_space() || b.is_half_space())
        return true;
    if (!are_within(distance, scratch_.boxes[i], scratch_.boxes[j]))
        return false;
    if (a.surface || b.surface)
        return true;
    const Vec3 between = state_.motions[b.body].position - state_.motions[a.body].position;
    const Real reach = a.extent + a.rounding + b.extent + b.rounding + distance;
    return glm::dot(between, between) <= reach * reach;
}

void World::add_candidate(std::uint32_t i, std::uint32_t j, std::vector<Candidate> &out) const {
    if (scratch_.still[model_->colliders[i].body] != 0 &&
        scratch_.still[model_->colliders[j].body] != 0)
        return;
    if (model_->colliders[i].body > model_->colliders[j].body)
        std::swap(i, j);
    const Collider &a = model_->colliders[i];
    const Collider &b = model_->colliders[j];
    if (!is_asked(a.body) && !is_asked(b.body))
        return;
    if (!model_->joined.may_collide(a.body, b.body, state_.joints))
        return;
    Candidate candidate{{a.body, b.body, a.child, b.child}, i, j};
    candidate.margin = contact_margin(candidate);
    // Not finite: about to diverge, at speeds whose square overflows.
    if (std::isfinite(candidate.margin) && may_be_within(candidate.margin, i, j))
        out.push_back(candidate);
}

// Updates the pairs whose fat boxes touch, after some colliders left theirs.
void World::find_fat_pairs() const {
    Scratch &s = scratch_;
    std::atomic<std::size_t> found = 0;
    const auto find = [&](std::size_t begin, std::size_t end, std::size_t,
                          std::vector<std::uint64_t> &out) {
        for (auto i = static_cast<std::uint32_t>(begin); i < end; ++i) {
            if (s.moved[i] == 0)
                continue;
            const std::size_t before = out.size();
            s.tree.query(s.tree.fat_bounds(s.leaves[i]), [&](std::uint32_t other) {
                const bool both_will_ask = s.moved[other] != 0 && other < i;
                if (other != i && !both_will_ask && may_touch(i, other))
                    out.push_back(body_pair(i, other));
                return true;
            });
            refuse_more_than(most_near_pairs, found += out.size() - before);
        }
    };
    collect(s.tasks, model_->colliders.size(), colliders_a_part, s.pair_parts, s.new_pairs, find);
    radix_sort(s.new_pairs, s.sorted_numbers, std::identity{});
    s.merged_pairs.clear();
    auto next = s.new_pairs.begin();
    for (const std::uint64_t pair : s.fat_pairs) {
        if (s.moved[pair >> 32] != 0 || s.moved[pair & 0xFFFFFFFFU] != 0)
            continue; // if it still is a pair, it is among the new ones
        for (; next != s.new_pairs.end() && *next < pair; ++next)
            s.merged_pairs.push_back(*next);
        s.merged_pairs.push_back(pair);
    }
    s.merged_pairs.insert(s.merged_pairs.end(), next, s.new_pairs.end());
    std::swap(s.fat_pairs, s.merged_pairs);
    refuse_more_than(most_near_pairs, s.fat_pairs.size());
}

void World::find_pairs_with_planes() const {
    Scratch &s = scratch_;
    s.plane_candidates.clear();
    s.plane_candidates.reserve(model_->half_spaces.size() * model_->colliders.size());
    for (const std::uint32_t plane : model_->half_spaces) {
        if (meets_nothing(model_->colliders[plane]))
            continue;
        const std::uint32_t body = model_->colliders[plane].body;
        HalfSpace reached = std::get<HalfSpace>(s.placed[plane]);
        reached.offset += static_cast<Real>(settings_.speculative_distance) / 2;
        if (model_->bodies[body].kind != BodyKind::static_body)
            reached.offset +=
                glm::length(expected_motion(body).velocity) * static_cast<Real>(settings_.dt);
        for (std::uint32_t i = 0; i < model_->colliders.size(); ++i) {
            const Collider &other = model_->colliders[i];
            if (other.body != no_body && !other.is_half_space() && may_touch(i, plane) &&
                touch(s.swept[i], reached))
                add_candidate(i, plane, s.plane_candidates);
        }
    }
}

// Candidates are the pairs whose swept boxes touch and that may meet by their relative motion. The
// tree's fat boxes only save testing all pairs: which candidates come out, and in which order,
// depends on the present poses alone.
void World::find_pairs() const {
    Scratch &s = scratch_;
    s.candidates.clear();
    if (!needs_contacts()) {
        if (needs_particle_contacts())
            place_colliders();
        else
            std::ranges::fill(s.stays, std::uint8_t{0}); // they move without being placed
        return;
    }
    if (place_colliders())
        find_fat_pairs();
    // Room for all of them, so that nothing is allocated when some begin to touch.
    s.pair_candidates.reserve(s.fat_pairs.capacity());
    collect(s.tasks, s.fat_pairs.size(), pairs_a_part, s.candidate_parts, s.pair_candidates,
            [&](std::size_t begin, std::size_t end, std::size_t, std::vector<Candidate> &out) {
                for (std::size_t k = begin; k < end; ++k) {
                    const auto i = static_cast<std::uint32_t>(s.fat_pairs[k] >> 32);
                    const auto j = static_cast<std::uint32_t>(s.fat_pairs[k] & 0xFFFFFFFFU);
                    if (touch(s.swept[i], s.swept[j]))
                        add_candidate(i, j, out);
                }
            });
    find_pairs_with_planes();
    refuse_more_than(most_candidates, s.pair_candidates.size() + s.plane_candidates.size());
    sort_candidates(s.pair_candidates, s.sorted_candidates);
    sort_candidates(s.plane_candidates, s.sorted_candidates);
    s.candidates.reserve(s.pair_candidates.capacity() + s.plane_candidates.capacity());
    s.candidates.resize(s.pair_candidates.size() + s.plane_candidates.size());
    std::ranges::merge(s.pair_candidates, s.plane_candidates, s.candidates.begin(), {},
                       &Candidate::key, &Candidate::key);
    note_floors();
}

// The static and kinematic colliders near each of the others: where there are several they may be
// flush.
void World::note_floors() const {
    Scratch &s = scratch_;
    s.floors.clear();
    for (const Candidate &candidate : s.candidates) {
        const bool a_is_floor = model_->bodies[candidate.key.a].kind != BodyKind::dynamic;
        const bool b_is_floor = model_->bodies[candidate.key.b].kind != BodyKind::dynamic;
        if (!a_is_floor && !b_is_floor)
            continue;
        const std::uint32_t other = a_is_floor ? candidate.collider_b : candidate.collider_a;
        const std::uint32_t of_floor = a_is_floor ? candidate.collider_a : candidate.collider_b;
        if (!model_->colliders[of_floor].sensor && !model_->colliders[other].sensor)
            s.floors.push_back(std::uint64_t{other} << 32 | of_floor);
    }
    radix_sort(s.floors, s.sorted_numbers, std::identity{});
}

} // namespace plumb::inline PLUMB_PRECISION
