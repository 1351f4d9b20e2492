// Points to build hulls from, and the exact hull of points on the integer lattice.
#pragma once

#include "tests/geometry/oracle.h"

#include <array>
#include <cstdint>
#include <map>
#include <numeric>
#include <set>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {
namespace oracle {

// --- Exact: all planes through three of the points ----------------------------------------------

using Lattice = std::array<std::int64_t, 3>;

struct ExactHull {
    // Facets by primitive normal and offset, each with those of the points that are corners.
    std::map<std::array<std::int64_t, 4>, std::set<Lattice>> facets;
    std::set<Lattice> vertices;
};

inline ExactHull exact_hull(const std::vector<Lattice> &points) {
    ExactHull hull;
    std::map<Lattice, int> facets_at;
    std::map<std::array<std::int64_t, 4>, std::set<Lattice>> on_facet;
    for (std::size_t i = 0; i < points.size(); ++i)
        for (std::size_t j = i + 1; j < points.size(); ++j)
            for (std::size_t k = j + 1; k < points.size(); ++k) {
                const auto &a = points[i], &b = points[j], &c = points[k];
                const std::int64_t u[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
                const std::int64_t w[3] = {c[0] - a[0], c[1] - a[1], c[2] - a[2]};
                std::int64_t n[3] = {u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2],
                                     u[0] * w[1] - u[1] * w[0]};
                const std::int64_t divisor = std::gcd(std::gcd(n[0], n[1]), n[2]);
                if (divisor == 0)
                    continue;
                bool any_front = false, any_behind = false;
                for (const auto &p : points) {
                    const std::int64_t h =
                        n[0] * (p[0] - a[0]) + n[1] * (p[1] - a[1]) + n[2] * (p[2] - a[2]);
                    any_front |= h > 0;
                    any_behind |= h < 0;
                }
                if (any_front == any_behind)
                    continue; // not supporting, or all points coplanar
                const std::int64_t sign = any_front ? -divisor : divisor;
                for (std::int64_t &x : n)
                    x /= sign;
                const std::int64_t offset = n[0] * a[0] + n[1] * a[1] + n[2] * a[2];
                auto &on = on_facet[{n[0], n[1], n[2], offset}];
                on.insert({a, b, c});
            }
    for (const auto &[facet, on] : on_facet)
        for (const Lattice &point : on)
            ++facets_at[point];
    // A point on an edge of the hull is in two facets, a corner in at least three.
    for (const auto &[point, count] : facets_at)
        if (count >= 3)
            hull.vertices.insert(point);
    for (const auto &[facet, on] : on_facet)
        for (const Lattice &point : on)
            if (hull.vertices.count(point) == 1)
                hull.facets[facet].insert(point);
    return hull;
}

// --- Awkward points ------------------------------------------------------------------------------

inline std::vector<V> any_points(Random &random, int family) {
    std::vector<V> points;
    const auto in_ball = [&] { return any_direction(random) * std::cbrt(random.next_unit()); };
    switch (family) {
    case 0: // on a sphere
        for (int i = 0; i < 60; ++i)
            points.push_back(any_direction(random));
        break;
    case 1: // in a ball
        for (int i = 0; i < 100; ++i)
            points.push_back(in_ball());
        break;
    case 2: // a cube filled with a grid
        for (int i = 0; i < 216; ++i)
            points.push_back(V{double(i % 6), double(i / 6 % 6), double(i / 36)} / 2.5 - V{1.0});
        break;
    case 3: // a slab
        for (int i = 0; i < 60; ++i) {
            const V p = in_ball();
            points.push_back({p.x, p.y, 1e-3 * p.z});
        }
        break;
    case 4: // a needle
        for (int i = 0; i < 60; ++i) {
            const V p = in_ball();
            points.push_back({p.x, 1e-3 * p.y, 1e-3 * p.z});
        }
        break;
    case 5: // a many-sided prism
        for (int i = 0; i < 64; ++i) {
            const double angle = double(i / 2) * 3.14159265358979323846 / 16.0;
            points.push_back({std::cos(angle), i % 2 == 0 ? -0.5 : 0.5, std::sin(angle)});
        }
        break;
    case 6: // two clusters
        for (int i = 0; i < 60; ++i)
            points.push_back(1e-2 * in_ball() + V{i % 2 == 0 ? 1.0 : -1.0, 0.0, 0.0});
        break;
    case 7: { // corners of a box, near-duplicates of them, and points on its faces
        for (int i = 0; i < 80; ++i) {
            V p = in_ball();
            for (int axis = 0; axis < 3; ++axis)
                if (random.next_index(2) == 0 || axis == i % 3)
                    p[axis] = p[axis] > 0.0 ? 1.0 : -1.0;
            points.push_back(p + 1e-7 * in_ball());
        }
        break;
    }
    default: // a cone with a very sharp tip
        for (int i = 0; i < 40; ++i) {
            const double angle = random.next_in(0.0, 6.283185307179586);
            points.push_back({1e-2 * std::cos(angle), -1.0, 1e-2 * std::sin(angle)});
        }
        points.push_back({0.0, 1.0, 0.0});
        break;
    }
    for (std::size_t i = 0; i < points.size() / 8; ++i)
        points.push_back(points[random.next_index(std::uint32_t(points.size()))]);
    return points;
}

inline constexpr int families = 9;

inline std::vector<Vec3> placed_points(Random &random, const std::vector<V> &points, double size,
                                       double offset) {
    const Quat turn = awkward_rotation(random);
    const glm::dquat q =
        glm::normalize(glm::dquat(double(turn.w), double(turn.x), double(turn.y), double(turn.z)));
    const V shift = offset * any_direction(random);
    std::vector<Vec3> result;
    for (const V &p : points) {
        const V placed = shift + size * (q * p);
        result.push_back({Real(placed.x), Real(placed.y), Real(placed.z)});
    }
    return result;
}

} // namespace oracle
} // namespace plumb::inline PLUMB_PRECISION
