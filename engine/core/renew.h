// Arrays that are refilled over and over.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace plumb {

// Makes `items` hold `count` copies of `item`. Capacity grows by more than needed, so fluctuating
// sizes allocate nothing.
template <typename Item>
void renew(std::vector<Item> &items, std::size_t count, const Item &item = {}) {
    items.resize(count);
    std::ranges::fill(items, item);
}

} // namespace plumb
