#include "engine/space/dynamic_tree.h"

#include "engine/core/check.h"
#include "engine/geometry/frustum.h"
#include "tests/geometry/oracle.h"
#include "tests/trials.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include <glm/gtc/matrix_transform.hpp>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace oracle;

Aabb any_box(Random &random, double reach, double size) {
    const Vec3 center = any_vector(random, reach);
    const Vec3 half = glm::abs(any_vector(random, size));
    return {center - half, center + half};
}

bool touches(const Aabb &a, const Aabb &b) {
    for (int i = 0; i < 3; ++i)
        if (a.min[i] > b.max[i] || b.min[i] > a.max[i])
            return false;
    return true;
}

// A list of boxes, and the tree that should know them.
struct Mirror {
    DynamicTree tree;
    std::vector<DynamicTree::Leaf> leaves;
    std::vector<std::uint32_t> users;
    std::vector<Aabb> boxes;
    std::uint32_t next_user = 0;

    explicit Mirror(Real margin) : tree(margin) {}
    void insert(const Aabb &box) {
        leaves.push_back(tree.insert(box, next_user));
        users.push_back(next_user++);
        boxes.push_back(box);
    }
    void remove(std::size_t i) {
        tree.remove(leaves[i]);
        leaves.erase(leaves.begin() + std::ptrdiff_t(i));
        users.erase(users.begin() + std::ptrdiff_t(i));
        boxes.erase(boxes.begin() + std::ptrdiff_t(i));
    }
    // What a query should find: by the fat boxes, all of them.
    std::vector<std::uint32_t> brute(const Aabb &box) const {
        std::vector<std::uint32_t> found;
        for (std::size_t i = 0; i < leaves.size(); ++i)
            if (touches(tree.fat_bounds(leaves[i]), box))
                found.push_back(users[i]);
        std::sort(found.begin(), found.end());
        return found;
    }
};

std::vector<std::uint32_t> sorted_query(const DynamicTree &tree, const Aabb &box) {
    std::vector<std::uint32_t> found;
    tree.query(box, [&](std::uint32_t user) {
        found.push_back(user);
        return true;
    });
    std::sort(found.begin(), found.end());
    return found;
}

TEST(DynamicTree, RandomChangesAgainstBruteForce) {
    Random random(1);
    const Real margin = Real(0.1);
    Mirror mirror(margin);
    for (int step = 0; step < 100000; ++step) {
        const std::uint32_t action = random.next_index(8);
        const std::size_t count = mirror.leaves.size();
        // Up to some 150 boxes, now and then none.
        if (step % 20000 == 19999) {
            while (!mirror.leaves.empty())
                mirror.remove(random.next_index(std::uint32_t(mirror.leaves.size())));
        } else if (count == 0 || (action == 0 && count < 150)) {
            mirror.insert(any_box(random, 5.0, random.next_index(5) == 0 ? 3.0 : 0.3));
        } else if (action == 1 && random.next_index(3) == 0) {
            mirror.remove(random.next_index(std::uint32_t(count)));
        } else {
            const std::size_t i = random.next_index(std::uint32_t(count));
            const Vec3 by = any_vector(random, action == 2 ? 5.0 : 0.12);
            const Aabb moved{mirror.boxes[i].min + by, mirror.boxes[i].max + by};
            const Aabb before = mirror.tree.fat_bounds(mirror.leaves[i]);
            bool held = true;
            for (int k = 0; k < 3; ++k)
                held = held && before.min[k] <= moved.min[k] && moved.max[k] <= before.max[k];
            ASSERT_EQ(mirror.tree.update(mirror.leaves[i], moved), !held);
            const Aabb &after = mirror.tree.fat_bounds(mirror.leaves[i]);
            for (int k = 0; k < 3; ++k) {
                ASSERT_LE(after.min[k], moved.min[k]);
                ASSERT_GE(after.max[k], moved.max[k]);
                if (!held) {
                    ASSERT_EQ(after.min[k], moved.min[k] - margin);
                    ASSERT_EQ(after.max[k], moved.max[k] + margin);
                }
            }
            mirror.boxes[i] = moved;
        }
        ASSERT_EQ(mirror.tree.size(), mirror.leaves.size());
        if (step % 50 == 0)
            mirror.tree.validate();
        const Aabb where = any_box(random, 6.0, 1.0);
        ASSERT_EQ(sorted_query(mirror.tree, where), mirror.brute(where)) << "step " << step;
    }
    for (std::size_t i = 0; i < mirror.leaves.size(); ++i)
        EXPECT_EQ(mirror.tree.user(mirror.leaves[i]), mirror.users[i]);
}

TEST(DynamicTree, PairsAgainstBruteForce) {
    Random random(2);
    for (int trial = 0; trial < 20; ++trial) {
        Mirror mirror(Real(0.05));
        for (int i = 0; i < 200; ++i)
            mirror.insert(any_box(random, 2.0, 0.6));
        std::vector<std::pair<std::uint32_t, std::uint32_t>> found, expected;
        for (std::size_t i = 0; i < 200; ++i) {
            const Aabb &box = mirror.tree.fat_bounds(mirror.leaves[i]);
            for (const std::uint32_t other : sorted_query(mirror.tree, box))
                if (other > i)
                    found.emplace_back(i, other);
            for (std::size_t j = i + 1; j < 200; ++j)
                if (touches(box, mirror.tree.fat_bounds(mirror.leaves[j])))
                    expected.emplace_back(i, j);
        }
        EXPECT_GT(expected.size(), 100U);
        EXPECT_EQ(found, expected);
    }
}

TEST(DynamicTree, RaycastAgainstBruteForce) {
    Random random(3);
    Mirror mirror(Real(0));
    for (int i = 0; i < 300; ++i)
        mirror.insert(any_box(random, 5.0, 1.0));
    int hits = 0;
    for (int trial = 0; trial < 100000; ++trial) {
        Ray ray{any_vector(random, 7.0), any_vector(random, 1.0), any_real(random, 0.1, 20.0)};
        for (int k = 0; k < 3; ++k)
            if (random.next_index(6) == 0)
                ray.direction[k] = random.next_index(2) == 0 ? Real(0) : -Real(0);
        if (ray.direction == Vec3{Real(0)})
            continue;
        // All that are met, with a visit that does not shorten the ray.
        std::vector<std::uint32_t> found, expected;
        mirror.tree.raycast(ray, [&](std::uint32_t user, const Ray &left) {
            found.push_back(user);
            return left.max_t;
        });
        Real nearest = std::numeric_limits<Real>::infinity();
        for (std::size_t i = 0; i < mirror.boxes.size(); ++i) {
            if (const auto interval = ray_interval(mirror.boxes[i], ray)) {
                expected.push_back(mirror.users[i]);
                nearest = std::min(nearest, interval->t_enter);
            }
        }
        std::sort(found.begin(), found.end());
        ASSERT_EQ(found, expected);
        // The closest hit.
        Real closest = std::numeric_limits<Real>::infinity();
        mirror.tree.raycast(ray, [&](std::uint32_t user, const Ray &left) {
            if (const auto interval = ray_interval(mirror.boxes[user], left)) {
                closest = std::min(closest, interval->t_enter);
                return interval->t_enter;
            }
            return left.max_t;
        });
        ASSERT_EQ(closest, nearest);
        hits += expected.empty() ? 0 : 1;
    }
    EXPECT_GT(hits, 20000);
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

TEST(DynamicTree, QueryStopsWhenTold) {
    Random random(4);
    Mirror mirror(Real(0));
    for (int i = 0; i < 50; ++i)
        mirror.insert(any_box(random, 1.0, 1.0));
    int visits = 0;
    mirror.tree.query(Aabb{Vec3{Real(-9)}, Vec3{Real(9)}},
                      [&](std::uint32_t) { return ++visits < 7; });
    EXPECT_EQ(visits, 7);
}

TEST(DynamicTree, CopyAnswersAlikeAndIsIndependent) {
    Random random(5);
    Mirror mirror(Real(0.1));
    for (int i = 0; i < 100; ++i)
        mirror.insert(any_box(random, 3.0, 0.5));
    for (int i = 0; i < 30; ++i)
        mirror.remove(random.next_index(std::uint32_t(mirror.leaves.size())));
    DynamicTree copy = mirror.tree;
    const Aabb everywhere{Vec3{Real(-99)}, Vec3{Real(99)}};
    const auto in_order = [&](const DynamicTree &tree) {
        std::vector<std::uint32_t> found;
        tree.query(everywhere, [&](std::uint32_t user) {
            found.push_back(user);
            return true;
        });
        return found;
    };
    const auto before = in_order(mirror.tree);
    EXPECT_EQ(in_order(copy), before);
    // The same changes give the same tree.
    const Aabb more = any_box(random, 3.0, 0.5);
    EXPECT_EQ(copy.insert(more, 1000), mirror.tree.insert(more, 1000));
    EXPECT_EQ(in_order(copy), in_order(mirror.tree));
    copy.remove(mirror.leaves[0]);
    EXPECT_EQ(copy.size() + 1, mirror.tree.size());
    copy.validate();
    mirror.tree.validate();
}

TEST(DynamicTree, StaysShallow) {
    // In order along a line, the worst order for insertion: still a small multiple of the 10 levels
    // that a balanced tree of 1024 has.
    DynamicTree line(Real(0));
    for (std::uint32_t i = 0; i < 1024; ++i) {
        const Real x = Real(i);
        line.insert({Vec3{x, Real(0), Real(0)}, Vec3{x + Real(1), Real(1), Real(1)}}, i);
    }
    line.validate();
    EXPECT_LE(line.height(), 40);

    Random random(6);
    DynamicTree cloud(Real(0));
    for (std::uint32_t i = 0; i < 1024; ++i)
        cloud.insert(any_box(random, 10.0, 0.3), i);
    cloud.validate();
    EXPECT_LE(cloud.height(), 30);
}

TEST(DynamicTree, ManyBoxesInOnePlace) {
    DynamicTree tree(Real(0));
    const Aabb box{Vec3{Real(0)}, Vec3{Real(1)}};
    std::vector<DynamicTree::Leaf> leaves;
    for (std::uint32_t i = 0; i < 500; ++i)
        leaves.push_back(tree.insert(box, i));
    tree.validate();
    EXPECT_EQ(sorted_query(tree, box).size(), 500U);
    for (const DynamicTree::Leaf leaf : leaves)
        tree.remove(leaf);
    tree.validate();
    EXPECT_EQ(tree.size(), 0U);
    EXPECT_EQ(tree.height(), 0);
}

template <typename Query>
std::vector<std::uint32_t> sorted_answers(const DynamicTree &tree, const Query &query) {
    std::vector<std::uint32_t> found;
    tree.query(query, [&](std::uint32_t user) {
        found.push_back(user);
        return true;
    });
    std::sort(found.begin(), found.end());
    return found;
}

// Small integers: every answer is decided exactly, so touching is met over and over.
Vec3 any_integers(Random &random, std::uint32_t reach) {
    const auto one = [&] { return Real(int(random.next_index(2 * reach + 1)) - int(reach)); };
    const Real x = one(), y = one(), z = one();
    return {x, y, z};
}

Aabb any_integer_box(Random &random) {
    const Vec3 a = any_integers(random, 12), b = a + glm::abs(any_integers(random, 3));
    return {a, b};
}

struct Field {
    DynamicTree tree{Real(0)};
    std::vector<Aabb> boxes;

    template <typename Make> Field(std::uint32_t count, Make &&make) {
        for (std::uint32_t i = 0; i < count; ++i) {
            boxes.push_back(make());
            tree.insert(boxes.back(), i);
        }
    }
};

TEST(DynamicTree, SphereQueryAgainstBruteForceInDouble) {
    Random random(11);
    const int rounds = trials(20000);
    Field integers(60, [&] { return any_integer_box(random); });
    Field reals(60, [&] { return any_box(random, 12.0, 2.0); });
    std::size_t found_in_all = 0, doubtful = 0;
    for (int round = 0; round < rounds; ++round) {
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
    const int rounds = trials(20000);
    Field field(60, [&] { return any_integer_box(random); });
    std::size_t found_in_all = 0, ends = 0;
    for (int round = 0; round < rounds; ++round) {
        Segment segment{any_integers(random, 14), any_integers(random, 14)};
        const std::uint32_t kind = random.next_index(5);
        if (kind == 0)
            segment.b = segment.a;
        if (kind == 1) // contained, or along an axis
            for (int k = 0; k < 3; ++k)
                if (random.next_index(3) != 0)
                    segment.b[k] = segment.a[k];
        const std::vector<std::uint32_t> found = sorted_answers(field.tree, segment);
        found_in_all += found.size();
        for (std::uint32_t i = 0; i < field.boxes.size(); ++i) {
            // Exactly, in integers: clip [0, 1] with the parameters as fractions over a common
            // denominator, the product of the components that are not zero.
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
    // Ends in boxes, with coordinates that round.
    Field reals(100, [&] { return any_box(random, 5.0, 1.0); });
    for (int round = 0; round < rounds; ++round) {
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
    Field field(120, [&] { return any_box(random, 20.0, 1.5); });
    std::vector<DynamicTree> single;
    for (std::uint32_t i = 0; i < field.boxes.size(); ++i)
        single.emplace_back(Real(0)).insert(field.boxes[i], i);
    const int rounds = trials(8000);
    std::size_t found_in_all = 0, doubtful = 0;
    for (int round = 0; round < rounds; ++round) {
        // Half of them with a corner of a box in a plane, as rounded.
        Frustum frustum = frustum_of(
            glm::perspective(any_real(random, 0.3, 1.5), Real(1.5), Real(0.5), Real(40)) *
            glm::lookAt(any_vector(random, 25.0), any_vector(random, 5.0),
                        Vec3{Real(0), Real(1), Real(0)}));
        if (round % 2 == 0) {
            Plane &plane = frustum.planes[random.next_index(6)];
            plane.offset = glm::dot(plane.normal, field.boxes[random.next_index(120)].min);
        }
        const std::vector<std::uint32_t> found = sorted_answers(field.tree, frustum);
        found_in_all += found.size();
        for (std::uint32_t i = 0; i < field.boxes.size(); ++i) {
            const Aabb &box = field.boxes[i];
            long double foremost = -1e9L; // of the planes, the height of the lowest corner
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
            // No branch is lost: the answer is that for the box alone, to the bit.
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
    EXPECT_GT(found_in_all, std::size_t(rounds));
    EXPECT_LT(doubtful, std::size_t(rounds) * 2);
}

TEST(DynamicTree, QueryIfTakesAnyRegion) {
    Random random(18);
    Field field(100, [&] { return any_integer_box(random); });
    std::vector<std::uint32_t> found;
    // Beside the origin, along x + y <= -3.
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
    // Two trees of the same boxes, put in forwards and backwards: the answers must be the same.
    Field field(200, [&] { return any_integer_box(random); });
    DynamicTree backwards(Real(0));
    for (std::uint32_t i = 200; i-- > 0;)
        backwards.insert(field.boxes[i], i);
    std::size_t hits = 0, ties = 0;
    for (int round = 0; round < trials(50000); ++round) {
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
            ASSERT_LE(asked, any ? 1 : 0); // a box is its own shape here
        }
        hits += expected ? 1 : 0;
    }
    EXPECT_GT(hits, std::size_t(trials(50000)) / 5);
    EXPECT_GT(ties, std::size_t(trials(50000)) / 50);
}

TEST(DynamicTree, OverlappingPairsInOrderAgainstBruteForce) {
    Random random(15);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> found;
    std::size_t looked = 0;
    for (int trial = 0; trial < 60; ++trial) {
        Mirror mirror(Real(0.05));
        const bool is_integer = trial % 2 == 0;
        const int count = trial < 4 ? trial : 200;
        for (int i = 0; i < count; ++i)
            mirror.insert(is_integer ? any_integer_box(random) : any_box(random, 2.0, 0.4));
        for (int i = 0; i < count / 4; ++i)
            mirror.remove(random.next_index(std::uint32_t(mirror.leaves.size())));
        std::vector<std::pair<std::uint32_t, std::uint32_t>> expected;
        for (std::size_t i = 0; i < mirror.leaves.size(); ++i)
            for (std::size_t j = i + 1; j < mirror.leaves.size(); ++j) {
                ++looked;
                if (touches(mirror.tree.fat_bounds(mirror.leaves[i]),
                            mirror.tree.fat_bounds(mirror.leaves[j])))
                    expected.emplace_back(mirror.users[i], mirror.users[j]);
            }
        mirror.tree.overlapping_pairs(found);
        ASSERT_EQ(found, expected);
    }
    EXPECT_GT(looked, 500'000U);
}

TEST(DynamicTree, NodesAreVisitedParentsFirst) {
    Random random(16);
    Mirror mirror(Real(0.1));
    int visits = 0;
    mirror.tree.each_node([&](const Aabb &, int, bool) { ++visits; });
    EXPECT_EQ(visits, 0);
    for (int i = 0; i < 500; ++i)
        mirror.insert(any_box(random, 5.0, 0.5));
    for (int i = 0; i < 200; ++i)
        mirror.remove(random.next_index(std::uint32_t(mirror.leaves.size())));
    // In this order a parent is the last box seen one level up; and the boxes of the leaves are
    // those that were put in.
    std::vector<Aabb> above;
    std::vector<Aabb> leaves;
    int deepest = 0, nodes = 0;
    mirror.tree.each_node([&](const Aabb &box, int depth, bool is_leaf) {
        ++nodes;
        deepest = std::max(deepest, depth);
        ASSERT_LE(std::size_t(depth), above.size());
        above.resize(std::size_t(depth));
        if (depth > 0) {
            for (int k = 0; k < 3; ++k) {
                ASSERT_LE(above.back().min[k], box.min[k]);
                ASSERT_GE(above.back().max[k], box.max[k]);
            }
        }
        above.push_back(box);
        if (is_leaf)
            leaves.push_back(box);
    });
    EXPECT_EQ(deepest, mirror.tree.height());
    EXPECT_EQ(nodes, 2 * int(mirror.leaves.size()) - 1);
    const auto by_corner = [](const Aabb &a, const Aabb &b) {
        return std::pair(a.min.x, a.max.y) < std::pair(b.min.x, b.max.y);
    };
    std::vector<Aabb> expected;
    for (const DynamicTree::Leaf leaf : mirror.leaves)
        expected.push_back(mirror.tree.fat_bounds(leaf));
    std::sort(leaves.begin(), leaves.end(), by_corner);
    std::sort(expected.begin(), expected.end(), by_corner);
    ASSERT_EQ(leaves.size(), expected.size());
    for (std::size_t i = 0; i < leaves.size(); ++i) {
        EXPECT_EQ(leaves[i].min, expected[i].min);
        EXPECT_EQ(leaves[i].max, expected[i].max);
    }
}

// A million changes and queries of all kinds, against lists.
TEST(DynamicTree, AMillionOperations) {
    Random random(17);
    Mirror mirror(Real(0.05));
    const int steps = trials(1'000'000);
    std::size_t found_in_all = 0;
    for (int step = 0; step < steps; ++step) {
        const std::size_t count = mirror.leaves.size();
        const std::uint32_t action = random.next_index(8);
        const std::size_t any = count == 0 ? 0 : random.next_index(std::uint32_t(count));
        if (count == 0 || (action == 0 && count < 40)) {
            mirror.insert(any_box(random, 4.0, 0.5));
        } else if (action == 0 || (action == 1 && random.next_index(3) == 0)) {
            mirror.remove(any);
        } else if (action < 5) {
            const Vec3 by = any_vector(random, action == 2 ? 4.0 : 0.1);
            mirror.boxes[any] = {mirror.boxes[any].min + by, mirror.boxes[any].max + by};
            mirror.tree.update(mirror.leaves[any], mirror.boxes[any]);
        } else if (action == 5) {
            const Aabb where = any_box(random, 5.0, 1.0);
            const auto found = sorted_query(mirror.tree, where);
            ASSERT_EQ(found, mirror.brute(where)) << "step " << step;
            found_in_all += found.size();
        } else {
            // A sphere's or a segment's answers must be among its box's, and hold all leaves that
            // have its centre or an end.
            const Vec3 a = any_vector(random, 5.0), b = any_vector(random, 5.0);
            const Real radius = any_real(random, 0.0, 1.0);
            const Sphere sphere{a, radius};
            const Segment segment{a, b};
            const auto found = action == 6 ? sorted_answers(mirror.tree, sphere)
                                           : sorted_answers(mirror.tree, segment);
            const auto most = mirror.brute(action == 6 ? Aabb{a - radius, a + radius}
                                                       : Aabb{glm::min(a, b), glm::max(a, b)});
            const auto least = mirror.brute({a, a});
            ASSERT_TRUE(std::includes(most.begin(), most.end(), found.begin(), found.end()));
            ASSERT_TRUE(std::includes(found.begin(), found.end(), least.begin(), least.end()));
            found_in_all += found.size();
        }
        if (step % 1000 == 0)
            mirror.tree.validate();
    }
    EXPECT_GT(found_in_all, std::size_t(steps) / 40);
}

template <typename Call> std::string failure(Call &&call) {
    try {
        call();
    } catch (const CheckFailure &error) {
        return error.what();
    }
    return {};
}

TEST(DynamicTree, MisuseNamesTheValue) {
    const auto says = [](const std::string &text, const char *part) {
        EXPECT_NE(text.find(part), std::string::npos) << "said: " << text;
    };
    const Real nan = std::numeric_limits<Real>::quiet_NaN();
    const Aabb good{Vec3{Real(0)}, Vec3{Real(1)}};
    says(failure([&] { DynamicTree tree(Real(-7)); }), "-7");
    says(failure([&] { DynamicTree tree(nan); }), "nan");
    DynamicTree tree(Real(0));
    says(failure([&] { tree.insert({Vec3{Real(2)}, Vec3{Real(1)}}, 0); }), "[2, 1]");
    says(failure([&] { tree.insert({Vec3{nan}, Vec3{Real(1)}}, 0); }), "nan");
    says(failure([&] { tree.insert(Aabb{}, 0); }), "e+");
    EXPECT_EQ(tree.size(), 0U);
    const DynamicTree::Leaf leaf = tree.insert(good, 0);
    says(failure([&] { tree.update(leaf, {Vec3{Real(0)}, Vec3{nan}}); }), "nan");
    says(failure([&] { tree.remove(41); }), "41");
    tree.remove(leaf);
    says(failure([&] { tree.remove(leaf); }), "not a leaf");
    says(failure([&] { tree.user(-1); }), "-1");
    says(failure([&] {
             tree.raycast(Ray{Vec3{Real(0)}, Vec3{Real(0)}},
                          [](std::uint32_t, const Ray &) { return Real(0); });
         }),
         "direction must not be zero");
    const auto go_on = [](std::uint32_t) { return true; };
    says(failure([&] { tree.query(Sphere{Vec3{Real(0)}, Real(-3)}, go_on); }), "-3");
    says(failure([&] { tree.query(Sphere{Vec3{nan}, Real(1)}, go_on); }), "nan");
    says(failure([&] { tree.query(Segment{Vec3{Real(0)}, Vec3{nan}}, go_on); }), "nan");
    tree.validate();
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
