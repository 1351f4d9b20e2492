// Tables for compacting eight lanes by a mask.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace plumb {

// The places of a byte's set bits in order, a byte each, the first in the lowest; then zeros.
inline constexpr std::array<std::uint64_t, 256> places_of_bits = [] {
    std::array<std::uint64_t, 256> table{};
    for (std::size_t bits = 0; bits < 256; ++bits) {
        int n = 0;
        for (std::uint64_t place = 0; place < 8; ++place)
            if ((bits >> place & 1) != 0)
                table[bits] |= place << 8 * n++;
    }
    return table;
}();

// The byte's bit i at place 2 i.
inline constexpr std::array<std::uint16_t, 256> spread_bits = [] {
    std::array<std::uint16_t, 256> table{};
    for (std::size_t bits = 0; bits < 256; ++bits)
        for (std::size_t place = 0; place < 8; ++place)
            table[bits] =
                static_cast<std::uint16_t>(table[bits] | (bits >> place & 1) << 2 * place);
    return table;
}();

// The lane after each of n lanes, the first after the last, a byte each.
inline constexpr std::array<std::uint64_t, 9> next_lanes = [] {
    std::array<std::uint64_t, 9> table{};
    for (std::size_t n = 1; n <= 8; ++n)
        for (std::uint64_t lane = 0; lane + 1 < n; ++lane)
            table[n] |= (lane + 1) << 8 * lane;
    return table;
}();

} // namespace plumb
