#include "engine/geometry/manifold.h"

#include "engine/geometry/edge_gap.h"
#include "engine/geometry/epa.h"
#include "tests/geometry/convex_oracle.h"
#include "tests/trials.h"

#include <gtest/gtest.h>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace oracle;

constexpr double margin = 0.1;
constexpr double epsilon = double(std::numeric_limits<Real>::epsilon());
// The chosen face may be worse than the best direction by 1e-4 m, and its points are found within
// another 2e-4; coordinates are below 8 m.
constexpr double preference = 3e-4 + 32 * 8 * epsilon;

double deepest(const Manifold &m) {
    double least = 1e300;
    for (int i = 0; i < m.count; ++i)
        least = std::min(least, double(m.points[std::size_t(i)].separation));
    return least;
}

// The tests of GJK and EPA prove distance and depth; here both are taken as given.
template <typename A, typename B> double signed_distance_of(const Pair<A, B> &pair) {
    const auto deep = penetration(pair.a, pair.b);
    return deep ? -double(deep->depth) : double(distance(pair.a, pair.b).distance);
}

std::string complaint(const WidePair &pair, double signed_distance, const Manifold &m) {
    std::ostringstream out;
    const double allowed =
        preference + (pair.is_curved ? 4e-3 * std::max(0.0, -signed_distance) : 0.0);
    if (m.count == 0) {
        if (signed_distance < margin - preference)
            out << "no contact at " << signed_distance;
        return out.str();
    }
    const W n = to_wide(m.normal);
    if (!(std::abs(double(glm::length(n)) - 1.0) <= 4.0 * epsilon))
        out << "normal of length " << glm::length(n) << "; ";
    // The bound stated in manifold.h.
    if (!(std::abs(deepest(m) - signed_distance) <= allowed - 1e-4))
        out << "deepest " << deepest(m) << ", signed distance " << signed_distance << "; ";
    const double along = -double(overlap_along(pair.wide_a, pair.wide_b, n));
    if (!(deepest(m) >= along - allowed))
        out << "deeper than the separation " << along << " along the normal; ";
    for (int i = 0; i < m.count; ++i) {
        const ManifoldPoint &point = m.points[std::size_t(i)];
        const W at = to_wide(point.position) - pair.place;
        const W half = n * Wide(0.5) * Wide(point.separation);
        if (!(double(point.separation) <= margin))
            out << "point beyond the margin; ";
        if (!(double(pair.wide_a.outside(at - half)) <= allowed))
            out << "point " << i << " is " << pair.wide_a.outside(at - half) << " off A; ";
        if (!(double(pair.wide_b.outside(at + half)) <= allowed))
            out << "point " << i << " is " << pair.wide_b.outside(at + half) << " off B; ";
        for (int j = 0; j < i; ++j)
            if (m.points[std::size_t(j)].feature == point.feature)
                out << "feature " << point.feature << " twice; ";
    }
    if (!out.str().empty())
        out << m.count << " points, signed distance " << signed_distance;
    return out.str();
}

// Ordinary sizes, near each other, every other pair with parallel faces and edges.
template <typename A, typename B> Pair<A, B> near_pair(Random &random) {
    Scale scale;
    scale.is_awkward = random.next_index(2) == 0;
    const Vec3 at = any_place(random, scale);
    const auto make = [&]<typename Shape>() {
        // Contacts are between solids: no needles, nothing flat.
        Scale round = scale;
        round.is_awkward = false;
        if constexpr (std::same_as<Shape, Box>)
            return Box{at, any_turn(random, scale), any_half(random, 1.0, false, false)};
        else
            return Any<Shape>::make(random, at, 1.0,
                                    std::same_as<Shape, ConvexHull> ? scale : round);
    };
    const A a = make.template operator()<A>();
    B b = make.template operator()<B>();
    V u = any_direction(random);
    if (scale.is_awkward && random.next_index(2) == 0)
        u = V{0.0, random.next_index(2) == 0 ? 1.0 : -1.0, 0.0};
    const double both =
        double(overlap_along(body_of(a, to_wide(at)), body_of(b, to_wide(at)), W(u)));
    const double move = random.next_index(4) == 0 ? both * random.next_in(0.0, 1.0)
                                                  : both + random.next_in(-0.1, 0.12);
    b = moved(b, Vec3{Real(u.x * move), Real(u.y * move), Real(u.z * move)});
    return {a, b};
}

TEST(ManifoldConvex, KeepsTheContract) {
    std::uint64_t seed = 400;
    std::array<long, 5> counts{};
    const auto check = [&]<typename A, typename B>() {
        Random random(++seed);
        int wrong = 0;
        const int trial_count = trials(1'000'000 / 14);
        for (int i = 0; i < trial_count; ++i) {
            const Pair<A, B> pair = near_pair<A, B>(random);
            const Manifold m = collide(pair.a, pair.b, Real(margin));
            ++counts[std::size_t(m.count)];
            const std::string text = complaint(pair, signed_distance_of(pair), m);
            if (!text.empty() && ++wrong <= 3)
                ADD_FAILURE() << "seed " << seed << " pair " << i << ": " << text;
        }
        EXPECT_EQ(wrong, 0) << "of " << trial_count << ", seed " << seed;
    };
    check.operator()<Sphere, Cylinder>();
    check.operator()<Sphere, ConvexHull>();
    check.operator()<Sphere, Triangle>();
    check.operator()<Box, Cylinder>();
    check.operator()<Box, ConvexHull>();
    check.operator()<Box, Triangle>();
    check.operator()<Capsule, Cylinder>();
    check.operator()<Capsule, ConvexHull>();
    check.operator()<Capsule, Triangle>();
    check.operator()<Cylinder, Cylinder>();
    check.operator()<Cylinder, ConvexHull>();
    check.operator()<Cylinder, Triangle>();
    check.operator()<ConvexHull, ConvexHull>();
    check.operator()<ConvexHull, Triangle>();
    check.operator()<Triangle, Triangle>();
    check.operator()<Cylinder, Box>(); // in the other order
    check.operator()<Triangle, ConvexHull>();
    std::cout << "mean: points 0 to 4: " << counts[0] << ' ' << counts[1] << ' ' << counts[2] << ' '
              << counts[3] << ' ' << counts[4] << '\n';
}

// With a guess near the right normal or anywhere, the contract is the same. With the right one, a
// face decides one case in four, and a face or an edge of each every other.
TEST(ManifoldConvex, KeepsTheContractWithAGuess) {
    std::uint64_t seed = 450;
    const auto check = [&]<typename A, typename B>() {
        Random random(++seed);
        int wrong = 0;
        int with_contact = 0;
        int by_a_face = 0;
        int by_features = 0;
        const int trial_count = trials(1'000'000 / 14);
        for (int i = 0; i < trial_count; ++i) {
            const Pair<A, B> pair = near_pair<A, B>(random);
            V guess = any_direction(random);
            const Manifold without = collide(pair.a, pair.b, Real(margin));
            if (without.count > 0 && random.next_index(4) != 0) {
                guess = V{without.normal} + 0.05 * guess;
                const Vec3 origin = place_of(pair.a);
                ++with_contact;
                const auto a = core_of(pair.a, origin);
                const auto b = core_of(pair.b, origin);
                by_a_face += face_gap(a, b, Vec3{guess}, Real(margin)).has_value() ? 1 : 0;
                by_features += feature_gap(a, b, Vec3{guess}, Real(margin)).has_value() ? 1 : 0;
            }
            const Manifold m = collide(Shape{pair.a}, Shape{pair.b}, Real(margin), Vec3{guess});
            const std::string text = complaint(pair, signed_distance_of(pair), m);
            if (!text.empty() && ++wrong <= 3)
                ADD_FAILURE() << "seed " << seed << " pair " << i << ": " << text;
        }
        EXPECT_EQ(wrong, 0) << "of " << trial_count << ", seed " << seed;
        EXPECT_GT(by_a_face, with_contact / 5);
        EXPECT_GT(by_features, 2 * with_contact / 5);
        std::cout << "of " << with_contact << ": " << by_a_face << ", " << by_features << '\n';
    };
    check.operator()<Box, ConvexHull>();
    check.operator()<ConvexHull, Box>();
    check.operator()<ConvexHull, ConvexHull>();
}

// Every kind with every other, in either order.
template <typename A, typename... Bs> constexpr bool collides_with_all = (Collidable<A, Bs> && ...);
template <typename... Kinds>
constexpr bool all_collide = (collides_with_all<Kinds, Kinds...> && ...);
static_assert(all_collide<Sphere, Box, Capsule, Cylinder, ConvexHull, Triangle, HalfSpace>);
static_assert(!Collidable<Sphere, Segment>); // unknown shapes do not compile

TEST(ManifoldConvex, TrianglesOnAHalfSpace) {
    const HalfSpace ground{};
    const Triangle flat{Vec3{Real(0), Real(-0.25), Real(0)}, Vec3{Real(0), Real(-0.25), Real(2)},
                        Vec3{Real(2), Real(-0.25), Real(0)}};
    const Manifold m = collide(flat, ground, Real(0));
    ASSERT_EQ(m.count, 3);
    EXPECT_EQ(m.normal, (Vec3{Real(0), Real(-1), Real(0)}));
    for (int i = 0; i < 3; ++i)
        EXPECT_EQ(m.points[std::size_t(i)].separation, Real(-0.25));
    const Manifold mirror = collide(ground, flat, Real(0));
    EXPECT_EQ(mirror.count, 3);
    EXPECT_EQ(mirror.normal, (Vec3{Real(0), Real(1), Real(0)}));
    EXPECT_EQ(collide(ground, ground, Real(1)).count, 0);
}

TEST(ManifoldConvex, RestsOnAsManyPointsAsAFaceHas) {
    const Triangle ground{Vec3{Real(-10), Real(0), Real(-10)}, Vec3{Real(0), Real(0), Real(20)},
                          Vec3{Real(10), Real(0), Real(-10)}};
    const Box box{Vec3{Real(0), Real(0.5), Real(0)}, identity_rotation, Vec3{Real(0.5)}};
    const Cylinder standing{Vec3{Real(0)}, Vec3{Real(0), Real(1), Real(0)}, Real(0.5)};
    const Cylinder lying{Vec3{Real(-1), Real(0.5), Real(0)}, Vec3{Real(1), Real(0.5), Real(0)},
                         Real(0.5)};
    const HullMesh mesh = prism(6, V{0.5, 0.5, 0.5}, 1.0);
    const ConvexHull hull{&mesh, Vec3{Real(0), Real(0.5), Real(0)}, identity_rotation};
    const HalfSpace plane{Vec3{Real(0), Real(1), Real(0)}, Real(0)};
    const auto expect = [](const Manifold &m, int count, Real up) {
        EXPECT_EQ(m.count, count);
        EXPECT_NEAR(double(m.normal.y), double(up), 1e-6);
        for (int i = 0; i < m.count; ++i) {
            EXPECT_NEAR(double(m.points[std::size_t(i)].separation), 0.0, 1e-6);
            EXPECT_NEAR(double(m.points[std::size_t(i)].position.y), 0.0, 1e-6);
        }
    };
    expect(collide(box, ground, Real(0.01)), 4, Real(-1));
    expect(collide(standing, ground, Real(0.01)), 4, Real(-1));
    expect(collide(lying, ground, Real(0.01)), 2, Real(-1));
    expect(collide(hull, ground, Real(0.01)), 4, Real(-1));
    expect(collide(standing, plane, Real(0.01)), 4, Real(-1));
    expect(collide(lying, plane, Real(0.01)), 2, Real(-1));
    expect(collide(hull, plane, Real(0.01)), 4, Real(-1));
    const Sphere ball{Vec3{Real(0), Real(0.5), Real(0)}, Real(0.5)};
    expect(collide(ball, ground, Real(0.01)), 1, Real(-1));
    const Cylinder beside{Vec3{Real(-1), Real(0.5), Real(1)}, Vec3{Real(1), Real(0.5), Real(1)},
                          Real(0.5)};
    EXPECT_EQ(collide(lying, beside, Real(0.01)).count, 2);
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
