#include "engine/space/dynamic_tree.h"

#include "tests/says.h"
#include "tests/space/tree_boxes.h"
#include "tests/trials.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace oracle;
using namespace tree_boxes;

// A list of boxes, and the tree that should match it.
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
    // The expected answer, from all fat boxes.
    std::vector<std::uint32_t> brute(const Aabb &box) const {
        std::vector<std::uint32_t> found;
        for (std::size_t i = 0; i < leaves.size(); ++i)
            if (touches(tree.fat_bounds(leaves[i]), box))
                found.push_back(users[i]);
        std::sort(found.begin(), found.end());
        return found;
    }
};

TEST(DynamicTree, RandomChangesAgainstBruteForce) {
    Random random(1);
    const Real margin = Real(0.1);
    Mirror mirror(margin);
    for (int step = 0; step < 100000; ++step) {
        const std::uint32_t action = random.next_index(8);
        const std::size_t count = mirror.leaves.size();
        // Up to about 150 boxes, occasionally none.
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
        ASSERT_EQ(sorted_answers(mirror.tree, where), mirror.brute(where)) << "step " << step;
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
            for (const std::uint32_t other : sorted_answers(mirror.tree, box))
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
    // Sorted along a line, the worst insertion order: the height stays a small multiple of the 10
    // levels of a balanced tree of 1024.
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
    EXPECT_EQ(sorted_answers(tree, box).size(), 500U);
    for (const DynamicTree::Leaf leaf : leaves)
        tree.remove(leaf);
    tree.validate();
    EXPECT_EQ(tree.size(), 0U);
    EXPECT_EQ(tree.height(), 0);
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

TEST(DynamicTree, AMillionTimesOverlappingPairs) {
    Random random(19);
    Mirror mirror(Real(0.05));
    std::vector<std::pair<std::uint32_t, std::uint32_t>> found, expected;
    std::size_t pairs = 0;
    int inserted = 0, removed = 0, updated = 0;
    const int steps = trials(4'400'000);
    for (int step = 0; step < steps; ++step) {
        const std::size_t count = mirror.leaves.size();
        const std::size_t any = count == 0 ? 0 : random.next_index(std::uint32_t(count));
        const auto any_one = [&] {
            return step % 2 == 0 ? any_integer_box(random) : any_box(random, 6.0, 4.0);
        };
        const std::uint32_t action = random.next_index(4);
        if (count == 0 || (action == 0 && count < 10)) {
            mirror.insert(any_one());
            ++inserted;
        } else if (action == 1) {
            mirror.remove(any);
            ++removed;
        } else {
            mirror.boxes[any] = any_one();
            mirror.tree.update(mirror.leaves[any], mirror.boxes[any]);
            ++updated;
        }
        expected.clear();
        for (std::size_t i = 0; i < mirror.leaves.size(); ++i)
            for (std::size_t j = i + 1; j < mirror.leaves.size(); ++j)
                if (touches(mirror.tree.fat_bounds(mirror.leaves[i]),
                            mirror.tree.fat_bounds(mirror.leaves[j])))
                    expected.emplace_back(mirror.users[i], mirror.users[j]);
        mirror.tree.overlapping_pairs(found);
        ASSERT_EQ(found, expected) << "step " << step;
        pairs += expected.size();
    }
    EXPECT_GT(pairs, std::size_t(steps) / 4);
    EXPECT_GT(std::min({inserted, removed, updated}), trials(1'000'000));
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
    // In this order the parent is the last box seen one level up; the leaf boxes are those
    // inserted.
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

// A million changes, each followed by a query, and other kinds of query, against brute force.
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
        } else if (action > 5) {
            // A sphere's or segment's answers must be a subset of its AABB's, and include every
            // leaf that contains its centre or an end.
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
        const Aabb where = any_box(random, 5.0, 1.0);
        ASSERT_EQ(sorted_answers(mirror.tree, where), mirror.brute(where)) << "step " << step;
        if (step % 1000 == 0)
            mirror.tree.validate();
    }
    EXPECT_GT(found_in_all, std::size_t(steps) / 40);
}

TEST(DynamicTree, MisuseNamesTheValue) {
    const Real nan = std::numeric_limits<Real>::quiet_NaN();
    const Aabb good{Vec3{Real(0)}, Vec3{Real(1)}};
    says([&] { DynamicTree tree(Real(-7)); }, "-7");
    says([&] { DynamicTree tree(nan); }, "nan");
    DynamicTree tree(Real(0));
    says([&] { tree.insert({Vec3{Real(2)}, Vec3{Real(1)}}, 0); }, "[2, 1]");
    says([&] { tree.insert({Vec3{nan}, Vec3{Real(1)}}, 0); }, "nan");
    says([&] { tree.insert(Aabb{}, 0); }, "e+");
    EXPECT_EQ(tree.size(), 0U);
    const DynamicTree::Leaf leaf = tree.insert(good, 0);
    says([&] { tree.update(leaf, {Vec3{Real(0)}, Vec3{nan}}); }, "nan");
    says([&] { tree.remove(41); }, "41");
    tree.remove(leaf);
    says([&] { tree.remove(leaf); }, "not a leaf");
    says([&] { tree.user(-1); }, "-1");
    says(
        [&] {
            tree.raycast(Ray{Vec3{Real(0)}, Vec3{Real(0)}},
                         [](std::uint32_t, const Ray &) { return Real(0); });
        },
        "direction must not be zero");
    const auto go_on = [](std::uint32_t) { return true; };
    says([&] { tree.query(Sphere{Vec3{Real(0)}, Real(-3)}, go_on); }, "-3");
    says([&] { tree.query(Sphere{Vec3{nan}, Real(1)}, go_on); }, "nan");
    says([&] { tree.query(Segment{Vec3{Real(0)}, Vec3{nan}}, go_on); }, "nan");
    tree.validate();
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
