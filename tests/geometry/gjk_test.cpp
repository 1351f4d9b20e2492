#include "engine/geometry/gjk.h"

#include "engine/core/check.h"
#include "tests/geometry/convex_oracle.h"
#include "tests/trials.h"

#include <gtest/gtest.h>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace oracle;

constexpr double epsilon = double(std::numeric_limits<Real>::epsilon());

// Proves a distance rather than recomputing it: points of A and B that far apart bound it from
// above, and a slab that wide between A and B bounds it from below.
std::string complaint(const WidePair &pair, const ClosestPoints &found) {
    std::ostringstream out;
    out.precision(12);
    const double distance = double(found.distance);
    const double relative = pair.is_curved ? (sizeof(Real) == 4 ? 1e-5 : 1e-9) : 16.0 * epsilon;
    const double allowed = relative * distance + 32.0 * epsilon * pair.size;
    const double in_world = allowed + 2.0 * epsilon * pair.far;
    const W on_a = to_wide(found.on_a) - pair.place, on_b = to_wide(found.on_b) - pair.place;
    if (pair.wide_a.outside(on_a) > in_world)
        out << "point of A is " << pair.wide_a.outside(on_a) << " outside; ";
    if (pair.wide_b.outside(on_b) > in_world)
        out << "point of B is " << pair.wide_b.outside(on_b) << " outside; ";
    if (std::abs(double(glm::length(on_b - on_a)) - distance) > 2.0 * in_world)
        out << "points " << glm::length(on_b - on_a) << " apart; ";
    if (distance > 0.0) {
        const W n = to_wide(found.normal);
        if (std::abs(double(glm::length(n)) - 1.0) > 4.0 * epsilon)
            out << "normal of length " << glm::length(n) << "; ";
        const double proved = std::max(0.0, -double(overlap_along(pair.wide_a, pair.wide_b, n)));
        if (proved < distance - allowed)
            out << "slab " << distance - proved << " too thin; ";
    } else if (found.normal != Vec3{Real(0)}) {
        out << "a normal without a distance; ";
    }
    if (!out.str().empty())
        out << "distance " << distance << ", allowed " << allowed << ", size " << pair.size
            << ", iterations " << found.iterations;
    return out.str();
}

TEST(Gjk, ProvesEachDistance) {
    std::uint64_t seed = 100;
    int most = 0;
    long iterations = 0, count = 0;
    int all_wrong = 0;
    for_all_pairs([&]<typename A, typename B>() {
        Random random(++seed);
        int wrong = 0;
        const int trial_count = trials(1'000'000 / kinds_of_pairs);
        for (int i = 0; i < trial_count; ++i) {
            const Pair<A, B> pair = any_pair_of<A, B>(random);
            const ClosestPoints found = distance(pair.a, pair.b);
            iterations += found.iterations;
            ++count;
            most = std::max(most, found.iterations);
            const std::string text = complaint(pair, found);
            if (!text.empty()) {
                ++wrong;
                std::cout << "seed " << seed << " pair " << i << ": " << text << '\n';
            }
            const bool is_apart = double(found.distance) > 32.0 * epsilon * pair.size;
            ASSERT_FALSE(is_apart && overlaps(pair.a, pair.b)) << seed << ' ' << i;
        }
        all_wrong += wrong;
    });
    EXPECT_EQ(all_wrong, 0);
    std::cout << "iterations: mean " << double(iterations) / double(count) << ", most " << most
              << '\n';
    EXPECT_EQ(oddity("gjk: iteration limit").met, 0U);
}

// The areas in a needle do not say where along it the closest point is, but it must still be on it.
TEST(Gjk, PointsAreOnNeedles) {
    const Capsule capsule{{Real(0.23897179961204529), Real(-0.25), Real(0.25)},
                          {Real(0.26102820038795471), Real(-0.25), Real(0.25)},
                          Real(0.0082711558789)};
    const Triangle needle{
        {Real(0.2521340548992157), Real(-0.23361685872077942), Real(0.249171182513237)},
        {Real(0.25212776660919189), Real(-0.23361651599407196), Real(0.24916212260723114)},
        {Real(0.24787221848964691), Real(-0.26638346910476685), Real(0.25083786249160767)}};
    const Pair<Capsule, Triangle> pair(capsule, needle);
    EXPECT_EQ(complaint(pair, distance(capsule, needle)), "");
}

// So close that the squared distance underflows: there is no direction left, and none is invented.
TEST(Gjk, CloserThanANumberOverlaps) {
    const Real tiny = std::sqrt(std::numeric_limits<Real>::min()) / Real(16);
    const Segment segment{Vec3{Real(-1), Real(0), Real(0)}, Vec3{Real(1), Real(0), Real(0)}};
    const Vec3 point{Real(0), tiny, tiny};
    const ClosestPoints found = distance(segment, point);
    EXPECT_EQ(found.distance, Real(0));
    EXPECT_EQ(found.normal, Vec3{Real(0)});
}

// Small integers: shapes that touch at a face, edge or corner overlap, and shapes one unit apart do
// not.
TEST(Gjk, TouchingIsOverlapping) {
    const Box cube{Vec3{Real(3), Real(-2), Real(5)}, identity_rotation, Vec3{Real(1)}};
    const HullMesh mesh = prism(4, V{2.0, 1.0, 2.0}, 1.0); // a square standing on its corner
    for (int x = -1; x <= 1; ++x)
        for (int y = -1; y <= 1; ++y)
            for (int z = -1; z <= 1; ++z) {
                const Vec3 way{Real(x), Real(y), Real(z)};
                Vec3 corner = cube.center + way;
                if (x == 0 && y == 0 && z == 0)
                    continue;
                EXPECT_EQ(distance(cube, corner).distance, Real(0));
                EXPECT_TRUE(overlaps(cube, Segment{corner, corner + Real(3) * way}));
                EXPECT_TRUE(overlaps(Box{corner + way, identity_rotation, Vec3{Real(1)}}, cube));
                EXPECT_TRUE(overlaps(Triangle{corner, corner + way, corner + Real(2) * way}, cube));
                corner += way;
                const Real apart = std::sqrt(glm::dot(way, way));
                EXPECT_NEAR(double(distance(cube, corner).distance), double(apart), 4 * epsilon);
                EXPECT_FALSE(overlaps(cube, Segment{corner, corner + Real(3) * way}));
            }
    const ConvexHull hull{&mesh, Vec3{Real(4), Real(0), Real(0)}, identity_rotation};
    EXPECT_TRUE(overlaps(hull, Vec3{Real(2), Real(1), Real(0)}));
    EXPECT_TRUE(overlaps(hull, Sphere{Vec3{Real(4), Real(3), Real(0)}, Real(2)}));
    EXPECT_FALSE(overlaps(hull, Sphere{Vec3{Real(4), Real(4), Real(0)}, Real(2)}));
}

// On a ground 200 km wide, the error of a gap is the rounding of heights, not of widths.
TEST(Gjk, SmallOnLarge) {
    const Aabb ground{Vec3{Real(-1e5), Real(-1), Real(-1e5)}, Vec3{Real(1e5), Real(0), Real(1e5)}};
    Random random(7);
    for (int i = 0; i < trials(10'000); ++i) {
        const double gap = std::pow(10.0, random.next_in(-5.0, 0.0));
        const Vec3 at{any_real(random, -100, 100), Real(0.5 + gap), any_real(random, -100, 100)};
        const Box box{at, identity_rotation, Vec3{Real(0.5)}};
        const ClosestPoints found = distance(ground, box);
        ASSERT_NEAR(double(found.distance), double(at.y) - 0.5, 32 * epsilon) << text(at);
        ASSERT_NEAR(double(found.normal.y), 1.0, 1e-6) << text(at);
    }
}

TEST(Gjk, RefusesWhatIsNotAShape) {
    const Real nan = std::numeric_limits<Real>::quiet_NaN();
    const Real infinite = std::numeric_limits<Real>::infinity();
    const Sphere ball{Vec3{Real(0)}, Real(1)};
    const Box box{Vec3{Real(0)}, identity_rotation, Vec3{Real(1)}};
    EXPECT_THROW((void)distance(Vec3{nan, Real(0), Real(0)}, ball), CheckFailure);
    EXPECT_THROW((void)distance(ball, Segment{Vec3{Real(0)}, Vec3{infinite}}), CheckFailure);
    EXPECT_THROW((void)overlaps(Sphere{Vec3{Real(0)}, Real(-1)}, Triangle{}), CheckFailure);
    EXPECT_THROW(
        (void)distance(Box{Vec3{Real(0)}, Quat{Real(2), Real(0), Real(0), Real(0)}, Vec3{Real(1)}},
                       ball),
        CheckFailure);
    EXPECT_THROW((void)distance(box, Aabb{}), CheckFailure); // empty
    EXPECT_THROW((void)distance(box, Cylinder{Vec3{Real(1)}, Vec3{Real(1)}, Real(1)}),
                 CheckFailure);
    EXPECT_THROW((void)distance(Capsule{Vec3{Real(0)}, Vec3{Real(1)}, nan}, box), CheckFailure);
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
