// Seeded random numbers: the same sequence on every machine and compiler.
#pragma once

#include <cstdint>

namespace plumb {

// SplitMix64 (Steele, Lea, Flood 2014, "Fast splittable pseudorandom number generators", fig. 17).
// Passed by reference to whatever draws from it; there is no global generator.
class Random {
  public:
    explicit Random(std::uint64_t seed) : state_(seed) {}

    std::uint64_t next_u64() {
        state_ += 0x9E3779B97F4A7C15ULL;
        std::uint64_t z = state_;
        z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
        z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
        return z ^ (z >> 31);
    }

    // Uniform in [0, 1), with 53 random bits.
    double next_unit() { return static_cast<double>(next_u64() >> 11) * 0x1.0p-53; }

    // Uniform in [low, high).
    double next_in(double low, double high) { return low + (high - low) * next_unit(); }

    // Uniform in {0, ..., count - 1}; count > 0. (Bias below 2^-32 for the counts used here.)
    std::uint32_t next_index(std::uint32_t count) {
        return static_cast<std::uint32_t>(((next_u64() >> 32) * count) >> 32);
    }

  private:
    std::uint64_t state_;
};

} // namespace plumb
