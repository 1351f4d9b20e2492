// Which bodies joints keep from colliding with each other.
#pragma once

#include "engine/dynamics/joints/joint.h"

#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {

// The same for either order: lesser << 32 | greater.
inline std::uint64_t body_pair(std::uint32_t a, std::uint32_t b) {
    return a < b ? (std::uint64_t{a} << 32 | b) : (std::uint64_t{b} << 32 | a);
}

// The two bodies of a joint do not collide while it holds, unless it says so
// (Joint::collide_connected); nor do any two of the bodies that rigid fixed joints without a
// breaking force make one: a contact between them could do nothing but strain the joints. The world
// itself has no shape.
class JoinedBodies {
  public:
    // `bodies`: how many slots the model has.
    void add(const Joint &joint, std::uint32_t index, std::size_t bodies);
    // `joints`: all of the model's, `index` among them as it was.
    void remove(std::span<const Joint> joints, std::uint32_t index);

    // Whether two bodies may collide as far as their joints are concerned.
    bool may_collide(std::uint32_t a, std::uint32_t b, std::span<const JointMemory> joints) const {
        return pairs_.empty() || (!are_welded(a, b) && !are_held_by_a_joint(a, b, joints));
    }

  private:
    struct Pair {
        std::uint64_t bodies; // body_pair
        std::uint32_t joint;
        friend auto operator<=>(const Pair &, const Pair &) = default;
    };

    bool are_welded(std::uint32_t a, std::uint32_t b) const {
        return a < welds_.size() && b < welds_.size() && welds_[a] == welds_[b];
    }
    bool are_held_by_a_joint(std::uint32_t a, std::uint32_t b,
                             std::span<const JointMemory> joints) const;

    std::vector<Pair> pairs_;          // ascending
    std::vector<std::uint32_t> welds_; // per body, the least that it is welded to; empty: none is
};

} // namespace plumb::inline PLUMB_PRECISION
