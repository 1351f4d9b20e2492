// Families of rays that break slab tests, quadratic formulas and epsilons.

#include "engine/core/random.h"
#include "engine/geometry/contains.h"
#include "engine/geometry/raycast.h"
#include "tests/geometry/exact.h"
#include "tests/geometry/wide_triangle.h"
#include "tests/trials.h"

#include <gtest/gtest.h>

#include <optional>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace exact_oracle;
using namespace wide_triangle;

constexpr Real infinity = std::numeric_limits<Real>::infinity();

// The direction to a target, of any length, with some components zero, negative zero or tiny.
Vec3 awkward_direction(Random &random, const Vec3 &to_target) {
    Vec3 direction = to_target;
    for (int i = 0; i < 3; ++i) {
        const Real tiny[] = {Real(0), -Real(0), Real(1e-30), Real(-1e-20)};
        if (random.next_index(6) == 0)
            direction[i] = tiny[random.next_index(4)];
    }
    direction *= static_cast<Real>(std::pow(10.0, random.next_in(-6.0, 6.0)));
    return direction;
}

// --- Axis-aligned boxes: the slabs in rationals, and in long double where that is enough.

struct Slabs {
    long double near = 0.0L; // the latest entry
    long double far = std::numeric_limits<long double>::infinity();
    bool is_met = true;
};

bool is_met_exactly(const Aabb &box, const Ray &ray) {
    Rational near = 0, far;
    bool has_far = ray.max_t < infinity;
    if (has_far)
        far = rational(ray.max_t);
    for (int i = 0; i < 3; ++i) {
        const Rational origin = rational(ray.origin[i]), d = rational(ray.direction[i]);
        const Rational low = rational(box.min[i]), high = rational(box.max[i]);
        if (d == 0) {
            if (origin < low || origin > high)
                return false;
            continue;
        }
        const Rational to_low = (low - origin) / d, to_high = (high - origin) / d;
        near = std::max(near, std::min(to_low, to_high));
        far = has_far ? std::min(far, std::max(to_low, to_high)) : std::max(to_low, to_high);
        has_far = true;
    }
    return !has_far || near <= far;
}

Slabs slabs(const Aabb &box, const Ray &ray) {
    Slabs s;
    for (int i = 0; i < 3; ++i) {
        const long double origin = ray.origin[i], d = ray.direction[i];
        const long double low = box.min[i], high = box.max[i];
        if (d == 0.0L) {
            s.is_met = s.is_met && origin >= low && origin <= high;
            continue;
        }
        s.near = std::max(s.near, std::min((low - origin) / d, (high - origin) / d));
        s.far = std::min(s.far, std::max((low - origin) / d, (high - origin) / d));
    }
    s.far = std::min(s.far, static_cast<long double>(ray.max_t));
    if (!s.is_met)
        return s;
    s.is_met = std::abs(s.far - s.near) > 1e-17L * std::abs(s.far) ? s.near <= s.far
                                                                   : is_met_exactly(box, ray);
    return s;
}

TEST(RaycastFamilies, NoRayThatMeetsABoxIsLost) {
    Random random(51);
    int meets = 0, grazes = 0;
    const int count = trials(1'000'000);
    for (int trial = 0; trial < count; ++trial) {
        const double size = std::pow(10.0, random.next_in(-3.0, 5.0));
        const Vec3 center = any_offset(random, random.next_index(2) == 0 ? size : 1e5);
        const Vec3 half = glm::abs(any_offset(random, size));
        const Box box{center, identity_rotation, half};
        const Aabb aabb{center - half, center + half};
        // To a corner, an edge or a face, into the box, or past it.
        Vec3 target = center + any_offset(random, 1.2 * size);
        for (int i = 0; i < 3; ++i)
            if (random.next_index(2) == 0)
                target[i] = random.next_index(2) == 0 ? aabb.min[i] : aabb.max[i];
        Vec3 origin = center + any_offset(random, size * std::pow(10.0, random.next_in(-2.0, 3.0)));
        for (int i = 0; i < 3; ++i)
            if (random.next_index(6) == 0)
                origin[i] = random.next_index(2) == 0 ? aabb.min[i] : aabb.max[i];
        Ray ray{origin, awkward_direction(random, target - origin)};
        if (ray.direction == Vec3{Real(0)})
            continue;
        if (random.next_index(4) == 0) {
            ray.direction = target - origin;
            ray.max_t = random.next_index(2) == 0 ? Real(1) : Real(0.5);
            if (ray.direction == Vec3{Real(0)})
                continue;
        }
        const Slabs truth = slabs(aabb, ray);
        const auto interval = ray_interval(aabb, ray);
        if (truth.is_met && truth.near < std::numeric_limits<Real>::max()) {
            ASSERT_TRUE(interval) << "trial " << trial;
            ++meets;
        }
        if (interval) {
            const long double enter = interval->t_enter, exit = interval->t_exit;
            // Past the edge by no more than the stated bound.
            ASSERT_LE(truth.near, truth.far + 8.0L * epsilon * truth.far) << "trial " << trial;
            ASSERT_LE(std::abs(enter - truth.near), 8.0L * epsilon * truth.near)
                << "trial " << trial;
            if (exit < infinity) {
                ASSERT_LE(std::abs(exit - truth.far), 8.0L * epsilon * exit) << "trial " << trial;
            }
            ASSERT_EQ(interval->enter_normal == Vec3{Real(0)}, contains(aabb, ray.origin))
                << "trial " << trial;
            grazes += !truth.is_met;
        }
        const auto prepared = ray_interval(aabb, PreparedRay(ray));
        if (truth.is_met && truth.near < std::numeric_limits<Real>::max()) {
            ASSERT_TRUE(prepared) << "trial " << trial;
        }
        if (prepared) {
            const long double enter = prepared->t_enter, exit = prepared->t_exit;
            ASSERT_LE(truth.near, truth.far + 8.0L * epsilon * truth.far) << "trial " << trial;
            ASSERT_LE(std::abs(enter - truth.near), 8.0L * epsilon * truth.near)
                << "trial " << trial;
            if (exit < infinity) {
                ASSERT_LE(std::abs(exit - truth.far), 8.0L * epsilon * exit) << "trial " << trial;
            }
            ASSERT_EQ(prepared->enter_normal == Vec3{Real(0)}, contains(aabb, ray.origin))
                << "trial " << trial;
        }
        const auto of_box = ray_interval(box, ray);
        ASSERT_EQ(of_box.has_value(), interval.has_value());
        if (of_box) {
            ASSERT_TRUE(of_box->t_enter == interval->t_enter && of_box->t_exit == interval->t_exit);
        }
    }
    EXPECT_GT(meets, count / 5);
    EXPECT_GT(grazes, 0);
}

// --- Small integers, where nothing rounds: every touching case must be exactly right.

struct WholeRay {
    Vec3 origin, direction;
};

WholeRay any_whole_ray(Random &random, int reach) {
    const auto coordinate = [&] {
        return Real(int(random.next_index(2 * std::uint32_t(reach) + 1)) - reach);
    };
    WholeRay ray{{coordinate(), coordinate(), coordinate()},
                 {coordinate(), coordinate(), coordinate()}};
    for (int i = 0; i < 3; ++i)
        if (random.next_index(4) == 0)
            ray.direction[i] = random.next_index(2) == 0 ? Real(0) : -Real(0);
    return ray;
}

using Whole = Whole3<long long>;
Whole exactly(const Vec3 &v) {
    return whole<long long>(v, 1.0);
}
long long squared(const Whole &v) {
    return dot(v, v);
}

// Whether some point o + t d, 0 <= t <= last, is within r of the segment from a along e, whose
// length may be zero: the minimum of a quadratic form over a strip, by its corners, sides and
// interior.
bool comes_within(const Whole &o, const Whole &d, std::optional<long long> last, const Whole &a,
                  const Whole &e, long long r) {
    const Whole w = o - a;
    const long long dd = squared(d), ee = squared(e), de = dot(d, e), wd = dot(w, d),
                    we = dot(w, e);
    // Inside: t = (we de - wd ee) / n, s = (we dd - wd de) / n, at the distance (w . d x e)^2 / n.
    const Whole c = cross(d, e);
    const long long n = squared(c);
    if (n > 0) {
        const long long t = we * de - wd * ee, s = we * dd - wd * de;
        const long long volume = dot(w, c);
        if (t >= 0 && (!last || t <= *last * n) && s >= 0 && s <= n && volume * volume <= r * r * n)
            return true;
    }
    const auto near_line = [&](const Whole &from, const Whole &along, std::optional<long long> end,
                               const Whole &p) {
        const Whole to = p - from;
        const long long height = dot(to, along), length = squared(along);
        if (height > 0 && (!end || height < *end * length))
            return squared(cross(to, along)) <= r * r * length;
        const Whole tip = end && height > 0 ? Whole{to.x - *end * along.x, to.y - *end * along.y,
                                                    to.z - *end * along.z}
                                            : to;
        return squared(tip) <= r * r;
    };
    const Whole b{a.x + e.x, a.y + e.y, a.z + e.z};
    if (near_line(o, d, last, a) || near_line(o, d, last, b) || near_line(a, e, 1, o))
        return true;
    return last && near_line(a, e, 1, {o.x + *last * d.x, o.y + *last * d.y, o.z + *last * d.z});
}

TEST(RaycastFamilies, RoundShapesAreExactForSmallIntegers) {
    Random random(52);
    int hits[2] = {};
    const int count = trials(1'000'000);
    for (int trial = 0; trial < count; ++trial) {
        const int reach = trial % 2 == 0 ? 2 : 7;
        const WholeRay ray = any_whole_ray(random, reach);
        if (ray.direction == Vec3{Real(0)})
            continue;
        const WholeRay ends = any_whole_ray(random, reach);
        const Vec3 a = ends.origin, b = random.next_index(8) == 0 ? a : ends.direction;
        const int radius = int(random.next_index(std::uint32_t(reach) + 1));
        const Whole o = exactly(ray.origin), d = exactly(ray.direction);
        const std::optional<long long> last =
            trial % 3 == 0 ? std::optional<long long>(1) : std::nullopt;
        const Ray cut{ray.origin, ray.direction, last ? Real(1) : infinity};

        const bool to_capsule = ray_interval(Capsule{a, b, Real(radius)}, cut).has_value();
        ASSERT_EQ(to_capsule, comes_within(o, d, last, exactly(a), exactly(b) - exactly(a), radius))
            << "trial " << trial;
        const bool to_sphere = ray_interval(Sphere{a, Real(radius)}, cut).has_value();
        ASSERT_EQ(to_sphere, comes_within(o, d, last, exactly(a), {0, 0, 0}, radius))
            << "trial " << trial;
        const Vec3 end = ray.origin + ray.direction;
        ASSERT_EQ(linetest(Capsule{a, b, Real(radius)}, ray.origin, end),
                  comes_within(o, d, 1, exactly(a), exactly(b) - exactly(a), radius));
        ASSERT_EQ(linetest(Sphere{a, Real(radius)}, ray.origin, end),
                  comes_within(o, d, 1, exactly(a), {0, 0, 0}, radius));
        hits[0] += to_capsule;
        hits[1] += to_sphere;
    }
    EXPECT_GT(hits[0], count / 5);
    EXPECT_GT(hits[1], count / 10);
}

// Along an axis a cylinder is a disc times an interval.
TEST(RaycastFamilies, CylindersAreExactForSmallIntegers) {
    Random random(53);
    int hits = 0;
    const int count = trials(2'000'000); // a million segments
    for (int trial = 0; trial < count; ++trial) {
        const WholeRay ray = any_whole_ray(random, 6);
        const int k = int(random.next_index(3)), x = (k + 1) % 3, y = (k + 2) % 3;
        const Vec3 a = any_whole_ray(random, 3).origin;
        const int length = 1 + int(random.next_index(5)), radius = int(random.next_index(6));
        Vec3 b = a;
        b[k] += Real(length);
        const bool is_segment = trial % 2 == 0;
        if (ray.direction == Vec3{Real(0)})
            continue;
        const Cylinder cylinder =
            trial % 4 < 2 ? Cylinder{a, b, Real(radius)} : Cylinder{b, a, Real(radius)};
        const auto interval =
            ray_interval(cylinder, Ray{ray.origin, ray.direction, is_segment ? Real(1) : infinity});
        // t is in [near, far], as integer fractions over |d_k|; the disc must be near within that.
        const Whole o = exactly(ray.origin) - exactly(a), d = exactly(ray.direction);
        const long long o_k = k == 0 ? o.x : (k == 1 ? o.y : o.z);
        const long long d_k = k == 0 ? d.x : (k == 1 ? d.y : d.z);
        const auto component = [](const Whole &v, int i) {
            return i == 0 ? v.x : (i == 1 ? v.y : v.z);
        };
        const long long ox = component(o, x), oy = component(o, y), dx = component(d, x),
                        dy = component(d, y);
        bool is_met = true;
        Rational near = 0, far = is_segment ? 1 : 1'000'000;
        if (d_k == 0) {
            is_met = o_k >= 0 && o_k <= length;
        } else {
            const Rational to_a = Rational(-o_k) / d_k, to_b = Rational(length - o_k) / d_k;
            near = std::max(near, std::min(to_a, to_b));
            far = std::min(far, std::max(to_a, to_b));
            is_met = near <= far;
        }
        if (is_met) {
            const long long dd = dx * dx + dy * dy;
            Rational t = dd == 0 ? near : Rational(Rational(-(ox * dx + oy * dy)) / dd);
            t = std::min(std::max(t, near), far);
            const Rational px = ox + t * dx, py = oy + t * dy;
            is_met = px * px + py * py <= radius * radius;
        }
        ASSERT_EQ(interval.has_value(), is_met) << "trial " << trial;
        if (is_segment) {
            ASSERT_EQ(linetest(cylinder, ray.origin, ray.origin + ray.direction), is_met)
                << "trial " << trial;
        }
        hits += is_met;
    }
    EXPECT_GT(hits, count / 20);
}

// --- The bound elsewhere: sizes from 1e-3 to 1e5, up to 1e5 from the origin.

// Round shapes, by the proven distance from a flat triangle, which is a segment.
TEST(RaycastFamilies, RoundShapesWithinTheBound) {
    Random random(54);
    int hits = 0, sharp = 0;
    const int count = trials(1'000'000);
    for (int trial = 0; trial < count; ++trial) {
        const double size = std::pow(10.0, random.next_in(-3.0, 5.0));
        const Vec3 a = any_offset(random, random.next_index(2) == 0 ? size : 1e5);
        const bool is_sphere = trial % 2 == 0;
        const Vec3 b = is_sphere ? a : a + any_offset(random, size);
        const Vec3 origin =
            a + any_offset(random, size * std::pow(10.0, random.next_in(-1.0, 1.0)));
        Vec3 target = a + any_offset(random, size);
        if (random.next_index(6) == 0)
            target = origin + (b - a); // along the axis
        Ray ray{origin, awkward_direction(random, target - origin), Real(1)};
        if (glm::length(ray.direction) == Real(0))
            continue;
        ray.max_t = static_cast<Real>(10.0 * size) / glm::length(ray.direction);
        if (!(ray.max_t < infinity) || !(ray.max_t > Real(0)))
            continue;
        const Wide3 from = wide(ray.origin);
        const Wide3 to = from + static_cast<long double>(ray.max_t) * wide(ray.direction);
        const WideTriangle axis{wide(a), wide(b), wide(b)};
        const Range distance = distance_of_segment_to_triangle(axis, from, to);
        const long double largest = std::max({largest_of(a), largest_of(b), largest_of(origin),
                                              static_cast<long double>(20.0 * size)});
        const long double bound = 16.0L * epsilon * largest;
        Real radius = static_cast<Real>(distance.low);
        radius += random.next_index(2) == 0
                      ? static_cast<Real>(double(bound) * random.next_in(-4.0, 4.0))
                      : static_cast<Real>(size * random.next_in(-0.5, 0.5));
        radius = std::max(radius, Real(0));
        const auto interval = is_sphere ? ray_interval(Sphere{a, radius}, ray)
                                        : ray_interval(Capsule{a, b, radius}, ray);
        hits += interval.has_value();
        if (distance.low > static_cast<long double>(radius) + bound) {
            ASSERT_FALSE(interval) << "trial " << trial << " distance " << double(distance.low)
                                   << " radius " << double(radius) << " bound " << double(bound);
        } else if (distance.high < static_cast<long double>(radius) - bound) {
            ASSERT_TRUE(interval) << "trial " << trial << " distance " << double(distance.high)
                                  << " radius " << double(radius) << " bound " << double(bound);
        } else {
            continue;
        }
        ++sharp;
        if (!interval)
            continue;
        // The ends are on the surface, and the normal points away from the axis.
        const auto height = [&](Real t) {
            const Wide3 p = from + static_cast<long double>(t) * wide(ray.direction);
            return distance_to_triangle(axis, p).high - static_cast<long double>(radius);
        };
        const long double loose = 2.0L * bound;
        ASSERT_LE(height(interval->t_enter), loose) << "trial " << trial;
        ASSERT_LE(height(interval->t_exit), loose) << "trial " << trial;
        if (interval->t_enter > Real(0)) {
            ASSERT_GE(height(interval->t_enter), -loose) << "trial " << trial;
            ASSERT_NEAR(double(glm::length(interval->enter_normal)), 1.0, double(8.0L * epsilon));
        }
        if (interval->t_exit < ray.max_t) {
            ASSERT_GE(height(interval->t_exit), -loose) << "trial " << trial;
        }
    }
    EXPECT_GT(hits, count / 4);
    EXPECT_GT(sharp, count / 3);
}

// How far a point is outside a cylinder; negative inside.
long double height_above(const Cylinder &cylinder, const Wide3 &p) {
    const Wide3 along = wide(cylinder.b) - wide(cylinder.a);
    const long double length = glm::length(along);
    const Wide3 from = p - wide(cylinder.a);
    const long double h = glm::dot(from, along) / length;
    const long double beyond = std::max(-h, h - length);
    const long double outside =
        glm::length(from - h / length * along) - static_cast<long double>(cylinder.radius);
    if (beyond > 0.0L && outside > 0.0L)
        return std::hypot(beyond, outside);
    return std::max(beyond, outside);
}

TEST(RaycastFamilies, CylindersWithinTheBound) {
    Random random(55);
    int hits = 0, sharp = 0;
    const int count = trials(1'000'000);
    for (int trial = 0; trial < count; ++trial) {
        const double size = std::pow(10.0, random.next_in(-3.0, 5.0));
        const Vec3 a = any_offset(random, random.next_index(2) == 0 ? size : 1e5);
        Vec3 b = a + any_offset(random, size * std::pow(10.0, random.next_in(-2.0, 0.0)));
        if (random.next_index(4) == 0)
            b = {a.x, a.y, b.z};
        if (a == b)
            continue;
        const Cylinder cylinder{
            a, b, static_cast<Real>(size * std::pow(10.0, random.next_in(-2.0, 0.0)))};
        const Vec3 origin =
            a + any_offset(random, size * std::pow(10.0, random.next_in(-2.0, 1.0)));
        Vec3 target =
            a + Real(random.next_unit()) * (b - a) + any_offset(random, double(cylinder.radius));
        if (random.next_index(6) == 0)
            target = origin + (b - a); // along the axis
        Ray ray{origin, awkward_direction(random, target - origin), Real(1)};
        if (glm::length(ray.direction) == Real(0))
            continue;
        ray.max_t = static_cast<Real>(10.0 * size) / glm::length(ray.direction);
        if (!(ray.max_t < infinity) || !(ray.max_t > Real(0)))
            continue;
        const Wide3 from = wide(ray.origin);
        const auto height = [&](long double t) {
            return height_above(cylinder, from + t * wide(ray.direction));
        };
        const long double largest = std::max({largest_of(a), largest_of(b), largest_of(origin),
                                              static_cast<long double>(20.0 * size)});
        const long double bound = 16.0L * epsilon * largest;
        const auto interval = ray_interval(cylinder, ray);
        if (!interval) {
            // The height is convex along the ray, so the search finds the minimum. A few trials are
            // enough.
            if (trial % 10 != 0)
                continue;
            long double low = 0.0L, high = ray.max_t;
            for (int i = 0; i < 80; ++i) {
                const long double s = low + (high - low) / 3, u = high - (high - low) / 3;
                const bool is_left = height(s) <= height(u);
                (is_left ? high : low) = is_left ? u : s;
            }
            ASSERT_GE(height(low), -bound) << "trial " << trial;
            ++sharp;
            continue;
        }
        ++hits;
        ASSERT_LE(height(interval->t_enter), bound) << "trial " << trial;
        ASSERT_LE(height(interval->t_exit), bound) << "trial " << trial;
        if (interval->t_enter > Real(0)) {
            ASSERT_GE(height(interval->t_enter), -bound) << "trial " << trial;
        }
        if (interval->t_exit < ray.max_t) {
            ASSERT_GE(height(interval->t_exit), -bound) << "trial " << trial;
        }
        if (interval->t_enter > Real(0) && height(0.0L) > bound) {
            const Wide3 n = wide(interval->enter_normal);
            ASSERT_NEAR(double(glm::length(n)), 1.0, double(8.0L * epsilon));
            ASSERT_LE(double(glm::dot(n, glm::normalize(wide(ray.direction)))), 1e-3);
        }
    }
    EXPECT_GT(hits, count / 4);
    EXPECT_GT(sharp, count / 100);
}

// --- Planes and half-spaces: the sides are exact.

TEST(RaycastFamilies, PlanesAndHalfSpaces) {
    Random random(56);
    int hits = 0, inside = 0;
    const int count = trials(1'000'000);
    for (int trial = 0; trial < count; ++trial) {
        const double size = std::pow(10.0, random.next_in(-3.0, 5.0));
        const Vec3 n = random.next_index(2) == 0 ? plane_normals[random.next_index(4)]
                                                 : glm::normalize(any_offset(random, 1.0));
        const Vec3 origin = any_offset(random, size);
        const Real offset = random.next_index(3) == 0
                                ? glm::dot(n, origin)
                                : static_cast<Real>(random.next_in(-size, size));
        Vec3 direction = awkward_direction(random, any_offset(random, 1.0));
        if (random.next_index(4) == 0)
            direction = glm::cross(n, any_offset(random, 1.0)); // in the plane, or nearly
        if (direction == Vec3{Real(0)})
            continue;
        const auto side = [&](const Vec3 &v, Real o) { return side_of(n, o, v); };
        const int above = side(origin, offset), climb = side(direction, Real(0));
        const Vec3 end = origin + direction;
        const int at_end = side(end, offset);
        ASSERT_EQ(linetest(Plane{n, offset}, origin, end), above * at_end <= 0);
        ASSERT_EQ(linetest(HalfSpace{n, offset}, origin, end), above <= 0 || at_end <= 0);
        const Ray ray{origin, direction};
        const auto of_plane = raycast(Plane{n, offset}, ray);
        const auto of_space = ray_interval(HalfSpace{n, offset}, ray);
        const long double rate = glm::dot(wide(n), wide(direction));
        const long double truth =
            (static_cast<long double>(offset) - glm::dot(wide(n), wide(origin))) / rate;
        if (std::abs(truth) > 0.9L * std::numeric_limits<Real>::max())
            continue;
        ASSERT_EQ(of_plane.has_value(), above == 0 || above * climb < 0) << "trial " << trial;
        ASSERT_EQ(of_space.has_value(), above <= 0 || climb < 0) << "trial " << trial;
        const long double path =
            of_plane ? static_cast<long double>(of_plane->t) * glm::length(wide(direction)) : 0.0L;
        const long double bound =
            8.0L * epsilon *
            std::max({largest_of(origin), static_cast<long double>(std::abs(offset)), path});
        if (of_plane && above == 0) {
            ++inside;
            ASSERT_TRUE(of_plane->starts_inside && of_plane->t == Real(0));
            ASSERT_EQ(of_plane->normal, Vec3{Real(0)});
        } else if (of_plane) {
            ++hits;
            ASSERT_FALSE(of_plane->starts_inside);
            ASSERT_EQ(of_plane->normal, Real(above) * n);
            if (std::abs(rate) > 1e-9L * glm::length(wide(direction))) {
                ASSERT_LE(std::abs((static_cast<long double>(of_plane->t) - truth) * rate), bound);
            }
        }
        if (of_space) {
            ASSERT_EQ(of_space->t_enter == Real(0) && of_space->enter_normal == Vec3{Real(0)},
                      above <= 0);
            if (above <= 0 && climb <= 0) {
                ASSERT_EQ(of_space->t_exit, infinity);
            }
        }
    }
    EXPECT_GT(hits, count / 5);
    EXPECT_GT(inside, count / 50);
}

// Segments of zero length query a point; segments inside touch.
TEST(RaycastFamilies, SegmentsInsideAndWithoutLength) {
    Random random(57);
    int contained = 0;
    const int count = trials(1'000'000) / 4;
    for (int trial = 0; trial < count; ++trial) {
        const double size = std::pow(10.0, random.next_in(-3.0, 5.0));
        const Vec3 at = any_offset(random, random.next_index(2) == 0 ? size : 1e5);
        const Vec3 a = at + any_offset(random, size), b = at + any_offset(random, size);
        const Real radius = static_cast<Real>(size * random.next_in(0.1, 1.0));
        const Vec3 p = at + any_offset(random, 1.5 * size);
        const Vec3 q = p + any_offset(random, 0.1 * size);
        const auto ask = [&](const auto &solid) {
            const bool has_p = contains(solid, p), has_q = contains(solid, q);
            ASSERT_EQ(linetest(solid, p, p), has_p);
            if (has_p || has_q) {
                ASSERT_TRUE(linetest(solid, p, q) && linetest(solid, q, p));
            }
            if (has_p && p != q) {
                const auto interval = ray_interval(solid, Ray{p, q - p, Real(1)});
                ASSERT_TRUE(interval);
                ASSERT_EQ(interval->t_enter, Real(0));
                ASSERT_EQ(interval->enter_normal, Vec3{Real(0)});
                ++contained;
            }
        };
        ask(Sphere{at, radius});
        ask(Capsule{a, b, radius});
        if (a != b)
            ask(Cylinder{a, b, radius});
        ask(Aabb{at - radius, at + radius});
        ask(Box{at, any_rotation(random), glm::abs(any_offset(random, size))});
        ask(HalfSpace{glm::normalize(a - b + Vec3{Real(1e-9)}), Real(0)});
    }
    EXPECT_GT(contained, count / 2);
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
