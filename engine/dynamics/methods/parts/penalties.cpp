// How a world remembers the stiffness of its rows (penalty.h).
#include "engine/core/renew.h"
#include "engine/dynamics/world.h"

#include <algorithm>

namespace plumb::inline PLUMB_PRECISION {

// Points get the penalties of those their contact had before, matched by feature id.
void World::load_penalties() {
    Scratch &s = scratch_;
    if (!method_->info.keeps_penalties()) {
        s.point_penalties.clear();
        s.joint_penalties.clear();
        return;
    }
    s.joint_penalties = state_.penalties.joints;
    s.joint_penalties.resize(joints().size());
    renew(s.point_penalties, s.contacts.size());
    if (state_.penalties.points.empty())
        return;
    auto memory = state_.contacts.begin();
    for (std::size_t i = 0; i < s.contacts.size(); ++i) {
        const Contact &contact = s.contacts[i];
        while (memory != state_.contacts.end() && memory->key < contact.key)
            ++memory;
        if (memory == state_.contacts.end() || memory->key != contact.key)
            continue;
        for (std::size_t k = 0; k < static_cast<std::size_t>(contact.manifold.count); ++k)
            for (std::size_t j = memory->first_point; j < memory->first_point + memory->point_count;
                 ++j)
                if (state_.points[j].feature == contact.manifold.points[k].feature)
                    s.point_penalties[i][k] = state_.penalties.points[j];
    }
}

// Call after gather_memory, which finds the places.
void World::gather_penalties() {
    Scratch &s = scratch_;
    if (!method_->info.keeps_penalties()) {
        s.next_penalties.clear();
        return;
    }
    renew(s.next_penalties, s.next_points.size());
    for (std::size_t i = 0; i < s.contacts.size(); ++i)
        if (s.remembered[i] != UINT32_MAX) {
            const ContactMemory &to = s.next_memory[s.remembered[i]];
            std::copy_n(s.point_penalties[i].begin(), to.point_count,
                        s.next_penalties.begin() + to.first_point);
        }
    if (state_.penalties.points.empty())
        return;
    for (const auto &[from, to] : s.kept_memory)
        std::copy_n(state_.penalties.points.begin() + state_.contacts[from].first_point,
                    s.next_memory[to].point_count,
                    s.next_penalties.begin() + s.next_memory[to].first_point);
}

// Like remember_contact: the points are the last ones of State::points.
void World::remember_penalties(std::span<const PointPenalty> penalties, std::size_t point_count) {
    std::vector<PointPenalty> &all = state_.penalties.points;
    if (penalties.empty() && all.empty())
        return;
    all.resize(state_.points.size());
    std::ranges::copy(penalties.first(std::min(penalties.size(), point_count)),
                      all.end() - static_cast<std::ptrdiff_t>(point_count));
}

void World::remember_penalty(std::uint32_t joint, const JointPenalty &penalty) {
    std::vector<JointPenalty> &all = state_.penalties.joints;
    if (all.empty() && penalty == JointPenalty{})
        return;
    all.resize(joints().size());
    all[joint] = penalty;
}

} // namespace plumb::inline PLUMB_PRECISION
