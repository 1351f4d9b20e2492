// Numbers and shapes from a fuzzer's bytes: mostly small and likely to coincide, now and then any
// float within the size limits of queries.
#pragma once

#include "engine/geometry/shapes.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace plumb {

class FuzzInput {
  public:
    FuzzInput(const std::uint8_t *data, std::size_t size) : data_(data), left_(size) {}

    bool is_empty() const { return left_ == 0; }
    std::uint8_t byte() {
        if (left_ == 0)
            return 0;
        --left_;
        return *data_++;
    }
    std::uint32_t below(std::uint32_t count) { return byte() % count; }

    // Magnitude at most 1e5.
    Real number() {
        const std::uint8_t kind = byte();
        if (kind < 160)
            return static_cast<Real>(static_cast<int>(kind % 17) - 8) * Real(0.25);
        if (kind < 200)
            return std::ldexp(Real(1), static_cast<int>(kind % 27) - 10);
        std::uint32_t bits = 0;
        for (int i = 0; i < 4; ++i)
            bits = bits << 8 | byte();
        float any = 0;
        std::memcpy(&any, &bits, sizeof any);
        return std::isfinite(any) && std::abs(any) <= 1e5f ? static_cast<Real>(any) : Real(1);
    }
    // From 1e-3 to 1e5.
    Real size() {
        const Real n = std::abs(number());
        return n < Real(1e-3) ? Real(1e-3) : n;
    }
    Vec3 point() {
        const Real x = number(), y = number(), z = number();
        return {x, y, z};
    }
    Quat rotation() {
        const Real w = number(), x = number(), y = number(), z = number();
        const Real length = std::hypot(std::hypot(w, x), std::hypot(y, z));
        if (!(length > Real(1e-6)))
            return identity_rotation;
        return {w / length, x / length, y / length, z / length};
    }
    Aabb aabb() {
        const Vec3 a = point(), b = point();
        return {glm::min(a, b), glm::max(a, b)};
    }

  private:
    const std::uint8_t *data_;
    std::size_t left_;
};

} // namespace plumb

// Traps when an answer contradicts itself.
#define FUZZ_ASSERT(condition)                                                                     \
    do {                                                                                           \
        if (!(condition))                                                                          \
            __builtin_trap();                                                                      \
    } while (false)
