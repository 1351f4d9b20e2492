#include "engine/core/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace plumb {
namespace {

// From the reference implementation (Vigna, splitmix64.c), seed 1234567; also given by Rosetta
// Code, "Pseudo-random numbers/Splitmix64".
TEST(Random, IsSplitMix64) {
    Random random(1234567);
    for (const std::uint64_t expected :
         {6457827717110365317ULL, 3203168211198807973ULL, 9817491932198370423ULL,
          4593380528125082431ULL, 16408922859458223821ULL})
        EXPECT_EQ(random.next_u64(), expected);
}

// Seed 0, as published with java.util.SplittableRandom and xoshiro's seeding.
TEST(Random, SeedZero) {
    Random random(0);
    EXPECT_EQ(random.next_u64(), 0xE220A8397B1DCDAFULL);
    EXPECT_EQ(random.next_u64(), 0x6E789E6AA1B965F4ULL);
    EXPECT_EQ(random.next_u64(), 0x06C45D188009454FULL);
}

TEST(Random, CopiesGoOnAlike) {
    Random random(7);
    random.next_u64();
    Random copy = random;
    for (int i = 0; i < 10; ++i)
        EXPECT_EQ(random.next_u64(), copy.next_u64());
}

// n uniform draws: the mean has standard deviation 1/sqrt(12 n), the mean square sqrt(4/45/n). One
// seed in a million is off by five of them; this seed is fixed.
TEST(Random, UnitIsUniform) {
    Random random(42);
    constexpr int n = 100'000;
    double sum = 0;
    double squares = 0;
    for (int i = 0; i < n; ++i) {
        const double x = random.next_unit();
        ASSERT_GE(x, 0.0);
        ASSERT_LT(x, 1.0);
        sum += x;
        squares += x * x;
    }
    EXPECT_NEAR(sum / n, 0.5, 5 * std::sqrt(1.0 / 12 / n));
    EXPECT_NEAR(squares / n, 1.0 / 3, 5 * std::sqrt(4.0 / 45 / n));
}

TEST(Random, InStaysInItsRange) {
    Random random(3);
    double low = 5;
    double high = -2;
    for (int i = 0; i < 10'000; ++i) {
        const double x = random.next_in(-2, 5);
        ASSERT_GE(x, -2.0);
        ASSERT_LT(x, 5.0);
        low = std::min(low, x);
        high = std::max(high, x);
    }
    // The chance that none of 10,000 draws is within 1/500 of an end is e^-20.
    EXPECT_LT(low, -2 + 7.0 / 500);
    EXPECT_GT(high, 5 - 7.0 / 500);
}

// Chi-squared with 6 degrees of freedom exceeds 35.9 once in a million.
TEST(Random, IndexIsUniform) {
    Random random(11);
    constexpr int n = 70'000;
    std::array<int, 7> counts{};
    for (int i = 0; i < n; ++i) {
        const std::uint32_t index = random.next_index(7);
        ASSERT_LT(index, 7U);
        ++counts[index];
    }
    double chi_squared = 0;
    for (const int count : counts)
        chi_squared += (count - n / 7.0) * (count - n / 7.0) / (n / 7.0);
    EXPECT_LT(chi_squared, 35.9);
}

TEST(Random, IndexOfOneAndOfMost) {
    Random random(5);
    for (int i = 0; i < 100; ++i)
        EXPECT_EQ(random.next_index(1), 0U);
    // With count 2^32 - 1 the index is nearly the word's upper half.
    Random one(9);
    Random other(9);
    for (int i = 0; i < 100; ++i) {
        const auto upper = static_cast<std::uint32_t>(one.next_u64() >> 32);
        EXPECT_LE(upper - other.next_index(0xFFFFFFFFU), 1U);
    }
}

} // namespace
} // namespace plumb
