// Slow, simple answers in the plane as a reference for the engine: signed distances of polygons in
// long double, and 128-bit integers where the answer must be exact. Shares no method with the
// engine.
#pragma once

#include "engine/core/random.h"
#include "engine/geometry/shapes_2d.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {
namespace oracle_2d {

constexpr double epsilon = double(std::numeric_limits<Real>::epsilon());

// --- In long double ----------------------------------------------------------------------------

using W = long double;
using Wide = glm::vec<2, W, glm::defaultp>;

inline Wide wide(const Vec2 &v) {
    return {W(v.x), W(v.y)};
}
inline W cross(const Wide &a, const Wide &b) {
    return a.x * b.y - a.y * b.x;
}
inline W length(const Wide &v) {
    return std::sqrt(v.x * v.x + v.y * v.y);
}
inline W segment_distance(const Wide &a, const Wide &b, const Wide &p) {
    const Wide d = b - a;
    const W dd = glm::dot(d, d);
    const W s = dd > 0 ? std::clamp(glm::dot(p - a, d) / dd, W(0), W(1)) : W(0);
    return length(p - a - s * d);
}

// Counter-clockwise and convex. Relative to `origin`, so that small polygons lose no digits far
// away.
struct Polygon {
    Wide origin{W(0)};
    std::array<Wide, 16> corners{};
    std::size_t count = 0;
    W size = 0; // largest distance of a corner from the origin

    void add(const Wide &corner) {
        corners[count++] = corner;
        size = std::max(size, length(corner));
    }
    // For a point relative to the origin; negative inside.
    W signed_distance(const Wide &p) const {
        W least = 1e300L;
        bool is_inside = cross(corners[1] - corners[0], corners[2] - corners[0]) > 0; // not flat
        for (std::size_t i = 0; i < count; ++i) {
            const Wide &a = corners[i];
            const Wide &b = corners[(i + 1) % count];
            least = std::min(least, segment_distance(a, b, p));
            is_inside = is_inside && cross(b - a, p - a) >= 0;
        }
        return is_inside ? -least : least;
    }
};

inline Polygon polygon(const OrientedRectangle &r) {
    const Wide u = wide(r.axis) / length(wide(r.axis));
    const Wide x = u * W(r.half_extents.x);
    const Wide y = Wide{-u.y, u.x} * W(r.half_extents.y);
    Polygon result;
    result.origin = wide(r.center);
    for (const Wide &corner : {-x - y, x - y, x + y, -x + y})
        result.add(corner);
    return result;
}
inline Polygon polygon(const Rectangle &r) {
    const Wide size = wide(r.max) - wide(r.min);
    Polygon result;
    result.origin = wide(r.min);
    for (const Wide &corner : {Wide{0, 0}, Wide{size.x, 0}, size, Wide{0, size.y}})
        result.add(corner);
    return result;
}

inline W signed_distance(const Circle &c, const Vec2 &p) {
    return length(wide(p) - wide(c.center)) - W(c.radius);
}
inline W signed_distance(const auto &rectangle, const Vec2 &p) {
    const Polygon outline = polygon(rectangle);
    return outline.signed_distance(wide(p) - outline.origin);
}

// Two circles, or a circle and a polygon.
inline W signed_distance(const Circle &a, const Circle &b) {
    return length(wide(b.center) - wide(a.center)) - W(a.radius) - W(b.radius);
}
inline W signed_distance(const Circle &a, const Rectangle &b) {
    return signed_distance(b, a.center) - W(a.radius);
}
inline W signed_distance(const Circle &a, const OrientedRectangle &b) {
    return signed_distance(b, a.center) - W(a.radius);
}
inline W signed_distance(const auto &a, const Circle &b) {
    return signed_distance(b, a);
}
// Two polygons: the origin's distance from the hull of all corner differences (Andrew 1979).
inline W polygon_distance(const Polygon &a, const Polygon &b) {
    std::array<Wide, 16> differences{};
    std::size_t count = 0;
    const Wide offset = b.origin - a.origin;
    for (std::size_t i = 0; i < a.count; ++i)
        for (std::size_t j = 0; j < b.count; ++j)
            differences[count++] = b.corners[j] - a.corners[i];
    std::sort(differences.begin(), differences.end(),
              [](const Wide &p, const Wide &q) { return p.x < q.x || (p.x == q.x && p.y < q.y); });
    std::array<Wide, 34> hull{};
    std::size_t top = 0;
    const auto push = [&](const Wide &p, std::size_t floor) {
        while (top >= floor + 2 && cross(hull[top - 1] - hull[top - 2], p - hull[top - 1]) <= 0)
            --top;
        hull[top++] = p;
    };
    for (std::size_t i = 0; i < count; ++i)
        push(differences[i], 0);
    const std::size_t floor = top - 1;
    for (std::size_t i = count - 1; i-- > 0;)
        push(differences[i], floor);
    --top;
    W least = 1e300L;
    bool is_inside = top >= 3; // not flat
    for (std::size_t i = 0; i < top; ++i) {
        const Wide &p = hull[i];
        const Wide &q = hull[(i + 1) % top];
        least = std::min(least, segment_distance(p, q, -offset));
        is_inside = is_inside && cross(q - p, -offset - p) >= 0;
    }
    return is_inside ? -least : least;
}
inline W signed_distance(const OrientedRectangle &a, const OrientedRectangle &b) {
    return polygon_distance(polygon(a), polygon(b));
}
inline W signed_distance(const Rectangle &a, const OrientedRectangle &b) {
    return polygon_distance(polygon(a), polygon(b));
}
inline W signed_distance(const Rectangle &a, const Rectangle &b) {
    return polygon_distance(polygon(a), polygon(b));
}

inline W size_of(const Circle &c) {
    return W(c.radius);
}
inline W size_of(const OrientedRectangle &r) {
    return length(wide(r.half_extents));
}
inline W size_of(const Rectangle &r) {
    return length(wide(r.max) - wide(r.min)) / 2;
}

// --- In whole numbers --------------------------------------------------------------------------

__extension__ using Int = __int128;

struct Whole {
    Int x = 0;
    Int y = 0;
};
inline Whole operator-(const Whole &a, const Whole &b) {
    return {a.x - b.x, a.y - b.y};
}
inline Whole whole(const Vec2 &v) {
    return {static_cast<std::int64_t>(v.x), static_cast<std::int64_t>(v.y)};
}
inline Int cross(const Whole &a, const Whole &b) {
    return a.x * b.y - a.y * b.x;
}
inline Int dot(const Whole &a, const Whole &b) {
    return a.x * b.x + a.y * b.y;
}
inline int sign(Int n) {
    return n > 0 ? 1 : n < 0 ? -1 : 0;
}

// --- Random inputs -----------------------------------------------------------------------------

inline Real any_real(Random &random, double low, double high) {
    return static_cast<Real>(random.next_in(low, high));
}
inline Real any_magnitude(Random &random, double low_exponent, double high_exponent) {
    return static_cast<Real>(std::pow(10.0, random.next_in(low_exponent, high_exponent)));
}
// 1 mm to 100 km.
inline Real any_size(Random &random) {
    return any_magnitude(random, -3.0, 5.0);
}
inline Vec2 any_vector(Random &random, double reach) {
    const Real x = any_real(random, -reach, reach);
    const Real y = any_real(random, -reach, reach);
    return {x, y};
}
inline Vec2 any_position(Random &random) {
    if (random.next_index(2) == 0)
        return Vec2{Real(0)};
    const double reach = double(any_size(random));
    return any_vector(random, reach);
}
inline Wide any_unit(Random &random) {
    const W angle = W(random.next_in(-3.15, 3.15));
    return {std::cos(angle), std::sin(angle)};
}
// Often turned by quarters, or nearly.
inline Vec2 any_axis(Random &random) {
    const std::uint32_t kind = random.next_index(4);
    double angle = random.next_in(-3.15, 3.15);
    if (kind >= 2) {
        constexpr std::array<std::array<int, 2>, 4> quarters{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
        const std::uint32_t quarter = random.next_index(4);
        if (kind == 2)
            return {Real(quarters[quarter][0]), Real(quarters[quarter][1])};
        angle = 1.5707963267948966 * double(quarter) +
                double(any_magnitude(random, -16.0, -1.0)) * (random.next_index(2) == 0 ? 1 : -1);
    }
    return {static_cast<Real>(std::cos(angle)), static_cast<Real>(std::sin(angle))};
}
inline Vec2 any_half_extents(Random &random, Real size) {
    const Real x = random.next_index(8) == 0 ? Real(0) : any_magnitude(random, -4.0, 0.0);
    const Real y = random.next_index(8) == 0 ? Real(0) : any_magnitude(random, -4.0, 0.0);
    const std::uint32_t longer = random.next_index(3);
    return size * Vec2{longer == 0 ? Real(1) : x, longer == 1 ? Real(1) : y};
}
inline Circle any_circle(Random &random) {
    const Vec2 center = any_position(random);
    return {center, any_size(random)};
}
inline OrientedRectangle any_oriented(Random &random) {
    const Vec2 center = any_position(random);
    const Vec2 axis = any_axis(random);
    return {center, axis, any_half_extents(random, any_size(random))};
}
inline Rectangle any_rectangle(Random &random) {
    const Vec2 center = any_position(random);
    const Vec2 half = any_half_extents(random, any_size(random));
    return {center - half, center + half};
}

// A number in [-reach, reach].
inline Real any_whole(Random &random, std::int64_t reach) {
    const std::uint64_t count = 2 * static_cast<std::uint64_t>(reach) + 1;
    return static_cast<Real>(static_cast<std::int64_t>(random.next_u64() % count) - reach);
}
inline Vec2 any_whole_point(Random &random, std::int64_t reach) {
    const Real x = any_whole(random, reach);
    const Real y = any_whole(random, reach);
    return {x, y};
}
// Most are small, so that coincidences are common; others as large as fits with their differences,
// so that rounded products come out wrong.
constexpr int whole_bits = std::numeric_limits<Real>::digits == 24 ? 22 : 48;
inline std::int64_t any_reach(Random &random) {
    if (random.next_index(2) == 0)
        return 1 + random.next_index(6);
    return std::int64_t(1) << (3 + random.next_index(std::uint32_t(whole_bits) - 2));
}
// A point on the line through a and b, or near it.
inline Vec2 near_line(Random &random, const Vec2 &a, const Vec2 &b) {
    const double s = random.next_index(2) == 0 ? random.next_in(-0.5, 1.5)
                                               : 0.5 * double(random.next_index(4)) - 0.5;
    const double x = std::nearbyint(double(a.x) + s * (double(b.x) - double(a.x)));
    const double y = std::nearbyint(double(a.y) + s * (double(b.y) - double(a.y)));
    const Vec2 off = random.next_index(2) == 0 ? Vec2{Real(0)} : any_whole_point(random, 1);
    return Vec2{static_cast<Real>(x), static_cast<Real>(y)} + off;
}

} // namespace oracle_2d
} // namespace plumb::inline PLUMB_PRECISION
