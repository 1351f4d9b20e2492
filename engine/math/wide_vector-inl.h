// SIMD vectors: as many Vec3 side by side as the processor handles. Included by files that Highway
// compiles once for each instruction set, and compiled as often.
//
// Nothing is fused, and min and max choose between +0 and -0 as std::min and std::max do, so each
// lane has the bits of the scalar functions on every processor.
#if defined(PLUMB_MATH_WIDE_VECTOR) == defined(HWY_TARGET_TOGGLE)
#ifdef PLUMB_MATH_WIDE_VECTOR
#undef PLUMB_MATH_WIDE_VECTOR
#else
#define PLUMB_MATH_WIDE_VECTOR
#endif

#include "engine/math/types.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace plumb::inline PLUMB_PRECISION {
namespace wide::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// If equal, the first.
template <typename Lanes> HWY_INLINE Lanes min(Lanes a, Lanes b) {
    return hn::IfThenElse(hn::Lt(b, a), b, a);
}
template <typename Lanes> HWY_INLINE Lanes max(Lanes a, Lanes b) {
    return hn::IfThenElse(hn::Lt(a, b), b, a);
}

// In GLM's order of operations.
template <typename Lanes> struct Vector { Lanes x, y, z; };
template <typename Lanes>
HWY_INLINE Vector<Lanes> minus(const Vector<Lanes> &a, const Vector<Lanes> &b) {
    return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
template <typename Lanes>
HWY_INLINE Vector<Lanes> plus(const Vector<Lanes> &a, const Vector<Lanes> &b) {
    return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
template <typename Lanes> HWY_INLINE Vector<Lanes> times(Lanes s, const Vector<Lanes> &a) {
    return {hn::Mul(s, a.x), hn::Mul(s, a.y), hn::Mul(s, a.z)};
}
template <typename Lanes>
HWY_INLINE Vector<Lanes> times(const Vector<Lanes> &a, const Vector<Lanes> &b) {
    return {hn::Mul(a.x, b.x), hn::Mul(a.y, b.y), hn::Mul(a.z, b.z)};
}
template <typename Lanes> HWY_INLINE Lanes dot(const Vector<Lanes> &a, const Vector<Lanes> &b) {
    return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
template <typename Lanes>
HWY_INLINE Vector<Lanes> cross(const Vector<Lanes> &a, const Vector<Lanes> &b) {
    return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(b.y, a.z)),
            hn::Sub(hn::Mul(a.z, b.x), hn::Mul(b.z, a.x)),
            hn::Sub(hn::Mul(a.x, b.y), hn::Mul(b.x, a.y))};
}

} // namespace wide::HWY_NAMESPACE
} // namespace plumb::inline PLUMB_PRECISION
HWY_AFTER_NAMESPACE();

#endif
