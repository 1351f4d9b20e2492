// Exact rational arithmetic for oracles: takes the engine's numbers at face value, with nothing
// rounded.
#pragma once

#include "engine/math/types.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <boost/multiprecision/gmp.hpp>

namespace plumb::inline PLUMB_PRECISION {
namespace exact_oracle {

using Rational = boost::multiprecision::mpq_rational;

struct Rational2 {
    Rational x, y;
};

struct Rational3 {
    Rational x, y, z;
};

inline Rational rational(Real value) {
    return Rational(double(value));
}
inline Rational2 rational(const Vec2 &v) {
    return {rational(v.x), rational(v.y)};
}
inline Rational3 rational(const Vec3 &v) {
    return {rational(v.x), rational(v.y), rational(v.z)};
}

inline Rational3 operator+(const Rational3 &a, const Rational3 &b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Rational3 operator-(const Rational3 &a, const Rational3 &b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Rational3 operator*(const Rational &s, const Rational3 &v) {
    return {s * v.x, s * v.y, s * v.z};
}
inline bool operator==(const Rational3 &a, const Rational3 &b) {
    return a.x == b.x && a.y == b.y && a.z == b.z;
}
inline Rational dot(const Rational3 &a, const Rational3 &b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Rational3 cross(const Rational3 &a, const Rational3 &b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline bool is_zero(const Rational3 &v) {
    return v.x == 0 && v.y == 0 && v.z == 0;
}

// The side of the plane that the point is on, taking the plane's numbers at face value: in long
// double where that is enough.
inline int side_of(const Vec3 &normal, Real offset, const Vec3 &p) {
    long double height = -static_cast<long double>(offset), size = std::abs(height);
    for (int i = 0; i < 3; ++i) {
        const long double term =
            static_cast<long double>(normal[i]) * static_cast<long double>(p[i]);
        height += term;
        size += std::abs(term);
    }
    // Six roundings, each below 2^-64.
    if (std::abs(height) > 0x1p-60L * size)
        return height > 0 ? 1 : -1;
    return Rational(dot(rational(normal), rational(p)) - rational(offset)).sign();
}

// Unit normals that are only rounded in floats, and ones that are exact.
inline constexpr std::array<Vec3, 4> plane_normals{{{Real(0), Real(1), Real(0)},
                                                    {Real(-1), Real(0), Real(0)},
                                                    {Real(0.6), Real(0), Real(-0.8)},
                                                    {Real(0.48), Real(-0.6), Real(0.64)}}};

// --- Separating axes of polytopes with integer coordinates. Nothing rounds or overflows while
// coordinates stay below 2^12 for 64 bits, or 2^24 for 128.

__extension__ typedef __int128 Int128;

template <typename Whole> struct Whole3 {
    Whole x, y, z;

    friend Whole3 operator-(const Whole3 &a, const Whole3 &b) {
        return {a.x - b.x, a.y - b.y, a.z - b.z};
    }
    friend Whole dot(const Whole3 &a, const Whole3 &b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
    friend Whole3 cross(const Whole3 &a, const Whole3 &b) {
        return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    }
    friend bool is_zero(const Whole3 &v) { return v.x == 0 && v.y == 0 && v.z == 0; }
};

// v * scale - offset, which must come out an integer.
template <typename Whole> Whole3<Whole> whole(const Vec3 &v, double scale, int offset = 0) {
    const auto component = [&](Real x) {
        return Whole(static_cast<long long>(double(x) * scale) - offset);
    };
    return {component(v.x), component(v.y), component(v.z)};
}

// The hull of points, with the directions of its edges (and perhaps more).
template <typename Whole> struct Polytope {
    std::array<Whole3<Whole>, 8> points;
    std::size_t point_count;
    std::array<Whole3<Whole>, 3> edges;
    std::size_t edge_count;

    static Polytope point(const Whole3<Whole> &a) { return {{a}, 1, {}, 0}; }
    static Polytope segment(const Whole3<Whole> &a, const Whole3<Whole> &b) {
        return {{a, b}, 2, {b - a}, 1};
    }
    static Polytope triangle(const Whole3<Whole> &a, const Whole3<Whole> &b,
                             const Whole3<Whole> &c) {
        return {{a, b, c}, 3, {b - a, c - b, a - c}, 3};
    }
    static Polytope box(const Whole3<Whole> &low, const Whole3<Whole> &high) {
        Polytope box{{}, 8, {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, 3};
        for (std::size_t k = 0; k < 8; ++k)
            box.points[k] = {(k & 1) != 0 ? high.x : low.x, (k & 2) != 0 ? high.y : low.y,
                             (k & 4) != 0 ? high.z : low.z};
        return box;
    }
};

template <typename Whole>
bool separates(const Whole3<Whole> &axis, const Polytope<Whole> &a, const Polytope<Whole> &b) {
    const auto extent = [&](const Polytope<Whole> &p) {
        std::pair<Whole, Whole> range(dot(axis, p.points[0]), dot(axis, p.points[0]));
        for (std::size_t i = 1; i < p.point_count; ++i) {
            const Whole height = dot(axis, p.points[i]);
            range = {std::min(range.first, height), std::max(range.second, height)};
        }
        return range;
    };
    const auto of_a = extent(a), of_b = extent(b);
    return of_a.second < of_b.first || of_b.second < of_a.first;
}

// Whether closed polytopes of any dimension meet. They do not when the origin is outside their
// Minkowski difference, whose edges are parallel to theirs. Then it is separated by a facet, with
// the normal u x v; for a polygon in the origin's plane by an edge, with the normal u x (u x v);
// for a segment or point by an end (u), its side, or the point itself (w).
template <typename Whole> bool polytopes_meet(const Polytope<Whole> &a, const Polytope<Whole> &b) {
    const Whole3<Whole> w = b.points[0] - a.points[0];
    if (separates(w, a, b))
        return false;
    std::array<Whole3<Whole>, 6> edges{};
    const std::size_t count = a.edge_count + b.edge_count;
    std::copy_n(b.edges.begin(), b.edge_count,
                std::copy_n(a.edges.begin(), a.edge_count, edges.begin()));
    for (std::size_t i = 0; i < count; ++i) {
        const Whole3<Whole> &u = edges[i];
        if (is_zero(u))
            continue;
        if (separates(u, a, b) || separates(cross(u, cross(u, w)), a, b))
            return false;
        for (std::size_t j = 0; j < count; ++j) {
            const Whole3<Whole> n = cross(u, edges[j]);
            if (is_zero(n))
                continue;
            if ((i < j && separates(n, a, b)) || separates(cross(u, n), a, b))
                return false;
        }
    }
    return true;
}

} // namespace exact_oracle
} // namespace plumb::inline PLUMB_PRECISION
