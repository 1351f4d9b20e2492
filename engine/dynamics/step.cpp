// The step, phase by phase.
#include "engine/dynamics/world.h"

#include "engine/core/check.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

// Adds the time until it goes to a phase of the report.
class PhaseTimer {
  public:
    explicit PhaseTimer(double &seconds) : seconds_(seconds) {}
    ~PhaseTimer() { seconds_ += std::chrono::duration<double>(Clock::now() - start_).count(); }
    PhaseTimer(const PhaseTimer &) = delete;
    PhaseTimer &operator=(const PhaseTimer &) = delete;

  private:
    using Clock = std::chrono::steady_clock;
    double &seconds_;
    Clock::time_point start_ = Clock::now();
};

bool touch(const Aabb &a, const Aabb &b) {
    return a.min.x <= b.max.x && b.min.x <= a.max.x && a.min.y <= b.max.y && b.min.y <= a.max.y &&
           a.min.z <= b.max.z && b.min.z <= a.max.z;
}

// Whether a box reaches below a plane.
bool touch(const Aabb &box, const HalfSpace &half_space) {
    const Vec3 lowest = glm::mix(box.max, box.min, glm::greaterThan(half_space.normal, Vec3{0}));
    return glm::dot(half_space.normal, lowest) <= half_space.offset;
}

// What the solver remembered, point by point of the same features. What points bore that are gone
// is shared out among those that are new, so that a rocking box keeps its load while its corners
// pass from one edge to the next.
void carry_over(const Contact &from, Contact &to) {
    std::array<bool, 4> found{};
    Vec3 lost{Real(0)};
    int fresh = to.manifold.count;
    for (int old = 0; old < from.manifold.count; ++old) {
        const auto old_index = static_cast<std::size_t>(old);
        if (from.impulses[old_index] == Vec3{Real(0)})
            continue; // what bore nothing is not remembered, in files either
        bool gone = true;
        for (int k = 0; k < to.manifold.count && gone; ++k) {
            const auto index = static_cast<std::size_t>(k);
            if (found[index] ||
                from.manifold.points[old_index].feature != to.manifold.points[index].feature)
                continue;
            to.impulses[index] = from.impulses[old_index];
            found[index] = true;
            gone = false;
            --fresh;
        }
        if (gone)
            lost += from.impulses[old_index];
    }
    if (fresh == 0)
        return;
    const Vec3 share = lost / static_cast<Real>(fresh);
    for (int k = 0; k < to.manifold.count; ++k)
        if (!found[static_cast<std::size_t>(k)])
            to.impulses[static_cast<std::size_t>(k)] = share;
}

} // namespace

void World::step(TaskPool *tasks) {
    report_ = StepReport{};
    {
        const PhaseTimer timer(report_.find_pairs);
        find_pairs();
    }
    {
        const PhaseTimer timer(report_.collide);
        collide(tasks);
    }
    {
        const PhaseTimer timer(report_.advance);
        advance();
    }
    {
        const PhaseTimer timer(report_.finish);
        finish();
    }
}

// A world of one body, or a method that knows no contacts, pays for no collision detection.
bool World::needs_contacts() const {
    if (!method_->info.contacts)
        return false;
    std::size_t alive = 0;
    bool dynamic = false;
    for (const Body &body : bodies_)
        if (body.alive) {
            ++alive;
            dynamic = dynamic || body.kind == BodyKind::dynamic;
        }
    return dynamic && alive >= 2;
}

// Everything that the body may reach in this step, and half the distance at which contacts are
// made.
Aabb World::swept_bounds(std::uint32_t body) const {
    const Aabb box = bounds(placed_[body]);
    const auto dt = static_cast<Real>(settings_.dt);
    Real reach = static_cast<Real>(settings_.speculative_distance) / 2;
    if (bodies_[body].kind != BodyKind::fixed)
        reach += glm::length(motions_[body].velocity) * dt;
    if (bodies_[body].kind == BodyKind::dynamic)
        reach += glm::length(Vec3{settings_.gravity}) * dt * dt;
    return {box.min - reach, box.max + reach};
}

// Candidates are the pairs whose swept boxes touch. The tree's fat boxes only save looking at all
// of them: which pairs come out, and in which order, depends on the present poses alone.
void World::find_pairs() {
    candidates_.clear();
    if (!needs_contacts())
        return;
    const auto count = static_cast<std::uint32_t>(bodies_.size());
    placed_.resize(count);
    swept_.resize(count);
    moved_.assign(count, 0);
    bool any_moved = false;
    for (std::uint32_t i = 0; i < count; ++i) {
        Body &body = bodies_[i];
        if (!body.alive)
            continue;
        if (has_diverged(motions_[i])) { // the report says so; nothing to collide any more
            swept_[i] = Aabb{};
            continue;
        }
        placed_[i] = placed(body.shape, Transform{motions_[i].position, motions_[i].rotation});
        if (std::holds_alternative<HalfSpace>(body.shape))
            continue;
        swept_[i] = swept_bounds(i);
        const Aabb &box = swept_[i];
        const Real sum = box.min.x + box.min.y + box.min.z + box.max.x + box.max.y + box.max.z;
        if (!std::isfinite(sum)) { // diverged: the report says so; nothing to collide any more
            swept_[i] = Aabb{};
            continue;
        }
        if (body.leaf == DynamicTree::none) {
            body.leaf = tree_.insert(box, i);
            moved_[i] = 1;
        } else if (tree_.update(body.leaf, box)) {
            moved_[i] = 1;
        }
        any_moved = any_moved || moved_[i] != 0;
    }
    if (any_moved) {
        std::erase_if(fat_pairs_, [&](std::uint64_t key) {
            return moved_[key >> 32] != 0 || moved_[key & 0xFFFFFFFFU] != 0;
        });
        for (std::uint32_t i = 0; i < count; ++i) {
            if (moved_[i] == 0)
                continue;
            tree_.query(tree_.fat_bounds(bodies_[i].leaf), [&](std::uint32_t other) {
                const bool both_will_ask = moved_[other] != 0 && other < i;
                const bool one_dynamic = bodies_[i].kind == BodyKind::dynamic ||
                                         bodies_[other].kind == BodyKind::dynamic;
                if (other != i && !both_will_ask && one_dynamic)
                    fat_pairs_.push_back(Contact::pair_key(i, other));
                return true;
            });
        }
        std::ranges::sort(fat_pairs_);
    }
    for (const std::uint64_t key : fat_pairs_) {
        const auto a = static_cast<std::uint32_t>(key >> 32);
        const auto b = static_cast<std::uint32_t>(key & 0xFFFFFFFFU);
        if (touch(swept_[a], swept_[b]))
            candidates_.push_back(key);
    }
    for (const std::uint32_t plane : half_spaces_) {
        HalfSpace reached = std::get<HalfSpace>(placed_[plane]);
        reached.offset += static_cast<Real>(settings_.speculative_distance) / 2;
        if (bodies_[plane].kind != BodyKind::fixed)
            reached.offset +=
                glm::length(motions_[plane].velocity) * static_cast<Real>(settings_.dt);
        for (std::uint32_t i = 0; i < count; ++i)
            if (bodies_[i].alive && bodies_[i].kind == BodyKind::dynamic &&
                touch(swept_[i], reached))
                candidates_.push_back(Contact::pair_key(i, plane));
    }
    if (!joined_.empty())
        std::erase_if(candidates_,
                      [&](std::uint64_t key) { return std::ranges::binary_search(joined_, key); });
    std::ranges::sort(candidates_);
    report_.pairs = static_cast<std::uint32_t>(candidates_.size());
}

// Manifolds of all candidates, with the impulses of those that were contacts before.
void World::collide(TaskPool *tasks) {
    const std::vector<Contact> old = std::move(contacts_);
    contacts_.assign(candidates_.size(), Contact{});
    const auto dt = static_cast<Real>(settings_.dt);
    const Real gravity = glm::length(Vec3{settings_.gravity});
    const auto collide_part = [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            Contact &contact = contacts_[i];
            contact.a = static_cast<std::uint32_t>(candidates_[i] >> 32);
            contact.b = static_cast<std::uint32_t>(candidates_[i] & 0xFFFFFFFFU);
            const Vec3 approach = motions_[contact.b].velocity - motions_[contact.a].velocity;
            // What gravity adds within the step; two dynamic bodies fall together.
            const bool both_fall = bodies_[contact.a].kind == bodies_[contact.b].kind;
            const Real fall = both_fall ? Real(0) : gravity * dt * dt;
            const Real margin = static_cast<Real>(settings_.speculative_distance) +
                                glm::length(approach) * dt + fall;
            if (!std::isfinite(margin)) // about to diverge: speeds whose square is infinite
                continue;
            contact.manifold = plumb::collide(placed_[contact.a], placed_[contact.b], margin);
            if (contact.manifold.count == 0)
                continue;
            const Material &a = bodies_[contact.a].material;
            const Material &b = bodies_[contact.b].material;
            contact.friction = std::sqrt(a.friction * b.friction);
            contact.restitution = std::max(a.restitution, b.restitution);
            const auto before = std::ranges::lower_bound(old, candidates_[i], {}, &Contact::key);
            if (before != old.end() && before->key() == candidates_[i])
                carry_over(*before, contact);
        }
    };
    // About 20 microseconds of work in a part: enough to pay for handing it out.
    constexpr std::size_t grain = 64;
    if (tasks != nullptr)
        tasks->for_parts(contacts_.size(), grain, collide_part);
    else
        collide_part(0, contacts_.size());
    std::erase_if(contacts_, [](const Contact &c) { return c.manifold.count == 0; });
    report_.contacts = static_cast<std::uint32_t>(contacts_.size());
    for (const Contact &contact : contacts_)
        report_.contact_points += static_cast<std::uint32_t>(contact.manifold.count);
}

void World::advance() {
    double energy_before = 0;
    for (std::size_t i = 0; i < bodies_.size(); ++i)
        energy_before += energy_of(bodies_[i], motions_[i]);
    Motion world_frame;
    StepContext context{settings_, bodies_, motions_, contacts_, joints_, world_frame};
    method_->advance(context);
    report_.impacts = context.impacts;
    report_.unresolved_impacts = context.unresolved_impacts;
    report_.energy_gain = -energy_before;
}

void World::finish() {
    ++step_count_;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        const Motion &motion = motions_[i];
        const Vec3 linear = motion.position + motion.velocity;
        const Vec3 angular = motion.angular_velocity;
        const Real sum = linear.x + linear.y + linear.z + angular.x + angular.y + angular.z;
        report_.finite = report_.finite && std::isfinite(sum) && !has_diverged(motion);
        report_.energy += energy_of(bodies_[i], motion);
        if (bodies_[i].alive && bodies_[i].kind != BodyKind::fixed)
            ++report_.moving_bodies;
    }
    report_.energy_gain += report_.energy;
    for (const Joint &joint : joints_)
        report_.joints += joint.alive ? 1 : 0;
}

} // namespace plumb::inline PLUMB_PRECISION
