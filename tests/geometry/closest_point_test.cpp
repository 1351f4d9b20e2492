#include "engine/geometry/closest_point.h"

#include "engine/geometry/contains.h"
#include "tests/geometry/wide.h"
#include "tests/says.h"
#include "tests/trials.h"

#include <gtest/gtest.h>

#include <string>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace wide;

// The closest point q of a convex set is the only point in the set with the whole set behind the
// plane through q perpendicular to p - q. `height` is q's height above the surface and `support`
// how far the set reaches along `p - q`, both computed independently of the engine. If q is off by
// `bound`, the plane is off by as much and tilts by bound / |p - q| over the set's diameter.
void expect_closest(const W3 &p, const W3 &q, W height, W support, W diameter, W bound, int trial) {
    ASSERT_LE(height, bound) << "not in the set, trial " << trial;
    ASSERT_LE(support - glm::dot(p - q, q), bound * (diameter + W(2) * glm::length(p - q)))
        << "the set is nearer elsewhere, trial " << trial;
}

// A query point from deep inside to far away.
Vec3 any_query(Random &random, const W3 &center, W size) {
    return narrowed(center + any_offset(random, size * any_power(random, -3, 2)));
}

W scale_with(W scale, const Vec3 &p) {
    return std::max(scale, scale_of(p));
}

TEST(ClosestPoint, Sphere) {
    Random random(1);
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const W size = any_size(random);
        const Sphere sphere{narrowed(any_position(random)), static_cast<Real>(size)};
        const W3 c = widened(sphere.center);
        const Vec3 point = any_query(random, c, size);
        const Vec3 answer = closest_point(sphere, point);
        if (contains(sphere, point)) {
            ASSERT_EQ(answer, point);
            continue;
        }
        const W3 p = widened(point), q = widened(answer);
        const W bound = 16 * epsilon * scale_with(scale_of(sphere), point);
        expect_closest(p, q, glm::length(q - c) - W(sphere.radius),
                       glm::dot(p - q, c) + glm::length(p - q) * W(sphere.radius),
                       W(2) * W(sphere.radius), bound, trial);
        ASSERT_LE(glm::length(q - (c + glm::normalize(p - c) * W(sphere.radius))), bound);
        if (HasFatalFailure())
            return;
    }
}

TEST(ClosestPoint, BoxAndAabb) {
    Random random(2);
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const W size = any_size(random);
        const Box box{narrowed(any_position(random)), oracle::awkward_rotation(random),
                      any_half_extents(random, size)};
        const Frame frame(box);
        const Vec3 point = any_query(random, frame.center, size);
        const W3 p = widened(point);
        const Vec3 answer = closest_point(box, point);
        const W bound = 16 * epsilon * scale_with(scale_of(box), point);
        if (contains(box, point)) {
            ASSERT_EQ(answer, point);
        }
        const W3 q = widened(answer);
        expect_closest(p, q, frame.signed_distance(q),
                       glm::dot(p - q, frame.center) + frame.reach(p - q),
                       W(2) * glm::length(frame.half), bound, trial);
        ASSERT_LE(glm::length(q - frame.closest(p)), bound);
        ASSERT_LE(std::abs(std::sqrt(W(squared_distance(box, point))) -
                           std::max(W(0), frame.signed_distance(p))),
                  16 * epsilon * (glm::length(p - frame.center) + glm::length(frame.half)));

        // The closest point of an Aabb is exact; its distance comes from differences.
        const Aabb aabb{box.center - box.half_extents, box.center + box.half_extents};
        const Vec3 clamped = closest_point(aabb, point);
        W squared = 0;
        for (int i = 0; i < 3; ++i) {
            const Real x = point[i];
            ASSERT_EQ(clamped[i], x < aabb.min[i]   ? aabb.min[i]
                                  : x > aabb.max[i] ? aabb.max[i]
                                                    : x);
            const W gap = std::max({W(aabb.min[i]) - W(x), W(x) - W(aabb.max[i]), W(0)});
            squared += gap * gap;
        }
        ASSERT_LE(std::abs(W(squared_distance(aabb, point)) - squared), 8 * epsilon * squared);
        if (HasFatalFailure())
            return;
    }
}

TEST(ClosestPoint, SegmentAndCapsule) {
    Random random(3);
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const W size = any_size(random);
        const W3 middle = any_position(random);
        const W3 u = awkward_unit(random) * size;
        Segment segment{narrowed(middle), narrowed(middle + u)};
        if (random.next_index(16) == 0)
            segment.b = segment.a;
        const Vec3 point = any_query(random, middle, size);
        const W3 a = widened(segment.a), b = widened(segment.b), p = widened(point);
        const W3 q = widened(closest_point(segment, point));
        const W scale = scale_with(scale_of(segment), point);
        const W3 exact = closest_on_segment(a, b, p);
        expect_closest(p, q, glm::length(q - closest_on_segment(a, b, q)),
                       std::max(glm::dot(p - q, a), glm::dot(p - q, b)), glm::length(b - a),
                       16 * epsilon * scale, trial);
        ASSERT_LE(glm::length(q - exact), 16 * epsilon * scale) << "trial " << trial;
        ASSERT_LE(std::abs(std::sqrt(W(squared_distance(segment, point))) -
                           glm::length((p - a) - closest_on_segment(W3{W(0)}, b - a, p - a))),
                  8 * epsilon * (glm::length(p - a) + glm::length(b - a)))
            << "trial " << trial;

        const Capsule capsule{segment.a, segment.b,
                              static_cast<Real>(size * any_power(random, -3, 1))};
        const Vec3 on_capsule = closest_point(capsule, point);
        if (contains(capsule, point)) {
            ASSERT_EQ(on_capsule, point);
            continue;
        }
        const W3 r = widened(on_capsule);
        expect_closest(p, r, glm::length(r - closest_on_segment(a, b, r)) - W(capsule.radius),
                       std::max(glm::dot(p - r, a), glm::dot(p - r, b)) +
                           glm::length(p - r) * W(capsule.radius),
                       glm::length(b - a) + W(2) * W(capsule.radius),
                       16 * epsilon * std::max(scale, W(capsule.radius)), trial);
        if (HasFatalFailure())
            return;
    }
}

TEST(ClosestPoint, Cylinder) {
    Random random(4);
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const W size = any_size(random);
        const W3 middle = any_offset(random, size * any_power(random, -2, 2));
        const Cylinder cylinder{narrowed(middle), narrowed(middle + awkward_unit(random) * size),
                                static_cast<Real>(size * any_power(random, -3, 1))};
        if (cylinder.a == cylinder.b)
            continue;
        const Vec3 point = any_query(random, middle, size);
        const Vec3 answer = closest_point(cylinder, point);
        if (contains(cylinder, point)) {
            ASSERT_EQ(answer, point);
            continue;
        }
        const W3 a = widened(cylinder.a), b = widened(cylinder.b), p = widened(point);
        const W3 q = widened(answer), axis = glm::normalize(b - a), n = p - q;
        const W beyond = std::max(glm::dot(q - b, axis), -glm::dot(q - a, axis));
        const W3 from_axis = (q - a) - axis * glm::dot(q - a, axis);
        const W height = std::max(beyond, glm::length(from_axis) - W(cylinder.radius));
        const W3 n_across = n - axis * glm::dot(n, axis);
        const W support =
            std::max(glm::dot(n, a), glm::dot(n, b)) + W(cylinder.radius) * glm::length(n_across);
        expect_closest(p, q, height, support, glm::length(b - a) + W(2) * W(cylinder.radius),
                       16 * epsilon * scale_with(scale_of(cylinder), point), trial);
        if (HasFatalFailure())
            return;
    }
}

TEST(ClosestPoint, PlaneAndHalfSpace) {
    Random random(5);
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const W size = any_size(random);
        const W3 n = awkward_unit(random);
        const W off_unit = random.next_index(8) == 0 ? W(random.next_in(-9e-4, 9e-4)) : W(0);
        const Plane plane{narrowed(n * (W(1) + off_unit)),
                          static_cast<Real>(size * W(random.next_in(-1, 1)))};
        const Vec3 point = any_query(random, n * W(plane.offset), size);
        const W3 normal = widened(plane.normal), p = widened(point);
        const W length = glm::length(normal);
        const W height = (glm::dot(normal, p) - W(plane.offset)) / length;
        const W3 foot = p - normal * (height / length);
        const W bound = 16 * epsilon * scale_with(W(std::abs(plane.offset)), point);
        ASSERT_LE(glm::length(widened(closest_point(plane, point)) - foot), bound) << trial;
        const HalfSpace half_space{plane.normal, plane.offset};
        const W3 q = widened(closest_point(half_space, point));
        ASSERT_LE(glm::length(q - (height > W(0) ? foot : p)), height > W(0) ? bound : W(0));
    }
}

TEST(ClosestPoint, RayOfAnyLength) {
    Random random(6);
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const W size = any_size(random);
        const W3 o = any_position(random);
        const W speed =
            random.next_index(8) == 0 ? any_power(random, -30, 30) : any_power(random, -6, 6);
        Ray ray{narrowed(o), narrowed(awkward_unit(random) * speed)};
        if (random.next_index(2) == 0)
            ray.max_t = static_cast<Real>(size / speed * W(random.next_in(0, 1)));
        const Vec3 point = any_query(random, o, size);
        const W3 p = widened(point), origin = widened(ray.origin), d = widened(ray.direction);
        const W t = std::clamp(glm::dot(p - origin, d) / glm::dot(d, d), W(0), W(ray.max_t));
        const W3 exact = origin + d * t;
        const W scale = scale_with(scale_of(ray.origin), point);
        ASSERT_LE(glm::length(widened(closest_point(ray, point)) - exact), 16 * epsilon * scale)
            << "trial " << trial;
        ASSERT_LE(std::abs(std::sqrt(W(squared_distance(ray, point))) -
                           glm::length((p - origin) - d * t)),
                  8 * epsilon * glm::length(p - origin))
            << "trial " << trial;
    }
}

TEST(ClosestPoint, DegenerateAndMisuse) {
    const Vec3 p{Real(1), Real(2), Real(3)}, far{Real(9)};
    EXPECT_EQ(closest_point(Sphere{p, Real(0)}, far), p);
    EXPECT_EQ(closest_point(Segment{p, p}, far), p);
    EXPECT_EQ(closest_point(Capsule{p, p, Real(0)}, far), p);
    EXPECT_EQ(closest_point(Segment{far, p}, Vec3{Real(0)}), p); // an end, to the bit
    EXPECT_EQ(closest_point(Box{p, identity_rotation, Vec3{Real(0)}}, far), p);
    EXPECT_EQ(closest_point(Ray{p, far, Real(0)}, far), p);
    EXPECT_EQ(closest_point(Shape{Sphere{p, Real(0)}}, far), p);
    const Real nan = std::numeric_limits<Real>::quiet_NaN();
    says([&] { closest_point(Aabb{p, Vec3{Real(0)}}, p); }, "(1, 2, 3)");
    says([&] { closest_point(Aabb{Vec3{Real(0)}, p}, Vec3{nan}); }, "nan");
    says([&] { closest_point(Ray{p, p, Real(-2)}, p); }, "-2");
    says([&] { closest_point(Segment{p, Vec3{nan}}, p); }, "nan");
    says([&] { closest_point(Plane{Vec3{Real(3)}, Real(0)}, p); }, "(3, 3, 3)");
    says([&] { squared_distance(Box{p, identity_rotation, -p}, p); }, "(-1, -2, -3)");
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
