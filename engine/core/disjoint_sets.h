// Disjoint sets (union-find): which of n items belong together.
#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace plumb {

// Trees of items, with path halving (Tarjan and van Leeuwen 1984). A set's root is its least item,
// so that the roots depend only on what was joined, not on its order.
struct DisjointSets {
    std::vector<std::uint32_t> parent; // per item; a root's is itself

    // Each item on its own.
    void start(std::size_t items) {
        parent.resize(items);
        std::iota(parent.begin(), parent.end(), std::uint32_t{0});
    }
    std::uint32_t root_of(std::uint32_t item) {
        while (parent[item] != item)
            item = parent[item] = parent[parent[item]];
        return item;
    }
    void join(std::uint32_t a, std::uint32_t b) {
        a = root_of(a);
        b = root_of(b);
        if (a < b)
            parent[b] = a;
        else
            parent[a] = b;
    }
};

} // namespace plumb
