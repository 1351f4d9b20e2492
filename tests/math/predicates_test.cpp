#include "engine/math/predicates.h"

#include "engine/core/random.h"
#include "tests/geometry/exact.h"
#include "tests/trials.h"

#include <gtest/gtest.h>

#include <cmath>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace exact_oracle;

int sign_of(const Rational &value) {
    return value.sign();
}

// The oracle for most trials: a long double decides if its error cannot reach `value`, and only the
// rest need rationals. `size` is a sum of magnitudes that bounds all intermediate values; each of
// fewer than 32 roundings adds an error below 2^-64.
template <typename Exactly>
int sign_by(long double value, long double size, const Exactly &exactly) {
    if (std::abs(value) > 0x1p-59L * size)
        return value > 0 ? 1 : -1;
    return sign_of(exactly());
}

long double wide(Real value) {
    return static_cast<long double>(value);
}

int true_cross_sign(const Vec2 &u, const Vec2 &a, const Vec2 &b) {
    const long double left = wide(u.x) * (wide(b.y) - wide(a.y));
    const long double right = wide(u.y) * (wide(b.x) - wide(a.x));
    return sign_by(left - right, std::abs(left) + std::abs(right), [&] {
        const Rational2 p = rational(u), q = rational(a), r = rational(b);
        return Rational(p.x * (r.y - q.y) - p.y * (r.x - q.x));
    });
}

int true_orient2d(const Vec2 &a, const Vec2 &b, const Vec2 &c) {
    const long double left = (wide(b.x) - wide(a.x)) * (wide(c.y) - wide(a.y));
    const long double right = (wide(b.y) - wide(a.y)) * (wide(c.x) - wide(a.x));
    return sign_by(left - right, std::abs(left) + std::abs(right), [&] {
        // The area as a sum over the corners; the engine takes differences first.
        const Rational2 p = rational(a), q = rational(b), r = rational(c);
        return Rational(p.x * q.y - p.y * q.x + q.x * r.y - q.y * r.x + r.x * p.y - r.y * p.x);
    });
}

struct Wide3 {
    long double x, y, z;
    Wide3(const Vec3 &a, const Vec3 &b)
        : x(wide(a.x) - wide(b.x)), y(wide(a.y) - wide(b.y)), z(wide(a.z) - wide(b.z)) {}
};

template <typename Exactly>
int true_triple(const Wide3 &u, const Wide3 &v, const Wide3 &w, const Exactly &exactly) {
    const long double value = u.x * (v.y * w.z - v.z * w.y) + u.y * (v.z * w.x - v.x * w.z) +
                              u.z * (v.x * w.y - v.y * w.x);
    const long double size = std::abs(u.x) * (std::abs(v.y * w.z) + std::abs(v.z * w.y)) +
                             std::abs(u.y) * (std::abs(v.z * w.x) + std::abs(v.x * w.z)) +
                             std::abs(u.z) * (std::abs(v.x * w.y) + std::abs(v.y * w.x));
    return sign_by(value, size, exactly);
}

int true_triple_sign(const Vec3 &u, const Vec3 &o, const Vec3 &a, const Vec3 &b) {
    return true_triple({u, Vec3{Real(0)}}, {a, o}, {b, o}, [&] {
        const Rational3 from = rational(o);
        return Rational(dot(rational(u), cross(rational(a) - from, rational(b) - from)));
    });
}

int true_orient3d(const Vec3 &a, const Vec3 &b, const Vec3 &c, const Vec3 &d) {
    return true_triple({d, a}, {b, a}, {c, a}, [&] {
        const Rational3 p = rational(a);
        return Rational(dot(rational(d) - p, cross(rational(b) - p, rational(c) - p)));
    });
}

int true_difference_sign(Real a, Real b, Real c, Real d) {
    const long double ab = wide(a) * wide(b), cd = wide(c) * wide(d);
    return sign_by(ab - cd, std::abs(ab) + std::abs(cd),
                   [&] { return Rational(rational(a) * rational(b) - rational(c) * rational(d)); });
}

int true_dot_sign(const Vec3 &a, const Vec3 &b, const Vec3 &c, const Vec3 &d) {
    const Wide3 u(b, a), v(d, c);
    return sign_by(u.x * v.x + u.y * v.y + u.z * v.z,
                   std::abs(u.x * v.x) + std::abs(u.y * v.y) + std::abs(u.z * v.z),
                   [&] { return dot(rational(b) - rational(a), rational(d) - rational(c)); });
}

int true_ball_sign(const Vec3 &center, Real radius, const Vec3 &point) {
    const Wide3 m(point, center);
    const long double reach = wide(radius) * wide(radius);
    const long double away = m.x * m.x + m.y * m.y + m.z * m.z;
    return sign_by(reach - away, reach + away, [&] {
        const Rational3 p = rational(point) - rational(center);
        return Rational(rational(radius) * rational(radius) - dot(p, p));
    });
}

int true_line_ball_sign(const Vec3 &center, Real radius, const Vec3 &origin, const Vec3 &from,
                        const Vec3 &to) {
    const Wide3 m(center, origin), d(to, from);
    const long double x = m.y * d.z - m.z * d.y, y = m.z * d.x - m.x * d.z,
                      z = m.x * d.y - m.y * d.x;
    const long double mm = m.x * m.x + m.y * m.y + m.z * m.z;
    const long double dd = d.x * d.x + d.y * d.y + d.z * d.z;
    const long double r = wide(radius);
    // The moment's error scales with |m| |d|, and the comparison uses its square.
    return sign_by(r * r * dd - (x * x + y * y + z * z),
                   dd * (r * r + 2 * r * std::sqrt(mm) + 0x1p-59L * mm), [&] {
                       // The centre's distance from its foot on the line; the engine uses the
                       // moment.
                       const Rational3 p = rational(center) - rational(origin);
                       const Rational3 q = rational(to) - rational(from);
                       const Rational squared = dot(q, q), along = dot(p, q);
                       return Rational(squared * (rational(radius) * rational(radius)) -
                                       (dot(p, p) * squared - along * along));
                   });
}

__extension__ typedef __float128 Quad; // 113 bits

// (b - a) x (d - c), to 1e-16 relative to its largest component; {0, 0, 0} exactly when it is zero.
glm::dvec3 true_cross(const Vec3 &a, const Vec3 &b, const Vec3 &c, const Vec3 &d) {
    const auto magnitude = [](Quad x) { return x < 0 ? -x : x; };
    Quad n[3], size = 0, greatest = 0;
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        const Quad left = (Quad(b[j]) - Quad(a[j])) * (Quad(d[k]) - Quad(c[k]));
        const Quad right = (Quad(b[k]) - Quad(a[k])) * (Quad(d[j]) - Quad(c[j]));
        n[i] = left - right;
        size += magnitude(left) + magnitude(right);
        greatest = std::max(greatest, magnitude(n[i]));
    }
    // Fewer than 8 roundings of 2^-113.
    if (Quad(0x1p-110) * size < Quad(1e-16) * greatest)
        return {double(n[0]), double(n[1]), double(n[2])};
    const Rational3 exact = cross(rational(b) - rational(a), rational(d) - rational(c));
    return {exact.x.convert_to<double>(), exact.y.convert_to<double>(),
            exact.z.convert_to<double>()};
}

// Coordinates of every kind: small integers, ordinary ones of one size, sizes over many orders of
// magnitude, zeros of both signs.
Real any_coordinate(Random &random, std::uint32_t kind) {
    switch (kind) {
    case 0:
        return Real(int(random.next_index(9)) - 4);
    case 1:
        return static_cast<Real>(random.next_in(-1.0, 1.0));
    case 2:
        return static_cast<Real>(random.next_in(-1.0, 1.0) *
                                 std::pow(10.0, random.next_in(-9.0, 6.0)));
    case 3:
        return static_cast<Real>(1e5 + random.next_in(-1e-2, 1e-2));
    default:
        return random.next_index(3) == 0 ? (random.next_index(2) == 0 ? Real(0) : -Real(0))
                                         : static_cast<Real>(random.next_in(-100.0, 100.0));
    }
}

Vec3 any_point(Random &random, std::uint32_t kind) {
    return {any_coordinate(random, kind), any_coordinate(random, kind),
            any_coordinate(random, kind)};
}

// Up to two ulps away; from zero, a step within the supported range.
Real nudged(Random &random, Real value) {
    if (value == Real(0))
        return random.next_index(3) == 0 ? Real(1e-20) : value;
    for (std::uint32_t steps = random.next_index(3); steps > 0; --steps)
        value = std::nextafter(value, random.next_index(2) == 0 ? Real(-1e30) : Real(1e30));
    return value;
}

Vec3 nudged(Random &random, const Vec3 &v) {
    return {nudged(random, v.x), nudged(random, v.y), nudged(random, v.z)};
}

TEST(Predicates, ProductDifference) {
    Random random(11);
    int zeros = 0;
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const std::uint32_t kind = random.next_index(5);
        const Real a = any_coordinate(random, kind), b = any_coordinate(random, kind);
        Real c = any_coordinate(random, kind), d = any_coordinate(random, kind);
        if (trial % 2 == 0) { // nearly equal products
            c = nudged(random, a * Real(2));
            d = nudged(random, b / Real(2));
        }
        const int sign = product_difference_sign(a, b, c, d);
        ASSERT_EQ(sign, true_difference_sign(a, b, c, d)) << a << ' ' << b << ' ' << c << ' ' << d;
        zeros += sign == 0;
    }
    EXPECT_GT(zeros, trials(1'000'000) / 50);
}

TEST(Predicates, PlaneSide) {
    Random random(12);
    int zeros = 0;
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const std::uint32_t kind = random.next_index(5);
        const Vec3 normal = any_point(random, random.next_index(5));
        const Vec3 point = any_point(random, kind);
        Real offset = any_coordinate(random, kind);
        if (trial % 2 == 0)
            offset = nudged(random, normal.x * point.x + normal.y * point.y + normal.z * point.z);
        const int sign = plane_sign(normal, offset, point);
        ASSERT_EQ(sign, side_of(normal, offset, point));
        zeros += sign == 0;
    }
    EXPECT_GT(zeros, trials(1'000'000) / 50);
}

TEST(Predicates, OrientInThePlane) {
    Random random(13);
    int zeros = 0;
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const std::uint32_t kind = random.next_index(5);
        const auto point = [&] {
            return Vec2{any_coordinate(random, kind), any_coordinate(random, kind)};
        };
        const Vec2 a = point(), b = point();
        Vec2 c = point();
        if (trial % 2 == 0) { // on the line, up to rounding
            const Real s = static_cast<Real>(random.next_in(-1.0, 2.0));
            c = {nudged(random, a.x + s * (b.x - a.x)), nudged(random, a.y + s * (b.y - a.y))};
        }
        const int sign = orient2d(a, b, c);
        ASSERT_EQ(sign, true_orient2d(a, b, c));
        ASSERT_EQ(sign, orient2d(b, c, a));
        ASSERT_EQ(sign, -orient2d(b, a, c));
        ASSERT_EQ(cross_sign(a, b, c), true_cross_sign(a, b, c));
        const Vec2 u = random.next_index(2) == 0 ? c - b : Real(0.5) * (b - c);
        ASSERT_EQ(cross_sign(u, b, c), true_cross_sign(u, b, c));
        zeros += sign == 0;
    }
    EXPECT_GT(zeros, trials(1'000'000) / 50);
}

TEST(Predicates, OrientInSpace) {
    Random random(14);
    int zeros = 0;
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const std::uint32_t kind = random.next_index(5);
        const Vec3 a = any_point(random, kind), b = any_point(random, kind),
                   c = any_point(random, kind);
        Vec3 d = any_point(random, kind);
        if (trial % 4 == 0) { // in the plane, up to rounding
            const Real s = static_cast<Real>(random.next_in(-1.0, 2.0));
            const Real t = static_cast<Real>(random.next_in(-1.0, 2.0));
            d = nudged(random, a + s * (b - a) + t * (c - a));
        } else if (trial % 16 == 1) { // a corner of the parallelogram
            d = a + (b - c);
        }
        const int sign = orient3d(a, b, c, d);
        ASSERT_EQ(sign, true_orient3d(a, b, c, d));
        if (trial % 8 == 0) {
            ASSERT_EQ(sign, orient3d(b, c, a, d));
            ASSERT_EQ(sign, -orient3d(b, a, c, d));
            ASSERT_EQ(sign, -orient3d(d, b, c, a));
            const Vec3 u = random.next_index(2) == 0 ? c - b : a;
            ASSERT_EQ(triple_sign(u, b, c, d), true_triple_sign(u, b, c, d));
            ASSERT_EQ(triple_sign(u, d, a, b), true_triple_sign(u, d, a, b));
        }
        zeros += sign == 0;
    }
    EXPECT_GT(zeros, trials(1'000'000) / 100);
}

// Nearly parallel vectors, whose cross product cancels completely.
TEST(Predicates, LinesAndBalls) {
    Random random(17);
    int zeros[3] = {};
    const int count = trials(1'000'000);
    for (int trial = 0; trial < count; ++trial) {
        const std::uint32_t kind = random.next_index(5);
        const Vec3 a = any_point(random, kind), b = any_point(random, kind),
                   c = any_point(random, kind);
        Vec3 d = any_point(random, kind);
        if (trial % 4 == 0) // nearly perpendicular
            d = nudged(random, c + glm::cross(b - a, any_point(random, 1)));
        const int dot = dot_sign(a, b, c, d);
        ASSERT_EQ(dot, true_dot_sign(a, b, c, d)) << "trial " << trial;
        zeros[0] += dot == 0;

        const Real to_point = nudged(random, glm::length(b - a));
        const int ball = ball_sign(a, to_point, b);
        ASSERT_EQ(ball, true_ball_sign(a, to_point, b)) << "trial " << trial;
        zeros[1] += ball == 0;

        const Vec3 along = d - c;
        const Real length = glm::length(along);
        const Real to_line = nudged(
            random, length > Real(0) ? glm::length(glm::cross(a - b, along)) / length : Real(1));
        const int line = line_ball_sign(a, to_line, b, c, d);
        ASSERT_EQ(line, true_line_ball_sign(a, to_line, b, c, d)) << "trial " << trial;
        zeros[2] += line == 0;
    }
    for (const int zero : zeros)
        EXPECT_GT(zero, count / 300);
}

TEST(Predicates, AccurateCross) {
    Random random(16);
    int zeros = 0, cancelled = 0;
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const std::uint32_t kind = random.next_index(5);
        const Vec3 a = any_point(random, kind), b = any_point(random, kind),
                   c = any_point(random, kind);
        const Real s = static_cast<Real>(random.next_in(-2.0, 2.0));
        const Vec3 d = trial % 2 == 0 ? nudged(random, c + s * (b - a)) : any_point(random, kind);
        const glm::dvec3 answer = accurate_cross(a, b, c, d);
        const glm::dvec3 truth = true_cross(a, b, c, d);
        const bool is_zero = truth == glm::dvec3(0.0);
        ASSERT_EQ(answer == glm::dvec3(0.0), is_zero) << "trial " << trial;
        zeros += is_zero;
        // Scaled, because the squares of the smallest would underflow.
        const double size =
            std::max({std::abs(truth.x), std::abs(truth.y), std::abs(truth.z), 1e-300});
        ASSERT_LE(glm::length((answer - truth) / size),
                  (sizeof(Real) == 4 ? 2e-9 : 4e-15) * glm::length(truth / size))
            << "trial " << trial;
        const double lengths =
            glm::length(glm::dvec3(b) - glm::dvec3(a)) * glm::length(glm::dvec3(d) - glm::dvec3(c));
        cancelled += size < 1e-6 * lengths;
    }
    EXPECT_GT(zeros, trials(1'000'000) / 100);
    EXPECT_GT(cancelled, trials(1'000'000) / 10);
}

// Coordinates from both ends of the supported range in one determinant.
TEST(Predicates, TheWholeRange) {
    Random random(15);
    const double low = sizeof(Real) == 4 ? -44.0 : -80.0, high = sizeof(Real) == 4 ? 38.0 : 90.0;
    const auto coordinate = [&] {
        return static_cast<Real>((random.next_index(2) == 0 ? -1.0 : 1.0) *
                                 random.next_in(1.0, 3.0) *
                                 std::pow(10.0, random.next_in(low, high)));
    };
    const auto point = [&] { return Vec3{coordinate(), coordinate(), coordinate()}; };
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const Vec3 a = point(), b = point(), c = point();
        Vec3 d = point();
        if (trial % 2 == 0)
            d = {b.x, c.y, a.z};
        ASSERT_EQ(orient3d(a, b, c, d), true_orient3d(a, b, c, d));
        ASSERT_EQ(triple_sign(a, b, c, d), true_triple_sign(a, b, c, d));
        ASSERT_EQ(orient3d(a, b, a, d), 0);
        ASSERT_EQ(orient2d(Vec2(a), Vec2(b), Vec2(c)), true_orient2d(Vec2(a), Vec2(b), Vec2(c)));
        ASSERT_EQ(cross_sign(Vec2(a), Vec2(b), Vec2(c)),
                  true_cross_sign(Vec2(a), Vec2(b), Vec2(c)));
        ASSERT_EQ(plane_sign(a, b.x, c), side_of(a, b.x, c));
        ASSERT_EQ(product_difference_sign(a.x, b.x, c.x, d.x),
                  true_difference_sign(a.x, b.x, c.x, d.x));
        ASSERT_EQ(dot_sign(a, b, c, d), true_dot_sign(a, b, c, d));
        ASSERT_EQ(ball_sign(a, b.x, c), true_ball_sign(a, b.x, c));
    }
}

// Products of four factors.
TEST(Predicates, TheWholeRangeOfLinesAndBalls) {
    Random random(18);
    const double low = sizeof(Real) == 4 ? -44.0 : -60.0, high = sizeof(Real) == 4 ? 38.0 : 70.0;
    const auto coordinate = [&] {
        return static_cast<Real>((random.next_index(2) == 0 ? -1.0 : 1.0) *
                                 random.next_in(1.0, 3.0) *
                                 std::pow(10.0, random.next_in(low, high)));
    };
    const auto point = [&] { return Vec3{coordinate(), coordinate(), coordinate()}; };
    for (int trial = 0; trial < trials(40'000); ++trial) {
        const Vec3 a = point(), b = point(), c = point(), d = point();
        const Real radius = trial % 2 == 0 ? std::abs(coordinate()) : std::abs(a.y - b.y);
        const Vec3 to = trial % 2 == 0 ? d : Vec3{d.x, c.y, c.z}; // along x
        const Vec3 center = trial % 2 == 0 ? a : Vec3{a.x, a.y, b.z};
        const Rational3 m = rational(center) - rational(b), q = rational(to) - rational(c);
        const Rational r = rational(radius);
        ASSERT_EQ(line_ball_sign(center, radius, b, c, to),
                  sign_of(r * r * dot(q, q) - dot(cross(m, q), cross(m, q))))
            << "trial " << trial;
    }
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
