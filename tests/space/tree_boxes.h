// Boxes for trees, and brute-force answers.
#pragma once

#include "engine/space/dynamic_tree.h"
#include "tests/geometry/oracle.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {
namespace tree_boxes {

inline Aabb any_box(Random &random, double reach, double size) {
    const Vec3 center = oracle::any_vector(random, reach);
    const Vec3 half = glm::abs(oracle::any_vector(random, size));
    return {center - half, center + half};
}

inline bool touches(const Aabb &a, const Aabb &b) {
    for (int i = 0; i < 3; ++i)
        if (a.min[i] > b.max[i] || b.min[i] > a.max[i])
            return false;
    return true;
}

// Small integers: every answer is exact, and boxes often just touch.
inline Vec3 any_integers(Random &random, std::uint32_t reach) {
    const auto one = [&] { return Real(int(random.next_index(2 * reach + 1)) - int(reach)); };
    const Real x = one(), y = one(), z = one();
    return {x, y, z};
}

inline Aabb any_integer_box(Random &random, std::uint32_t size = 3) {
    const Vec3 a = any_integers(random, 12), b = a + glm::abs(any_integers(random, size));
    return {a, b};
}

template <typename Query>
std::vector<std::uint32_t> sorted_answers(const DynamicTree &tree, const Query &query) {
    std::vector<std::uint32_t> found;
    tree.query(query, [&](std::uint32_t user) {
        found.push_back(user);
        return true;
    });
    std::sort(found.begin(), found.end());
    return found;
}

} // namespace tree_boxes
} // namespace plumb::inline PLUMB_PRECISION
