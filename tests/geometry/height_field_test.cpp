#include "engine/geometry/height_field.h"

#include "engine/geometry/triangle.h"
#include "engine/geometry/triangle_overlap.h"
#include "tests/geometry/oracle.h"
#include "tests/says.h"
#include "tests/trials.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace oracle;

constexpr double epsilon = double(std::numeric_limits<Real>::epsilon());

// Rough, stepped or flat ground of any size, near or far.
HeightField any_field(Random &random, int rows, int columns) {
    HeightField field;
    field.rows = rows;
    field.columns = columns;
    const std::uint32_t kind = random.next_index(4);
    const double size = kind == 0 ? 1.0 : std::pow(10.0, random.next_in(-3.0, 3.0));
    field.spacing = Real(size);
    if (kind == 0)
        field.origin = {Real(random.next_index(9)) - Real(4), Real(0), Real(-2)};
    else
        field.origin = any_vector(random, random.next_index(2) == 0 ? size : 100.0 * size);
    for (int i = 0; i < rows * columns; ++i)
        field.heights.push_back(kind == 0   ? Real(random.next_index(3))
                                : kind == 1 ? Real(0)
                                            : Real(size * random.next_in(-1.0, 1.0)));
    return field;
}

// Usually small: the oracle tests every triangle.
int any_side(Random &random) {
    return 2 + int(random.next_index(random.next_index(4) == 0 ? 6 : 3));
}

Vec3 any_point_of(Random &random, const HeightField &field) {
    const std::uint32_t index = random.next_index(triangle_count(field));
    const Triangle t = triangle(field, index);
    switch (random.next_index(4)) {
    case 0:
        return t.a;
    case 1:
        return Real(0.5) * (t.a + t.b);
    case 2:
        return glm::mix(t.c, t.a, Real(random.next_unit()));
    default:
        return glm::mix(glm::mix(t.a, t.b, Real(random.next_unit())), t.c,
                        Real(random.next_unit()));
    }
}

Ray any_ray(Random &random, const HeightField &field) {
    const Real size = field.spacing;
    const Vec3 target = any_point_of(random, field);
    Vec3 origin = random.next_index(3) == 0 ? any_point_of(random, field) : target;
    if (random.next_index(4) != 0)
        origin += size * any_vector(random, 4.0);
    Vec3 direction = target - origin;
    // Along grid lines, straight down, or nearly so.
    for (int i = 0; i < 3; ++i)
        if (random.next_index(6) == 0)
            direction[i] = random.next_index(2) == 0 ? Real(0) : -Real(0);
        else if (random.next_index(12) == 0)
            direction[i] *= Real(1e-7);
    if (direction == Vec3{Real(0)})
        direction.y = -size;
    direction *= Real(std::pow(10.0, random.next_in(-6.0, 6.0)));
    Ray ray{origin, direction};
    if (random.next_index(3) == 0)
        ray.max_t = size * Real(random.next_in(0.0, 6.0)) / glm::length(direction);
    return ray;
}

TEST(HeightField, RaysAgainstAllTriangles) {
    Random random(1);
    const int count = trials(1'000'000);
    HeightField field;
    int hits = 0;
    for (int trial = 0; trial < count; ++trial) {
        if (trial % 50 == 0)
            field = any_field(random, any_side(random), any_side(random));
        const Ray ray = any_ray(random, field);
        const auto hit = raycast(field, ray);
        std::optional<Real> least;
        for (std::uint32_t i = 0; i < triangle_count(field); ++i)
            if (const auto one = raycast(triangle(field, i), ray))
                least = least ? std::min(*least, one->t) : one->t;
        ASSERT_EQ(hit.has_value(), least.has_value()) << "trial " << trial;
        if (hit) {
            ++hits;
            ASSERT_EQ(hit->t, *least) << "trial " << trial;
        }
        const Vec3 a = ray.origin;
        const Vec3 b = trial % 3 == 0 ? any_point_of(random, field)
                                      : a + field.spacing * any_vector(random, 3.0);
        bool any = false;
        for (std::uint32_t i = 0; i < triangle_count(field) && !any; ++i)
            any = linetest(triangle(field, i), a, b);
        ASSERT_EQ(linetest(field, a, b), any) << "trial " << trial;
        ASSERT_EQ(linetest(field, a, a),
                  [&] {
                      for (std::uint32_t i = 0; i < triangle_count(field); ++i)
                          if (contains(triangle(field, i), a))
                              return true;
                      return false;
                  }())
            << "trial " << trial;
    }
    EXPECT_GT(hits, count / 4);
}

// From above at corners and edges inside the field's border: none may fall through.
TEST(HeightField, NothingFallsBetweenTriangles) {
    Random random(2);
    const int count = trials(1'000'000);
    HeightField field;
    for (int trial = 0; trial < count; ++trial) {
        if (trial % 1000 == 0) {
            field = any_field(random, 9, 12);
        }
        const int row = 1 + int(random.next_index(7)), column = 1 + int(random.next_index(10));
        const Vec3 corner = sample_point(field, row, column);
        Vec3 target = corner;
        const std::uint32_t kind = random.next_index(5);
        const Real s = Real(random.next_unit());
        if (kind == 1)
            target = glm::mix(corner, sample_point(field, row, column - 1), s);
        else if (kind == 2)
            target = glm::mix(corner, sample_point(field, row - 1, column), s);
        else if (kind == 3)
            target = glm::mix(corner, sample_point(field, row - 1, column - 1), s);
        // The ground rises by at most two spacings along each axis, a slope of 2.83. These rays
        // drop with a slope of at least 3.5, so they come from above and hit once.
        const Real drop = field.spacing * Real(random.next_in(3.0, 30.0));
        const Real slant = kind == 4 ? Real(0) : Real(0.2);
        const Vec3 up{slant * drop * Real(random.next_in(-1.0, 1.0)), drop,
                      slant * drop * Real(random.next_in(-1.0, 1.0))};
        Ray ray{target + up, -up * Real(std::pow(10.0, random.next_in(-3.0, 3.0)))};
        const auto hit = raycast(field, ray);
        ASSERT_TRUE(hit) << "trial " << trial;
        ASSERT_GT(hit->normal.y, Real(0));
        if (trial % 4 == 0) {
            ASSERT_TRUE(linetest(field, target + up, target - up)) << "trial " << trial;
        }
        // The ray passes the target to within the rounding of its origin and direction.
        const V o = wide(ray.origin);
        const double size = std::abs(o.x) + std::abs(o.y) + std::abs(o.z);
        const auto height = height_at(field, hit->point.x, hit->point.z);
        ASSERT_TRUE(height);
        ASSERT_NEAR(double(*height), double(hit->point.y), 32 * epsilon * size * (1.0 + 2.83))
            << "trial " << trial;
    }
}

// A field sampled from an inclined plane is that plane.
TEST(HeightField, InclinedPlane) {
    Random random(3);
    for (int trial = 0; trial < trials(20000); ++trial) {
        HeightField field;
        field.rows = 5;
        field.columns = 7;
        const int slope_x = int(random.next_index(7)) - 3, slope_z = int(random.next_index(7)) - 3;
        for (int row = 0; row < field.rows; ++row)
            for (int column = 0; column < field.columns; ++column)
                field.heights.push_back(Real(slope_x * column + slope_z * row));
        const Real x = Real(random.next_index(97)) / Real(16), z = Real(random.next_index(65)) / 16;
        const auto height = height_at(field, x, z);
        ASSERT_TRUE(height);
        ASSERT_NEAR(double(*height), double(slope_x) * double(x) + double(slope_z) * double(z),
                    8 * epsilon * 40);
        const auto hit = raycast(field, Ray{{x, Real(64), z}, {Real(0), Real(-2), Real(0)}});
        ASSERT_TRUE(hit);
        ASSERT_EQ(double(hit->point.y), double(slope_x) * double(x) + double(slope_z) * double(z));
        const V normal = glm::normalize(V{-slope_x, 1, -slope_z});
        for (int i = 0; i < 3; ++i)
            ASSERT_NEAR(double(hit->normal[i]), normal[i], 4 * epsilon);
        // From below the other side.
        const auto below = raycast(field, Ray{{x, Real(-64), z}, {Real(0), Real(1), Real(0)}});
        ASSERT_TRUE(below);
        ASSERT_LT(below->normal.y, Real(0));
    }
}

TEST(HeightField, HeightsAgainstWideArithmetic) {
    Random random(4);
    const int count = trials(1'000'000);
    HeightField field;
    for (int trial = 0; trial < count; ++trial) {
        if (trial % 1000 == 0)
            field = any_field(random, 6, 5);
        const Aabb all = bounds(field);
        const Vec3 p = glm::clamp(any_point_of(random, field), all.min, all.max);
        const auto height = height_at(field, p.x, p.z);
        ASSERT_TRUE(height) << "trial " << trial;
        // Against the triangles that contain p as seen from above; there is at least one.
        bool is_right = false;
        double most = 0.0;
        const Aabb column{{p.x, Real(-1e30), p.z}, {p.x, Real(1e30), p.z}};
        triangles_touching(field, column, [&](std::uint32_t, const Triangle &t) {
            using L = long double;
            const L ax = L(t.a.x) - L(p.x), az = L(t.a.z) - L(p.z);
            const L bx = L(t.b.x) - L(p.x), bz = L(t.b.z) - L(p.z);
            const L cx = L(t.c.x) - L(p.x), cz = L(t.c.z) - L(p.z);
            const L wa = bz * cx - bx * cz, wb = cz * ax - cx * az, wc = az * bx - ax * bz;
            const L size = wa + wb + wc;
            if (wa < -1e-6L * size || wb < -1e-6L * size || wc < -1e-6L * size)
                return true;
            const L y = (wa * L(t.a.y) + wb * L(t.b.y) + wc * L(t.c.y)) / size;
            const double largest = std::max(
                {std::abs(double(t.a.y)), std::abs(double(t.b.y)), std::abs(double(t.c.y))});
            // u and v are rounded, which adds an error for the place in a far-away cell.
            is_right |= std::abs(double(y) - double(*height)) <= 8 * epsilon * largest;
            most = std::max(most, std::abs(double(y) - double(*height)) / (epsilon * largest));
            return true;
        });
        ASSERT_TRUE(is_right) << "trial " << trial << " off by " << most << " epsilon";
    }
    const HeightField flat{Vec3{Real(0)}, Real(1), 2, 2, std::vector<Real>(4, Real(1))};
    EXPECT_FALSE(height_at(flat, std::nextafter(Real(1), Real(2)), Real(0)));
    EXPECT_FALSE(height_at(flat, Real(0), std::nextafter(Real(0), Real(-1))));
    EXPECT_EQ(height_at(flat, Real(1), Real(1)), Real(1));
}

TEST(HeightField, PointsAndSolidsAgainstAllTriangles) {
    Random random(5);
    const int count = trials(1'000'000);
    HeightField field;
    int touching = 0;
    for (int trial = 0; trial < count; ++trial) {
        if (trial % 50 == 0)
            field = any_field(random, any_side(random), any_side(random));
        const Real size = field.spacing;
        const Vec3 p = any_point_of(random, field) +
                       (trial % 5 == 0 ? Real(0) : size) *
                           any_vector(random, std::pow(10.0, random.next_in(-2.0, 1.0)));
        const Vec3 closest = closest_point(field, p);
        const double distance = glm::length(wide(p) - wide(closest));
        // A triangle's closest point may round to outside its box and so be nearer; then the cell
        // may be skipped.
        double least = 1e300, least_in_box = 1e300;
        for (std::uint32_t i = 0; i < triangle_count(field); ++i) {
            const Triangle t = triangle(field, i);
            const double here = glm::length(wide(p) - wide(closest_point(t, p)));
            const Aabb box = bounds(t);
            const double to_box = glm::length(wide(p) - wide(glm::clamp(p, box.min, box.max)));
            least = std::min(least, here);
            least_in_box = std::min(least_in_box, std::max(here, to_box));
        }
        ASSERT_GE(distance, least * (1.0 - 2 * epsilon)) << "trial " << trial;
        ASSERT_LE(distance, least_in_box * (1.0 + 2 * epsilon)) << "trial " << trial;

        const Real radius = size * Real(random.next_in(0.0, 1.5));
        const Sphere sphere{p, radius};
        const Aabb box{p - radius, p + radius * Vec3{Real(1), Real(0.5), Real(0.2)}};
        const Capsule capsule{p, p + size * any_vector(random, 2.0), Real(0.5) * radius};
        bool by_sphere = false, by_box = false, by_capsule = false;
        std::vector<std::uint32_t> expected, found;
        for (std::uint32_t i = 0; i < triangle_count(field); ++i) {
            const Triangle t = triangle(field, i);
            by_sphere |= overlaps(t, sphere);
            by_box |= overlaps(t, box);
            by_capsule |= overlaps(t, capsule);
            const Aabb around = bounds(t);
            bool is_touching = true;
            for (int axis = 0; axis < 3; ++axis)
                is_touching = is_touching && around.min[axis] <= box.max[axis] &&
                              around.max[axis] >= box.min[axis];
            if (is_touching)
                expected.push_back(i);
        }
        triangles_touching(field, box, [&](std::uint32_t index, const Triangle &t) {
            EXPECT_EQ(t.a, triangle(field, index).a);
            found.push_back(index);
            return true;
        });
        ASSERT_EQ(found, expected) << "trial " << trial;
        ASSERT_EQ(overlaps(field, sphere), by_sphere) << "trial " << trial;
        ASSERT_EQ(overlaps(field, box), by_box) << "trial " << trial;
        ASSERT_EQ(overlaps(field, capsule), by_capsule) << "trial " << trial;
        touching += by_sphere;
    }
    EXPECT_GT(touching, count / 10);
    EXPECT_LT(touching, count - count / 10);
}

TEST(HeightField, MisuseNamesTheValue) {
    const HeightField good{Vec3{Real(0)}, Real(1), 2, 2, std::vector<Real>(4, Real(0))};
    const Real nan = std::numeric_limits<Real>::quiet_NaN();
    check_valid(good);
    HeightField bad = good;
    bad.rows = 1;
    says([&] { check_valid(bad); }, "got 1 and 2");
    bad.rows = 3;
    says([&] { bounds(bad); }, "got 4");
    says([&] { raycast(bad, Ray{}); }, "got 4");
    bad = good;
    bad.spacing = Real(-3);
    says([&] { height_at(bad, Real(0), Real(0)); }, "-3");
    bad.spacing = Real(1e-30);
    bad.origin.x = Real(7);
    says([&] { check_valid(bad); }, "lost to rounding at 7");
    bad = good;
    bad.heights[2] = nan;
    says([&] { check_valid(bad); }, "nan");
    says([&] { height_at(good, nan, Real(0)); }, "nan");
    says([&] { closest_point(good, Vec3{nan}); }, "nan");
    says([&] { linetest(good, Vec3{nan}, Vec3{Real(0)}); }, "nan");
    says([&] { raycast(good, Ray{Vec3{Real(0)}, Vec3{Real(0)}}); }, "(0, 0, 0)");
    says([&] { overlaps(good, Sphere{Vec3{Real(0)}, Real(-5)}); }, "-5");
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
