// Gathers the results of a parallel loop in item order.
#pragma once

#include "engine/core/task_pool.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace plumb {

// Kept for its memory: a loop no larger than an earlier one allocates nothing.
template <class T> struct FoundParts {
    std::vector<std::vector<T>> parts;
    std::vector<std::size_t> starts; // each part's start in the output, and the end
};

// How many parts the loops below run in, for sizing per-part data.
inline std::size_t part_count(const TaskPool *tasks, std::size_t count, std::size_t grain) {
    if (tasks == nullptr || tasks->threads() == 1)
        return 1;
    grain = tasks->grain(count, grain);
    return std::max<std::size_t>((count + grain - 1) / grain, 1);
}

// Calls body(begin, end, part) for parts of [0, count); `part` counts from 0.
template <class Body>
void for_counted_parts(TaskPool *tasks, std::size_t count, std::size_t grain, Body &&body) {
    if (part_count(tasks, count, grain) == 1) {
        body(std::size_t{0}, count, std::size_t{0});
        return;
    }
    grain = tasks->grain(count, grain);
    tasks->for_parts(count, grain,
                     [&](std::size_t begin, std::size_t end) { body(begin, end, begin / grain); });
}

// Calls find(begin, end, part, found) for parts of [0, count); each call appends its results to its
// own `found`. `out` gets all of them in item order, the same for any number of threads.
template <class T, class Find>
void collect(TaskPool *tasks, std::size_t count, std::size_t grain, FoundParts<T> &scratch,
             std::vector<T> &out, Find &&find) {
    const std::size_t parts = part_count(tasks, count, grain);
    if (parts == 1) { // nothing to merge
        out.clear();
        find(std::size_t{0}, count, std::size_t{0}, out);
        return;
    }
    scratch.parts.resize(std::max(scratch.parts.size(), parts));
    for_counted_parts(tasks, count, grain,
                      [&](std::size_t begin, std::size_t end, std::size_t part) {
                          scratch.parts[part].clear();
                          // One each: else a heap that trembles would allocate now and then.
                          scratch.parts[part].reserve(end - begin);
                          find(begin, end, part, scratch.parts[part]);
                      });
    scratch.starts.assign(1, 0);
    for (std::size_t part = 0; part < parts; ++part)
        scratch.starts.push_back(scratch.starts.back() + scratch.parts[part].size());
    out.resize(scratch.starts.back());
    tasks->for_parts(parts, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t part = begin; part < end; ++part)
            std::ranges::copy(scratch.parts[part],
                              out.begin() + static_cast<std::ptrdiff_t>(scratch.starts[part]));
    });
}

} // namespace plumb
