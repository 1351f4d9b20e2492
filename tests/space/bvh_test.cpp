#include "engine/space/bvh.h"

#include "engine/core/check.h"
#include "engine/core/random.h"
#include "tests/space/tree_boxes.h"
#include "tests/trials.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include <glm/common.hpp>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using oracle::any_vector;
using tree_boxes::touches;

struct Family {
    const char *name;
    Aabb (*make)(Random &random, int i);
};

// Ordinary boxes, and families that are hard to split.
const Family families[] = {
    {"scattered",
     [](Random &random, int) {
         const Vec3 center = any_vector(random, 100.0);
         const Vec3 half = glm::abs(any_vector(random, 3.0));
         return Aabb{center - half, center + half};
     }},
    {"points far away",
     [](Random &random, int) {
         const Vec3 p = Vec3{Real(1e5), Real(-1e5), Real(1e5)} + any_vector(random, 0.1);
         return Aabb{p, p};
     }},
    {"all the same",
     [](Random &, int) {
         return Aabb{Vec3{Real(1)}, Vec3{Real(2)}};
     }},
    {"one in the other",
     [](Random &, int i) {
         return Aabb{Vec3{-Real(i + 1)}, Vec3{Real(i + 1)}};
     }},
    {"each twice as far",
     [](Random &, int i) {
         const Vec3 p{std::ldexp(Real(1), i % 150 - 100), Real(0), Real(0)};
         return Aabb{p, p};
     }},
    {"a grid in a plane",
     [](Random &, int i) {
         const Vec3 p{Real(i % 32), Real(0), Real(i / 32)};
         return Aabb{p, p + Vec3{Real(1), Real(0), Real(1)}};
     }},
    {"a crowd and one far away",
     [](Random &random, int i) {
         const Vec3 p = i == 0 ? Vec3{Real(1e14)} : any_vector(random, 1e-3);
         return Aabb{p, p};
     }},
};

std::vector<Aabb> boxes_of(const Family &family, Random &random, int count) {
    std::vector<Aabb> boxes;
    for (int i = 0; i < count; ++i)
        boxes.push_back(family.make(random, i));
    return boxes;
}

// Every item is in one leaf, every node is reached once, bounds are tight, and the stack is large
// enough for any traversal.
void expect_consistent(const Bvh &tree, const std::vector<Aabb> &boxes) {
    std::vector<int> seen(boxes.size(), 0);
    std::vector<int> leaf_seen(tree.leaf_count(), 0);
    std::size_t nodes_seen = 0;
    const auto visit = [&](const auto &self, std::uint32_t index, int height) -> Aabb {
        ++nodes_seen;
        EXPECT_LE(std::size_t(height) * (Bvh::width - 1) + 1, Bvh::stack_size);
        const Bvh::Node &node = tree.nodes()[index];
        Aabb all;
        for (std::size_t child = 0; child < Bvh::width; ++child) {
            Aabb box;
            if (node.children[child] == Bvh::no_child) {
                // empty box
            } else if ((node.children[child] & Bvh::leaf_bit) != 0) {
                const std::uint32_t leaf = node.children[child] & ~Bvh::leaf_bit;
                ++leaf_seen[leaf];
                EXPECT_LE(tree.items(leaf).size(), Bvh::leaf_size);
                EXPECT_GE(tree.items(leaf).size(), 1U);
                for (const std::uint32_t item : tree.items(leaf)) {
                    ++seen[item];
                    box.min = glm::min(box.min, boxes[item].min);
                    box.max = glm::max(box.max, boxes[item].max);
                }
            } else {
                EXPECT_GT(node.children[child], index); // parents first
                box = self(self, node.children[child], height + 1);
            }
            for (int axis = 0; axis < 3; ++axis) {
                EXPECT_EQ(node.bounds[axis][0][child], box.min[axis]);
                EXPECT_EQ(node.bounds[axis][1][child], box.max[axis]);
            }
            all = {glm::min(all.min, box.min), glm::max(all.max, box.max)};
        }
        return all;
    };
    Aabb all;
    if (!tree.nodes().empty())
        all = visit(visit, 0, 1);
    EXPECT_EQ(all.min, tree.bounds().min);
    EXPECT_EQ(all.max, tree.bounds().max);
    EXPECT_EQ(nodes_seen, tree.nodes().size());
    EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), std::ptrdiff_t(boxes.size()));
    EXPECT_EQ(std::count(leaf_seen.begin(), leaf_seen.end(), 1), std::ptrdiff_t(leaf_seen.size()));
}

// The items of every leaf that touches the query are visited once, no others.
void expect_right_query(const Bvh &tree, const std::vector<Aabb> &boxes, const Aabb &query) {
    std::vector<int> visits(boxes.size(), 0);
    tree.query(query, [&](std::uint32_t item) {
        ++visits[item];
        return true;
    });
    for (std::size_t leaf = 0; leaf < tree.leaf_count(); ++leaf) {
        Aabb box;
        for (const std::uint32_t item : tree.items(leaf))
            box = {glm::min(box.min, boxes[item].min), glm::max(box.max, boxes[item].max)};
        for (const std::uint32_t item : tree.items(leaf))
            ASSERT_EQ(visits[item], touches(box, query) ? 1 : 0);
    }
}

TEST(Bvh, IsConsistentAndAnswersQueriesAsAListDoes) {
    Random random(1);
    for (const Family &family : families) {
        SCOPED_TRACE(family.name);
        for (const int count : {0, 1, 2, 4, 5, 8, 9, 33, 150, 1000}) {
            SCOPED_TRACE(count);
            const std::vector<Aabb> boxes = boxes_of(family, random, count);
            const Bvh tree(boxes);
            ASSERT_EQ(tree.size(), boxes.size());
            expect_consistent(tree, boxes);
            for (int k = 0; k < trials(count <= 33 ? 18'000 : 2'000); ++k) {
                Aabb query = family.make(random, int(random.next_index(1000)));
                const Vec3 grow = glm::abs(any_vector(random, 2.0));
                if (k % 2 == 0)
                    query = {query.min - grow, query.max + grow};
                expect_right_query(tree, boxes, query);
            }
        }
    }
}

TEST(Bvh, StopsWhenTheVisitSaysSo) {
    Random random(2);
    const std::vector<Aabb> boxes = boxes_of(families[0], random, 500);
    const Bvh tree(boxes);
    int visits = 0;
    tree.query({Vec3{Real(-1000)}, Vec3{Real(1000)}}, [&](std::uint32_t) { return ++visits < 7; });
    EXPECT_EQ(visits, 7);
}

TEST(Bvh, RefitsToBoxesThatMoved) {
    Random random(3);
    for (int k = 0; k < trials(40); ++k) {
        std::vector<Aabb> boxes = boxes_of(families[0], random, 300);
        Bvh tree(boxes);
        const Bvh before = tree;
        for (Aabb &box : boxes) {
            const Vec3 by = any_vector(random, k % 2 == 0 ? 1.0 : 300.0);
            box = {box.min + by, box.max + by};
        }
        tree.refit(boxes);
        expect_consistent(tree, boxes);
        for (int q = 0; q < 50; ++q)
            expect_right_query(tree, boxes, families[0].make(random, 0));
        EXPECT_TRUE(std::equal(tree.items(0).begin(), tree.items(0).end(), before.items(0).begin(),
                               before.items(0).end()));
    }
}

TEST(Bvh, RefitsAMillionTimes) {
    Random random(7);
    for (const int count : {1, 3, 8, 9, 20}) {
        const std::vector<Aabb> start = boxes_of(families[0], random, count);
        std::vector<Aabb> boxes = start;
        Bvh tree(boxes);
        for (int k = 0; k < trials(200'000); ++k) {
            for (std::size_t i = 0; i < boxes.size(); ++i) {
                const Vec3 by = any_vector(random, 2.0);
                boxes[i] = {start[i].min + by, start[i].max + by};
            }
            tree.refit(boxes);
            const Vec3 middle = boxes[std::size_t(k) % boxes.size()].min;
            expect_right_query(tree, boxes, {middle - Real(3), middle + Real(3)});
        }
        expect_consistent(tree, boxes);
    }
}

TEST(Bvh, FindsTheNearestItemAsAListDoes) {
    Random random(4);
    const auto squared_distance = [](const Aabb &box, const Vec3 &p) {
        const Vec3 away = p - glm::clamp(p, box.min, box.max);
        return away.x * away.x + away.y * away.y + away.z * away.z;
    };
    for (const Family &family : families) {
        SCOPED_TRACE(family.name);
        for (const int count : {2, 9, 20, 700}) {
            const std::vector<Aabb> boxes = boxes_of(family, random, count);
            const Bvh tree(boxes);
            for (int k = 0; k < trials(count <= 20 ? 48'000 : 3'000); ++k) {
                const Vec3 p = k % 3 == 0 ? any_vector(random, 120.0)
                                          : family.make(random, k % 700).min +
                                                any_vector(random, k % 3 == 1 ? 1.0 : 1e-3);
                Real best = std::numeric_limits<Real>::infinity();
                tree.nearest(p, best, [&](std::uint32_t item) {
                    best = std::min(best, squared_distance(boxes[item], p));
                    return best;
                });
                Real expected = std::numeric_limits<Real>::infinity();
                for (const Aabb &box : boxes)
                    expected = std::min(expected, squared_distance(box, p));
                ASSERT_EQ(best, expected) << count;
            }
        }
    }
}

TEST(Bvh, IsTheSameForTheSameBoxes) {
    Random random(5);
    const std::vector<Aabb> boxes = boxes_of(families[0], random, 3000);
    const Bvh one(boxes);
    const Bvh other(boxes);
    ASSERT_EQ(one.nodes().size(), other.nodes().size());
    for (std::size_t i = 0; i < one.nodes().size(); ++i) {
        EXPECT_EQ(0, std::memcmp(one.nodes()[i].bounds, other.nodes()[i].bounds,
                                 sizeof(Bvh::Node::bounds)));
        EXPECT_EQ(0, std::memcmp(one.nodes()[i].children, other.nodes()[i].children,
                                 sizeof(Bvh::Node::children)));
    }
}

// The point of a tree: far fewer visits than a list needs.
TEST(Bvh, VisitsFewOfAMillion) {
    Random random(6);
    const int count = trials(1'000'000);
    std::vector<Aabb> boxes;
    for (int i = 0; i < count; ++i) {
        const Vec3 p = any_vector(random, 100.0);
        boxes.push_back({p, p + Real(0.1)});
    }
    const Bvh tree(boxes);
    EXPECT_LE(tree.leaf_count(), std::size_t(count) / 2);
    int visits = 0;
    for (int k = 0; k < 1000; ++k) {
        const Vec3 p = any_vector(random, 99.0);
        tree.query({p, p + Real(1)}, [&](std::uint32_t) {
            ++visits;
            return true;
        });
    }
    EXPECT_LT(visits / 1000.0, 10.0); // 0.17 of the million touch on average
}

TEST(Bvh, RefusesBoxesThatAreNone) {
    const Aabb fine{Vec3{Real(0)}, Vec3{Real(1)}};
    const auto message_of = [&](const Aabb &bad) -> std::string {
        try {
            const Aabb boxes[] = {fine, bad};
            const Bvh tree(boxes);
        } catch (const CheckFailure &failure) {
            return failure.what();
        }
        return "";
    };
    Aabb bad = fine;
    bad.min.y = Real(2);
    EXPECT_NE(message_of(bad).find("got [2, 1] on axis 1"), std::string::npos);
    bad = fine;
    bad.max.z = std::numeric_limits<Real>::quiet_NaN();
    EXPECT_NE(message_of(bad).find("got [0, nan] on axis 2"), std::string::npos);
    bad.max.z = std::numeric_limits<Real>::infinity();
    EXPECT_NE(message_of(bad).find("got [0, inf] on axis 2"), std::string::npos);
    bad.max.z = Real(2e15);
    EXPECT_NE(message_of(bad).find("box 1"), std::string::npos);
    Bvh tree(std::span(&fine, 1));
    EXPECT_THROW(tree.refit({}), CheckFailure);
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
