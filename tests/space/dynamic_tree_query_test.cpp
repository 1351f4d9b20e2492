// DynamicTree queries against brute force.

#include "engine/geometry/frustum.h"
#include "engine/space/dynamic_tree.h"
#include "tests/space/tree_boxes.h"
#include "tests/trials.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include <glm/gtc/matrix_transform.hpp>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace oracle;
using namespace tree_boxes;

struct Field {
    DynamicTree tree{Real(0)};
    std::vector<Aabb> boxes;

    Field() = default;
    template <typename Make> Field(std::uint32_t count, Make &&make) {
        for (std::uint32_t i = 0; i < count; ++i) {
            boxes.push_back(make());
            tree.insert(boxes.back(), i);
        }
    }
};

TEST(DynamicTree, RaycastAgainstBruteForce) {
    Random random(3);
    Field field;
    int hits = 0;
    const int count = trials(1'000'000);
    for (int trial = 0; trial < count; ++trial) {
        if (trial % 500 == 0) // occasionally a large one
            field = Field(trial % 50'000 == 0 ? 300 : random.next_index(32),
                          [&] { return any_box(random, 5.0, 3.5); });
        Ray ray{any_vector(random, 7.0), any_vector(random, 1.0), any_real(random, 0.1, 20.0)};
        for (int k = 0; k < 3; ++k)
            if (random.next_index(6) == 0)
                ray.direction[k] = random.next_index(2) == 0 ? Real(0) : -Real(0);
        if (ray.direction == Vec3{Real(0)})
            continue;
        // All boxes hit, with a callback that does not shorten the ray.
        std::vector<std::uint32_t> found, expected;
        field.tree.raycast(ray, [&](std::uint32_t user, const Ray &left) {
            found.push_back(user);
            return left.max_t;
        });
        Real nearest = std::numeric_limits<Real>::infinity();
        for (std::uint32_t i = 0; i < field.boxes.size(); ++i) {
            if (const auto interval = ray_interval(field.boxes[i], ray)) {
                expected.push_back(i);
                nearest = std::min(nearest, interval->t_enter);
            }
        }
        std::sort(found.begin(), found.end());
        ASSERT_EQ(found, expected);
        // The closest hit.
        Real closest = std::numeric_limits<Real>::infinity();
        field.tree.raycast(ray, [&](std::uint32_t user, const Ray &left) {
            if (const auto interval = ray_interval(field.boxes[user], left)) {
                closest = std::min(closest, interval->t_enter);
                return interval->t_enter;
            }
            return left.max_t;
        });
        ASSERT_EQ(closest, nearest);
        hits += expected.empty() ? 0 : 1;
    }
    EXPECT_GT(hits, count / 5);
}

TEST(DynamicTree, VisitsTheNearChildFirst) {
    // Boxes in a row: a search from either end that stops at its first hit needs few visits.
    DynamicTree tree(Real(0));
    for (std::uint32_t i = 0; i < 256; ++i) {
        const Real x = Real(3 * i);
        tree.insert({Vec3{x, Real(0), Real(0)}, Vec3{x + Real(1), Real(1), Real(1)}}, i);
    }
    for (const bool is_backward : {false, true}) {
        const Real h = Real(0.5);
        const Ray ray = is_backward ? Ray{{Real(1000), h, h}, {Real(-1), Real(0), Real(0)}}
                                    : Ray{{Real(-10), h, h}, {Real(1), Real(0), Real(0)}};
        std::vector<std::uint32_t> visited;
        tree.raycast(ray, [&](std::uint32_t user, const Ray &) {
            visited.push_back(user);
            return Real(0);
        });
        ASSERT_EQ(visited.size(), 1U);
        EXPECT_EQ(visited[0], is_backward ? 255U : 0U);
    }
}

TEST(DynamicTree, SphereQueryAgainstBruteForceInDouble) {
    Random random(11);
    const int rounds = trials(500'000); // two spheres each
    Field integers, reals;
    std::size_t found_in_all = 0, doubtful = 0;
    for (int round = 0; round < rounds; ++round) {
        if (round % 500 == 0) {
            const std::uint32_t count = round % 50'000 == 0 ? 60 : random.next_index(24);
            integers = Field(count, [&] { return any_integer_box(random, 7); });
            reals = Field(count, [&] { return any_box(random, 12.0, 6.0); });
        }
        const Sphere whole{any_integers(random, 14), Real(random.next_index(7))};
        const Sphere real{any_vector(random, 14.0), any_real(random, 0.0, 6.0)};
        for (const bool is_integer : {true, false}) {
            const Field &field = is_integer ? integers : reals;
            const Sphere &sphere = is_integer ? whole : real;
            const std::vector<std::uint32_t> found = sorted_answers(field.tree, sphere);
            found_in_all += found.size();
            for (std::uint32_t i = 0; i < field.boxes.size(); ++i) {
                // The distance of the closest point, in long double.
                long double squared = 0;
                for (int k = 0; k < 3; ++k) {
                    const long double c = sphere.center[k];
                    const long double gap =
                        c - std::clamp(c, static_cast<long double>(field.boxes[i].min[k]),
                                       static_cast<long double>(field.boxes[i].max[k]));
                    squared += gap * gap;
                }
                const long double r = sphere.radius;
                const bool expected = squared <= r * r;
                const bool got = std::binary_search(found.begin(), found.end(), i);
                const long double slack =
                    2 * static_cast<long double>(std::numeric_limits<Real>::epsilon()) * r;
                if (!is_integer && std::abs(std::sqrt(squared) - r) <= slack) {
                    ++doubtful;
                    continue;
                }
                ASSERT_EQ(got, expected) << "round " << round << ", box " << i;
            }
        }
    }
    EXPECT_GT(found_in_all, std::size_t(rounds));
    EXPECT_LT(doubtful, std::size_t(rounds) / 100 + 2);
}

TEST(DynamicTree, SegmentQueryAgainstBruteForce) {
    Random random(12);
    const int rounds = trials(1'000'000);
    Field field;
    std::size_t found_in_all = 0, ends = 0;
    for (int round = 0; round < rounds; ++round) {
        if (round % 500 == 0)
            field = Field(round % 50'000 == 0 ? 60 : random.next_index(24),
                          [&] { return any_integer_box(random, 7); });
        Segment segment{any_integers(random, 14), any_integers(random, 14)};
        const std::uint32_t kind = random.next_index(5);
        if (kind == 0)
            segment.b = segment.a;
        if (kind == 1) // a point, or along an axis
            for (int k = 0; k < 3; ++k)
                if (random.next_index(3) != 0)
                    segment.b[k] = segment.a[k];
        const std::vector<std::uint32_t> found = sorted_answers(field.tree, segment);
        found_in_all += found.size();
        for (std::uint32_t i = 0; i < field.boxes.size(); ++i) {
            // Exact, in integers: clip [0, 1] with the parameters as fractions over a common
            // denominator, the product of the nonzero components.
            const Aabb &box = field.boxes[i];
            long long common = 1;
            for (int k = 0; k < 3; ++k)
                if (segment.a[k] != segment.b[k])
                    common *= std::abs((long long)(segment.b[k]) - (long long)(segment.a[k]));
            long long enter = 0, exit = common;
            for (int k = 0; k < 3; ++k) {
                const auto a = (long long)(segment.a[k]), d = (long long)(segment.b[k]) - a;
                long long low = (long long)(box.min[k]) - a, high = (long long)(box.max[k]) - a;
                if (d == 0) {
                    if (low > 0 || high < 0)
                        exit = -1;
                    continue;
                }
                if (d < 0)
                    std::swap(low, high);
                const long long unit = common / d;
                enter = std::max(enter, low * unit);
                exit = std::min(exit, high * unit);
            }
            const bool got = std::binary_search(found.begin(), found.end(), i);
            ASSERT_EQ(got, enter <= exit) << "round " << round << ", box " << i;
            if (touches({segment.b, segment.b}, box)) {
                ++ends;
                ASSERT_TRUE(got);
            }
        }
    }
    EXPECT_GT(found_in_all, std::size_t(rounds) / 5);
    EXPECT_GT(ends, std::size_t(rounds) / 40);
    // Ends in boxes, with coordinates that round off.
    const Field reals(100, [&] { return any_box(random, 5.0, 1.0); });
    for (int round = 0; round < rounds / 10; ++round) {
        Segment segment{any_vector(random, 5.0), any_vector(random, 5.0)};
        if (random.next_index(2) == 0) // on a face
            segment.b.x = reals.boxes[random.next_index(100)].max.x;
        const std::vector<std::uint32_t> found = sorted_answers(reals.tree, segment);
        for (std::uint32_t i = 0; i < 100; ++i)
            if (touches({segment.a, segment.a}, reals.boxes[i]) ||
                touches({segment.b, segment.b}, reals.boxes[i])) {
                ASSERT_TRUE(std::binary_search(found.begin(), found.end(), i));
            }
    }
}

TEST(DynamicTree, FrustumQueryAgainstBruteForceInDouble) {
    Random random(13);
    Field field;
    std::vector<DynamicTree> single;
    const int rounds = trials(1'000'000);
    std::size_t found_in_all = 0, doubtful = 0;
    for (int round = 0; round < rounds; ++round) {
        if (round % 500 == 0) {
            field = Field(round % 100'000 == 0 ? 120 : 1 + random.next_index(6),
                          [&] { return any_box(random, 20.0, 4.0); });
            single.clear();
            for (std::uint32_t i = 0; i < field.boxes.size(); ++i)
                single.emplace_back(Real(0)).insert(field.boxes[i], i);
        }
        // Half have a box corner in a plane, up to rounding.
        Frustum frustum = frustum_of(
            glm::perspective(any_real(random, 0.3, 1.5), Real(1.5), Real(0.5), Real(40)) *
            glm::lookAt(any_vector(random, 25.0), any_vector(random, 5.0),
                        Vec3{Real(0), Real(1), Real(0)}));
        if (round % 2 == 0) {
            Plane &plane = frustum.planes[random.next_index(6)];
            plane.offset =
                glm::dot(plane.normal,
                         field.boxes[random.next_index(std::uint32_t(field.boxes.size()))].min);
        }
        const std::vector<std::uint32_t> found = sorted_answers(field.tree, frustum);
        found_in_all += found.size();
        for (std::uint32_t i = 0; i < field.boxes.size(); ++i) {
            const Aabb &box = field.boxes[i];
            long double foremost = -1e9L; // the lowest corner's height, largest over the planes
            long double size = 0;
            for (const Plane &plane : frustum.planes) {
                long double lowest = 1e9L;
                for (int corner = 0; corner < 8; ++corner) {
                    long double height = -static_cast<long double>(plane.offset);
                    for (int k = 0; k < 3; ++k) {
                        const Real at = (corner >> k & 1) == 0 ? box.min[k] : box.max[k];
                        height += static_cast<long double>(plane.normal[k]) * at;
                        size = std::max(size, std::abs(static_cast<long double>(at)));
                    }
                    lowest = std::min(lowest, height);
                }
                foremost = std::max(foremost, lowest);
            }
            const bool got = std::binary_search(found.begin(), found.end(), i);
            // No branch is lost: the answer equals that for the box alone, bit for bit.
            ASSERT_EQ(got, !sorted_answers(single[i], frustum).empty());
            const long double slack =
                4 * static_cast<long double>(std::numeric_limits<Real>::epsilon()) * size;
            if (std::abs(foremost) <= slack) {
                ++doubtful;
                continue;
            }
            ASSERT_EQ(got, foremost <= 0) << "round " << round << ", box " << i;
            if (std::abs(foremost) > 4 * slack) {
                ASSERT_EQ(got, classify(frustum, box) != FrustumSide::outside);
            }
        }
    }
    EXPECT_GT(found_in_all, std::size_t(rounds) / 10);
    EXPECT_LT(doubtful, std::size_t(rounds) * 2);
}

TEST(DynamicTree, QueryIfTakesAnyRegion) {
    Random random(18);
    Field field(100, [&] { return any_integer_box(random); });
    std::vector<std::uint32_t> found;
    // The half space x + y <= -3.
    field.tree.query_if([](const Aabb &box) { return box.min.x + box.min.y <= Real(-3); },
                        [&](std::uint32_t user) {
                            found.push_back(user);
                            return true;
                        });
    std::sort(found.begin(), found.end());
    std::vector<std::uint32_t> expected;
    for (std::uint32_t i = 0; i < 100; ++i)
        if (field.boxes[i].min.x + field.boxes[i].min.y <= Real(-3))
            expected.push_back(i);
    EXPECT_EQ(found, expected);
    EXPECT_GT(found.size(), 10U);
    int visits = 0;
    field.tree.query_if([](const Aabb &) { return true; },
                        [&](std::uint32_t) { return ++visits < 5; });
    EXPECT_EQ(visits, 5);
}

TEST(DynamicTree, ClosestAndAnyHitAgainstBruteForce) {
    Random random(14);
    // Two trees of the same boxes, inserted forwards and backwards, must agree.
    Field field;
    DynamicTree backwards(Real(0));
    std::size_t hits = 0, ties = 0;
    const int rounds = trials(1'000'000);
    for (int round = 0; round < rounds; ++round) {
        if (round % 500 == 0) {
            field = Field(round % 50'000 == 0 ? 200 : 1 + random.next_index(96),
                          [&] { return any_integer_box(random, 7); });
            backwards = DynamicTree(Real(0));
            for (std::uint32_t i = std::uint32_t(field.boxes.size()); i-- > 0;)
                backwards.insert(field.boxes[i], i);
        }
        const bool is_integer = random.next_index(2) == 0;
        Ray ray{is_integer ? any_integers(random, 14) : any_vector(random, 14.0),
                is_integer ? any_integers(random, 2) : any_vector(random, 1.0)};
        if (random.next_index(2) == 0)
            ray.max_t = any_real(random, 0.0, 10.0);
        if (random.next_index(10) == 0)
            ray.max_t = Real(0);
        if (ray.direction == Vec3{Real(0)})
            continue;
        std::optional<DynamicTree::Hit> expected;
        for (std::uint32_t i = 0; i < field.boxes.size(); ++i)
            if (const auto interval = ray_interval(field.boxes[i], ray)) {
                if (!expected || interval->t_enter < expected->t)
                    expected = {i, interval->t_enter};
                else
                    ties += interval->t_enter == expected->t ? 1 : 0;
            }
        const auto first = [&](std::uint32_t user, const Ray &left) -> std::optional<Real> {
            const auto interval = ray_interval(field.boxes[user], left);
            if (!interval)
                return std::nullopt;
            return interval->t_enter;
        };
        for (const DynamicTree *tree : {&field.tree, &backwards}) {
            const auto found = tree->closest_hit(ray, first);
            ASSERT_EQ(found.has_value(), expected.has_value());
            if (expected) {
                ASSERT_EQ(found->user, expected->user);
                ASSERT_EQ(found->t, expected->t);
            }
            int asked = 0;
            const bool any = tree->any_hit(ray, [&](std::uint32_t user, const Ray &left) {
                ++asked;
                return ray_interval(field.boxes[user], left).has_value();
            });
            ASSERT_EQ(any, expected.has_value());
            ASSERT_LE(asked, any ? 1 : 0); // here the boxes are the shapes
        }
        hits += expected ? 1 : 0;
    }
    EXPECT_GT(hits, std::size_t(rounds) / 5);
    EXPECT_GT(ties, std::size_t(rounds) / 50);
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
