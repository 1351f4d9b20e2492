#include "engine/geometry/enclosing_2d.h"

#include "engine/core/check.h"
#include "engine/geometry/contains_2d.h"
#include "engine/math/constants.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {

namespace {

Real squared_distance(const Vec2 &a, const Vec2 &b) {
    const Vec2 d = b - a;
    return glm::dot(d, d);
}

// The centre of the circle through three points. Computed from the corner with the largest angle,
// which is at least 60 degrees, so unless the triangle is obtuse the error is only a few epsilon
// times the radius, however close two of the points are. Obtuse triangles are not used in the end;
// their result may be far off or not finite.
Vec2 circumcenter(Vec2 a, Vec2 b, Vec2 c) {
    const Real opposite_a = squared_distance(b, c);
    const Real opposite_b = squared_distance(c, a);
    const Real opposite_c = squared_distance(a, b);
    if (opposite_b >= opposite_a && opposite_b >= opposite_c)
        std::swap(a, b);
    else if (opposite_c >= opposite_a)
        std::swap(a, c);
    const Vec2 u = b - a;
    const Vec2 v = c - a;
    const Real twice_cross = Real(2) * (u.x * v.y - u.y * v.x);
    return a + (perpendicular(v) * -glm::dot(u, u) + perpendicular(u) * glm::dot(v, v)) *
                   (Real(1) / twice_cross);
}

// Up to three points on the border of their smallest enclosing circle, and room for one to be
// added.
struct Support {
    std::array<Vec2, 4> points{};
    std::size_t count = 0;
    Vec2 center{Real(0)};
    Real squared_radius = Real(0);

    // A point outside the circle is on the border of the next one. Try the circles through it and
    // each one or two of the others and take the smallest. Each candidate's radius is enlarged to
    // reach all points, so none needs testing for containment.
    void add(const Vec2 &point) {
        points[count++] = point;
        squared_radius = infinity;
        std::array<std::size_t, 3> chosen{};
        std::size_t chosen_count = 0;
        const auto consider = [&](const Vec2 &candidate, std::size_t i, std::size_t j) {
            Real reach = Real(0);
            for (std::size_t k = 0; k < count; ++k)
                reach = std::max(reach, squared_distance(candidate, points[k]));
            if (!(reach < squared_radius))
                return;
            center = candidate;
            squared_radius = reach;
            chosen = {count - 1, i, j};
            chosen_count = i == j ? 2 : 3;
        };
        for (std::size_t i = 0; i + 1 < count; ++i)
            consider(point + Real(0.5) * (points[i] - point), i, i);
        for (std::size_t i = 0; i + 1 < count; ++i)
            for (std::size_t j = i + 1; j + 1 < count; ++j) {
                const Vec2 candidate = circumcenter(points[i], points[j], point);
                if (std::isfinite(candidate.x) && std::isfinite(candidate.y))
                    consider(candidate, i, j);
            }
        const std::array<Vec2, 4> all = points;
        count = chosen_count;
        for (std::size_t k = 0; k < count; ++k)
            points[k] = all[chosen[k]];
    }
};

// The smallest circle around `center` in which `contains` finds every point, or one a few epsilons
// larger: distances are rounded, `contains` is not.
Circle reaching_all(const Vec2 &center, std::span<const Vec2> points) {
    Real squared = Real(0);
    for (const Vec2 &point : points)
        squared = std::max(squared, squared_distance(center, point));
    Circle circle{center, std::sqrt(squared)};
    for (const Vec2 &point : points)
        while (!contains(circle, point))
            circle.radius = std::nextafter(circle.radius, infinity);
    return circle;
}

} // namespace

// Repeatedly adds the point farthest outside the circle around the current support points, until
// none is outside: Welzl 1991, "Smallest enclosing disks", with the farthest-point rule of Gaertner
// 1999, "Fast and robust smallest enclosing balls". Takes a few rounds for any number of points,
// and nothing is random.
Circle containing_circle(std::span<const Vec2> points) {
    PLUMB_CHECK(!points.empty(),
                "a containing circle needs at least one point, got " << points.size());
    for (const Vec2 &point : points)
        check_valid(point);

    // Relative to one of the points, so that roundings scale with the circle's size.
    const Vec2 origin = points[0];
    Support support;
    support.count = 1;
    Vec2 best_center{Real(0)};
    Real best_squared = infinity;
    // No circle around all points is smaller than the one around the support. Distances are
    // rounded: stop when the farthest point is outside by no more than that.
    constexpr Real slack = Real(1) + Real(16) * std::numeric_limits<Real>::epsilon();
    constexpr int most_rounds = 100;
    for (int round = 0; !PLUMB_RARELY("containing_circle ran out of rounds", round == most_rounds);
         ++round) {
        Vec2 furthest{Real(0)};
        Real squared = Real(-1);
        for (const Vec2 &point : points) {
            const Vec2 local = point - origin;
            const Real candidate = squared_distance(support.center, local);
            if (candidate > squared) {
                squared = candidate;
                furthest = local;
            }
        }
        if (squared < best_squared) {
            best_squared = squared;
            best_center = support.center;
        }
        if (squared <= support.squared_radius * slack)
            break;
        support.add(furthest);
    }
    return reaching_all(origin + best_center, points);
}

Rectangle containing_rectangle(std::span<const Vec2> points) {
    PLUMB_CHECK(!points.empty(),
                "a containing rectangle needs at least one point, got " << points.size());
    Rectangle rectangle{points[0], points[0]};
    for (const Vec2 &point : points) {
        check_valid(point);
        rectangle.min = glm::min(rectangle.min, point);
        rectangle.max = glm::max(rectangle.max, point);
    }
    return rectangle;
}

} // namespace plumb::inline PLUMB_PRECISION
