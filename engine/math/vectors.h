// Vector functions that GLM lacks: for zero, tiny and huge vectors, and accurate near 0 and pi.
//
// For finite vectors; non-finite ones give non-finite results.
#pragma once

#include "engine/math/types.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

template <int N> using VecN = glm::vec<N, Real, glm::defaultp>;

// a b - c d, off by at most 1.5 ulp however much cancels (Kahan's algorithm; Jeannerod, Louvet,
// Muller 2013, "Further analysis of Kahan's algorithm for the accurate computation of 2x2
// determinants").
inline Real difference_of_products(Real a, Real b, Real c, Real d) {
    if constexpr (sizeof(Real) == sizeof(float)) {
        // Products of floats are exact in double.
        return static_cast<Real>(double(a) * double(b) - double(c) * double(d));
    } else {
        const Real cd = c * d;
        const Real error = std::fma(-c, d, cd);
        return std::fma(a, b, -cd) + error;
    }
}

// a x b with each component accurate to its last place, so it keeps its direction when a and b are
// nearly parallel, where glm::cross is nothing but rounding.
inline Vec3 accurate_cross(const Vec3 &a, const Vec3 &b) {
    return {difference_of_products(a.y, b.z, a.z, b.y), difference_of_products(a.z, b.x, a.x, b.z),
            difference_of_products(a.x, b.y, a.y, b.x)};
}
// The third component of the cross product of two vectors in the xy plane.
inline Real accurate_cross(const Vec2 &a, const Vec2 &b) {
    return difference_of_products(a.x, b.y, a.y, b.x);
}

// Each component's magnitude. glm::abs asks for each sign, which is hard to foresee, and leaves -0.
inline Vec3 magnitudes(const Vec3 &v) {
    return {std::abs(v.x), std::abs(v.y), std::abs(v.z)};
}

template <int N> Real largest_magnitude(const VecN<N> &v) {
    Real largest = std::abs(v[0]);
    for (int i = 1; i < N; ++i)
        largest = std::max(largest, std::abs(v[i]));
    return largest;
}

// v times the power of two that brings its largest component to [1, 2): exact, except for
// components too small to matter. Zero and non-finite vectors stay as they are.
template <int N> VecN<N> rescaled(VecN<N> v) {
    const Real largest = largest_magnitude<N>(v);
    if (largest == Real(0) || !std::isfinite(largest))
        return v;
    const int exponent = std::ilogb(largest);
    for (int i = 0; i < N; ++i)
        v[i] = std::scalbn(v[i], -exponent);
    return v;
}

// The unit vector along v, for every length from the smallest float to the largest; none for zero.
template <int N> std::optional<VecN<N>> normalized(const VecN<N> &v) {
    // The squared length neither overflows nor loses digits here.
    const Real squared = glm::dot(v, v);
    constexpr Real low = std::numeric_limits<Real>::min() / std::numeric_limits<Real>::epsilon();
    if (squared > low && squared <= std::numeric_limits<Real>::max())
        return v / std::sqrt(squared);
    if (largest_magnitude<N>(v) == Real(0))
        return std::nullopt;
    const VecN<N> scaled = rescaled<N>(v);
    return scaled / glm::length(scaled);
}

// The same, with a fallback for zero.
template <int N> VecN<N> normalized_or(const VecN<N> &v, const VecN<N> &if_zero) {
    return normalized<N>(v).value_or(if_zero);
}

// The angle between two vectors, 0 to pi; 0 when either is zero. Accurate to a few ulp even near 0
// and pi, where the arc cosine of the dot product loses half its digits or more: it is the arc
// tangent (Kahan 2006, "How Futile are Mindless Assessments of Roundoff in Floating-Point
// Computation?", section 12) of a cross product that does not cancel.
inline Real angle_between(const Vec3 &a, const Vec3 &b) {
    const Vec3 u = rescaled<3>(a), v = rescaled<3>(b);
    return std::atan2(glm::length(accurate_cross(u, v)), glm::dot(u, v));
}
inline Real angle_between(const Vec2 &a, const Vec2 &b) {
    const Vec2 u = rescaled<2>(a), v = rescaled<2>(b);
    return std::atan2(std::abs(accurate_cross(u, v)), glm::dot(u, v));
}

// The part of v along `axis`, which may have any length. Zero for a zero axis.
template <int N> VecN<N> projection(const VecN<N> &v, const VecN<N> &axis) {
    const VecN<N> n = rescaled<N>(axis);
    const Real squared = glm::dot(n, n);
    if (squared == Real(0))
        return VecN<N>{Real(0)};
    return (glm::dot(v, n) / squared) * n;
}

// The part of v perpendicular to `axis`; v itself for a zero axis. Uses cross products, so it is
// perpendicular even when v is nearly along the axis and v - projection is nothing but rounding.
inline Vec3 rejection(const Vec3 &v, const Vec3 &axis) {
    const Vec3 n = rescaled<3>(axis);
    const Real squared = glm::dot(n, n);
    if (squared == Real(0))
        return v;
    return glm::cross(n, accurate_cross(v, n)) / squared;
}
inline Vec2 rejection(const Vec2 &v, const Vec2 &axis) {
    const Vec2 n = rescaled<2>(axis);
    const Real squared = glm::dot(n, n);
    if (squared == Real(0))
        return v;
    return (accurate_cross(n, v) / squared) * Vec2{-n.y, n.x};
}

// v mirrored in the plane (in 2D, the line) through the origin with this normal, of any length; v
// itself for a zero normal. glm::reflect needs a unit normal.
template <int N> VecN<N> reflection(const VecN<N> &v, const VecN<N> &normal) {
    return v - Real(2) * projection<N>(v, normal);
}

} // namespace plumb::inline PLUMB_PRECISION
