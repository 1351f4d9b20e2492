// Runs blocks of rows on threads. Blocks of one colour share nothing that moves, so they can be
// solved at the same time, in any order, with bit-identical results.
#pragma once

#include "engine/core/task_pool.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace plumb {

// A block is about a microsecond of work, as long as it takes to hand it out; but a colour has few
// blocks, and larger parts would leave some threads idle.
inline constexpr std::size_t blocks_a_part = 1;

// Calls use(blocks) for parts of blocks that nobody else writes to.
template <class Block, class Use>
void for_blocks(TaskPool *tasks, std::span<Block> blocks, Use &&use) {
    for_parts(tasks, blocks.size(), blocks_a_part,
              [&](std::size_t begin, std::size_t end) { use(blocks.subspan(begin, end - begin)); });
}

// Runs one colour after another; `ends` holds each colour's end. Blocks after the last end have no
// colour and are used on one thread.
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
