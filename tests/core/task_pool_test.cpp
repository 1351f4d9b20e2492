#include "engine/core/task_pool.h"

#include "engine/core/check.h"
#include "engine/core/collect.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <stdexcept>
#include <thread>
#include <vector>

namespace plumb {
namespace {

TEST(TaskPool, EachItemOnce) {
    for (const int threads : {1, 2, 3, 8}) {
        TaskPool tasks(threads);
        EXPECT_EQ(tasks.threads(), threads);
        for (const std::size_t count : {0U, 1U, 2U, 7U, 64U, 1000U})
            for (const std::size_t grain : {0U, 1U, 3U, 64U, 5000U}) {
                std::vector<int> done(count, 0); // plain ints: each part belongs to one thread
                tasks.for_parts(count, grain, [&](std::size_t begin, std::size_t end) {
                    for (std::size_t i = begin; i < end; ++i)
                        ++done[i];
                });
                EXPECT_EQ(done, std::vector<int>(count, 1))
                    << threads << " threads, " << count << " items, grain " << grain;
            }
    }
}

TEST(TaskPool, PartsAreNotEmptyAndNoLargerThanTheGrain) {
    TaskPool tasks(3);
    std::atomic<int> bad{0};
    tasks.for_parts(1001, 10, [&](std::size_t begin, std::size_t end) {
        if (begin >= end || end - begin > 10 || end > 1001)
            ++bad;
    });
    EXPECT_EQ(bad, 0);
}

// Each thread gets the same items loop after loop, and free threads take over the parts of a busy
// one rather than wait for it.
TEST(TaskPool, FreeThreadsHelpOthers) {
    TaskPool tasks(4);
    std::atomic<int> done{0};
    tasks.for_parts(64, 1, [&](std::size_t begin, std::size_t) {
        ++done;
        while (begin == 0 && done < 64) // the first part waits until others have done the rest
            std::this_thread::yield();
    });
    EXPECT_EQ(done, 64);
}

TEST(TaskPool, LoopsOfOneItemAPartToLookForRacesWith) {
    TaskPool tasks(3, TaskPool::Parts::single);
    EXPECT_EQ(tasks.equal_grain(1000, 64), 1U);
    EXPECT_EQ(tasks.grain(1000, 64), 1U);
    EXPECT_EQ(TaskPool(3).grain(1000, 64), 64U);
    EXPECT_EQ(tasks.grain(3 * TaskPool::most_parts, 64), 3U);
    EXPECT_EQ(TaskPool(3).equal_grain(1000, 64), 84U); // 12 parts
    EXPECT_EQ(TaskPool(3).equal_grain(100, 64), 64U);
}

// More items than a loop has parts: the parts get larger, for what is collected by part, too.
TEST(TaskPool, MoreItemsThanParts) {
    TaskPool tasks(3, TaskPool::Parts::single);
    constexpr std::size_t count = 2 * TaskPool::most_parts + 5;
    FoundParts<std::size_t> scratch;
    std::vector<std::size_t> found;
    for (int turn = 0; turn < 2; ++turn)
        collect(&tasks, count, 1, scratch, found,
                [](std::size_t begin, std::size_t end, std::size_t, std::vector<std::size_t> &out) {
                    for (std::size_t i = begin; i < end; ++i)
                        if (i % 1000 == 0)
                            out.push_back(i);
                });
    ASSERT_EQ(found.size(), (count + 999) / 1000);
    for (std::size_t i = 0; i < found.size(); ++i)
        ASSERT_EQ(found[i], 1000 * i);
}

// A pool kept awake works like one that sleeps between loops, and goes back to sleep.
TEST(TaskPool, StaysAwakeWhileItIsAsked) {
    TaskPool tasks(4);
    for (int turn = 0; turn < 50; ++turn) {
        const TaskPool::Awake awake(&tasks);
        std::atomic<int> done{0};
        for (int loop = 0; loop < 20; ++loop)
            tasks.for_parts(8, 1, [&](std::size_t, std::size_t) { ++done; });
        EXPECT_EQ(done, 160);
    }
    const TaskPool::Awake of_nobody(nullptr);
}

TEST(TaskPool, NothingToDoCallsNothing) {
    TaskPool tasks(2);
    int calls = 0;
    tasks.for_parts(0, 1, [&](std::size_t, std::size_t) { ++calls; });
    EXPECT_EQ(calls, 0);
}

// After for_parts the caller reads what the parts wrote, round after round: a data race or a lost
// round shows here, and under ThreadSanitizer immediately.
TEST(TaskPool, ManyRounds) {
    TaskPool tasks(4);
    std::vector<std::uint64_t> values(97);
    std::iota(values.begin(), values.end(), 0U);
    constexpr std::uint64_t rounds = 5000;
    for (std::uint64_t round = 0; round < rounds; ++round)
        tasks.for_parts(values.size(), 5, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                values[i] += i;
        });
    for (std::size_t i = 0; i < values.size(); ++i)
        ASSERT_EQ(values[i], i + rounds * i);
}

TEST(TaskPool, AnExceptionReachesTheCallerAndThePoolGoesOn) {
    for (const int threads : {1, 4}) {
        TaskPool tasks(threads);
        for (int round = 0; round < 50; ++round) {
            EXPECT_THROW(tasks.for_parts(200, 1,
                                         [](std::size_t begin, std::size_t end) {
                                             if (begin <= 37 && 37 < end)
                                                 throw std::runtime_error("item 37");
                                         }),
                         std::runtime_error);
            std::atomic<std::size_t> items{0};
            tasks.for_parts(200, 1,
                            [&](std::size_t begin, std::size_t end) { items += end - begin; });
            EXPECT_EQ(items, 200U);
        }
    }
}

TEST(TaskPool, ManyThrowOneArrives) {
    TaskPool tasks(4);
    EXPECT_THROW(
        tasks.for_parts(1000, 1, [](std::size_t, std::size_t) { throw std::out_of_range("all"); }),
        std::out_of_range);
}

TEST(TaskPool, UnusedPoolsStop) {
    for (int i = 0; i < 50; ++i)
        TaskPool(4);
}

TEST(TaskPool, RefusesSenselessThreadCounts) {
    EXPECT_THROW(TaskPool(0), CheckFailure);
    EXPECT_THROW(TaskPool(-3), CheckFailure);
    EXPECT_THROW(TaskPool(100'000), CheckFailure);
}

} // namespace
} // namespace plumb
