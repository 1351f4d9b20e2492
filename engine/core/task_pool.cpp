#include "engine/core/task_pool.h"

#include "engine/core/check.h"

#include <algorithm>
#include <utility>

#if defined(__x86_64__) || defined(__i386__)
#include <immintrin.h>
#endif

namespace plumb {

namespace {

constexpr unsigned part_bits = 20;
constexpr std::uint64_t part_mask = (std::uint64_t{1} << part_bits) - 1;
static_assert(TaskPool::most_parts == part_mask);

std::uint64_t next_of(std::uint64_t share) {
    return share & part_mask;
}
std::uint64_t end_of(std::uint64_t share) {
    return share >> part_bits & part_mask;
}
std::uint64_t loop_of(std::uint64_t share) {
    return share >> 2 * part_bits;
}

// Pauses briefly; now and then it yields, as other threads may have real work if there are fewer
// cores than threads.
void wait_a_moment(unsigned turn) {
    constexpr unsigned turns_on_end = 256;
    if (turn % turns_on_end == turns_on_end - 1)
        std::this_thread::yield();
#if defined(__x86_64__) || defined(__i386__)
    else
        _mm_pause();
#endif
}

} // namespace

TaskPool::TaskPool(int threads, Parts parts)
    : parts_(parts), shares_(static_cast<std::size_t>(std::max(threads, 1))) {
    PLUMB_CHECK(threads >= 1 && threads <= 1024, "threads must be 1 to 1024, got " << threads);
    for (std::size_t i = 1; i < shares_.size(); ++i)
        workers_.emplace_back([this, i](const std::stop_token &stop) { work(i, stop); });
}

TaskPool::~TaskPool() = default;

TaskPool::Awake::Awake(TaskPool *pool) : pool_(pool) {
    if (pool_ != nullptr && pool_->threads() > 1)
        ++pool_->awake_;
}

TaskPool::Awake::~Awake() {
    if (pool_ != nullptr && pool_->threads() > 1)
        --pool_->awake_;
}

void TaskPool::run(Loop loop) {
    if (loop.count == 0)
        return;
    loop.grain = std::max<std::size_t>(loop.grain, 1);
    if (workers_.empty() || loop.count <= loop.grain) {
        loop.call(loop.body, 0, loop.count);
        return;
    }
    loop.grain = std::max(loop.grain, (loop.count + most_parts - 1) / most_parts);
    const std::size_t parts = (loop.count + loop.grain - 1) / loop.grain;
    body_.store(loop.body, std::memory_order_relaxed);
    call_.store(loop.call, std::memory_order_relaxed);
    count_.store(loop.count, std::memory_order_relaxed);
    grain_.store(loop.grain, std::memory_order_relaxed);
    done_.store(0, std::memory_order_relaxed);
    ++loops_;
    const std::size_t threads = shares_.size();
    // Sequentially consistent, as is a worker's read of its share after it counts itself asleep:
    // either we see it asleep or it sees the new loop.
    for (std::size_t i = 0; i < threads; ++i)
        shares_[i].parts.store(loops_ << 2 * part_bits | (parts * (i + 1) / threads) << part_bits |
                               parts * i / threads);
    if (asleep_.load() > 0) {
        { const std::lock_guard lock(mutex_); }
        wake_.notify_all();
    }
    run_shares(0);
    for (unsigned turn = 0; done_.load(std::memory_order_acquire) < parts; ++turn)
        wait_a_moment(turn);
    if (failure_)
        std::rethrow_exception(std::exchange(failure_, nullptr));
}

// Runs parts of a share until none are left; returns how many are done with, given-up ones
// included. If the share is still as it was read, the loop was not finished, so the fields read in
// between belong to that loop.
std::uint32_t TaskPool::run_share(Share &share) {
    std::uint32_t done = 0;
    std::uint64_t seen = share.parts.load(std::memory_order_acquire);
    while (next_of(seen) < end_of(seen)) {
        const Loop loop{
            body_.load(std::memory_order_relaxed), call_.load(std::memory_order_relaxed),
            count_.load(std::memory_order_relaxed), grain_.load(std::memory_order_relaxed)};
        if (!share.parts.compare_exchange_weak(seen, seen + 1, std::memory_order_acq_rel,
                                               std::memory_order_acquire))
            continue;
        const std::size_t begin = next_of(seen) * loop.grain;
        ++done;
        try {
            loop.call(loop.body, begin, std::min(begin + loop.grain, loop.count));
        } catch (...) {
            const std::lock_guard lock(mutex_);
            failure_ = std::current_exception();
            done += give_up();
        }
        seen = share.parts.load(std::memory_order_acquire);
    }
    return done;
}

// Claims all parts not yet started without running them; returns how many.
std::uint32_t TaskPool::give_up() {
    std::uint64_t left = 0;
    for (Share &share : shares_) {
        std::uint64_t seen = share.parts.load();
        while (next_of(seen) < end_of(seen) &&
               !share.parts.compare_exchange_weak(seen, seen + end_of(seen) - next_of(seen))) {
        }
        left += end_of(seen) - std::min(next_of(seen), end_of(seen));
    }
    return static_cast<std::uint32_t>(left);
}

// Runs a thread's own share, then the rest of the others'.
void TaskPool::run_shares(std::size_t thread) {
    for (std::size_t i = 0; i < shares_.size(); ++i) {
        const std::uint32_t done = run_share(shares_[(thread + i) % shares_.size()]);
        if (done > 0)
            done_.fetch_add(done, std::memory_order_acq_rel);
    }
}

void TaskPool::wait_for_loop(const Share &share, std::uint64_t seen, const std::stop_token &stop) {
    const auto is_new = [&] { return loop_of(share.parts.load()) != loop_of(seen); };
    for (unsigned turn = 0; awake_.load(std::memory_order_relaxed) > 0; ++turn) {
        if (is_new() || stop.stop_requested())
            return;
        wait_a_moment(turn);
    }
    std::unique_lock lock(mutex_);
    ++asleep_;
    wake_.wait(lock, stop, [&] { return is_new() || awake_.load() > 0; });
    --asleep_;
}

void TaskPool::work(std::size_t thread, const std::stop_token &stop) {
    const Share &own = shares_[thread];
    while (!stop.stop_requested()) {
        const std::uint64_t seen = own.parts.load(std::memory_order_acquire);
        run_shares(thread);
        wait_for_loop(own, seen, stop);
    }
}

} // namespace plumb
