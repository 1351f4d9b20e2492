#include "engine/geometry/epa.h"

#include "engine/core/check.h"
#include "tests/geometry/convex_oracle.h"
#include "tests/trials.h"

#include <gtest/gtest.h>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace oracle;

constexpr double epsilon = double(std::numeric_limits<Real>::epsilon());

// The overlap along the normal, in wider arithmetic, bounds the depth from above. From below it is
// bounded by all possible directions of least depth of two polytopes or, where the cores are apart,
// by the distance between points in them. For cylinders directions are sampled.
std::string complaint(const WidePair &pair, const Penetration &found, Random &random) {
    std::ostringstream out;
    out.precision(12);
    const double depth = double(found.depth);
    const bool is_curved = pair.is_curved;
    constexpr bool is_float = sizeof(Real) == 4;
    const double rounding = 32.0 * epsilon * pair.size;
    const double relative = is_curved ? 4e-3 : is_float ? 1e-5 : 1e-10;
    const double allowed = relative * depth + rounding;
    const double in_world = allowed + 2.0 * epsilon * pair.far;
    const W on_a = to_wide(found.on_a) - pair.place, on_b = to_wide(found.on_b) - pair.place;
    const W n = to_wide(found.normal);
    if (!(std::abs(double(glm::length(n)) - 1.0) <= 4.0 * epsilon))
        return "normal of length " + std::to_string(glm::length(n));
    const double along = double(overlap_along(pair.wide_a, pair.wide_b, n / glm::length(n)));
    if (!(std::abs(along - depth) <= rounding + (is_curved ? 4.0 * epsilon : relative) * depth))
        out << "overlap along the normal is off by " << along - depth << "; ";
    if (!(double(pair.wide_a.outside(on_a)) <= in_world))
        out << "point of A is " << pair.wide_a.outside(on_a) << " outside; ";
    if (!(double(pair.wide_b.outside(on_b)) <= in_world))
        out << "point of B is " << pair.wide_b.outside(on_b) << " outside; ";
    if (!(double(glm::length(on_a - on_b - n * Wide(depth))) <= 2.0 * in_world))
        out << "points off by " << glm::length(on_a - on_b - n * Wide(depth)) << "; ";

    const double radii = is_curved ? 0.0 : double(pair.wide_a.radius + pair.wide_b.radius);
    if (is_curved) {
        for (int i = 0; i < 40; ++i) {
            W u = W(any_direction(random));
            if (i % 2 == 0)
                u = glm::normalize(n + u * Wide(std::pow(10.0, random.next_in(-4.0, 0.0))));
            const double other = double(overlap_along(pair.wide_a, pair.wide_b, u));
            if (other < depth - allowed) {
                out << "only " << other << " deep along another direction; ";
                break;
            }
        }
    } else if (depth > radii + allowed) {
        const double least = -double(polytope_separation(pair.wide_a, pair.wide_b));
        if (least < 1e200 && least < depth - allowed)
            out << "only " << least << " deep; ";
    } else if (depth < radii - 4.0 * allowed) {
        Body core_a = pair.wide_a, core_b = pair.wide_b;
        core_a.radius = core_b.radius = 0.0;
        const Wide off_a = core_a.outside(on_a - pair.wide_a.radius * n);
        const Wide off_b = core_b.outside(on_b + pair.wide_b.radius * n);
        if (double(std::max(off_a, off_b)) > 2.0 * in_world)
            out << "points of cores off by " << off_a << ", " << off_b << "; ";
    }
    if (!out.str().empty())
        out << "depth " << depth << ", allowed " << allowed << ", size " << pair.size
            << ", iterations " << found.iterations;
    return out.str();
}

TEST(Epa, ProvesEachDepth) {
    const std::uint64_t full_before = oddity("epa: vertex limit").met;
    std::uint64_t seed = 200;
    int most = 0;
    long iterations = 0, deep = 0, all = 0;
    for_all_pairs([&]<typename A, typename B>() {
        Random random(++seed);
        int wrong = 0;
        const int trial_count = trials(1'000'000 / kinds_of_pairs);
        for (int i = 0; i < trial_count; ++i) {
            const Pair<A, B> pair = any_pair_of<A, B>(random);
            const std::optional<Penetration> found = penetration(pair.a, pair.b);
            ++all;
            std::string text;
            if (found) {
                text = complaint(pair, *found, random);
                iterations += found->iterations;
                most = std::max(most, found->iterations);
                ++deep;
            } else {
                if (overlaps(pair.a, pair.b))
                    text = "no penetration, and an overlap";
            }
            if (i % 4 == 0) {
                const Proximity both = proximity(pair.a, pair.b);
                if (found && (both.separation != -found->depth || both.normal != found->normal ||
                              both.on_a != found->on_a || both.on_b != found->on_b))
                    text += "another penetration as proximity";
                // Shapes apart by a rounding error may count either way.
                if (!found &&
                    std::max(both.separation, Real(0)) != distance(pair.a, pair.b).distance)
                    text += "another distance as proximity";
            }
            if (!text.empty() && ++wrong <= 3)
                ADD_FAILURE() << "seed " << seed << " pair " << i << ": " << text;
        }
        EXPECT_EQ(wrong, 0) << "of " << trial_count << ", seed " << seed;
    });
    std::cout << deep << " of " << all << " overlap; mean " << double(iterations) / double(deep)
              << " iterations, most " << most << '\n';
    EXPECT_EQ(oddity("epa: vertex limit").met, full_before);
}

// Shapes that touch within rounding, or are one ulp apart: the depth is then a rounding error below
// zero, and the search must still terminate.
TEST(Epa, EndsWhereTouchingIsRounding) {
    const Triangle triangle{
        {Real(-39.839759826660156), Real(25.809856414794922), Real(-0.74999427795410156)},
        {Real(53.119705200195312), Real(52.369667053222656), Real(-0.74999618530273438)},
        {Real(-1.2483539649110753e-05), Real(-40.589763641357422), Real(-0.75000381469726562)}};
    const Segment segment{{Real(-16752.33203125), Real(-40.589794158935547), Real(-0.75)},
                          {Real(16752.33203125), Real(-40.589794158935547), Real(-0.75)}};
    // In double they may be apart.
    if (const std::optional<Penetration> found = penetration(triangle, segment)) {
        EXPECT_LE(found->iterations, 100);
        EXPECT_LE(double(found->depth), 32.0 * epsilon * 16752.0);
    }
    const Real half_turn = std::sqrt(Real(0.5));
    const Box plate{Vec3{Real(-0.5), Real(0), Real(0.5)},
                    Quat{half_turn, Real(0), half_turn, Real(0)},
                    Vec3{Real(0), Real(0.5), Real(0.5)}};
    const Segment along{Vec3{Real(0), Real(0), Real(0.5)}, Vec3{Real(2), Real(0), Real(0.5)}};
    if (const std::optional<Penetration> found = penetration(plate, along)) {
        EXPECT_LE(found->iterations, 100);
        EXPECT_LE(double(found->depth), 32.0 * epsilon);
    }
}

// The difference is a cylinder swept along 1574 m: in float the normals of the slivers at its ends
// are pure rounding, and their planes seem to pass closer to the origin than the faces that matter.
TEST(Epa, EndsOnLongNeedles) {
    const Cylinder cylinder{Vec3{Real(-2), Real(-0.75), Real(-2)},
                            Vec3{Real(0.125), Real(0.125), Real(0.125)}, Real(0.125)};
    const Aabb line{Vec3{Real(0.125), Real(-1574.14893), Real(0.125)},
                    Vec3{Real(0.125), Real(0.125), Real(0.125)}};
    const Pair<Cylinder, Aabb> pair(cylinder, line);
    const std::uint64_t limits = oddity("epa: vertex limit").met;
    Random random(1);
    const std::optional<Penetration> found = penetration(cylinder, line);
    ASSERT_TRUE(found);
    EXPECT_EQ(complaint(pair, *found, random), "");
    EXPECT_LE(found->iterations, 100);
    EXPECT_EQ(oddity("epa: vertex limit").met, limits);
}

// Cores so close that the squared distance underflows still have a way out.
TEST(Epa, CoresCloserThanANumberPart) {
    const Real tiny = std::sqrt(std::numeric_limits<Real>::min()) / Real(16);
    const Capsule capsule{Vec3{Real(-1), Real(0), Real(0)}, Vec3{Real(1), Real(0), Real(0)},
                          Real(0.25)};
    const std::optional<Penetration> found =
        penetration(capsule, Sphere{Vec3{Real(0), tiny, tiny}, Real(0.5)});
    ASSERT_TRUE(found);
    EXPECT_EQ(found->depth, Real(0.75));
    EXPECT_NEAR(double(glm::length(found->normal)), 1.0, 4.0 * epsilon);
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
