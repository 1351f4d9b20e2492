// Boxes of all sizes against boxes: parallel, nearly parallel, edge to edge, and far from the
// origin.
#include "engine/geometry/sat.h"
#include "tests/geometry/wide.h"
#include "tests/trials.h"

#include <gtest/gtest.h>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace wide;

// Whether box `a`, grown by `grow` on all sides, meets box `b`: clips each box's faces by the
// other's planes and looks for anything left.
bool boxes_meet(Frame a, const Frame &b, W grow) {
    a.half += W3{grow};
    if (a.signed_distance(b.center) <= W(0) || b.signed_distance(a.center) <= W(0))
        return true;
    std::array<W3, 8> corners_a, corners_b;
    for (int k = 0; k < 8; ++k) {
        corners_a[std::size_t(k)] = a.corner(k);
        corners_b[std::size_t(k)] = b.corner(k);
        if (b.signed_distance(corners_a[std::size_t(k)]) <= W(0) ||
            a.signed_distance(corners_b[std::size_t(k)]) <= W(0))
            return true;
    }
    for (const auto &face : face_corners) {
        Polygon of_a, of_b;
        for (const std::size_t k : face) {
            of_a.corner[of_a.count++] = corners_a[k];
            of_b.corner[of_b.count++] = corners_b[k];
        }
        b.cut(of_a);
        a.cut(of_b);
        if (of_a.count > 0 || of_b.count > 0)
            return true;
    }
    return false;
}

// The box's support point along n; where n is perpendicular to an axis, any point along it.
W3 any_support(Random &random, const Frame &box, const W3 &n) {
    W3 local{W(0)};
    for (int i = 0; i < 3; ++i) {
        const W along = glm::dot(n, box.axis[std::size_t(i)]);
        local[i] = std::abs(along) > W(1e-12) ? (along > W(0) ? box.half[i] : -box.half[i])
                                              : box.half[i] * W(random.next_in(-1, 1));
    }
    return box.point(local);
}

// Two boxes that almost touch along a face normal of one, across an edge of each, or along a random
// direction.
struct Pair {
    Box a, b;
    W3 n{W(0)};
};

Pair any_pair(Random &random, bool is_aligned) {
    const W size = any_size(random), other = size * any_power(random, -2, 2);
    Pair pair;
    const Quat turn = is_aligned ? identity_rotation : oracle::awkward_rotation(random);
    pair.a = {narrowed(any_position(random)), turn, any_half_extents(random, size)};
    pair.b = {{}, oracle::awkward_rotation(random), any_half_extents(random, other)};
    const std::uint32_t likeness = random.next_index(4);
    if (likeness == 0) // parallel to the last bit, or nearly
        pair.b.rotation = pair.a.rotation;
    else if (likeness == 1)
        pair.b.rotation = glm::normalize(
            oracle::tilt(random, std::pow(10.0, random.next_in(-9, -1))) * pair.a.rotation);
    const Frame a(pair.a), b(pair.b);
    const std::size_t i = random.next_index(3), j = random.next_index(3);
    switch (random.next_index(4)) {
    case 0:
        pair.n = a.axis[i];
        break;
    case 1:
        pair.n = b.axis[j];
        break;
    case 2:
        pair.n = full_cross(a.axis[i], b.axis[j]);
        break;
    default:
        pair.n = any_unit(random);
    }
    if (glm::length(pair.n) == W(0))
        pair.n = a.axis[i];
    pair.n = glm::normalize(pair.n) * (random.next_index(2) == 0 ? W(1) : W(-1));
    // Moves b's point to a's, and past it by the gap.
    const W3 from = any_support(random, a, pair.n), to = any_support(random, b, -pair.n);
    pair.b.center =
        narrowed(from - (to - b.center) + pair.n * any_gap(random, std::min(size, other)));
    return pair;
}

struct Counts {
    int overlapping = 0, apart = 0, cut = 0;
};

void judge(bool answer, const Frame &a, const Frame &b, const W3 &n, W bound, Counts &counts) {
    answer ? ++counts.overlapping : ++counts.apart;
    const W gap = std::abs(glm::dot(b.center - a.center, n)) - a.reach(n) - b.reach(n);
    if (gap > bound) { // n itself proves it
        ASSERT_FALSE(answer) << "gap " << gap << ", bound " << bound;
        return;
    }
    // A box grown by g meets everything within g of it, and nothing further than sqrt(3) g; shrunk
    // by g, it still meets everything that penetrates deeper than that.
    ++counts.cut;
    const W g = bound / std::sqrt(W(3));
    if (answer) {
        ASSERT_TRUE(boxes_meet(a, b, g)) << "gap " << gap << ", bound " << bound;
    } else if (std::min({a.half.x, a.half.y, a.half.z}) > g) {
        ASSERT_FALSE(boxes_meet(a, b, -g)) << "gap " << gap << ", bound " << bound;
    }
}

TEST(BoxOverlap, BoxesOfAnySizeAgainstClipping) {
    Random random(1);
    Counts counts;
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        Pair pair = any_pair(random, false);
        if (random.next_index(8) == 0)
            pair.a.rotation *= Real(1) + static_cast<Real>(random.next_in(-7, 7) * double(epsilon));
        const W bound = 32 * epsilon * std::max(scale_of(pair.a), scale_of(pair.b));
        judge(overlaps(pair.a, pair.b), Frame(pair.a), Frame(pair.b), pair.n, bound, counts);
        const W separation = W(separating_axis(pair.a, pair.b).separation);
        if (std::abs(separation) > bound) {
            ASSERT_EQ(overlaps(pair.a, pair.b), separation <= W(0));
        }
        if (HasFatalFailure())
            FAIL() << "trial " << trial;
    }
    EXPECT_GT(counts.overlapping, trials(1'000'000) / 5);
    EXPECT_GT(counts.apart, trials(1'000'000) / 5);
}

TEST(BoxOverlap, AabbsOfAnySizeAgainstClipping) {
    Random random(2);
    Counts counts;
    for (int trial = 0; trial < trials(1'000'000); ++trial) {
        const Pair pair = any_pair(random, true);
        const Aabb a{pair.a.center - pair.a.half_extents, pair.a.center + pair.a.half_extents};
        const W bound = 32 * epsilon * std::max(scale_of(a), scale_of(pair.b));
        judge(overlaps(a, pair.b), Frame(a), Frame(pair.b), pair.n, bound, counts);
        if (HasFatalFailure())
            FAIL() << "trial " << trial;
    }
    EXPECT_GT(counts.overlapping, trials(1'000'000) / 5);
    EXPECT_GT(counts.apart, trials(1'000'000) / 5);
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
