#include "engine/space/dynamic_tree.h"

#include "engine/core/check.h"
#include "tests/geometry/oracle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

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
    mirror.tree.query({Vec3{Real(-9)}, Vec3{Real(9)}}, [&](std::uint32_t) { return ++visits < 7; });
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
    tree.validate();
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
