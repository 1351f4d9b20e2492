#include "engine/core/radix_sort.h"

#include "engine/core/random.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace plumb {
namespace {

struct Item {
    std::uint64_t key = 0;
    int number = 0;
    friend bool operator==(const Item &, const Item &) = default;
};

TEST(RadixSort, IsTheStableSort) {
    Random random(1);
    std::vector<Item> scratch;
    // Keys with few bits, with many, and with some at either end.
    for (const std::uint64_t mask :
         {std::uint64_t{0}, std::uint64_t{7}, UINT64_MAX, std::uint64_t{0xFF000000000000FF}})
        for (const int count : {0, 1, 2, 300}) {
            std::vector<Item> items;
            for (int i = 0; i < count; ++i)
                items.push_back({(std::uint64_t{random.next_index(UINT32_MAX)} << 32 |
                                  random.next_index(UINT32_MAX)) &
                                     mask,
                                 i});
            std::vector<Item> expected = items;
            std::ranges::stable_sort(expected, {}, &Item::key);
            radix_sort(items, scratch, [](const Item &item) { return item.key; });
            EXPECT_EQ(items, expected) << mask << ' ' << count;
        }
}

} // namespace
} // namespace plumb
