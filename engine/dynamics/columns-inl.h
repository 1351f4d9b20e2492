// Columns as vectors of lanes. Included by files that Highway compiles once for each instruction
// set, and like them once for each. Nothing is fused or reordered by width: each lane sees the same
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

struct Symmetric {
    Lanes xx, yy, zz, xy, xz, yz;
};

HWY_INLINE Lanes all(Real x) {
    return hn::Set(tag, x);
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

// Three Reals of each lane's body or particle, `offset` Reals from where it begins.
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

} // namespace columns::HWY_NAMESPACE
} // namespace plumb::inline PLUMB_PRECISION
HWY_AFTER_NAMESPACE();

#endif
