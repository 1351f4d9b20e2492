// Blocks of rows on threads. Those of one colour share nothing that moves: they may be solved at
// the same time, in any order, with the same bits.
#pragma once

#include "engine/core/task_pool.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace plumb {

// About a microsecond of work, as long as it takes to hand it out; but a colour has few blocks, and
// with more in a part some threads would have nothing to do.
inline constexpr std::size_t blocks_a_part = 1;

// Calls use(blocks) for parts of blocks that nobody else writes to.
template <class Block, class Use>
void for_blocks(TaskPool *tasks, std::span<Block> blocks, Use &&use) {
    for_parts(tasks, blocks.size(), blocks_a_part,
              [&](std::size_t begin, std::size_t end) { use(blocks.subspan(begin, end - begin)); });
}

// One colour after another, each up to one of `ends`; blocks after the last stand for themselves.
template <class Block, class Use>
void for_colours(TaskPool *tasks, std::span<Block> blocks, std::span<const std::uint32_t> ends,
                 Use &&use) {
    std::size_t first = 0;
    for (const std::uint32_t last : ends) {
        for_blocks(tasks, blocks.subspan(first, last - first), use);
        first = last;
    }
    if (first < blocks.size())
        use(blocks.subspan(first));
}

} // namespace plumb
