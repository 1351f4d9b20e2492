#include "engine/core/hash.h"

#include "engine/core/random.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <set>

namespace plumb {
namespace {

template <typename... Values> std::uint64_t hash_of(Values... values) {
    StateHash hash;
    (hash.add(values), ...);
    return hash.value();
}

constexpr std::uint64_t word(std::uint64_t value) {
    return value;
}

TEST(StateHash, EqualStatesEqualHashes) {
    EXPECT_EQ(hash_of(1.5F, 2.5, word(3)), hash_of(1.5F, 2.5, word(3)));
}

TEST(StateHash, OrderAndLengthMatter) {
    EXPECT_NE(hash_of(word(1), word(2)), hash_of(word(2), word(1)));
    EXPECT_NE(hash_of(), hash_of(word(0)));
    EXPECT_NE(hash_of(word(0)), hash_of(word(0), word(0)));
}

TEST(StateHash, SeesBitsNotValues) {
    EXPECT_NE(hash_of(0.0), hash_of(-0.0));
    EXPECT_NE(hash_of(0.0F), hash_of(-0.0F));
    EXPECT_NE(hash_of(1.0), hash_of(std::nextafter(1.0, 2.0)));
    EXPECT_NE(hash_of(1.0F), hash_of(std::nextafter(1.0F, 2.0F)));
    // NaN is unequal to itself as a value, but not in its bits.
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(hash_of(nan), hash_of(nan));
}

// A good mixer flips each of the 64 bits with probability 1/2 when one input bit flips. Over n
// trials the mean share of one (input, output) pair has standard deviation 1/(2 sqrt n); the chance
// that any of the 4096 pairs is off by six of them is 1e-5.
TEST(StateHash, OneBitChangesHalfOfThem) {
    constexpr int n = 2000;
    Random random(1);
    std::array<std::array<int, 64>, 64> flips{};
    for (int i = 0; i < n; ++i) {
        const std::uint64_t before = random.next_u64();
        const std::uint64_t plain = hash_of(before, word(7));
        for (std::size_t in = 0; in < 64; ++in) {
            const std::uint64_t changed = plain ^ hash_of(before ^ (word(1) << in), word(7));
            for (std::size_t out = 0; out < 64; ++out)
                flips[in][out] += static_cast<int>((changed >> out) & 1);
        }
    }
    for (std::size_t in = 0; in < 64; ++in)
        for (std::size_t out = 0; out < 64; ++out)
            ASSERT_NEAR(flips[in][out] / double{n}, 0.5, 6 * 0.5 / std::sqrt(double{n}))
                << "input bit " << in << ", output bit " << out;
}

// 100,000 neighbouring words: the chance that two 64-bit hashes collide is 3e-10.
TEST(StateHash, NeighboursDoNotCollide) {
    std::set<std::uint64_t> seen;
    for (std::uint64_t i = 0; i < 100'000; ++i)
        seen.insert(hash_of(word(i)));
    EXPECT_EQ(seen.size(), 100'000U);
}

} // namespace
} // namespace plumb
