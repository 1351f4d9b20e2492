#include "engine/geometry/shape_cast.h"

#include "engine/core/check.h"
#include "tests/geometry/convex_oracle.h"
#include "tests/trials.h"

#include <gtest/gtest.h>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace oracle;

constexpr double epsilon = double(std::numeric_limits<Real>::epsilon());

// When two polytopes meet: the axes do not rotate, so along each axis that can separate them the
// overlap is an interval of time. Empty when low > high.
struct Interval {
    double low = 0.0, high = 1.0;
};
Interval meeting(const Body &a, const Body &b, const W &translation, double slack) {
    Interval result;
    const auto consider = [&](const W &u) {
        // A's farthest point passes B's nearest, both ways.
        const double speed = double(glm::dot(u, translation));
        const double gap = -double(overlap_along(a, b, u)) - slack;
        if (speed == 0.0) {
            if (gap > 0.0)
                result.low = 2.0;
        } else if (speed > 0.0) {
            result.low = std::max(result.low, gap / speed);
        } else {
            result.high = std::min(result.high, gap / speed);
        }
    };
    for_all_axes(a, b, consider);
    for_all_axes(a, b, [&](const W &u) { consider(-u); });
    return result;
}

// Proves a hit: the point is on both shapes at that time, and the plane there separates them
// before. Checks a miss between solid polytopes against the intervals of all their axes.
std::string complaint(const WidePair &pair, const Vec3 &translation,
                      const std::optional<CastHit> &hit) {
    std::ostringstream out;
    out.precision(12);
    const W motion = to_wide(translation);
    const double reach = double(glm::length(motion));
    const double size = pair.size + reach;
    const double rounding = 32.0 * epsilon * size;
    const double target = 2.0 * double(cast_target(Real(2.0 * size)));
    if (!hit) {
        if (pair.wide_a.is_solid && pair.wide_b.is_solid) {
            const Interval sure = meeting(pair.wide_a, pair.wide_b, motion, -rounding);
            if (sure.low <= sure.high)
                out << "missed what is met from " << sure.low << " to " << sure.high;
        }
        return out.str();
    }
    const W n = to_wide(hit->normal);
    if (!(std::abs(double(glm::length(n)) - 1.0) <= 4.0 * epsilon))
        return "normal of length " + std::to_string(glm::length(n));
    const W point = to_wide(hit->point) - pair.place;
    double in_world = target + rounding + 2.0 * epsilon * pair.far;
    if (hit->starts_overlapping) { // what epa.h says about its points
        const double relative = pair.is_curved ? 4e-3 : sizeof(Real) == 4 ? 1e-5 : 1e-10;
        in_world += relative * std::max(0.0, double(overlap_along(pair.wide_a, pair.wide_b, n)));
    }
    if (!(hit->t >= Real(0) && hit->t <= Real(1)))
        out << "t is " << hit->t << "; ";
    if (!(double(pair.wide_b.outside(point)) <= in_world))
        out << "point is " << pair.wide_b.outside(point) << " outside of B; ";
    if (hit->starts_overlapping) {
        if (hit->t != Real(0))
            out << "t is " << hit->t << " from the start; ";
    } else {
        const W at = point - Wide(hit->t) * motion;
        if (!(double(pair.wide_a.outside(at)) <= in_world))
            out << "point is " << pair.wide_a.outside(at) << " outside of A; ";
        const double overlap =
            double(overlap_along(pair.wide_a, pair.wide_b, n) + Wide(hit->t) * glm::dot(n, motion));
        if (!(overlap <= target + rounding))
            out << "in each other by " << overlap << " along the normal; ";
        if (!(double(glm::dot(n, motion)) >= -rounding))
            out << "moves away from what it hits; ";
    }
    if (!out.str().empty())
        out << "t " << hit->t << ", target " << target << ", rounding " << rounding << ", size "
            << size << (hit->starts_overlapping ? ", from the start" : "");
    return out.str();
}

TEST(ShapeCast, ProvesEachHit) {
    std::uint64_t seed = 300;
    long hits = 0, all = 0;
    for_all_pairs([&]<typename A, typename B>() {
        Random random(++seed);
        int wrong = 0;
        const int trial_count = trials(1'000'000 / kinds_of_pairs);
        for (int i = 0; i < trial_count; ++i) {
            const Pair<A, B> pair = any_pair_of<A, B>(random);
            // Mostly roughly towards B, up to it and beyond.
            V aim = V(pair.wide_b.corners[0]) * random.next_in(0.0, 2.0) +
                    any_direction(random) * pair.size * std::pow(10.0, random.next_in(-3.0, 0.0));
            if (random.next_index(16) == 0)
                aim = V{0.0};
            const Vec3 translation{Real(aim.x), Real(aim.y), Real(aim.z)};
            const std::optional<CastHit> hit = cast(pair.a, translation, pair.b);
            ++all;
            hits += hit ? 1 : 0;
            const std::string text = complaint(pair, translation, hit);
            if (!text.empty() && ++wrong <= 3)
                ADD_FAILURE() << "seed " << seed << " pair " << i << ": " << text;
        }
        EXPECT_EQ(wrong, 0) << "of " << trial_count << ", seed " << seed;
    });
    std::cout << "mean: " << hits << " of " << all << " hit\n";
    EXPECT_EQ(oddity("cast: step limit").met, 0U);
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
