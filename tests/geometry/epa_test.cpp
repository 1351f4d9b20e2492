#include "engine/geometry/epa.h"

#include "engine/core/check.h"
#include "tests/geometry/convex_oracle.h"
#include "tests/trials.h"

#include <gtest/gtest.h>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace oracle;

constexpr double epsilon = double(std::numeric_limits<Real>::epsilon());

// The depth is proved from above by the overlap along the normal in wider arithmetic, and from
// below by all the directions that the least depth of two polytopes can have, or, where the cores
// are apart, by the distance of points in them. For cylinders directions are sampled.
template <typename A, typename B>
std::string complaint(const Pair<A, B> &pair, const Penetration &found, Random &random) {
    std::ostringstream out;
    out.precision(12);
    const double depth = double(found.depth);
    constexpr bool is_curved = std::same_as<A, Cylinder> || std::same_as<B, Cylinder>;
    constexpr bool is_float = sizeof(Real) == 4;
    const double rounding = 32.0 * epsilon * pair.size;
    const double relative = is_curved ? 4e-3 : is_float ? 1e-5 : 1e-10;
    const double allowed = relative * depth + rounding;
    const double in_world = allowed + 2.0 * epsilon * pair.far;
    const W place = to_wide(place_of(pair.a));
    const W on_a = to_wide(found.on_a) - place, on_b = to_wide(found.on_b) - place;
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
            if (!text.empty() && ++wrong <= 3)
                ADD_FAILURE() << "seed " << seed << " pair " << i << ": " << text;
        }
        EXPECT_EQ(wrong, 0) << "of " << trial_count << ", seed " << seed;
    });
    std::cout << deep << " of " << all << " overlap; mean " << double(iterations) / double(deep)
              << " iterations, most " << most << '\n';
    // Differences flat to the last digit, such as a segment in the plane of a triangle.
    EXPECT_LE(oddity("epa: vertex limit").met, std::uint64_t(1 + all / 50'000));
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
