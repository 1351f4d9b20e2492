#include "engine/geometry/closest_point_2d.h"

#include "engine/core/check.h"
#include "engine/geometry/contains_2d.h"
#include "tests/geometry/oracle_2d.h"
#include "tests/trials.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace oracle_2d;

W largest(const Vec2 &v) {
    return std::max(std::abs(W(v.x)), std::abs(W(v.y)));
}

W ray_distance(const Ray2 &ray, const Vec2 &p) {
    const Wide d = wide(ray.direction);
    const Wide from_origin = wide(p) - wide(ray.origin);
    const W t = glm::dot(from_origin, d) / glm::dot(d, d);
    if (t >= 0 && t <= W(ray.max_t))
        return std::abs(cross(d, from_origin)) / length(d);
    return length(from_origin - (t < 0 ? W(0) : W(ray.max_t)) * d);
}

// Up to rounding, the result is in the shape and no further from the point than the shape is. For
// convex shapes only one point qualifies.
void check_closest(W distance_of_result, W distance_of_point, const Vec2 &point, const Vec2 &result,
                   W size) {
    const W bound = 8 * W(epsilon) * size;
    ASSERT_LE(distance_of_result, bound);
    ASSERT_LE(length(wide(point) - wide(result)), std::max(distance_of_point, W(0)) + bound);
}

TEST(ClosestPoint2, IsInTheShapeAndAsFarAsTheShapeIs) {
    Random random(0x2d11);
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const auto any_point = [&](const Vec2 &near, W size) {
            const Wide p = wide(near) + any_unit(random) * size * W(random.next_in(0.0, 3.0));
            return random.next_index(8) == 0 ? any_position(random)
                                             : Vec2{static_cast<Real>(p.x), static_cast<Real>(p.y)};
        };
        const auto check = [&](const auto &shape, const Vec2 &near) {
            const Vec2 p = any_point(near, size_of(shape));
            const Vec2 q = closest_point(shape, p);
            if (contains(shape, p)) {
                ASSERT_EQ(q, p);
            }
            check_closest(signed_distance(shape, q), signed_distance(shape, p), p, q,
                          std::max({largest(near), largest(p), size_of(shape)}));
        };
        const Circle circle = any_circle(random);
        check(circle, circle.center);
        const OrientedRectangle oriented = any_oriented(random);
        check(oriented, oriented.center);
        const Rectangle rectangle = any_rectangle(random);
        check(rectangle, rectangle.min);

        const Vec2 a = any_position(random);
        const Wide along = any_unit(random) * W(any_size(random));
        const Vec2 b = random.next_index(16) == 0
                           ? a
                           : a + Vec2{static_cast<Real>(along.x), static_cast<Real>(along.y)};
        const Vec2 p = any_point(a, length(along));
        const Vec2 q = closest_point(Segment2{a, b}, p);
        check_closest(segment_distance(wide(a), wide(b), wide(q)),
                      segment_distance(wide(a), wide(b), wide(p)), p, q,
                      std::max({largest(a), largest(b), largest(p)}));

        if (a == b)
            continue;
        // The same segment as a ray with a direction of any length.
        const Real scale = any_magnitude(random, -6.0, 6.0);
        const Ray2 ray{a, (b - a) * scale,
                       random.next_index(2) == 0 ? Real(1) / scale : Real(1e30)};
        const Vec2 r = closest_point(ray, p);
        check_closest(ray_distance(ray, r), ray_distance(ray, p), p, r,
                      std::max({largest(a), largest(b), largest(p)}));
    }
}

TEST(ClosestPoint2, OfARectangleIsExact) {
    // Tries every point of a small grid.
    Random random(0x2d12);
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const Vec2 a = any_whole_point(random, 4), b = any_whole_point(random, 4);
        const Rectangle rectangle{glm::min(a, b), glm::max(a, b)};
        const Vec2 p = any_whole_point(random, 7);
        Int best = 1000;
        Vec2 expected{Real(0)};
        for (Real x = rectangle.min.x; x <= rectangle.max.x; ++x)
            for (Real y = rectangle.min.y; y <= rectangle.max.y; ++y) {
                const Whole d = whole(p) - whole({x, y});
                if (dot(d, d) < best) {
                    best = dot(d, d);
                    expected = {x, y};
                }
            }
        ASSERT_EQ(closest_point(rectangle, p), expected);
    }
}

TEST(ClosestPoint2, OfACompoundIsTheClosestOfItsParts) {
    Random random(0x2d13);
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const Circle circle{any_vector(random, 9.0), any_real(random, 0.0, 3.0)};
        const OrientedRectangle oriented{any_vector(random, 9.0), any_axis(random),
                                         any_half_extents(random, Real(2))};
        const Compound2 compound({circle, oriented});
        const Vec2 p = any_vector(random, 12.0);
        const Vec2 q = closest_point(compound, p);
        const W distance =
            std::max(std::min(signed_distance(circle, p), signed_distance(oriented, p)), W(0));
        ASSERT_NEAR(double(length(wide(p) - wide(q))), double(distance), 8.0 * epsilon * 12.0);
        if (contains(compound, p)) {
            ASSERT_EQ(q, p);
        }
    }
}

TEST(ClosestPoint2, EndsAreGivenToTheBit) {
    const Segment2 segment{{Real(0.1), Real(0.7)}, {Real(0.3), Real(-0.9)}};
    EXPECT_EQ(closest_point(segment, {Real(0), Real(5)}), segment.a);
    EXPECT_EQ(closest_point(segment, {Real(1), Real(-5)}), segment.b);
    const Segment2 point{segment.a, segment.a};
    EXPECT_EQ(closest_point(point, segment.b), segment.a);
    const Circle dot_circle{segment.a, Real(0)};
    EXPECT_EQ(closest_point(dot_circle, segment.b), segment.a);
}

TEST(ClosestPoint2, RefusesTheEmptySet) {
    EXPECT_THROW(closest_point(Rectangle{}, Vec2{Real(0)}), CheckFailure);
    EXPECT_THROW(closest_point(Ray2{Vec2{Real(0)}, Vec2{Real(1)}, Real(-1)}, Vec2{Real(0)}),
                 CheckFailure);
    const Real nan = std::numeric_limits<Real>::quiet_NaN();
    EXPECT_THROW(closest_point(Circle{Vec2{Real(0)}, Real(1)}, Vec2{nan}), CheckFailure);
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
