#include "engine/geometry/half_space.h"

#include "engine/geometry/contains.h"
#include "tests/geometry/convex_oracle.h"
#include "tests/trials.h"

#include <gtest/gtest.h>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace oracle;

constexpr double epsilon = double(std::numeric_limits<Real>::epsilon());

// The lowest point's height above the surface, in wider numbers, checked against all queries.
template <typename A> std::string complaint(Random &random) {
    const Scale scale = any_scale(random);
    const Vec3 at = any_place(random, scale);
    const A a = Any<A>::make(random, at, scale.size_a, scale);
    const Body body = body_of(a, W{0.0});
    const V direction = random.next_index(3) == 0 ? V{0.0, 1.0, 0.0} : any_direction(random);
    const Vec3 normal =
        glm::normalize(Vec3{Real(direction.x), Real(direction.y), Real(direction.z)});
    const W n = to_wide(normal);
    // Close to touching, or anywhere.
    const double reach = double(body.support(-n));
    const Real offset =
        Real(-reach + scale.size_a * (random.next_index(2) == 0 ? random.next_in(-2.0, 2.0)
                                                                : random.next_in(-1e-6, 1e-6)));
    const HalfSpace ground{normal, offset};
    const Wide lowest = -body.support(-n) - Wide(offset);
    const double size = double(largest_coordinate(body)) + std::abs(double(offset));
    const double doubt = 32.0 * epsilon * size;

    std::ostringstream out;
    const bool do_overlap = overlaps(a, ground);
    if (do_overlap != overlaps(ground, a) ||
        (std::abs(double(lowest)) > doubt && do_overlap != (lowest <= Wide(0))))
        out << "overlap at height " << lowest << "; ";
    const ClosestPoints found = distance(a, ground);
    if (std::abs(double(found.distance) - std::max(0.0, double(lowest))) > doubt ||
        (found.distance > Real(0) && do_overlap) ||
        (found.distance > Real(0)) != (found.normal != Vec3{Real(0)}))
        out << "distance " << found.distance << " at height " << lowest << "; ";
    if (double(body.outside(to_wide(found.on_a))) > doubt)
        out << "point of A outside by " << body.outside(to_wide(found.on_a)) << "; ";
    if (double(glm::dot(n, to_wide(found.on_b)) - Wide(offset)) > doubt)
        out << "point of B above the surface; ";
    if (double(glm::length(to_wide(found.on_a) + Wide(found.distance) * to_wide(found.normal) -
                           to_wide(found.on_b))) > doubt)
        out << "points not the distance apart; ";
    const ClosestPoints swapped = distance(ground, a);
    if (swapped.on_a != found.on_b || swapped.normal != -found.normal ||
        swapped.distance != found.distance)
        out << "another distance when swapped; ";

    const Vec3 translation = any_vector(random, 2.0 * scale.size_a);
    const Wide speed = -glm::dot(n, to_wide(translation));
    const std::optional<CastHit> hit = cast(a, translation, ground);
    const double moving = doubt + 32.0 * epsilon * double(glm::length(to_wide(translation)));
    if (double(lowest) > moving && hit.has_value() != (lowest <= speed) &&
        std::abs(double(lowest - speed)) > moving)
        out << "hit: " << hit.has_value() << " with speed " << speed << " at " << lowest << "; ";
    if (hit) {
        if (hit->starts_overlapping != !(found.distance > Real(0)) || hit->normal != -normal ||
            !(hit->t >= Real(0) && hit->t <= Real(1)))
            out << "hit at " << hit->t << "; ";
        const Wide left = lowest - Wide(hit->t) * speed;
        if (!hit->starts_overlapping && std::abs(double(left)) > moving)
            out << "left " << left << " at " << hit->t << "; ";
        const Wide height = glm::dot(n, to_wide(hit->point)) - Wide(offset);
        if (!hit->starts_overlapping && std::abs(double(height)) > moving)
            out << "hit point " << height << " over the surface; ";
    }
    const std::optional<CastHit> back = cast(ground, -translation, a);
    if (back.has_value() != hit.has_value() ||
        (hit && (back->t != hit->t || back->normal != -hit->normal)))
        out << "another hit when the half-space moves; ";
    if (back && double(body.outside(to_wide(back->point))) > moving)
        out << "hit point off the shape; ";
    return out.str();
}

TEST(HalfSpaces, AgainstEveryConvexShape) {
    std::uint64_t seed = 900;
    const auto check = [&]<typename A>() {
        Random random(++seed);
        int wrong = 0;
        const int trial_count = trials(100'000);
        for (int i = 0; i < trial_count; ++i) {
            const std::string text = complaint<A>(random);
            if (!text.empty() && ++wrong <= 3)
                ADD_FAILURE() << "seed " << seed << ", trial " << i << ": " << text;
        }
        EXPECT_EQ(wrong, 0) << "of " << trial_count << ", seed " << seed;
    };
    check.operator()<Vec3>();
    check.operator()<Segment>();
    check.operator()<Triangle>();
    check.operator()<Sphere>();
    check.operator()<Box>();
    check.operator()<Aabb>();
    check.operator()<Capsule>();
    check.operator()<Cylinder>();
    check.operator()<ConvexHull>();
}

TEST(HalfSpaces, WithEachOther) {
    const Vec3 up{Real(0), Real(1), Real(0)};
    const Vec3 third{Real(2) / Real(3), Real(2) / Real(3), Real(1) / Real(3)};
    EXPECT_TRUE(overlaps(HalfSpace{up, Real(-5)}, HalfSpace{up, Real(7)}));
    EXPECT_TRUE(overlaps(HalfSpace{up, Real(1)}, HalfSpace{-up, Real(-1)}));
    EXPECT_FALSE(
        overlaps(HalfSpace{up, Real(1)}, HalfSpace{-up, std::nextafter(Real(-1), Real(-2))}));
    EXPECT_FALSE(overlaps(HalfSpace{third, Real(1)}, HalfSpace{-third, Real(-1.5)}));
    EXPECT_TRUE(overlaps(HalfSpace{third, Real(1)}, HalfSpace{up, Real(-100)}));
    // Parallel up to the last bit, so they meet far away.
    Vec3 tilted = -third;
    tilted.x = std::nextafter(tilted.x, Real(0));
    EXPECT_TRUE(overlaps(HalfSpace{third, Real(1)}, HalfSpace{tilted, Real(-1.5)}));
}

TEST(HalfSpaces, AnEmptyBoxOverlapsNothing) {
    EXPECT_FALSE(overlaps(Aabb{}, HalfSpace{}));
    EXPECT_FALSE(overlaps(HalfSpace{}, Aabb{}));
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
