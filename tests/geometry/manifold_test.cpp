#include "engine/geometry/manifold.h"

#include "engine/geometry/gjk.h"
#include "engine/geometry/sat.h"
#include "tests/geometry/oracle.h"
#include "tests/says.h"
#include "tests/trials.h"

#include <gtest/gtest.h>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace oracle;

constexpr double margin = 0.1;

// Inputs are below 4 m, and a result goes through at most some 30 roundings, each at most half an
// epsilon of that size.
constexpr double rounding = 30 * 0.5 * 4 * double(std::numeric_limits<Real>::epsilon());
// The chosen face may be worse than the best feature by the engine's stated 1e-4 m, and is accepted
// when its points are within another 2e-4 m; corners that far outside a face count as on it.
constexpr double preference = 3e-4 + rounding;

constexpr const char *kind_names[] = {"sphere", "box", "capsule"};

Shape any_shape(Random &random, std::uint32_t kind, const Vec3 &center, bool is_awkward) {
    const Quat rotation = is_awkward ? awkward_rotation(random) : any_rotation(random);
    if (kind == 0)
        return Sphere{center, any_real(random, 0.1, 0.8)};
    const Vec3 half{any_real(random, 0.1, 0.8), any_real(random, 0.1, 0.8),
                    any_real(random, 0.1, 0.8)};
    if (kind == 1)
        return Box{center, rotation, half};
    const Vec3 axis = rotation * Vec3{Real(0), half.x, Real(0)};
    return Capsule{center - axis, center + axis, half.y * Real(0.5)};
}

struct Pair {
    Shape a, b;
};

// Shapes near each other: overlapping, touching, or slightly apart.
Pair any_pair(Random &random, std::uint32_t kind_a, std::uint32_t kind_b, bool is_awkward,
              bool may_be_deep) {
    const Vec3 at = any_vector(random, 1.0);
    Pair pair{any_shape(random, kind_a, at, is_awkward), any_shape(random, kind_b, at, is_awkward)};
    const Solid a(pair.a), b(pair.b);
    V u = any_direction(random);
    if (is_awkward && random.next_index(2) == 0)
        u = V{0.0, random.next_index(2) == 0 ? 1.0 : -1.0, 0.0};
    const double gap = may_be_deep && random.next_index(4) == 0 ? -random.next_in(0.0, 1.0)
                                                                : random.next_in(-0.1, 0.12);
    const V move = u * std::max(0.0, translation_along(a, b, u) + gap);
    const Transform pose{Vec3{Real(move.x), Real(move.y), Real(move.z)}, identity_rotation};
    pair.b = placed(pair.b, pose);
    return pair;
}

double deepest(const Manifold &m) {
    double least = 1e300;
    for (int i = 0; i < m.count; ++i)
        least = std::min(least, double(m.points[std::size_t(i)].separation));
    return least;
}

// Checks one manifold's whole contract against the oracle. Returns a description of what is wrong.
std::string complaint(const Pair &pair, const Manifold &m, Random &random) {
    std::ostringstream out;
    const Solid a(pair.a), b(pair.b);
    const double apart = distance(a, b);
    if (m.count == 0) {
        if (apart < margin - rounding)
            out << "no contact at distance " << apart;
        return out.str();
    }
    const V n = wide(m.normal);
    const double separation = deepest(m);
    if (std::abs(glm::length(n) - 1.0) > rounding)
        out << "normal of length " << glm::length(n) << "; ";
    if (separation > margin + rounding)
        out << "separation " << separation << " beyond the margin; ";

    // Moved along the normal until 5 cm apart, the shapes are 5 cm apart: no less (the depth is
    // enough) and no more (it is not too much).
    Solid moved = b;
    moved.move(n * (0.05 - separation));
    const double left = distance(a, moved);
    // A face normal may lean 8 degrees from the edges' normal when its points are as deep.
    const double lean = a.is_box && b.is_box ? 0.05 * (1.0 - 0.99) : 0.0;
    if (left - 0.05 > preference || left - 0.05 < -preference - lean)
        out << "moved to be 0.05 apart, is " << left << " (separation " << separation << "); ";
    // When the cores are disjoint, the separation is the distance.
    if (apart > -a.radius - b.radius + preference && std::abs(apart - separation) > preference)
        out << "separation " << separation << " at distance " << apart << "; ";
    // No direction separates the shapes sooner.
    double best = 1e300;
    for (int i = 0; i < 24; ++i) {
        V u = any_direction(random);
        if (i < 8)
            u = glm::normalize(n + 0.1 * u);
        best = std::min(best, translation_along(a, b, u));
    }
    for (const Solid *s : {&a, &b})
        for (std::size_t i = 0; s->is_box && i < 3; ++i)
            best = std::min({best, translation_along(a, b, s->box.axis[i]),
                             translation_along(a, b, -s->box.axis[i])});
    if (-separation > best + preference)
        out << "depth " << -separation << " where " << best << " is enough; ";

    for (int i = 0; i < m.count; ++i) {
        const ManifoldPoint &p = m.points[std::size_t(i)];
        const V half = n * (0.5 * double(p.separation));
        const double off_a = a.signed_distance(wide(p.position) - half);
        const double off_b = b.signed_distance(wide(p.position) + half);
        // A point is on the spheres around two axis points. On a capsule tilted to the normal, the
        // sphere touches the side where it is r (1 - cos) above the capsule's surface.
        const auto tilted = [&](const Solid &s) {
            if (s.is_box || s.a == s.b || m.count == 1)
                return 0.0;
            const double sine = glm::dot(n, glm::normalize(s.b - s.a));
            return s.radius * (1.0 - std::sqrt(std::max(0.0, 1.0 - sine * sine)));
        };
        if (off_a > preference || off_b > preference || off_a < -preference - tilted(a) ||
            off_b < -preference - tilted(b))
            out << "point " << i << " of " << m.count << " off the surfaces by " << off_a << ", "
                << off_b << "; ";
        for (int j = 0; j < i; ++j)
            if (m.points[std::size_t(j)].feature == p.feature)
                out << "points " << j << " and " << i << " have one feature; ";
    }
    return out.str();
}

// A million pairs in all, a third for each kind.
void check_all_pairs(std::uint32_t kind_a) {
    Random random(1 + kind_a);
    int wrong = 0;
    for (int trial = 0; trial < trials(334'000); ++trial) {
        const std::uint32_t kind_b = random.next_index(3);
        const bool is_awkward = random.next_index(2) == 0;
        const Pair pair = any_pair(random, kind_a, kind_b, is_awkward, true);
        const Manifold m = collide(pair.a, pair.b, Real(margin));
        const std::string text = complaint(pair, m, random);
        if (!text.empty() && ++wrong <= 10)
            ADD_FAILURE() << "trial " << trial << ", " << kind_names[kind_a] << " and "
                          << kind_names[kind_b] << (is_awkward ? " (awkward): " : ": ") << text
                          << " count " << m.count << " feature " << std::hex << m.points[0].feature;
    }
    EXPECT_EQ(wrong, 0);
}

TEST(Manifold, SpheresWithAllAgainstTheOracle) {
    check_all_pairs(0);
}

TEST(Manifold, BoxesWithAllAgainstTheOracle) {
    check_all_pairs(1);
}

TEST(Manifold, CapsulesWithAllAgainstTheOracle) {
    check_all_pairs(2);
}

TEST(Manifold, HalfSpaceAgainstSupportHeights) {
    Random random(2);
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const std::uint32_t kind = random.next_index(3);
        const Shape solid = any_shape(random, kind, any_vector(random, 1.0), trial % 2 == 0);
        const V direction = trial % 3 == 0 ? V{0.0, 1.0, 0.0} : any_direction(random);
        const HalfSpace ground{Vec3{Real(direction.x), Real(direction.y), Real(direction.z)},
                               any_real(random, -2.0, 2.0)};
        const Manifold m = collide(solid, ground, Real(margin));
        const V n = wide(ground.normal);
        const Solid wide_solid(solid);
        const double lowest = -wide_solid.support(-n) - double(ground.offset);
        if (m.count == 0) {
            ASSERT_GT(lowest, margin - rounding) << kind_names[kind] << " in trial " << trial;
            continue;
        }
        ASSERT_NEAR(deepest(m), lowest, rounding) << kind_names[kind] << " in trial " << trial;
        ASSERT_LE(glm::length(wide(m.normal) + n), rounding);
        for (int i = 0; i < m.count; ++i) {
            const ManifoldPoint &p = m.points[std::size_t(i)];
            const V half = 0.5 * double(p.separation) * n;
            // On the plane, and no deeper in the solid than a sphere's lowest point below the side
            // of a tilted capsule.
            const double height = glm::dot(wide(p.position) - half, n) - double(ground.offset);
            ASSERT_NEAR(height, 0.0, rounding);
            const double off = wide_solid.signed_distance(wide(p.position) + half);
            ASSERT_LE(off, rounding);
            ASSERT_GE(off, -wide_solid.radius - rounding);
        }
        // Every corner and end within the margin, as far as there is room.
        int in_reach = 0;
        if (wide_solid.is_box) {
            for (int k = 0; k < 8; ++k)
                in_reach += glm::dot(wide_solid.box.corner(k), n) - double(ground.offset) <
                            margin - rounding;
            ASSERT_GE(m.count, std::min(in_reach, 1));
            if (in_reach <= 4) {
                ASSERT_GE(m.count, in_reach);
            }
        } else if (kind == 2) {
            for (const V &end : {wide_solid.a, wide_solid.b})
                in_reach += glm::dot(end, n) - wide_solid.radius - double(ground.offset) <
                            margin - rounding;
            ASSERT_GE(m.count, in_reach);
        }
    }
}

// The stated 0.2 mm where the tolerances matter: nearly parallel boxes.
TEST(Manifold, BoxesAreWithinTheStatedTolerance) {
    Random random(12);
    double worst = 0.0;
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const Vec3 half_a{any_real(random, 0.1, 0.8), any_real(random, 0.1, 0.8),
                          any_real(random, 0.1, 0.8)};
        const Vec3 half_b{any_real(random, 0.1, 0.8), any_real(random, 0.1, 0.8),
                          any_real(random, 0.1, 0.8)};
        const double tilt = std::pow(10.0, random.next_in(-4.5, -0.5));
        const V axis = any_direction(random) * std::sin(tilt);
        const Quat turn =
            glm::normalize(Quat{Real(std::cos(tilt)), Real(axis.x), Real(axis.y), Real(axis.z)} *
                           awkward_rotation(random));
        const int up = int(random.next_index(3));
        Vec3 place = any_vector(random, 1.0);
        place[up] = half_a[up];
        Box b{place, turn, half_b};
        const Box a{Vec3{Real(0)}, identity_rotation, half_a};
        // From 0.3 mm deep to 0.3 mm apart.
        const Real separation = separating_axis(a, b).separation;
        b.center[up] += any_real(random, -3e-4, 3e-4) - separation;
        const SatResult truth = separating_axis(a, b);
        const double apart =
            truth.separation > Real(0) ? double(distance(a, b).distance) : double(truth.separation);
        const Manifold m = collide(a, b, Real(margin));
        if (m.count == 0) {
            ASSERT_GT(apart, margin - 2e-4) << "trial " << trial;
            continue;
        }
        const double off = std::abs(deepest(m) - apart);
        worst = std::max(worst, off);
        ASSERT_LE(off, 2e-4 + rounding) << "trial " << trial;
    }
    std::cout << "at most " << worst << " m off\n";
}

// Within rounding, where a margin of 0 may leave out the points that touch: a shallow contact must
// not be taken for a deep one along another axis.
TEST(Manifold, ShapesThatJustTouchAreNotDeep) {
    Random random(18);
    for (int trial = 0; trial < trials(300'000); ++trial) {
        const std::uint32_t kind_a = random.next_index(3), kind_b = random.next_index(3);
        const bool is_awkward = random.next_index(2) == 0;
        Pair pair{any_shape(random, kind_a, any_vector(random, 1.0), is_awkward),
                  any_shape(random, kind_b, any_vector(random, 3.0), is_awkward)};
        const Manifold apart = collide(pair.a, pair.b, Real(10));
        if (deepest(apart) < 0.01)
            continue;
        const Vec3 to_touch = Real(-deepest(apart)) * apart.normal;
        pair.b = placed(pair.b, Transform{to_touch, identity_rotation});
        const Manifold m = collide(pair.a, pair.b, Real(0));
        EXPECT_GT(deepest(m), -preference)
            << "trial " << trial << ", " << kind_names[kind_a] << " and " << kind_names[kind_b];
        EXPECT_LE(m.count == 0 ? 0.0 : deepest(m), 0.0);
    }
}

TEST(Manifold, HalfSpacesGiveNone) {
    EXPECT_EQ(collide(HalfSpace{}, HalfSpace{}, Real(1)).count, 0);
}

// The larger box is the reference whichever comes first; between boxes of one size it is the first,
// which only shows where two features serve equally well.
TEST(Manifold, SwappedArgumentsGiveTheMirroredManifold) {
    Random random(3);
    int differing = 0;
    for (int trial = 0; trial < 100000; ++trial) {
        const std::uint32_t kind_a = random.next_index(3), kind_b = random.next_index(3);
        const Pair pair = any_pair(random, kind_a, kind_b, trial % 2 == 0, true);
        const Manifold ab = collide(pair.a, pair.b, Real(margin));
        const Manifold ba = collide(pair.b, pair.a, Real(margin));
        bool same = ab.count == ba.count && ab.normal == -ba.normal;
        if (kind_a == 0 && kind_b == 0 &&
            std::get<Sphere>(pair.a).center == std::get<Sphere>(pair.b).center) {
            ASSERT_EQ(ab.normal, ba.normal); // +Y in both orders
            continue;
        }
        for (int i = 0; same && i < ab.count; ++i) {
            const ManifoldPoint &p = ab.points[std::size_t(i)];
            const ManifoldPoint &q = ba.points[std::size_t(i)];
            same =
                p.position == q.position && p.separation == q.separation && p.feature == q.feature;
        }
        differing += !same;
    }
    EXPECT_EQ(differing, 0);
}

TEST(Manifold, MovesWithTheShapes) {
    Random random(4);
    int looked = 0, differing = 0;
    for (int trial = 0; trial < 100000; ++trial) {
        const std::uint32_t kind_a = random.next_index(3), kind_b = random.next_index(3);
        const Pair pair = any_pair(random, kind_a, kind_b, false, false);
        const Transform pose{any_vector(random, 1.0), any_rotation(random)};
        const Manifold here = collide(pair.a, pair.b, Real(margin));
        const Manifold there = collide(placed(pair.a, pose), placed(pair.b, pose), Real(margin));
        if (here.count == 0 || there.count == 0) {
            if (here.count + there.count > 0) {
                ASSERT_NEAR(deepest(here.count > 0 ? here : there), margin, preference);
            }
            continue;
        }
        ++looked;
        ASSERT_NEAR(deepest(here), deepest(there), preference);
        bool same = here.count == there.count &&
                    glm::length(wide(to_world_vector(pose, here.normal) - there.normal)) < 1e-3;
        for (int i = 0; same && i < here.count; ++i) {
            const ManifoldPoint &p = here.points[std::size_t(i)];
            const ManifoldPoint &q = there.points[std::size_t(i)];
            same = p.feature == q.feature &&
                   glm::length(wide(to_world_point(pose, p.position) - q.position)) < 1e-3;
        }
        differing += !same;
    }
    // Where two features tie to within rounding, the choice may go either way: over 1e-4 m (the
    // tolerances) or a rounding error, out of some 0.1 m.
    EXPECT_GT(looked, 40000);
    EXPECT_LT(differing, looked / 100);
}

TEST(Manifold, FeaturesPersistUnderSmallMotions) {
    Random random(5);
    int looked = 0, differing = 0;
    for (int trial = 0; trial < 100000; ++trial) {
        const std::uint32_t kind_a = random.next_index(3), kind_b = random.next_index(3);
        const Pair pair = any_pair(random, kind_a, kind_b, false, false);
        const Manifold before = collide(pair.a, pair.b, Real(margin));
        const Transform nudge{any_vector(random, 1e-5), identity_rotation};
        const Manifold after = collide(pair.a, placed(pair.b, nudge), Real(margin));
        if (before.count == 0 || after.count == 0)
            continue;
        ++looked;
        bool same = before.count == after.count;
        for (int i = 0; same && i < before.count; ++i)
            same = before.points[std::size_t(i)].feature == after.points[std::size_t(i)].feature;
        differing += !same;
    }
    EXPECT_GT(looked, 40000);
    EXPECT_LT(differing, looked / 200); // a 1e-5 m motion crosses a border 1e-5 / 0.1 of the time
}

// A box face-on on a box, at any angle about the vertical: always four points with the same feature
// ids, however much the solver jitters the boxes.
TEST(Manifold, StackedBoxesKeepFourPoints) {
    Random random(6);
    for (int trial = 0; trial < 2000; ++trial) {
        const Real size = any_real(random, 0.2, 1.0);
        const Vec3 half_a{any_real(random, 0.2, 1.0), any_real(random, 0.2, 1.0),
                          any_real(random, 0.2, 1.0)};
        // The same size and aligned (every corner on a border), or smaller and turned.
        const bool is_aligned = trial % 2 == 0;
        const Vec3 half_b = is_aligned ? half_a : Real(0.3) * size * half_a;
        const double angle = is_aligned ? 0.0 : random.next_in(0.0, 6.28);
        const Quat turn{Real(std::cos(0.5 * angle)), Real(0), Real(std::sin(0.5 * angle)), Real(0)};
        const Box lower{Vec3{Real(0)}, identity_rotation, half_a};
        std::array<std::uint32_t, 4> features{};
        for (int shake = 0; shake < 50; ++shake) {
            // Below half the 1e-4 m tolerance at the corners.
            const Vec3 at = Vec3{Real(0), half_a.y + half_b.y, Real(0)} + any_vector(random, 1e-5);
            const Box upper{at, tilt(random, 1e-5) * turn, half_b};
            const Manifold m = collide(lower, upper, Real(0.01));
            ASSERT_EQ(m.count, 4) << "trial " << trial;
            ASSERT_GT(m.normal.y, Real(0.9999));
            for (std::size_t i = 0; i < 4; ++i) {
                ASSERT_NEAR(double(m.points[i].separation), 0.0, 1e-4);
                if (shake == 0)
                    features[i] = m.points[i].feature;
                ASSERT_EQ(m.points[i].feature, features[i]) << "trial " << trial;
            }
        }
    }
}

// Two squares at 45 degrees meet in an octagon. The four points kept span at least the inscribed
// square and include the deepest of the eight.
TEST(Manifold, KeepsTheDeepestAndASpread) {
    Random random(7);
    for (int trial = 0; trial < 2000; ++trial) {
        const double angle = random.next_in(0.3, 1.2);
        const Quat turn{Real(std::cos(0.5 * angle)), Real(0), Real(std::sin(0.5 * angle)), Real(0)};
        const Vec3 half{Real(0.5)};
        const Box lower{Vec3{Real(0)}, identity_rotation, half};
        const Box upper{{Real(0), Real(0.99), Real(0)}, tilt(random, 5e-3) * turn, half};
        const Manifold m = collide(lower, upper, Real(0.05));
        ASSERT_EQ(m.count, 4);
        const double depth = translation_along(Solid(lower), Solid(upper), V{0, 1, 0});
        // The upper box's deepest corner is at most 0.2 outside the lower face, where the tilt
        // lifts the octagon by no more than 5e-3 * 0.21.
        EXPECT_NEAR(-deepest(m), depth, 5e-3 * 0.21 + 3e-4);
        // Shoelace area in the plane, with the four points in angular order.
        std::array<V, 4> p{};
        V middle{0.0};
        for (std::size_t i = 0; i < 4; ++i) {
            p[i] = wide(m.points[i].position);
            middle += 0.25 * p[i];
        }
        std::sort(p.begin(), p.end(), [&](const V &s, const V &t) {
            return std::atan2(s.z - middle.z, s.x - middle.x) <
                   std::atan2(t.z - middle.z, t.x - middle.x);
        });
        double area = 0.0;
        for (std::size_t i = 0; i < 4; ++i) {
            const V &s = p[i];
            const V &t = p[(i + 1) % 4];
            area += 0.5 * (s.x * t.z - t.x * s.z);
        }
        EXPECT_GT(std::abs(area), 0.5); // the octagon's area is 0.83
    }
}

TEST(Manifold, IsAsAccurateFarFromTheOrigin) {
    // Far out, at positions exact in both precisions: the answer is the one at the origin, up to
    // the rounding of the points' world positions.
    Random random(8);
    const Vec3 far{Real(8192), Real(-16384), Real(4096)};
    const double grid = 1.0 / 256; // a float at 16384 has steps of 1/512
    for (int trial = 0; trial < 20000; ++trial) {
        const auto on_grid = [&] {
            const Vec3 v = any_vector(random, 0.6);
            const V w = glm::round(wide(v) / grid) * grid;
            return Vec3{Real(w.x), Real(w.y), Real(w.z)};
        };
        const Box a{on_grid(), any_rotation(random), Vec3{Real(0.5)}};
        const Box b{on_grid(), any_rotation(random), Vec3{Real(0.4)}};
        const Box far_a{a.center + far, a.rotation, a.half_extents};
        const Box far_b{b.center + far, b.rotation, b.half_extents};
        const Manifold here = collide(a, b, Real(0.1));
        const Manifold there = collide(far_a, far_b, Real(0.1));
        ASSERT_EQ(here.count, there.count);
        ASSERT_EQ(here.normal, there.normal);
        for (std::size_t i = 0; i < std::size_t(here.count); ++i) {
            ASSERT_EQ(here.points[i].separation, there.points[i].separation);
            ASSERT_EQ(here.points[i].feature, there.points[i].feature);
        }
    }
}

// Nearly coaxial capsules and spheres: the difference of their closest points is mostly rounding,
// but the way out is perpendicular to the axis.
TEST(Manifold, NearlyCoaxialCapsulesPartSideways) {
    Random random(9);
    for (int trial = 0; trial < 100000; ++trial) {
        const Vec3 axis = any_rotation(random) * Vec3{Real(0), any_real(random, 0.3, 1.0), Real(0)};
        const Vec3 center = any_vector(random, 1.0);
        const Capsule a{center - axis, center + axis, Real(0.3)};
        const Vec3 nudge = any_vector(random, std::pow(10.0, random.next_in(-8.0, -4.0)));
        const Vec3 at = center + nudge;
        const Shape b =
            trial % 2 == 0
                ? Shape{Sphere{at, Real(0.2)}}
                : Shape{Capsule{at - Real(0.7) * axis, at + Real(0.7) * axis, Real(0.2)}};
        const Manifold m = collide(b, a, Real(0.1));
        ASSERT_GT(m.count, 0);
        const V n = wide(m.normal);
        ASSERT_NEAR(glm::length(n), 1.0, rounding);
        const V along = glm::normalize(wide(a.b) - wide(a.a));
        ASSERT_LT(std::abs(glm::dot(n, along)), 4 * rounding) << "trial " << trial;
        ASSERT_NEAR(deepest(m), -0.5, 3e-4);
    }
}

TEST(Manifold, ConcentricSpheresPushUp) {
    const Sphere a{Vec3{Real(1), Real(2), Real(3)}, Real(0.5)};
    const Manifold m = collide(a, a, Real(0));
    ASSERT_EQ(m.count, 1);
    EXPECT_EQ(m.normal, (Vec3{Real(0), Real(1), Real(0)}));
    EXPECT_EQ(m.points[0].separation, Real(-1));
}

TEST(Manifold, IdenticalBoxesAreLeftThroughTheNearestFace) {
    const Box a{Vec3{Real(0)}, identity_rotation, {Real(0.5), Real(0.2), Real(0.7)}};
    const Manifold m = collide(a, a, Real(0));
    ASSERT_EQ(m.count, 4);
    EXPECT_EQ(m.normal, (Vec3{Real(0), Real(1), Real(0)}));
    EXPECT_NEAR(double(m.points[0].separation), -0.4, 1e-6);
}

TEST(Manifold, MisuseNamesTheValue) {
    const Real nan = std::numeric_limits<Real>::quiet_NaN();
    const Sphere good{Vec3{Real(0)}, Real(1)};
    says([&] { collide(good, Sphere{Vec3{Real(0)}, Real(-2)}, Real(0)); }, "-2");
    says([&] { collide(Sphere{Vec3{nan}, Real(1)}, good, Real(0)); }, "nan");
    says([&] { collide(good, good, Real(-3)); }, "-3");
    says([&] { collide(good, good, nan); }, "nan");
    says(
        [&] {
            collide(good, Box{Vec3{Real(0)}, Quat{Real(2), Real(0), Real(0), Real(0)}, {}},
                    Real(0));
        },
        "(2, 0, 0, 0)");
    says(
        [&] {
            collide(good, HalfSpace{Vec3{Real(0), Real(5), Real(0)}, Real(0)}, Real(0));
        },
        "(0, 5, 0)");
    says([&] { bounds(Shape{HalfSpace{}}); }, "half-space");
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
