#include "engine/geometry/raycast_2d.h"

#include "engine/geometry/contains_2d.h"
#include "tests/geometry/oracle_2d.h"
#include "tests/says.h"
#include "tests/trials.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace oracle_2d;

constexpr Real infinity = std::numeric_limits<Real>::infinity();

// --- Against signed distances ------------------------------------------------------------------

// Heights above the border at origin + p, with the origin relative to the shape; and their minimum
// over the stretch [0, reach] along the unit vector u.
struct CircleAhead {
    Wide origin;
    W radius;

    CircleAhead(const Circle &circle, const Vec2 &from)
        : origin(wide(from) - wide(circle.center)), radius(W(circle.radius)) {}
    W height(const Wide &p) const { return length(origin + p) - radius; }
    W lowest(const Wide &u, W reach) const {
        return segment_distance(origin, origin + reach * u, {0, 0}) - radius;
    }
};
struct PolygonAhead {
    Polygon outline;
    Wide origin;

    PolygonAhead(const auto &rectangle, const Vec2 &from)
        : outline(polygon(rectangle)), origin(wide(from) - outline.origin) {}
    W height(const Wide &p) const { return outline.signed_distance(origin + p); }
    W lowest(const Wide &u, W reach) const {
        // The part of the stretch left after clipping by every edge.
        W low = 0, high = reach;
        W least = 1e300L;
        for (std::size_t i = 0; i < outline.count; ++i) {
            const Wide &a = outline.corners[i];
            const Wide &b = outline.corners[(i + 1) % outline.count];
            const W at = cross(b - a, origin - a);
            const W rate = cross(b - a, u);
            if (rate > 0)
                low = std::max(low, -at / rate);
            else if (rate < 0)
                high = std::min(high, -at / rate);
            else if (at < 0)
                high = -1;
            least = std::min({least, segment_distance(a, b, origin),
                              segment_distance(a, b, origin + reach * u),
                              segment_distance(origin, origin + reach * u, a)});
        }
        // A flat rectangle is cut at one point, up to rounding.
        if (low > high) {
            const bool is_cut = low - high < 1e-17L * (std::abs(low) + reach);
            return is_cut ? std::min(least, height(low * u)) : least;
        }
        // Convex along a line, so a golden-section search finds the minimum.
        const W part = (std::sqrt(W(5)) - 1) / 2;
        W s = high - part * (high - low), t = low + part * (high - low);
        W at_s = height(s * u), at_t = height(t * u);
        for (int i = 0; i < 52; ++i) { // to 1e-11 of the stretch
            // The height changes by no more than the distance moved: well outside or well inside,
            // stop.
            const W most_within = std::min(at_s, at_t);
            if (most_within > high - low || most_within < -1e-3L * outline.size)
                return most_within;
            if (at_s <= at_t) {
                high = t;
                t = s;
                at_t = at_s;
                s = high - part * (high - low);
                at_s = height(s * u);
            } else {
                low = s;
                s = t;
                at_s = at_t;
                t = low + part * (high - low);
                at_t = height(t * u);
            }
        }
        return height((low + high) / 2 * u);
    }
};

struct Tally {
    int hits = 0;
    int misses = 0;
    double worst = 0.0; // as a share of the bound
};

template <typename Shape, typename Ahead>
void check_interval(Random &random, Tally &tally, const Shape &shape, const Vec2 &center) {
    const W size = size_of(shape);
    const Wide from = wide(center) + any_unit(random) * size * W(random.next_in(0.0, 4.0));
    // Every fourth ray just touches, or just misses, the shape's farthest reach.
    const W aside = random.next_index(4) == 0 ? 1 + W(epsilon) * W(random.next_in(-8.0, 8.0))
                                              : W(random.next_in(0.0, 1.2));
    const Wide to = wide(center) + any_unit(random) * size * aside;
    const Vec2 origin{static_cast<Real>(from.x), static_cast<Real>(from.y)};
    Vec2 direction{static_cast<Real>(to.x - from.x), static_cast<Real>(to.y - from.y)};
    if (random.next_index(8) == 0)
        direction[int(random.next_index(2))] = random.next_index(2) == 0 ? Real(0) : -Real(0);
    direction *= any_magnitude(random, -6.0, 6.0);
    if (direction == Vec2{Real(0)})
        return;
    const W speed = length(wide(direction));
    const Wide u = wide(direction) / speed;
    const W distance = length(wide(center) - wide(origin));
    const bool is_endless = random.next_index(2) == 0;
    const Real max_t =
        is_endless ? infinity : static_cast<Real>(distance / speed) * any_real(random, 0.0, 2.0);
    const W bound = 8 * W(epsilon) * (distance + size);
    const auto note = [&](W excess) {
        tally.worst = std::max(tally.worst, bound > 0 ? double(excess / bound) : 0.0);
    };
    const Ahead ahead(shape, origin);
    const Ray2 ray{origin, direction, max_t};
    const auto interval = ray_interval(shape, ray);
    if (!interval) {
        ++tally.misses;
        const W reach = std::min(W(max_t) * speed, 2 * distance + 4 * size);
        note(-ahead.lowest(u, reach));
        return;
    }
    ++tally.hits;
    ASSERT_GE(interval->t_enter, Real(0));
    ASSERT_LE(interval->t_enter, interval->t_exit);
    ASSERT_LE(interval->t_exit, max_t);
    const W at_enter = ahead.height(u * (W(interval->t_enter) * speed));
    const W at_exit = ahead.height(u * (W(interval->t_exit) * speed));
    note(at_enter);
    note(at_exit);
    const bool starts_inside = contains(shape, origin);
    ASSERT_EQ(starts_inside, interval->enter_normal == Vec2{Real(0)});
    if (starts_inside) {
        ASSERT_EQ(interval->t_enter, Real(0));
    } else {
        note(-at_enter);
        const Wide n = wide(interval->enter_normal);
        ASSERT_NEAR(double(length(n)), 1.0, 4.0 * epsilon);
        ASSERT_LE(double(glm::dot(n, u)), 64.0 * epsilon * double((distance + size) / size));
        // A step along the outward normal leads out. An error of `bound` turns a circle's normal by
        // bound / radius, or picks the adjacent face near a corner.
        const W step = size;
        ASSERT_GE(ahead.height(u * (W(interval->t_enter) * speed) + n * step), step - 12 * bound);
    }
    if (interval->t_exit < max_t)
        note(-at_exit);
}

TEST(Raycast2, EndsAreOnTheBorderWithinTheStatedBound) {
    Random random(0x2d31);
    const int count = trials(1'000'000);
    std::array<Tally, 3> tallies{};
    for (int trial = 0; trial < count; ++trial) {
        const Circle circle = any_circle(random);
        check_interval<Circle, CircleAhead>(random, tallies[0], circle, circle.center);
        const Rectangle rectangle = any_rectangle(random);
        check_interval<Rectangle, PolygonAhead>(
            random, tallies[1], rectangle, Real(0.5) * rectangle.min + Real(0.5) * rectangle.max);
        const OrientedRectangle oriented = any_oriented(random);
        check_interval<OrientedRectangle, PolygonAhead>(random, tallies[2], oriented,
                                                        oriented.center);
    }
    for (std::size_t i = 0; i < tallies.size(); ++i) {
        EXPECT_GT(tallies[i].hits, count / 8) << i;
        EXPECT_GT(tallies[i].misses, count / 8) << i;
        EXPECT_LE(tallies[i].worst, 1.0) << i;
    }
}

// --- In integers -------------------------------------------------------------------------------

// An interval of fractions, clipped by one border after another (Liang and Barsky 1984).
struct Fractions {
    Int enter_over = 0, enter_under = 1;
    Int exit_over = 1, exit_under = 0; // none
    bool is_empty = false;

    // Keeps the t with t * slope <= room.
    void cut(Int slope, Int room) {
        if (slope > 0 && (exit_under == 0 || room * exit_under < exit_over * slope)) {
            exit_over = room;
            exit_under = slope;
        } else if (slope < 0 && -room * enter_under > enter_over * -slope) {
            enter_over = -room;
            enter_under = -slope;
        } else if (slope == 0 && room < 0) {
            is_empty = true;
        }
    }
    bool remains() const {
        return !is_empty && (exit_under == 0 || enter_over * exit_under <= exit_over * enter_under);
    }
};

Fractions in_rectangle(const Rectangle &rectangle, const Vec2 &origin, const Whole &d) {
    const Whole low = whole(rectangle.min) - whole(origin);
    const Whole high = whole(rectangle.max) - whole(origin);
    Fractions t;
    t.cut(d.x, high.x);
    t.cut(-d.x, -low.x);
    t.cut(d.y, high.y);
    t.cut(-d.y, -low.y);
    return t;
}

TEST(Raycast2, RectanglesAreExact) {
    Random random(0x2d32);
    int hits = 0, corners = 0;
    const int count = trials(1'000'000);
    for (int trial = 0; trial < count; ++trial) {
        const std::int64_t reach = any_reach(random);
        const Vec2 p = any_whole_point(random, reach), q = any_whole_point(random, reach);
        const Rectangle rectangle{glm::min(p, q), glm::max(p, q)};
        const Vec2 a = any_whole_point(random, reach);
        // Towards a corner, or just past it.
        const Vec2 b = random.next_index(2) == 0
                           ? any_whole_point(random, reach)
                           : near_line(random, a,
                                       {random.next_index(2) == 0 ? p.x : q.x,
                                        random.next_index(2) == 0 ? p.y : q.y});
        const Whole d = whole(b) - whole(a);
        Fractions t = in_rectangle(rectangle, a, d);
        const bool endless = t.remains();
        t.cut(1, 1);
        ASSERT_EQ(linetest(rectangle, a, b), t.remains());
        if (a == b)
            continue;
        hits += endless ? 1 : 0;
        corners += endless && t.enter_over * t.exit_under == t.exit_over * t.enter_under ? 1 : 0;
        const auto interval = ray_interval(rectangle, Ray2{a, b - a});
        ASSERT_EQ(interval.has_value(), endless);
        ASSERT_FALSE(ray_interval(rectangle, Ray2{a, b - a, Real(-1)}));
        if (reach > 9 || !endless)
            continue;
        // Small integers: the ends are the nearest floats, and max_t is compared with them.
        const Fractions whole_line = in_rectangle(rectangle, a, d);
        const auto quotient = [](Int over, Int under) {
            return static_cast<Real>(static_cast<std::int64_t>(over)) /
                   static_cast<Real>(static_cast<std::int64_t>(under));
        };
        const Real enter = quotient(whole_line.enter_over, whole_line.enter_under);
        ASSERT_EQ(interval->t_enter, enter);
        ASSERT_EQ(interval->t_exit, quotient(whole_line.exit_over, whole_line.exit_under));
        ASSERT_TRUE(ray_interval(rectangle, Ray2{a, b - a, enter}));
        ASSERT_EQ(ray_interval(rectangle, Ray2{a, b - a, Real(1)}).has_value(), t.remains());
    }
    EXPECT_GT(hits, count / 8);
    EXPECT_GT(corners, count / 100);
}

TEST(Raycast2, SegmentsAreExact) {
    Random random(0x2d33);
    int hits = 0, along = 0;
    const int count = trials(1'000'000);
    for (int trial = 0; trial < count; ++trial) {
        const std::int64_t reach = any_reach(random);
        const Vec2 origin = any_whole_point(random, reach);
        const Vec2 target = any_whole_point(random, reach);
        if (origin == target)
            continue;
        const Vec2 direction = target - origin;
        const Vec2 p = random.next_index(2) == 0 ? any_whole_point(random, reach)
                                                 : near_line(random, origin, target);
        const Vec2 q = random.next_index(16) == 0 ? p : near_line(random, origin, target);
        // The half-plane ahead, with the two ends on opposite sides.
        const Whole d = whole(target) - whole(origin);
        const Whole a = whole(p) - whole(origin), b = whole(q) - whole(origin);
        const Int side_a = cross(d, a), side_b = cross(d, b);
        bool expected = false;
        if (side_a == 0 && side_b == 0) {
            expected = dot(d, a) >= 0 || dot(d, b) >= 0;
            along += expected ? 1 : 0;
        } else if (sign(side_a) * sign(side_b) <= 0) {
            // origin + t d = p + s (q - p): t (d x (q - p)) = a x (q - p).
            const Whole pq = b - a;
            expected = sign(cross(a, pq)) * sign(cross(d, pq)) >= 0;
        }
        const auto hit = raycast(Segment2{p, q}, Ray2{origin, direction});
        ASSERT_EQ(hit.has_value(), expected);
        ASSERT_FALSE(raycast(Segment2{p, q}, Ray2{origin, direction, Real(-1)}));
        if (!hit)
            continue;
        ++hits;
        const W size = 2 * W(reach) + 1;
        ASSERT_LE(segment_distance(wide(p), wide(q), wide(hit->point)), 8 * W(epsilon) * size);
        const Wide at = wide(origin) + W(hit->t) * wide(direction);
        ASSERT_LE(length(at - wide(hit->point)), 8 * W(epsilon) * size);
        const bool starts_on = contains(Segment2{p, q}, origin);
        ASSERT_EQ(hit->starts_inside, starts_on);
        if (starts_on) {
            ASSERT_EQ(hit->t, Real(0));
            ASSERT_EQ(hit->point, origin);
            ASSERT_EQ(hit->normal, Vec2{Real(0)});
        } else {
            ASSERT_NEAR(double(length(wide(hit->normal))), 1.0, 4.0 * epsilon);
            ASSERT_LE(glm::dot(wide(hit->normal), wide(direction)),
                      2 * W(epsilon) * length(wide(direction))); // the normal is rounded
            if (side_a != 0 || side_b != 0) {
                ASSERT_NEAR(double(glm::dot(wide(hit->normal), wide(q) - wide(p))), 0.0,
                            4.0 * epsilon * double(size));
            }
        }
    }
    EXPECT_GT(hits, count / 8);
    EXPECT_GT(along, count / 100);
}

TEST(Raycast2, CirclesAreExactForSmallIntegers) {
    Random random(0x2d34);
    int hits = 0, touching = 0;
    const int count = trials(1'000'000);
    for (int trial = 0; trial < count; ++trial) {
        const std::int64_t reach = random.next_index(2) == 0 ? 8 : 500;
        const Vec2 center = any_whole_point(random, reach);
        const Real radius = std::abs(any_whole(random, reach));
        const Vec2 a = any_whole_point(random, reach);
        const Vec2 b = random.next_index(16) == 0 ? a : any_whole_point(random, reach);
        const Whole d = whole(b) - whole(a), m = whole(center) - whole(a);
        const Int r = static_cast<std::int64_t>(radius);
        // min |m - t d|^2 over t >= 0, or over 0 <= t <= 1, times |d|^2.
        const Int dd = dot(d, d), md = dot(m, d), mm = dot(m, m);
        const Whole from_b = whole(center) - whole(b);
        const bool at_foot = mm * dd - md * md <= r * r * dd;
        const bool endless = md > 0 ? at_foot : mm <= r * r;
        const bool between = md <= 0    ? mm <= r * r
                             : md >= dd ? dot(from_b, from_b) <= r * r
                                        : at_foot;
        const Circle circle{center, radius};
        ASSERT_EQ(linetest(circle, a, b), between);
        if (a == b)
            continue;
        const auto interval = ray_interval(circle, Ray2{a, b - a});
        ASSERT_EQ(interval.has_value(), endless);
        hits += endless ? 1 : 0;
        if (endless && mm * dd - md * md == r * r * dd) {
            ++touching;
            ASSERT_TRUE(mm <= r * r || interval->t_enter == interval->t_exit);
        }
        ASSERT_FALSE(ray_interval(circle, Ray2{a, b - a, Real(-1)}));
    }
    EXPECT_GT(hits, count / 8);
    EXPECT_GT(touching, count / 1000);
}

TEST(Raycast2, RectanglesTurnedByQuartersAreExactForSmallIntegers) {
    Random random(0x2d35);
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const std::int64_t reach = random.next_index(2) == 0 ? 8 : 500;
        const Vec2 center = any_whole_point(random, reach);
        const Vec2 half = glm::abs(any_whole_point(random, reach));
        const Vec2 a = any_whole_point(random, reach), b = any_whole_point(random, reach);
        const Rectangle rectangle{center - half, center + half};
        const OrientedRectangle lying{center, {Real(-1), Real(0)}, half};
        const OrientedRectangle standing{center, {-Real(0), Real(1)}, {half.y, half.x}};
        Fractions t = in_rectangle(rectangle, a, whole(b) - whole(a));
        const bool endless = t.remains();
        t.cut(1, 1);
        ASSERT_EQ(linetest(lying, a, b), t.remains());
        ASSERT_EQ(linetest(standing, a, b), t.remains());
        if (a == b)
            continue;
        const Ray2 ray{a, b - a};
        const auto plain = ray_interval(rectangle, ray);
        for (const auto &interval : {ray_interval(lying, ray), ray_interval(standing, ray)}) {
            ASSERT_EQ(interval.has_value(), endless);
            if (!endless)
                continue;
            ASSERT_EQ(interval->t_enter, plain->t_enter);
            ASSERT_EQ(interval->t_exit, plain->t_exit);
            ASSERT_NEAR(double(glm::dot(interval->enter_normal, interval->enter_normal)),
                        double(glm::dot(plain->enter_normal, plain->enter_normal)), 0.0);
        }
    }
}

// --- The rest ----------------------------------------------------------------------------------

TEST(Raycast2, LinetestsAreWrongOnlyWithinTheStatedBound) {
    Random random(0x2d36);
    int hits = 0;
    const int count = trials(1'000'000);
    const auto check = [&](const auto &shape, const auto &ahead_of, const Vec2 &center) {
        const W size = size_of(shape);
        const auto any_end = [&] {
            const Wide p = wide(center) + any_unit(random) * size * W(random.next_in(0.0, 3.0));
            return Vec2{static_cast<Real>(p.x), static_cast<Real>(p.y)};
        };
        const Vec2 a = any_end(), b = any_end();
        const W distance = length(wide(center) - wide(a)) + length(wide(b) - wide(a));
        const auto ahead = ahead_of(a);
        const Wide d = wide(b) - wide(a);
        const W reach = length(d);
        const bool answer = linetest(shape, a, b);
        ASSERT_EQ(answer, linetest(shape, b, a) || answer); // in either direction, up to rounding
        hits += answer ? 1 : 0;
        const W least = reach > 0 ? ahead.lowest(d / reach, reach) : ahead.height({0, 0});
        if (std::abs(least) > 8 * W(epsilon) * (distance + size)) {
            ASSERT_EQ(answer, least <= 0);
        }
    };
    for (int trial = 0; trial < count; ++trial) {
        const Circle circle = any_circle(random);
        check(
            circle, [&](const Vec2 &a) { return CircleAhead(circle, a); }, circle.center);
        const OrientedRectangle oriented = any_oriented(random);
        check(
            oriented, [&](const Vec2 &a) { return PolygonAhead(oriented, a); }, oriented.center);
    }
    EXPECT_GT(hits, count / 8);
}

TEST(Raycast2, ASegmentWhollyInsideTouches) {
    const Vec2 zero{Real(0)};
    const Vec2 a{Real(-0.25), Real(0.125)}, b{Real(0.25), Real(0.0625)};
    const Circle circle{zero, Real(1)};
    const Rectangle rectangle{Vec2{Real(-1)}, Vec2{Real(1)}};
    const OrientedRectangle oriented = oriented_rectangle(zero, Real(0.3), Vec2{Real(1)});
    EXPECT_TRUE(linetest(circle, a, b));
    EXPECT_TRUE(linetest(rectangle, a, b));
    EXPECT_TRUE(linetest(oriented, a, b));
    EXPECT_TRUE(linetest(Compound2({circle}), a, b));
    EXPECT_TRUE(linetest(Segment2{a, b}, a, b));
    EXPECT_TRUE(linetest(rectangle, a, a));
    EXPECT_FALSE(linetest(circle, Vec2{Real(2)}, Vec2{Real(2)}));
}

TEST(Raycast2, RaysInFacesAndThroughCorners) {
    const Rectangle rectangle{Vec2{Real(-1)}, Vec2{Real(1)}};
    for (const Real zero : {Real(0), -Real(0)}) {
        const auto in_face = ray_interval(rectangle, Ray2{{Real(-3), Real(1)}, {Real(2), zero}});
        ASSERT_TRUE(in_face);
        EXPECT_EQ(in_face->t_enter, Real(1));
        EXPECT_EQ(in_face->t_exit, Real(2));
        EXPECT_EQ(in_face->enter_normal, (Vec2{Real(-1), Real(0)}));
        const Real outside = std::nextafter(Real(1), Real(2));
        EXPECT_FALSE(ray_interval(rectangle, Ray2{{Real(-3), outside}, {Real(2), zero}}));
    }
    const auto corner = ray_interval(rectangle, Ray2{{Real(-2), Real(0)}, {Real(1), Real(1)}});
    ASSERT_TRUE(corner);
    EXPECT_EQ(corner->t_enter, Real(1));
    EXPECT_EQ(corner->t_exit, Real(1));
}

TEST(Raycast2, DirectionsOfAnyLength) {
    const Circle circle{{Real(10), Real(0)}, Real(1)};
    const OrientedRectangle oriented{{Real(10), Real(0)}, {Real(0), Real(1)}, Vec2{Real(1)}};
    const int most = std::numeric_limits<Real>::max_exponent - 5;
    for (int exponent = -most; exponent <= most; ++exponent) {
        const Real scale = std::ldexp(Real(1), exponent);
        const Ray2 ray{Vec2{Real(0)}, {scale, Real(0)}};
        const std::optional<RayHit2> on_circle = raycast(circle, ray);
        const std::optional<RayHit2> on_rectangle = raycast(oriented, ray);
        ASSERT_TRUE(on_circle && on_rectangle) << exponent;
        ASSERT_EQ(on_circle->t, Real(9) / scale) << exponent;
        ASSERT_EQ(on_rectangle->t, Real(9) / scale) << exponent;
        ASSERT_EQ(on_circle->point, (Vec2{Real(9), Real(0)}));
    }
    // So slow that it would arrive after the largest float.
    const Ray2 slow{Vec2{Real(0)}, {std::numeric_limits<Real>::denorm_min(), Real(0)}};
    EXPECT_FALSE(raycast(circle, slow));
    EXPECT_FALSE(raycast(oriented, slow));
    EXPECT_FALSE(raycast(Rectangle{Vec2{Real(9)}, Vec2{Real(11)}}, slow));
}

TEST(Raycast2, StartingInside) {
    const Circle circle{{Real(1), Real(2)}, Real(3)};
    const std::optional<RayHit2> hit =
        raycast(circle, Ray2{{Real(1), Real(2)}, {Real(2), Real(0)}});
    ASSERT_TRUE(hit);
    EXPECT_TRUE(hit->starts_inside);
    EXPECT_EQ(hit->t, Real(0));
    EXPECT_EQ(hit->normal, Vec2{Real(0)});
    const auto interval = ray_interval(circle, Ray2{{Real(1), Real(2)}, {Real(2), Real(0)}});
    EXPECT_EQ(interval->t_exit, Real(1.5));
    // On the border, leaving: the interval is that one point.
    const auto border = ray_interval(circle, Ray2{{Real(4), Real(2)}, {Real(2), Real(0)}});
    ASSERT_TRUE(border);
    EXPECT_EQ(border->t_exit, Real(0));
}

TEST(Raycast2, CompoundIsTheFirstOfItsParts) {
    Random random(0x2d37);
    int hits = 0;
    const int count = trials(1'000'000);
    for (int trial = 0; trial < count; ++trial) {
        const Circle circle{any_vector(random, 9.0), any_real(random, 0.0, 3.0)};
        const Vec2 corner = any_whole_point(random, 9);
        const Rectangle rectangle{corner, corner + glm::abs(any_whole_point(random, 4))};
        const OrientedRectangle oriented{any_vector(random, 9.0), any_axis(random),
                                         any_half_extents(random, Real(2))};
        const Compound2 compound({circle, rectangle, oriented});
        const Vec2 a = any_vector(random, 12.0), b = any_vector(random, 12.0);
        const Ray2 ray{a, b - a, random.next_index(2) == 0 ? Real(1) : infinity};
        const std::optional<RayHit2> hit = raycast(compound, ray);
        const std::array<std::optional<RayHit2>, 3> each{
            raycast(circle, ray), raycast(rectangle, ray), raycast(oriented, ray)};
        Real first = infinity;
        for (const auto &one : each)
            first = one ? std::min(first, one->t) : first;
        ASSERT_EQ(hit.has_value(), first < infinity);
        if (hit) {
            ++hits;
            ASSERT_EQ(hit->t, first);
            ASSERT_EQ(hit->starts_inside, contains(compound, a));
        }
        ASSERT_EQ(linetest(compound, a, b),
                  linetest(circle, a, b) || linetest(rectangle, a, b) || linetest(oriented, a, b));
    }
    EXPECT_GT(hits, count / 8);
}

TEST(Raycast2, SaysWhatIsWrong) {
    const Real nan = std::numeric_limits<Real>::quiet_NaN();
    const Vec2 zero{Real(0)}, x{Real(1), Real(0)};
    const Circle circle{zero, Real(1)};
    says([&] { ray_interval(circle, Ray2{zero, zero}); }, "(0, 0)");
    says([&] { ray_interval(Rectangle{zero, x}, Ray2{zero, -zero}); }, "(-0, -0)");
    says([&] { raycast(Segment2{zero, x}, Ray2{Vec2{nan}, x}); }, "nan");
    says([&] { raycast(circle, Ray2{zero, x, nan}); }, "nan");
    says([&] { raycast(OrientedRectangle{zero, x, Vec2{Real(-7)}}, Ray2{zero, x}); }, "-7");
    says([&] { linetest(circle, zero, Vec2{nan}); }, "nan");
    says([&] { linetest(Rectangle{zero, x}, Vec2{infinity}, x); }, "inf");
    EXPECT_FALSE(raycast(Rectangle{}, Ray2{zero, x}));
    EXPECT_FALSE(linetest(Rectangle{}, zero, x));
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
