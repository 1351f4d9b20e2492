// Arrays that are filled anew, again and again.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace plumb {

// So many times the same, in memory that grows by more than it must: sizes that waver allocate
// nothing.
template <typename Item>
void renew(std::vector<Item> &items, std::size_t count, const Item &item = {}) {
    items.resize(count);
    std::ranges::fill(items, item);
}

} // namespace plumb
