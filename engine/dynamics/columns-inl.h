// Columns as vectors of lanes. Included by files that Highway compiles once per instruction set,
// and so compiled once for each. Nothing is fused or reordered by width: each lane sees the same
// operations whatever the processor.
#if defined(PLUMB_DYNAMICS_COLUMNS) == defined(HWY_TARGET_TOGGLE)
#ifdef PLUMB_DYNAMICS_COLUMNS
#undef PLUMB_DYNAMICS_COLUMNS
#else
#define PLUMB_DYNAMICS_COLUMNS
#endif

#include "engine/dynamics/columns.h"
#include "engine/math/wide_vector-inl.h"

#include <hwy/highway.h>

#include <algorithm>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace plumb::inline PLUMB_PRECISION {
namespace columns::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<Real, column_lanes>;
using IndexTag = hn::RebindToSigned<Tag>;
using Lanes = hn::Vec<Tag>;
using Indices = hn::Vec<IndexTag>;
using Vector = wide::HWY_NAMESPACE::Vector<Lanes>;
using wide::HWY_NAMESPACE::cross;
using wide::HWY_NAMESPACE::dot;
using wide::HWY_NAMESPACE::max;
using wide::HWY_NAMESPACE::min;
using wide::HWY_NAMESPACE::minus;
using wide::HWY_NAMESPACE::plus;
using wide::HWY_NAMESPACE::times;
constexpr Tag tag{};
using Mask = hn::Mask<Tag>;

struct Symmetric {
    Lanes xx, yy, zz, xy, xz, yz;
};

HWY_INLINE Lanes all(Real x) {
    return hn::Set(tag, x);
}

HWY_INLINE Vector zeros() {
    return {hn::Zero(tag), hn::Zero(tag), hn::Zero(tag)};
}

HWY_INLINE Vector choose(Mask which, const Vector &yes, const Vector &no) {
    return {hn::IfThenElse(which, yes.x, no.x), hn::IfThenElse(which, yes.y, no.y),
            hn::IfThenElse(which, yes.z, no.z)};
}

// As bits, lane by lane within the block.
HWY_INLINE unsigned bits_of(Mask mask, std::size_t lane) {
    if (hn::AllFalse(tag, mask))
        return 0;
    HWY_ALIGN Real ones[column_lanes];
    hn::Store(hn::IfThenElseZero(mask, all(Real(1))), tag, ones);
    unsigned bits = 0;
    for (std::size_t k = 0; k < hn::Lanes(tag); ++k)
        bits |= ones[k] != Real(0) ? 1U << (lane + k) : 0U;
    return bits;
}

// The reverse.
HWY_INLINE Mask lanes_of(unsigned bits, std::size_t lane) {
    static constexpr IndexColumn powers{{1 << 0, 1 << 1, 1 << 2, 1 << 3, 1 << 4, 1 << 5, 1 << 6,
                                         1 << 7, 1 << 8, 1 << 9, 1 << 10, 1 << 11, 1 << 12, 1 << 13,
                                         1 << 14, 1 << 15}};
    constexpr IndexTag index_tag{};
    const auto all_bits = hn::Set(index_tag, static_cast<IndexColumn::Index>(bits));
    const auto power = hn::Load(index_tag, powers.lanes + lane);
    return hn::RebindMask(tag, hn::Eq(hn::And(all_bits, power), power));
}

HWY_INLINE Lanes load(const Column &from, std::size_t lane) {
    return hn::Load(tag, from.lanes + lane);
}
HWY_INLINE Vector load(const Columns3 &from, std::size_t lane) {
    return {load(from.x, lane), load(from.y, lane), load(from.z, lane)};
}
HWY_INLINE Symmetric load(const ColumnsSymmetric &from, std::size_t lane) {
    return {load(from.xx, lane), load(from.yy, lane), load(from.zz, lane),
            load(from.xy, lane), load(from.xz, lane), load(from.yz, lane)};
}
HWY_INLINE Indices load(const IndexColumn &from, std::size_t lane) {
    return hn::Load(IndexTag{}, from.lanes + lane);
}
HWY_INLINE void store(Lanes v, Column &to, std::size_t lane) {
    hn::Store(v, tag, to.lanes + lane);
}
HWY_INLINE void store(const Vector &v, Columns3 &to, std::size_t lane) {
    store(v.x, to.x, lane);
    store(v.y, to.y, lane);
    store(v.z, to.z, lane);
}

HWY_INLINE Vector times(const Symmetric &m, const Vector &v) {
    return {hn::Add(hn::Add(hn::Mul(m.xx, v.x), hn::Mul(m.xy, v.y)), hn::Mul(m.xz, v.z)),
            hn::Add(hn::Add(hn::Mul(m.xy, v.x), hn::Mul(m.yy, v.y)), hn::Mul(m.yz, v.z)),
            hn::Add(hn::Add(hn::Mul(m.xz, v.x), hn::Mul(m.yz, v.y)), hn::Mul(m.zz, v.z))};
}

// Three Reals of each lane's body or particle, starting `offset` Reals in.
HWY_INLINE Vector gather(const Real *first, int offset, Indices index) {
    const Real *from = first + offset;
    return {hn::GatherIndex(tag, from, index), hn::GatherIndex(tag, from + 1, index),
            hn::GatherIndex(tag, from + 2, index)};
}

// The reverse, for the lanes whose bits are set in `writes`.
HWY_INLINE void scatter(const Vector &v, Real *first, int offset, const IndexColumn &index,
                        unsigned writes, std::size_t lane) {
    HWY_ALIGN Real out[3][column_lanes];
    hn::Store(v.x, tag, out[0]);
    hn::Store(v.y, tag, out[1]);
    hn::Store(v.z, tag, out[2]);
    for (std::size_t k = 0; k < hn::Lanes(tag); ++k) {
        if (((writes >> (lane + k)) & 1U) == 0)
            continue;
        Real *to = first + index.lanes[lane + k] + offset;
        to[0] = out[0][k];
        to[1] = out[1][k];
        to[2] = out[2][k];
    }
}

#if HWY_TARGET == HWY_SCALAR

HWY_INLINE Vector gather_rows(const Real *first, int offset, const IndexColumn &index,
                              std::size_t lane) {
    return gather(first, offset, load(index, lane));
}
HWY_INLINE void scatter_rows(const Vector &v, const Vector &next, Real *first, int offset,
                             const IndexColumn &index, unsigned writes, std::size_t lane) {
    scatter(v, first, offset, index, writes, lane);
    scatter(next, first, offset + 3, index, writes, lane);
}

#else

// Transposes between rows of four Reals and blocks of four lanes, where Reals are float and vectors
// hold whole blocks. Gathering and scattering single Reals costs as much as all the arithmetic of a
// contact (AMD Zen 4).
template <typename D>
constexpr bool has_blocks = sizeof(hn::TFromD<D>) == 4 && sizeof(hn::Vec<D>) >= 16;

// Loads the rows of every fourth lane.
template <typename D>
HWY_INLINE hn::Vec<D> load_rows(D d, const Real *from, const IndexColumn::Index *index) {
    if constexpr (sizeof(hn::Vec<D>) == 16) {
        return hn::LoadU(d, from + *index);
    } else {
        constexpr hn::Half<D> half{};
        return hn::Combine(d, load_rows(half, from, index + hn::Lanes(half)),
                           load_rows(half, from, index));
    }
}

// Transposes each block of four lanes.
template <typename D>
HWY_INLINE void transpose(D d, hn::Vec<D> &a, hn::Vec<D> &b, hn::Vec<D> &c, hn::Vec<D> &e) {
    constexpr hn::Repartition<std::uint64_t, D> pairs{};
    const auto lower_ab = hn::BitCast(pairs, hn::InterleaveLower(d, a, b));
    const auto lower_ce = hn::BitCast(pairs, hn::InterleaveLower(d, c, e));
    const auto upper_ab = hn::BitCast(pairs, hn::InterleaveUpper(d, a, b));
    const auto upper_ce = hn::BitCast(pairs, hn::InterleaveUpper(d, c, e));
    a = hn::BitCast(d, hn::InterleaveLower(pairs, lower_ab, lower_ce));
    b = hn::BitCast(d, hn::InterleaveUpper(pairs, lower_ab, lower_ce));
    c = hn::BitCast(d, hn::InterleaveLower(pairs, upper_ab, upper_ce));
    e = hn::BitCast(d, hn::InterleaveUpper(pairs, upper_ab, upper_ce));
}

// Like gather(), but reads four Reals: at least one must follow the three.
template <typename D = Tag>
HWY_INLINE Vector gather_rows(const Real *first, int offset, const IndexColumn &index,
                              std::size_t lane) {
    if constexpr (has_blocks<D>) {
        constexpr D d{};
        const Real *from = first + offset;
        const IndexColumn::Index *at = index.lanes + lane;
        hn::Vec<D> x = load_rows(d, from, at);
        hn::Vec<D> y = load_rows(d, from, at + 1);
        hn::Vec<D> z = load_rows(d, from, at + 2);
        hn::Vec<D> unused = load_rows(d, from, at + 3);
        transpose(d, x, y, z, unused);
        return {x, y, z};
    } else {
        return gather(first, offset, load(index, lane));
    }
}

// Like scatter(), for two vectors stored one after the other.
template <typename D = Tag>
HWY_INLINE void scatter_rows(const Vector &v, const Vector &next, Real *first, int offset,
                             const IndexColumn &index, unsigned writes, std::size_t lane) {
    if constexpr (has_blocks<D>) {
        constexpr D d{};
        HWY_ALIGN Real four[4][column_lanes];
        HWY_ALIGN Real two[4][column_lanes];
        const auto store_rows = [&](hn::Vec<D> a, hn::Vec<D> b, hn::Vec<D> c, hn::Vec<D> e,
                                    Real(*to)[column_lanes]) HWY_ATTR {
            transpose(d, a, b, c, e);
            hn::Store(a, d, to[0]);
            hn::Store(b, d, to[1]);
            hn::Store(c, d, to[2]);
            hn::Store(e, d, to[3]);
        };
        store_rows(v.x, v.y, v.z, next.x, four);
        store_rows(next.y, next.z, hn::Zero(d), hn::Zero(d), two);
        for (std::size_t k = 0; k < hn::Lanes(d); ++k) {
            if (((writes >> (lane + k)) & 1U) == 0)
                continue;
            Real *to = first + index.lanes[lane + k] + offset;
            const std::size_t block = k / 4 * 4;
            std::copy_n(four[k % 4] + block, 4, to);
            std::copy_n(two[k % 4] + block, 2, to + 4);
        }
    } else {
        scatter(v, first, offset, index, writes, lane);
        scatter(next, first, offset + 3, index, writes, lane);
    }
}

#endif

} // namespace columns::HWY_NAMESPACE
} // namespace plumb::inline PLUMB_PRECISION
HWY_AFTER_NAMESPACE();

#endif
