#include "engine/dynamics/joints/joined_bodies.h"

#include "engine/core/disjoint_sets.h"

#include <algorithm>
#include <utility>

namespace plumb::inline PLUMB_PRECISION {

namespace {

bool keeps_apart(const Joint &joint) {
    return joint.alive && !joint.collide_connected && joint.a != Joint::world &&
           joint.b != Joint::world;
}

bool is_weld(const Joint &joint) {
    return keeps_apart(joint) && joint.type == JointType::fixed && joint.frequency == Real(0) &&
           joint.break_force == Real(0);
}

} // namespace

void JoinedBodies::add(const Joint &joint, std::uint32_t index, std::size_t bodies) {
    if (!keeps_apart(joint))
        return;
    const Pair pair{body_pair(joint.a, joint.b), index};
    pairs_.insert(std::ranges::upper_bound(pairs_, pair), pair);
    if (!is_weld(joint))
        return;
    for (auto i = static_cast<std::uint32_t>(welds_.size()); i < bodies; ++i)
        welds_.push_back(i);
    const auto [kept, gone] = std::minmax({welds_[joint.a], welds_[joint.b]});
    std::ranges::replace(welds_, gone, kept);
}

void JoinedBodies::remove(std::span<const Joint> joints, std::uint32_t index) {
    const Joint &joint = joints[index];
    if (!keeps_apart(joint))
        return;
    pairs_.erase(std::ranges::lower_bound(pairs_, Pair{body_pair(joint.a, joint.b), index}));
    if (!is_weld(joint))
        return;
    DisjointSets sets;
    sets.start(welds_.size());
    bool any = false;
    for (std::uint32_t i = 0; i < joints.size(); ++i)
        if (i != index && is_weld(joints[i])) {
            sets.join(joints[i].a, joints[i].b);
            any = true;
        }
    if (!any)
        sets.start(0);
    for (std::uint32_t i = 0; i < sets.parent.size(); ++i)
        sets.parent[i] = sets.root_of(i);
    welds_ = std::move(sets.parent);
}

bool JoinedBodies::are_held_by_a_joint(std::uint32_t a, std::uint32_t b,
                                       std::span<const JointMemory> joints) const {
    const std::uint64_t bodies = body_pair(a, b);
    for (auto pair = std::ranges::lower_bound(pairs_, bodies, {}, &Pair::bodies);
         pair != pairs_.end() && pair->bodies == bodies; ++pair)
        if (!joints[pair->joint].broken)
            return true;
    return false;
}

} // namespace plumb::inline PLUMB_PRECISION
