#include "engine/geometry/edge_gap.h"

#include "tests/geometry/convex_oracle.h"
#include "tests/trials.h"

#include <gtest/gtest.h>

#include <numbers>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace oracle;

constexpr double epsilon = double(std::numeric_limits<Real>::epsilon());

// An edge of a hull at the origin, and a direction in which no other corner is farther: between the
// normals of the edge's two faces, now and then almost one of them.
struct Crest {
    W start, along, out;
};
Crest any_crest(Random &random, const ConvexHull &hull) {
    const Body body = body_of(hull, W{0.0});
    const std::size_t i = random.next_index(std::uint32_t(body.edges.size()));
    const HullMesh::Edge &edge = hull.mesh->edges[i];
    const std::array<double, 5> ends = {0.0, 1.0, 1e-6, 1.0 - 1e-4, 1e-2};
    const double share =
        random.next_index(4) == 0 ? ends[random.next_index(5)] : random.next_in(0, 1);
    const W &left = body.planes[edge.left_face][0];
    const W &right = body.planes[edge.right_face][0];
    return {body.edges[i][0], body.edges[i][1] - body.edges[i][0],
            glm::normalize(left + Wide(share) * (right - left))};
}

W perpendicular_part(const W &v, const W &unit) {
    return v - glm::dot(v, unit) * unit;
}

double any_share(Random &random) { // of an edge
    const std::array<double, 6> near_ends = {0.0, 1.0, 1e-6, 1.0 - 1e-6, 1e-3, 0.99};
    return random.next_index(3) == 0 ? near_ends[random.next_index(6)] : random.next_in(0.0, 1.0);
}

// Two hulls with crossing edges, closer or deeper by `height` there, and the normal.
struct Crossed {
    ConvexHull a, b;
    Vec3 normal;
};
Crossed any_crossed(Random &random) {
    Scale scale;
    ConvexHull a = Any<ConvexHull>::make(random, Vec3{0}, 1.0, scale);
    ConvexHull b = Any<ConvexHull>::make(random, Vec3{0}, 1.0, scale);
    const Crest on_a = any_crest(random, a);
    Crest on_b = any_crest(random, b);
    // Turn b so that its direction out is opposite and its edge at some angle to a's.
    const auto turn_b = [&](const WideQuat &turn) {
        const WideQuat now{Wide(b.rotation.w), Wide(b.rotation.x), Wide(b.rotation.y),
                           Wide(b.rotation.z)};
        b.rotation = Quat{glm::normalize(turn * now)};
        on_b = {turn * on_b.start, turn * on_b.along, turn * on_b.out};
    };
    const W axis = glm::cross(on_b.out, -on_a.out);
    if (glm::length(axis) > Wide(1e-6))
        turn_b(glm::angleAxis(std::atan2(glm::length(axis), glm::dot(on_b.out, -on_a.out)),
                              glm::normalize(axis)));
    else if (glm::dot(on_b.out, on_a.out) > Wide(0))
        turn_b(glm::angleAxis(
            std::numbers::pi_v<Wide>,
            glm::normalize(perpendicular_part(
                std::abs(on_a.out.x) < Wide(0.9) ? W{1, 0, 0} : W{0, 1, 0}, on_a.out))));
    const W across_a = perpendicular_part(on_a.along, on_a.out);
    const W across_b = perpendicular_part(on_b.along, on_a.out);
    const double angle = random.next_index(4) == 0 ? std::pow(10.0, random.next_in(-4, -1))
                                                   : random.next_in(0.0, 3.14);
    turn_b(
        glm::angleAxis(Wide(angle) - std::atan2(glm::dot(glm::cross(across_a, across_b), on_a.out),
                                                glm::dot(across_a, across_b)),
                       on_a.out));
    const double sign = random.next_index(2) == 0 ? 1.0 : -1.0;
    const double height =
        random.next_index(8) == 0 ? 0.0 : sign * std::pow(10.0, random.next_in(-6, -0.5));
    const W to = (on_a.start + Wide(any_share(random)) * on_a.along) -
                 (on_b.start + Wide(any_share(random)) * on_b.along) + Wide(height) * on_a.out;
    b.position = Vec3{to};
    return {a, b, Vec3{on_a.out}};
}

// Against all axes in wider arithmetic. Also with a guess that is off, or wrong: none is an answer,
// a wrong one is not.
TEST(EdgeGap, IsTheDistanceOrDepth) {
    Random random(460);
    int wrong = 0;
    std::array<int, 3> found_count{}; // overlapping, apart, beyond
    const int trial_count = trials(200'000);
    for (int i = 0; i < trial_count; ++i) {
        const Crossed crossed = any_crossed(random);
        const Pair<ConvexHull, ConvexHull> pair(crossed.a, crossed.b);
        const std::array<double, 4> off = {0.0, 1e-3, 0.1, 2.0};
        const Vec3 guess =
            crossed.normal + Real(off[random.next_index(4)]) * Vec3{any_direction(random)};
        const Real far =
            random.next_index(2) == 0 ? Real(0.05) : std::numeric_limits<Real>::infinity();
        const Vec3 origin = place_of(pair.a);
        const std::optional<Proximity> found =
            edge_gap(core_of(pair.a, origin), core_of(pair.b, origin), guess, far);
        if (!found)
            continue;
        const double allowed = 64 * epsilon * pair.size;
        const W n = to_wide(found->normal);
        const double along = -double(overlap_along(pair.wide_a, pair.wide_b, n));
        std::ostringstream text;
        if (!(std::abs(double(glm::length(n)) - 1.0) <= 4.0 * epsilon))
            text << "normal of length " << glm::length(n) << "; ";
        if (found->is_beyond) {
            ++found_count[2];
            if (!(along > double(far) - allowed))
                text << "not beyond: " << along;
        } else {
            ++found_count[found->separation > Real(0) ? 1 : 0];
            // The plane's lower bound, and points of the shapes that far apart.
            if (!(std::abs(double(found->separation) - along) <= allowed))
                text << "separation " << found->separation << ", along the normal " << along
                     << "; ";
            const W on_a = to_wide(found->on_a), on_b = to_wide(found->on_b);
            if (!(double(glm::length(on_a + Wide(found->separation) * n - on_b)) <= 4 * allowed))
                text << "points " << glm::length(on_a - on_b) << " apart; ";
            if (!(double(pair.wide_a.outside(on_a)) <= allowed) ||
                !(double(pair.wide_b.outside(on_b)) <= allowed))
                text << "points off the shapes; ";
            if (found->separation < Real(0)) {
                const double true_separation =
                    double(polytope_separation(pair.wide_a, pair.wide_b));
                if (!(std::abs(double(found->separation) - true_separation) <= 4 * allowed))
                    text << "separation " << found->separation << ", truly " << true_separation;
            }
        }
        if (!text.str().empty() && ++wrong <= 5)
            ADD_FAILURE() << "pair " << i << ": " << text.str();
    }
    EXPECT_EQ(wrong, 0) << "of " << trial_count;
    std::cout << "overlapping " << found_count[0] << ", apart " << found_count[1] << ", beyond "
              << found_count[2] << '\n';
    EXPECT_GT(found_count[0], trial_count / 12);
    EXPECT_GT(found_count[1], trial_count / 6);
    EXPECT_GT(found_count[2], trial_count / 400);
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
