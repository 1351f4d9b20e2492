// Lines that touch a sphere, or miss it by the last bit: whether a ray, segment or point meets a
// sphere or circle is exact.
#include "engine/core/random.h"
#include "engine/geometry/contains.h"
#include "engine/geometry/contains_2d.h"
#include "engine/geometry/raycast.h"
#include "engine/geometry/raycast_2d.h"
#include "tests/geometry/exact.h"
#include "tests/trials.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <span>

#include <glm/geometric.hpp>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace exact_oracle;

// The deciding signs: the origin's depth and whether the centre is ahead of it; the same for the
// other end, looking back; and whether the line comes close enough.
struct Truth {
    int depth, ahead, end_depth, end_ahead, line;

    bool starts_inside() const { return depth >= 0; }
    bool ray_meets() const { return depth >= 0 || (line >= 0 && ahead > 0); }
    bool segment_meets() const {
        return depth >= 0 || end_depth >= 0 || (line >= 0 && ahead > 0 && end_ahead > 0);
    }
};

template <typename Number> int sign_of(const Number &x) {
    return x > 0 ? 1 : (x < 0 ? -1 : 0);
}

// The five signs from exact numbers: m from the origin to the centre, d to the other end.
template <typename Number, typename Vector>
Truth truth_of(const Vector &m, const Vector &d, const Number &radius) {
    const Number mm = dot(m, m), md = dot(m, d), dd = dot(d, d), rr = radius * radius;
    const Vector beyond = m - d;
    const Number end = dot(beyond, beyond), back = -dot(beyond, d);
    const Vector moment = cross(m, d);
    const Number height = dot(moment, moment), reach = rr * dd;
    return {sign_of(Number(rr - mm)), sign_of(md), sign_of(Number(rr - end)), sign_of(back),
            sign_of(Number(reach - height))};
}

struct Tally {
    int touching = 0;
    int met = 0;
    int lost_when_rounded = 0; // by the discriminant in Real
};

void check_sphere(const Sphere &sphere, const Ray &ray, const Truth &truth, Tally &tally) {
    const auto interval = ray_interval(sphere, ray);
    ASSERT_EQ(interval.has_value(), truth.ray_meets());
    ASSERT_EQ(contains(sphere, ray.origin), truth.starts_inside());
    tally.met += interval.has_value() ? 1 : 0;
    tally.touching += truth.line == 0 ? 1 : 0;
    const Vec3 m = sphere.center - ray.origin;
    const Vec3 moment = glm::cross(m, ray.direction);
    const Real rest = sphere.radius * sphere.radius * glm::dot(ray.direction, ray.direction) -
                      glm::dot(moment, moment);
    tally.lost_when_rounded += (rest >= Real(0)) != (truth.line >= 0) ? 1 : 0;
    if (!interval)
        return;
    ASSERT_EQ(interval->enter_normal == Vec3{Real(0)}, truth.starts_inside());
    ASSERT_GE(interval->t_enter, Real(0));
    ASSERT_LE(interval->t_enter, interval->t_exit);
    if (truth.line == 0) {
        ASSERT_TRUE(truth.starts_inside() || interval->t_enter == interval->t_exit);
    }
}

// --- Integers, in 128 bits -----------------------------------------------------------------------

using Large = Whole3<Int128>;

std::int64_t any_whole(Random &random, std::int64_t reach) {
    return static_cast<std::int64_t>(random.next_u64() % std::uint64_t(2 * reach + 1)) - reach;
}

// Integer vectors of integer length.
struct UnitTimes {
    int x, y, z, length;
};
constexpr UnitTimes space_units[] = {{1, 0, 0, 1}, {3, 4, 0, 5}, {1, 2, 2, 3},
                                     {2, 3, 6, 7}, {4, 4, 7, 9}, {2, 6, 9, 11}};
constexpr UnitTimes plane_units[] = {{1, 0, 0, 1}, {3, 4, 0, 5}, {5, 12, 0, 13}, {8, 15, 0, 17}};

struct WholeCase {
    Large center, origin, along;
    std::int64_t radius;
};

// A line through a point of the sphere's surface, perpendicular to the radius there; then perhaps a
// sphere larger or smaller by one.
WholeCase any_tangent(Random &random, std::span<const UnitTimes> units, bool is_plane) {
    const bool is_double = sizeof(Real) == sizeof(double);
    const UnitTimes &unit = units[random.next_index(std::uint32_t(units.size()))];
    const bool swaps = random.next_index(2) == 0;
    const auto sign = [&] { return random.next_index(2) == 0 ? 1 : -1; };
    const Large n{sign() * (swaps ? unit.y : unit.x), sign() * (swaps ? unit.x : unit.y),
                  sign() * unit.z};
    const std::int64_t spread = std::int64_t(1) << random.next_index(is_double ? 34 : 16);
    const std::int64_t size = std::int64_t(1) << random.next_index(is_double ? 30 : 12);
    const std::int64_t slope = std::int64_t(1) << random.next_index(9);
    const std::int64_t times = 1 + std::abs(any_whole(random, size));
    const std::int64_t z = is_plane ? 0 : 1;
    WholeCase one{};
    one.center = {any_whole(random, spread), any_whole(random, spread),
                  z * any_whole(random, spread)};
    one.radius = times * unit.length;
    const Large other{z * any_whole(random, slope), z * any_whole(random, slope),
                      any_whole(random, slope)};
    one.along = cross(n, other);
    const Int128 steps = any_whole(random, 40);
    one.origin = Large{one.center.x + times * n.x - steps * one.along.x,
                       one.center.y + times * n.y - steps * one.along.y,
                       one.center.z + times * n.z - steps * one.along.z};
    const std::uint32_t nudge = random.next_index(4);
    if (nudge == 1)
        ++one.radius;
    if (nudge == 2)
        --one.radius;
    return one;
}

Vec3 real(const Large &v) {
    return {static_cast<Real>(std::int64_t(v.x)), static_cast<Real>(std::int64_t(v.y)),
            static_cast<Real>(std::int64_t(v.z))};
}

bool is_kept(const Large &v) {
    const Vec3 rounded = real(v);
    return std::int64_t(rounded.x) == v.x && std::int64_t(rounded.y) == v.y &&
           std::int64_t(rounded.z) == v.z;
}

TEST(Tangents, SpheresInWholeNumbers) {
    Random random(0x7a1);
    Tally tally;
    int segments = 0;
    const int count = trials(1'000'000);
    for (int trial = 0; trial < count; ++trial) {
        const WholeCase one = any_tangent(random, space_units, false);
        const Large end{one.origin.x + one.along.x, one.origin.y + one.along.y,
                        one.origin.z + one.along.z};
        if (is_zero(one.along) || !is_kept(one.origin) || !is_kept(end))
            continue;
        const Truth truth = truth_of(one.center - one.origin, one.along, Int128(one.radius));
        // The same in any unit of length.
        const Real unit = std::ldexp(Real(1), int(random.next_index(41)) - 20);
        const Real stretch = std::ldexp(Real(1), int(random.next_index(41)) - 20);
        const Sphere sphere{unit * real(one.center), unit * Real(one.radius)};
        const Vec3 origin = unit * real(one.origin);
        check_sphere(sphere, Ray{origin, stretch * real(one.along)}, truth, tally);
        ASSERT_EQ(linetest(sphere, origin, unit * real(end)), truth.segment_meets());
        segments += truth.segment_meets() ? 1 : 0;
        if (HasFatalFailure())
            FAIL() << "trial " << trial;
    }
    EXPECT_GT(tally.touching, count / 4);
    EXPECT_GT(tally.met, count / 4);
    EXPECT_GT(segments, count / 100);
    EXPECT_GT(tally.lost_when_rounded, count / 100);
}

TEST(Tangents, CirclesInWholeNumbers) {
    Random random(0x7a2);
    int touching = 0, met = 0, segments = 0;
    const int count = trials(1'000'000);
    for (int trial = 0; trial < count; ++trial) {
        const WholeCase one = any_tangent(random, plane_units, true);
        const Large end{one.origin.x + one.along.x, one.origin.y + one.along.y, 0};
        if (is_zero(one.along) || !is_kept(one.origin) || !is_kept(end))
            continue;
        const Truth truth = truth_of(one.center - one.origin, one.along, Int128(one.radius));
        const Circle circle{Vec2(real(one.center)), Real(one.radius)};
        const Vec2 origin(real(one.origin));
        const Ray2 ray{origin, Vec2(real(one.along))};
        const auto interval = ray_interval(circle, ray);
        ASSERT_EQ(interval.has_value(), truth.ray_meets()) << "trial " << trial;
        ASSERT_EQ(contains(circle, origin), truth.starts_inside()) << "trial " << trial;
        ASSERT_EQ(linetest(circle, origin, Vec2(real(end))), truth.segment_meets())
            << "trial " << trial;
        if (interval && truth.line == 0) {
            ASSERT_TRUE(truth.starts_inside() || interval->t_enter == interval->t_exit);
        }
        touching += truth.line == 0 ? 1 : 0;
        met += interval ? 1 : 0;
        segments += truth.segment_meets() ? 1 : 0;
    }
    EXPECT_GT(touching, count / 4);
    EXPECT_GT(met, count / 4);
    EXPECT_GT(segments, count / 100);
}

// --- Any numbers, in rationals -------------------------------------------------------------------

// Rounded, for when 64 bits are enough.
struct Long3 {
    long double x, y, z;

    friend Long3 operator-(const Long3 &a, const Long3 &b) {
        return {a.x - b.x, a.y - b.y, a.z - b.z};
    }
    friend long double dot(const Long3 &a, const Long3 &b) {
        return a.x * b.x + a.y * b.y + a.z * b.z;
    }
    friend Long3 cross(const Long3 &a, const Long3 &b) {
        return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    }
};

Long3 wide(const Vec3 &v) {
    return {v.x, v.y, v.z};
}

Truth true_signs(const Sphere &sphere, const Vec3 &origin, const Vec3 &direction) {
    const Long3 m = wide(sphere.center) - wide(origin), d = wide(direction);
    const long double r = sphere.radius;
    const Long3 moment = cross(m, d), beyond = m - d;
    const long double dd = dot(d, d), mm = dot(m, m), away = dot(beyond, beyond);
    // Fewer than 32 roundings, each below 2^-64 of the bound on the terms; for the line, rounding
    // the moment is worth `off` of its distance.
    const long double sharp = 0x1p-59L;
    const long double off = sharp * (std::sqrt(mm) + r);
    const bool is_clear =
        std::abs(r * r - mm) > sharp * (r * r + mm) &&
        std::abs(dot(m, d)) > sharp * std::sqrt(mm * dd) &&
        std::abs(r * r - away) > sharp * (r * r + mm + dd) &&
        std::abs(dot(beyond, d)) > sharp * (std::sqrt(mm) + std::sqrt(dd)) * std::sqrt(dd) &&
        std::abs(r * r * dd - dot(moment, moment)) > dd * off * (2 * r + off);
    if (is_clear)
        return truth_of(m, d, r);
    return truth_of(rational(sphere.center) - rational(origin), rational(direction),
                    rational(sphere.radius));
}

Real nudged(Random &random, Real x) {
    for (std::uint32_t steps = random.next_index(3); steps > 0; --steps)
        x = std::nextafter(x, random.next_index(2) == 0 ? Real(-1e30) : Real(1e30));
    return x;
}

Vec3 any_vector(Random &random, double reach) {
    const auto x = static_cast<Real>(random.next_in(-reach, reach));
    const auto y = static_cast<Real>(random.next_in(-reach, reach));
    const auto z = static_cast<Real>(random.next_in(-reach, reach));
    return {x, y, z};
}

// Spheres whose radius is the distance to the line, or to the origin, to the last bit.
TEST(Tangents, SpheresOfAnySizeAndPlace) {
    Random random(0x7a3);
    Tally tally;
    const int count = trials(1'000'000);
    for (int trial = 0; trial < count; ++trial) {
        const double size = std::pow(10.0, random.next_in(-3.0, 5.0));
        const Vec3 center = any_vector(random, random.next_index(2) == 0 ? size : 1e5);
        const Vec3 origin =
            center + any_vector(random, size * std::pow(10.0, random.next_in(-2.0, 2.0)));
        Vec3 direction = any_vector(random, 1.0);
        for (int i = 0; i < 3; ++i)
            if (random.next_index(4) == 0)
                direction[i] = random.next_index(2) == 0 ? Real(0) : -Real(0);
        direction *= static_cast<Real>(std::pow(10.0, random.next_in(-6.0, 6.0)));
        if (direction == Vec3{Real(0)})
            continue;
        const Long3 m = wide(center) - wide(origin), d = wide(direction);
        const Long3 moment = cross(m, d);
        const bool is_by_origin = random.next_index(4) == 0;
        const long double distance =
            is_by_origin ? std::sqrt(dot(m, m)) : std::sqrt(dot(moment, moment) / dot(d, d));
        const Sphere sphere{center, std::max(nudged(random, static_cast<Real>(distance)), Real(0))};
        const Truth truth = true_signs(sphere, origin, direction);
        check_sphere(sphere, Ray{origin, direction}, truth, tally);
        if (HasFatalFailure())
            FAIL() << "trial " << trial;
    }
    EXPECT_GT(tally.met, count / 4);
    EXPECT_GT(tally.lost_when_rounded, count / 20);
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
