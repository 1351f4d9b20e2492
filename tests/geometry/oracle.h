// Slow, simple answers in double as a reference for the engine. Shares no method with it: distances
// come from bisection, overlap from clipping, depth from sampled directions.
#pragma once

#include "engine/core/random.h"
#include "engine/geometry/shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

namespace plumb::inline PLUMB_PRECISION {
namespace oracle {

using V = glm::dvec3;

inline V wide(const Vec3 &v) {
    return {double(v.x), double(v.y), double(v.z)};
}

// A box in double, with its axes orthonormalised from the engine's numbers.
struct WideBox {
    V center{0.0};
    std::array<V, 3> axis{};
    V half{0.0};

    WideBox() = default;
    explicit WideBox(const Box &box) : center(wide(box.center)), half(wide(box.half_extents)) {
        const glm::dquat q =
            glm::normalize(glm::dquat(double(box.rotation.w), double(box.rotation.x),
                                      double(box.rotation.y), double(box.rotation.z)));
        const glm::dmat3 m = glm::mat3_cast(q);
        axis = {m[0], m[1], m[2]};
    }
    V closest(const V &p) const {
        V result = center;
        for (int i = 0; i < 3; ++i)
            result += axis[std::size_t(i)] *
                      std::clamp(glm::dot(p - center, axis[std::size_t(i)]), -half[i], half[i]);
        return result;
    }
    // Negative inside.
    double signed_distance(const V &p) const {
        double inside = -1e300;
        for (int i = 0; i < 3; ++i)
            inside =
                std::max(inside, std::abs(glm::dot(p - center, axis[std::size_t(i)])) - half[i]);
        return inside > 0.0 ? glm::length(p - closest(p)) : inside;
    }
    V corner(int k) const {
        return center + axis[0] * ((k & 1) != 0 ? half.x : -half.x) +
               axis[1] * ((k & 2) != 0 ? half.y : -half.y) +
               axis[2] * ((k & 4) != 0 ? half.z : -half.z);
    }
};

// A sphere, capsule or box as a core (point, segment, box) and a radius.
struct Solid {
    bool is_box = false;
    WideBox box;
    V a{0.0}, b{0.0}; // the segment
    double radius = 0.0;

    explicit Solid(const Shape &shape) {
        if (const auto *s = std::get_if<Sphere>(&shape)) {
            a = b = wide(s->center);
            radius = double(s->radius);
        } else if (const auto *c = std::get_if<Capsule>(&shape)) {
            a = wide(c->a);
            b = wide(c->b);
            radius = double(c->radius);
        } else {
            is_box = true;
            box = WideBox(std::get<Box>(shape));
        }
    }
    void move(const V &by) {
        a += by;
        b += by;
        box.center += by;
    }
    V core_closest(const V &p) const {
        if (is_box)
            return box.closest(p);
        const V d = b - a;
        const double dd = glm::dot(d, d);
        return dd > 0.0 ? a + d * std::clamp(glm::dot(p - a, d) / dd, 0.0, 1.0) : a;
    }
    double signed_distance(const V &p) const {
        return is_box ? box.signed_distance(p) : glm::length(p - core_closest(p)) - radius;
    }
    double support(const V &u) const { // of the whole solid, along a unit vector
        if (!is_box)
            return std::max(glm::dot(a, u), glm::dot(b, u)) + radius;
        return glm::dot(box.center, u) + std::abs(glm::dot(box.axis[0], u)) * box.half.x +
               std::abs(glm::dot(box.axis[1], u)) * box.half.y +
               std::abs(glm::dot(box.axis[2], u)) * box.half.z;
    }
    std::vector<std::array<V, 2>> edges() const {
        if (!is_box)
            return {{a, b}};
        std::vector<std::array<V, 2>> result;
        for (int k = 0; k < 8; ++k)
            for (int bit = 1; bit < 8; bit *= 2)
                if ((k & bit) == 0)
                    result.push_back({box.corner(k), box.corner(k | bit)});
        return result;
    }
};

// The distance from a segment to a convex core: the derivative of the squared distance along the
// segment is monotonic, so bisection finds its root.
inline double edge_distance(const std::array<V, 2> &edge, const Solid &core) {
    const V d = edge[1] - edge[0];
    double low = 0.0, high = 1.0;
    for (int i = 0; i < 44; ++i) {
        const double s = 0.5 * (low + high);
        const V p = edge[0] + s * d;
        (glm::dot(p - core.core_closest(p), d) > 0.0 ? high : low) = s;
    }
    const V p = edge[0] + 0.5 * (low + high) * d;
    return glm::length(p - core.core_closest(p));
}

// The distance between cores, without the radii. When two polytopes are apart, one of the closest
// points can be taken on an edge. Zero when an edge of one solid meets the other core, as in any
// overlap of boxes unless one is inside the other.
inline double core_distance(const Solid &a, const Solid &b) {
    double least = 1e300;
    for (const auto &edge : a.edges())
        least = std::min(least, edge_distance(edge, b));
    if (a.is_box || b.is_box)
        for (const auto &edge : b.edges())
            least = std::min(least, edge_distance(edge, a));
    return least;
}

inline double distance(const Solid &a, const Solid &b) {
    return core_distance(a, b) - a.radius - b.radius;
}

// How far b must move along u to be clear of a.
inline double translation_along(const Solid &a, const Solid &b, const V &u) {
    return a.support(u) + b.support(-u);
}

// Whether box a, with all half extents grown by `grow`, meets box b: clips each box's faces by the
// other's planes and looks for anything left, or for one box's centre inside the other.
inline bool boxes_meet(WideBox a, const WideBox &b, double grow) {
    a.half += V{grow};
    if (a.signed_distance(b.center) <= 0.0 || b.signed_distance(a.center) <= 0.0)
        return true;
    const auto faces_meet = [](const WideBox &faces, const WideBox &planes) {
        for (int f = 0; f < 6; ++f) {
            const int i = f / 2, j = (i + 1) % 3, k = (i + 2) % 3;
            const V m = faces.center +
                        faces.axis[std::size_t(i)] * (f % 2 == 0 ? -faces.half[i] : faces.half[i]);
            const V u = faces.axis[std::size_t(j)] * faces.half[j];
            const V v = faces.axis[std::size_t(k)] * faces.half[k];
            std::vector<V> polygon{m - u - v, m + u - v, m + u + v, m - u + v};
            for (int p = 0; p < 6 && !polygon.empty(); ++p) {
                const V n = planes.axis[std::size_t(p / 2)] * (p % 2 == 0 ? -1.0 : 1.0);
                std::vector<V> left;
                for (std::size_t c = 0; c < polygon.size(); ++c) {
                    const V &here = polygon[c];
                    const V &next = polygon[(c + 1) % polygon.size()];
                    const double d0 = glm::dot(here - planes.center, n) - planes.half[p / 2];
                    const double d1 = glm::dot(next - planes.center, n) - planes.half[p / 2];
                    if (d0 <= 0.0)
                        left.push_back(here);
                    if ((d0 < 0.0 && d1 > 0.0) || (d0 > 0.0 && d1 < 0.0))
                        left.push_back(here + (next - here) * (d0 / (d0 - d1)));
                }
                polygon = left;
            }
            if (!polygon.empty())
                return true;
        }
        return false;
    };
    return faces_meet(a, b) || faces_meet(b, a);
}

// --- Random inputs -----------------------------------------------------------------------------

inline Real any_real(Random &random, double low, double high) {
    return static_cast<Real>(random.next_in(low, high));
}

inline Vec3 any_vector(Random &random, double reach) {
    const Real x = any_real(random, -reach, reach);
    const Real y = any_real(random, -reach, reach);
    const Real z = any_real(random, -reach, reach);
    return {x, y, z};
}

inline V any_direction(Random &random) {
    for (;;) {
        const double x = random.next_in(-1, 1), y = random.next_in(-1, 1),
                     z = random.next_in(-1, 1);
        const V v{x, y, z};
        const double length = glm::length(v);
        if (length > 0.1 && length < 1.0)
            return v / length;
    }
}

inline Quat any_rotation(Random &random) {
    for (;;) {
        const double w = random.next_in(-1, 1), x = random.next_in(-1, 1);
        const double y = random.next_in(-1, 1), z = random.next_in(-1, 1);
        const glm::dquat q(w, x, y, z);
        const double length = glm::length(q);
        if (length > 0.1 && length < 1.0) {
            const glm::dquat n = q / length;
            return {Real(n.w), Real(n.x), Real(n.y), Real(n.z)};
        }
    }
}

// A rotation by `angle` about a random axis.
inline Quat tilt(Random &random, double angle) {
    const V axis = any_direction(random) * std::sin(0.5 * angle);
    return {Real(std::cos(0.5 * angle)), Real(axis.x), Real(axis.y), Real(axis.z)};
}

// Rotations that are often quarter turns or nearly so, which makes edges and faces parallel.
inline Quat awkward_rotation(Random &random) {
    const std::uint32_t kind = random.next_index(4);
    if (kind == 0)
        return any_rotation(random);
    Quat q = identity_rotation;
    const Real h = Real(0.70710678118654752440L);
    if (random.next_index(2) == 1)
        q = Quat{h, h, Real(0), Real(0)} * q;
    if (random.next_index(2) == 1)
        q = Quat{h, Real(0), h, Real(0)} * q;
    if (kind == 1)
        return q;
    const double exponent = random.next_in(-7.0, -1.0);
    return glm::normalize(tilt(random, std::pow(10.0, exponent)) * q);
}

} // namespace oracle
} // namespace plumb::inline PLUMB_PRECISION
