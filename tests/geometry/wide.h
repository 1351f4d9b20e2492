// The shapes again in wider numbers, and random ones of all sizes and places: the reference that
// the geometry tests compare the engine with.
#pragma once

#include "engine/core/random.h"
#include "engine/geometry/shapes.h"
#include "tests/geometry/oracle.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>

namespace plumb::inline PLUMB_PRECISION {
namespace wide {

// 29 bits more than float, 11 more than double.
using W = std::conditional_t<sizeof(Real) == sizeof(float), double, long double>;
using W3 = glm::vec<3, W, glm::defaultp>;

inline constexpr W epsilon = std::numeric_limits<Real>::epsilon();

inline W3 widened(const Vec3 &v) {
    return {W(v.x), W(v.y), W(v.z)};
}

// Not inlined: GCC 12 at -O3 may drop a rounding to float and back that it can see through.
[[gnu::noinline]] inline Vec3 narrowed(const W3 &v) {
    return {static_cast<Real>(v.x), static_cast<Real>(v.y), static_cast<Real>(v.z)};
}

// a x b to the last bit, by Kahan's difference of products.
inline W3 full_cross(const W3 &a, const W3 &b) {
    const auto part = [](W x, W y, W z, W w) {
        const W zw = z * w;
        return std::fma(x, y, -zw) + std::fma(-z, w, zw);
    };
    return {part(a.y, b.z, a.z, b.y), part(a.z, b.x, a.x, b.z), part(a.x, b.y, a.y, b.x)};
}

inline W largest(const W3 &v) {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

// A box's frame: its unit axes, each the image of a basis vector under q v q*.
struct Frame {
    W3 center{W(0)};
    std::array<W3, 3> axis{};
    W3 half{W(0)};

    Frame() = default;
    explicit Frame(const Box &box) : center(widened(box.center)), half(widened(box.half_extents)) {
        const W3 v{W(box.rotation.x), W(box.rotation.y), W(box.rotation.z)};
        const W w = W(box.rotation.w);
        const W squared = w * w + glm::dot(v, v);
        for (int i = 0; i < 3; ++i) {
            W3 e{W(0)};
            e[i] = W(1);
            axis[std::size_t(i)] = ((w * w - glm::dot(v, v)) * e + W(2) * glm::dot(v, e) * v +
                                    W(2) * w * glm::cross(v, e)) /
                                   squared;
        }
    }
    explicit Frame(const Aabb &box)
        : center((widened(box.min) + widened(box.max)) / W(2)), axis{W3{1, 0, 0}, W3{0, 1, 0},
                                                                     W3{0, 0, 1}},
          half((widened(box.max) - widened(box.min)) / W(2)) {}

    W3 point(const W3 &local) const {
        return center + axis[0] * local.x + axis[1] * local.y + axis[2] * local.z;
    }
    W3 local(const W3 &p) const {
        return {glm::dot(p - center, axis[0]), glm::dot(p - center, axis[1]),
                glm::dot(p - center, axis[2])};
    }
    W3 corner(int k) const {
        return point({(k & 1) != 0 ? half.x : -half.x, (k & 2) != 0 ? half.y : -half.y,
                      (k & 4) != 0 ? half.z : -half.z});
    }
    W3 closest(const W3 &p) const { return point(glm::clamp(local(p), -half, half)); }
    // Negative inside.
    W signed_distance(const W3 &p) const {
        const W3 beyond = glm::abs(local(p)) - half;
        const W most = std::max({beyond.x, beyond.y, beyond.z});
        return most <= W(0) ? most : glm::length(glm::max(beyond, W3{W(0)}));
    }
    // Keeps the part inside all six faces.
    template <typename Cut> void cut(Cut &polygon) const {
        for (std::size_t p = 0; p < 6 && polygon.count > 0; ++p) {
            const W3 n = axis[p / 2] * (p % 2 == 0 ? W(-1) : W(1));
            polygon.cut(n, glm::dot(n, center) + half[int(p / 2)]);
        }
    }
    W reach(const W3 &u) const {
        return std::abs(glm::dot(u, axis[0])) * half.x + std::abs(glm::dot(u, axis[1])) * half.y +
               std::abs(glm::dot(u, axis[2])) * half.z;
    }
};

// The point of the segment closest to p.
inline W3 closest_on_segment(const W3 &a, const W3 &b, const W3 &p) {
    const W3 d = b - a;
    const W squared = glm::dot(d, d);
    if (squared == W(0))
        return a;
    return a + d * std::clamp(glm::dot(p - a, d) / squared, W(0), W(1));
}

// The corners of each face of a box, in order.
inline constexpr std::array<std::array<std::size_t, 4>, 6> face_corners{
    {{0, 2, 6, 4}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 1, 3, 2}, {4, 5, 7, 6}}};

// A polygon of 4 corners, clipped by up to 6 planes.
struct Polygon {
    std::array<W3, 12> corner;
    std::size_t count = 0;

    // Keeps the part with dot(n, p) <= offset.
    void cut(const W3 &n, W offset) {
        Polygon left;
        for (std::size_t i = 0; i < count; ++i) {
            const W3 &here = corner[i], &next = corner[(i + 1) % count];
            const W d0 = glm::dot(n, here) - offset, d1 = glm::dot(n, next) - offset;
            if (d0 <= W(0))
                left.corner[left.count++] = here;
            if ((d0 < W(0) && d1 > W(0)) || (d0 > W(0) && d1 < W(0)))
                left.corner[left.count++] = here + (next - here) * (d0 / (d0 - d1));
        }
        *this = left;
    }
};

// --- Random inputs of all sizes ----------------------------------------------------------------

inline W any_power(Random &random, double low, double high) {
    return W(std::pow(10.0, random.next_in(low, high)));
}

// Shorter than `reach`, with some components zero, -0 or tiny.
inline W3 any_offset(Random &random, W reach) {
    W3 v{reach * W(random.next_in(-1, 1)), reach * W(random.next_in(-1, 1)),
         reach * W(random.next_in(-1, 1))};
    if (random.next_index(4) == 0)
        for (int i = 0; i < 3; ++i)
            switch (random.next_index(4)) {
            case 0:
                v[i] = W(0);
                break;
            case 1:
                v[i] = -W(0);
                break;
            case 2:
                v[i] *= any_power(random, -12, -3);
                break;
            default:
                break;
            }
    return v;
}

inline W3 any_unit(Random &random) {
    const oracle::V v = oracle::any_direction(random);
    return {W(v.x), W(v.y), W(v.z)};
}

// A direction, often along an axis or nearly so.
inline W3 awkward_unit(Random &random) {
    W3 v = any_unit(random);
    if (random.next_index(3) == 0) {
        W3 axis{W(0)};
        axis[int(random.next_index(3))] = random.next_index(2) == 0 ? W(1) : W(-1);
        v = random.next_index(2) == 0 ? axis : glm::normalize(axis + v * any_power(random, -9, -1));
    }
    return v;
}

// A gap between two shapes: mostly close to touching, of either sign.
inline W any_gap(Random &random, W size) {
    return size * any_power(random, -9, 0) * (random.next_index(2) == 0 ? W(1) : W(-1));
}

// Half extents, some of them tiny or zero.
inline Vec3 any_half_extents(Random &random, W size) {
    Vec3 half{Real(0)};
    for (int i = 0; i < 3; ++i) {
        half[i] = static_cast<Real>(size * W(random.next_in(0.02, 1.0)));
        if (random.next_index(16) == 0)
            half[i] = Real(0);
        else if (random.next_index(16) == 0)
            half[i] *= static_cast<Real>(any_power(random, -6, -2));
    }
    return half;
}

// Sizes 1e-3 to 1e5, positions to 1e5.
inline W any_size(Random &random) {
    return any_power(random, -3, 5);
}
inline W3 any_position(Random &random) {
    return any_offset(random, any_power(random, -3, 5));
}

// The largest coordinate or size among the arguments: the stated bounds are multiples of it.
inline W scale_of(const Vec3 &v) {
    return largest(widened(v));
}
inline W scale_of(const Sphere &s) {
    return std::max(scale_of(s.center), W(s.radius));
}
inline W scale_of(const Box &b) {
    return std::max(scale_of(b.center), scale_of(b.half_extents));
}
inline W scale_of(const Aabb &b) {
    return std::max(scale_of(b.min), scale_of(b.max));
}
inline W scale_of(const Capsule &c) {
    return std::max({scale_of(c.a), scale_of(c.b), W(c.radius)});
}
inline W scale_of(const Cylinder &c) {
    return std::max({scale_of(c.a), scale_of(c.b), W(c.radius)});
}
inline W scale_of(const Segment &s) {
    return std::max(scale_of(s.a), scale_of(s.b));
}

// --- Whole numbers -----------------------------------------------------------------------------

using Int = std::int64_t;
using Int3 = glm::vec<3, Int, glm::defaultp>;

inline Int any_int(Random &random, Int reach) {
    return Int(random.next_index(std::uint32_t(2 * reach + 1))) - reach;
}
inline Int3 any_int3(Random &random, Int reach) {
    const Int x = any_int(random, reach), y = any_int(random, reach), z = any_int(random, reach);
    return {x, y, z};
}
inline Int product(const Int3 &a, const Int3 &b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Vec3 real(const Int3 &v) {
    return {Real(v.x), Real(v.y), Real(v.z)};
}

// --- Answers -----------------------------------------------------------------------------------

// Yes/no answers must be right except within `bound` of touching, and most inputs must be outside
// that.
class Judge {
  public:
    ~Judge() {
        EXPECT_GT(decided_, total_ / 2);
        EXPECT_GT(met_, total_ / 8);
        EXPECT_LT(met_, total_ * 7 / 8);
    }
    void operator()(bool answer, W distance, W bound) {
        ++total_;
        if (std::abs(distance) <= bound)
            return;
        ++decided_;
        met_ += answer;
        ASSERT_EQ(answer, distance <= W(0))
            << "input " << total_ << ", distance " << distance << ", bound " << bound;
    }

  private:
    int total_ = 0;
    int decided_ = 0;
    int met_ = 0;
};

} // namespace wide
} // namespace plumb::inline PLUMB_PRECISION
