// Distances from triangles in long double, with a proof: a range whose upper end is the distance
// between two points in the shapes, and whose lower end is the distance between two planes
// separating them. So it is correct however the points and planes were found.
#pragma once

#include "engine/core/random.h"
#include "engine/geometry/shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

namespace plumb::inline PLUMB_PRECISION {
namespace wide_triangle {

using Wide3 = glm::vec<3, long double, glm::defaultp>;
using WideTriangle = std::array<Wide3, 3>;

constexpr long double epsilon = std::numeric_limits<Real>::epsilon();

inline Wide3 wide(const Vec3 &v) {
    return Wide3(v);
}
inline WideTriangle wide(const Triangle &t) {
    return {wide(t.a), wide(t.b), wide(t.c)};
}

inline long double largest_of(const Vec3 &v) {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}
inline long double largest_of(const Triangle &t) {
    return std::max({largest_of(t.a), largest_of(t.b), largest_of(t.c)});
}

struct Range {
    long double low = 0.0L;
    long double high = std::numeric_limits<long double>::infinity();
};

// (b - a) x (c - a), in quadruple precision, which narrow triangles need.
inline Wide3 wide_cross(const WideTriangle &t) {
    __extension__ typedef __float128 Quad;
    const auto component = [&](int i, int j) {
        const auto edge = [&](std::size_t corner, int k) {
            return Quad(t[corner][k]) - Quad(t[0][k]);
        };
        return static_cast<long double>(edge(1, i) * edge(2, j) - edge(1, j) * edge(2, i));
    };
    return {component(1, 2), component(2, 0), component(0, 1)};
}

// Unit; zero when the triangle is flat.
inline Wide3 wide_normal(const WideTriangle &t) {
    const Wide3 n = wide_cross(t);
    const long double length = glm::length(n);
    return length > 0.0L ? n / length : n;
}

inline Wide3 nearest_on_segment(const Wide3 &a, const Wide3 &b, const Wide3 &p) {
    const Wide3 e = b - a;
    const long double squared = glm::dot(e, e);
    const long double s =
        squared > 0.0L ? std::clamp(glm::dot(p - a, e) / squared, 0.0L, 1.0L) : 0.0L;
    return s > 0.5L ? b - (1.0L - s) * e : a + s * e;
}

// A point of the triangle that is the nearest, or close to it.
inline Wide3 nearest_on_triangle(const WideTriangle &t, const Wide3 &p) {
    Wide3 nearest = nearest_on_segment(t[0], t[1], p);
    const auto consider = [&](const Wide3 &q) {
        if (glm::distance(q, p) < glm::distance(nearest, p))
            nearest = q;
    };
    consider(nearest_on_segment(t[1], t[2], p));
    consider(nearest_on_segment(t[2], t[0], p));
    // Inside: along the longest edge, and in the cross section there.
    std::size_t k = 0;
    for (std::size_t i = 1; i < 3; ++i)
        if (glm::distance(t[i], t[(i + 1) % 3]) > glm::distance(t[k], t[(k + 1) % 3]))
            k = i;
    const Wide3 &a = t[k], &b = t[(k + 1) % 3], &c = t[(k + 2) % 3];
    const Wide3 e = b - a;
    const long double squared = glm::dot(e, e);
    if (!(squared > 0.0L))
        return nearest;
    const long double apex = std::clamp(glm::dot(c - a, e) / squared, 0.0L, 1.0L);
    const long double s = glm::dot(p - a, e) / squared;
    if (s < 0.0L || s > 1.0L)
        return nearest;
    const Wide3 top = s < apex ? a + s / apex * (c - a)
                               : (apex < 1.0L ? b + (1.0L - s) / (1.0L - apex) * (c - b) : c);
    consider(nearest_on_segment(a + s * e, top, p));
    return nearest;
}

// The distance between planes perpendicular to u that separate the triangle from p and q.
inline long double gap_along(const Wide3 &u, const WideTriangle &t, const Wide3 &p,
                             const Wide3 &q) {
    const long double length = glm::length(u);
    if (!(length > 0.0L))
        return 0.0L;
    long double gap = std::numeric_limits<long double>::infinity();
    for (const Wide3 &corner : t)
        gap = std::min({gap, glm::dot(u, p - corner), glm::dot(u, q - corner)});
    return gap / length;
}

inline void raise(Range &range, const Wide3 &u, const WideTriangle &t, const Wide3 &p,
                  const Wide3 &q) {
    range.low = std::max({range.low, gap_along(u, t, p, q), gap_along(-u, t, p, q)});
}

inline Range distance_to_triangle(const WideTriangle &t, const Wide3 &p) {
    const Wide3 nearest = nearest_on_triangle(t, p);
    Range range{0.0L, glm::distance(nearest, p)};
    raise(range, p - nearest, t, p, p);
    raise(range, wide_normal(t), t, p, p);
    return range;
}

inline Range distance_of_segment_to_triangle(const WideTriangle &t, const Wide3 &p,
                                             const Wide3 &q) {
    Range range;
    Wide3 best{0.0L};
    const Wide3 d = q - p;
    const Wide3 n = wide_normal(t);
    raise(range, n, t, p, q);
    const long double rounding = 1e-18L * (glm::length(t[0]) + glm::length(p));
    const auto is_proven = [&] { return range.high <= range.low + 1e-16L * range.low + rounding; };
    const auto consider = [&](long double s) {
        if (is_proven() || !(s >= 0.0L && s <= 1.0L))
            return;
        // Alternating between the two sets gets closer.
        Wide3 x = p + s * d;
        for (int i = 0; i < 2; ++i) {
            const Wide3 y = nearest_on_triangle(t, x);
            if (glm::distance(x, y) < range.high) {
                range.high = glm::distance(x, y);
                best = x - y;
            }
            x = nearest_on_segment(p, q, y);
        }
        raise(range, best, t, p, q);
    };
    consider(0.0L);
    consider(1.0L);
    const long double height_p = glm::dot(n, p - t[0]), height_q = glm::dot(n, q - t[0]);
    consider(height_p / (height_p - height_q));
    for (std::size_t i = 0; i < 3 && !is_proven(); ++i) {
        const Wide3 &a = t[i], &b = t[(i + 1) % 3];
        const Wide3 across = glm::cross(d, b - a);
        raise(range, across, t, p, q);
        consider(glm::dot(glm::cross(a - p, b - a), across) / glm::dot(across, across));
        consider(glm::dot(a - p, d) / glm::dot(d, d));
    }
    return range;
}

// Whether any of the triangle is left inside a box grown (or shrunk) by this much.
inline bool clipped_by_box(const Triangle &t, const Box &box, long double grown) {
    using WideQuat = glm::qua<long double, glm::defaultp>;
    const WideQuat to_local = glm::normalize(WideQuat(
        static_cast<long double>(box.rotation.w), -static_cast<long double>(box.rotation.x),
        -static_cast<long double>(box.rotation.y), -static_cast<long double>(box.rotation.z)));
    std::vector<Wide3> polygon;
    for (const Wide3 &corner : wide(t))
        polygon.push_back(to_local * (corner - wide(box.center)));
    for (int axis = 0; axis < 3; ++axis) {
        const long double limit = static_cast<long double>(box.half_extents[axis]) + grown;
        for (const long double side : {-1.0L, 1.0L}) {
            std::vector<Wide3> rest;
            for (std::size_t i = 0; i < polygon.size(); ++i) {
                const Wide3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
                const long double above_a = side * a[axis] - limit,
                                  above_b = side * b[axis] - limit;
                if (above_a <= 0.0L)
                    rest.push_back(a);
                if ((above_a < 0.0L && above_b > 0.0L) || (above_a > 0.0L && above_b < 0.0L))
                    rest.push_back(a + above_a / (above_a - above_b) * (b - a));
            }
            polygon = rest;
        }
    }
    return !polygon.empty();
}

// --- Inputs of every kind.

inline Vec3 any_offset(Random &random, double size) {
    return {static_cast<Real>(random.next_in(-size, size)),
            static_cast<Real>(random.next_in(-size, size)),
            static_cast<Real>(random.next_in(-size, size))};
}

// Any rotation, a quarter turn, or a tiny one.
inline Quat any_rotation(Random &random) {
    const double angle[] = {random.next_in(-3.0, 3.0), 1.5707963267948966,
                            random.next_in(-1.0, 1.0) * 1e-6, 0.7853981633974483};
    const Vec3 axis = random.next_index(2) == 0
                          ? glm::normalize(any_offset(random, 1.0))
                          : Vec3{Real(0), Real(random.next_index(2)), Real(1)};
    return glm::normalize(
        glm::angleAxis(static_cast<Real>(angle[random.next_index(4)]), glm::normalize(axis)));
}

// Sizes from 1e-3 to 1e5, up to 1e5 from the origin; many narrow, nearly flat or flat.
inline Triangle awkward_triangle(Random &random) {
    const double size = std::pow(10.0, random.next_in(-3.0, 5.0));
    const double narrow = std::pow(10.0, random.next_in(-17.0, 0.0));
    const Vec3 at = any_offset(random, random.next_index(2) == 0 ? size : 1e5);
    Triangle t{at, at + any_offset(random, size), at + any_offset(random, size)};
    const Real s = static_cast<Real>(random.next_in(-0.5, 1.5));
    switch (random.next_index(6)) {
    case 0: // a needle
        t.c = t.b + any_offset(random, size * narrow);
        break;
    case 1: // the third corner near the line through the others
        t.c = t.a + s * (t.b - t.a) + any_offset(random, size * narrow);
        break;
    case 2: // flat, seen along an axis: exactly or nearly
        t.c = t.a + s * (t.b - t.a);
        t.a.y = t.b.y = t.c.y;
        t.a.z = t.b.z = t.c.z;
        t.c.y += random.next_index(2) == 0 ? Real(0) : static_cast<Real>(size * narrow);
        break;
    case 3:
        t.c = t.a;
        break;
    default:
        break;
    }
    return t;
}

} // namespace wide_triangle
} // namespace plumb::inline PLUMB_PRECISION
