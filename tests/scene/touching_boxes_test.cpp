#include "engine/scene/touching_boxes.h"

#include "engine/core/random.h"

#include <cmath>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace plumb {
namespace {

using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;

Pairs found(const std::vector<BoundsDesc> &boxes) {
    Pairs pairs;
    for_touching_boxes(boxes, [&](std::size_t i, std::size_t j) {
        pairs.emplace_back(i, j);
        return true;
    });
    return pairs;
}

Pairs by_asking_all(const std::vector<BoundsDesc> &boxes) {
    Pairs pairs;
    for (std::size_t i = 0; i < boxes.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) {
            bool touch = true;
            for (int axis = 0; axis < 3; ++axis)
                touch = touch && boxes[i].min[axis] <= boxes[j].max[axis] &&
                        boxes[j].min[axis] <= boxes[i].max[axis];
            if (touch)
                pairs.emplace_back(i, j);
        }
    return pairs;
}

// On a coarse grid, so that many touch exactly; near the origin and where float runs out of digits.
TEST(TouchingBoxes, AreThoseThatAskingAllFinds) {
    Random random(5);
    for (const double origin : {0.0, 1e6, 1e9}) {
        std::size_t pairs = 0;
        for (int trial = 0; trial < 50; ++trial) {
            std::vector<BoundsDesc> boxes;
            for (int i = 0; i < 60; ++i) {
                BoundsDesc box;
                for (int axis = 0; axis < 3; ++axis) {
                    box.min[axis] = origin + 0.25 * std::floor(random.next_in(0, 24));
                    box.max[axis] = box.min[axis] + 0.25 * std::floor(random.next_in(0, 8));
                }
                boxes.push_back(box);
            }
            const Pairs all = by_asking_all(boxes);
            ASSERT_EQ(found(boxes), all);
            pairs += all.size();
        }
        EXPECT_GT(pairs, 1000U);
    }
}

TEST(TouchingBoxes, StopsWhenTold) {
    const std::vector<BoundsDesc> same(100);
    int visits = 0;
    for_touching_boxes(same, [&](std::size_t, std::size_t) { return ++visits < 7; });
    EXPECT_EQ(visits, 7);
    EXPECT_TRUE(found({}).empty());
    EXPECT_TRUE(found({BoundsDesc{}}).empty());
}

} // namespace
} // namespace plumb
