// A 64-bit hash of plain values, fed in a fixed order: equal states, equal hashes.
#pragma once

#include <bit>
#include <cstdint>

namespace plumb {

class StateHash {
  public:
    // Mixes one word in with the finaliser of MurmurHash3 (Appleby 2011), chained.
    void add(std::uint64_t word) {
        std::uint64_t z = hash_ ^ word;
        z = (z ^ (z >> 33)) * 0xFF51AFD7ED558CCDULL;
        z = (z ^ (z >> 33)) * 0xC4CEB9FE1A85EC53ULL;
        hash_ = (z ^ (z >> 33)) + 0x9E3779B97F4A7C15ULL;
    }
    // Bits, not values: -0.0 and 0.0 differ, as they may lead to different motion.
    void add(float value) { add(static_cast<std::uint64_t>(std::bit_cast<std::uint32_t>(value))); }
    void add(double value) { add(std::bit_cast<std::uint64_t>(value)); }

    std::uint64_t value() const { return hash_; }

  private:
    std::uint64_t hash_ = 0x243F6A8885A308D3ULL;
};

} // namespace plumb
