// Four Reals side by side. Included by files that Highway compiles once for each instruction set,
// and compiled as often. Nothing is fused or reordered: each lane has the bits of the scalar
// operations, on every processor.
#if defined(PLUMB_MATH_FOUR) == defined(HWY_TARGET_TOGGLE)
#ifdef PLUMB_MATH_FOUR
#undef PLUMB_MATH_FOUR
#else
#define PLUMB_MATH_FOUR
#endif

#include "engine/math/types.h"

#include <hwy/highway.h>

#include <array>

HWY_BEFORE_NAMESPACE();
namespace plumb::inline PLUMB_PRECISION {
namespace wide::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using FourTag = hn::CappedTag<Real, 4>;
inline constexpr std::size_t four_lanes = hn::MaxLanes(FourTag{});
inline constexpr std::size_t four_parts = 4 / four_lanes;

struct Four {
    std::array<hn::Vec<FourTag>, four_parts> part;
};

template <typename Part> HWY_INLINE Four each_part(const Part &part) {
    if constexpr (four_parts == 1)
        return {{part(0)}};
    else if constexpr (four_parts == 2)
        return {{part(0), part(1)}};
    else
        return {{part(0), part(1), part(2), part(3)}};
}

HWY_INLINE Four all(Real value) {
    return each_part([&](std::size_t) HWY_ATTR { return hn::Set(FourTag{}, value); });
}
HWY_INLINE Four load(const Real *values) {
    return each_part([&](std::size_t k)
                         HWY_ATTR { return hn::LoadU(FourTag{}, values + k * four_lanes); });
}
template <typename Lane> HWY_INLINE Four four(Lane a, Lane b, Lane c, Lane d) {
    const FourTag tag;
#if HWY_TARGET == HWY_SCALAR
    return {{hn::Set(tag, a), hn::Set(tag, b), hn::Set(tag, c), hn::Set(tag, d)}};
#else
    const auto low = hn::InterleaveLower(tag, hn::Set(tag, a), hn::Set(tag, b));
    const auto high = hn::InterleaveLower(tag, hn::Set(tag, c), hn::Set(tag, d));
    if constexpr (four_parts == 1)
        return {{hn::ConcatUpperLower(tag, high, low)}};
    else
        return {{low, high}};
#endif
}
HWY_INLINE void store(const Four &a, Real *values) {
    for (std::size_t k = 0; k < four_parts; ++k)
        hn::StoreU(a.part[k], FourTag{}, values + k * four_lanes);
}
// Of four rows of four, or into them: first all rows' first numbers, and so on.
HWY_INLINE void load_columns(const Real *rows, Four &a, Four &b, Four &c, Four &d) {
    for (std::size_t k = 0; k < four_parts; ++k)
        hn::LoadInterleaved4(FourTag{}, rows + 4 * k * four_lanes, a.part[k], b.part[k], c.part[k],
                             d.part[k]);
}
HWY_INLINE void store_columns(const Four &a, const Four &b, const Four &c, const Four &d,
                              Real *rows) {
    for (std::size_t k = 0; k < four_parts; ++k)
        hn::StoreInterleaved4(a.part[k], b.part[k], c.part[k], d.part[k], FourTag{},
                              rows + 4 * k * four_lanes);
}
HWY_INLINE Four operator+(const Four &a, const Four &b) {
    return each_part([&](std::size_t k) HWY_ATTR { return hn::Add(a.part[k], b.part[k]); });
}
HWY_INLINE Four operator-(const Four &a, const Four &b) {
    return each_part([&](std::size_t k) HWY_ATTR { return hn::Sub(a.part[k], b.part[k]); });
}
HWY_INLINE Four operator-(const Four &a) {
    return each_part([&](std::size_t k) HWY_ATTR { return hn::Neg(a.part[k]); });
}
HWY_INLINE Four operator*(const Four &a, const Four &b) {
    return each_part([&](std::size_t k) HWY_ATTR { return hn::Mul(a.part[k], b.part[k]); });
}
HWY_INLINE Four operator*(const Four &a, Real b) {
    return a * all(b);
}
HWY_INLINE Four operator/(const Four &a, const Four &b) {
    return each_part([&](std::size_t k) HWY_ATTR { return hn::Div(a.part[k], b.part[k]); });
}
HWY_INLINE Four abs(const Four &a) {
    return each_part([&](std::size_t k) HWY_ATTR { return hn::Abs(a.part[k]); });
}
HWY_INLINE Four sqrt(const Four &a) {
    return each_part([&](std::size_t k) HWY_ATTR { return hn::Sqrt(a.part[k]); });
}
HWY_INLINE Four max(const Four &a, const Four &b) {
    return each_part([&](std::size_t k) HWY_ATTR { return hn::Max(a.part[k], b.part[k]); });
}
HWY_INLINE Real first(const Four &a) {
    return hn::GetLane(a.part[0]);
}
// The greatest lane, in all lanes.
HWY_INLINE Four greatest(const Four &a) {
    auto most = a.part[0];
    for (std::size_t k = 1; k < four_parts; ++k)
        most = hn::Max(most, a.part[k]);
    most = hn::MaxOfLanes(FourTag{}, most);
    return each_part([&](std::size_t) HWY_ATTR { return most; });
}
// `then` in the lanes where a > b, else `otherwise`.
HWY_INLINE Four where_greater(const Four &a, const Four &b, const Four &then,
                              const Four &otherwise) {
    return each_part([&](std::size_t k) HWY_ATTR {
        return hn::IfThenElse(hn::Gt(a.part[k], b.part[k]), then.part[k], otherwise.part[k]);
    });
}
// Bit k: whether it holds in lane k.
template <typename Holds> HWY_INLINE unsigned bits_where(const Holds &holds) {
    unsigned result = 0;
    for (std::size_t k = 0; k < four_parts; ++k) {
        std::array<std::uint8_t, 8> bits{};
        hn::StoreMaskBits(FourTag{}, holds(k), bits.data());
        result |= static_cast<unsigned>(bits[0]) << (k * four_lanes);
    }
    return result;
}
HWY_INLINE unsigned greater_bits(const Four &a, const Four &b) {
    return bits_where([&](std::size_t k) HWY_ATTR { return hn::Gt(a.part[k], b.part[k]); });
}
HWY_INLINE unsigned equal_bits(const Four &a, const Four &b) {
    return bits_where([&](std::size_t k) HWY_ATTR { return hn::Eq(a.part[k], b.part[k]); });
}

} // namespace wide::HWY_NAMESPACE
} // namespace plumb::inline PLUMB_PRECISION
HWY_AFTER_NAMESPACE();

#endif
