#include "engine/core/task_pool.h"

#include "engine/core/check.h"

#include <algorithm>
#include <utility>

#if defined(__x86_64__) || defined(__i386__)
#include <immintrin.h>
#endif

namespace plumb {

namespace {

constexpr std::uint64_t one_loop = std::uint64_t{1} << 32;

std::uint32_t part_of(std::uint64_t ticket) {
    return static_cast<std::uint32_t>(ticket);
}

// Waits a moment. Now and then it lets others run, who may have more to do than wait where there
// are fewer cores than threads.
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

TaskPool::TaskPool(int threads) {
    PLUMB_CHECK(threads >= 1 && threads <= 1024, "threads must be 1 to 1024, got " << threads);
    for (int i = 1; i < threads; ++i)
        workers_.emplace_back([this](const std::stop_token &stop) { work(stop); });
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
    constexpr std::size_t most_parts = UINT32_MAX - 1;
    loop.grain = std::max(loop.grain, (loop.count + most_parts - 1) / most_parts);
    const auto parts = static_cast<std::uint32_t>((loop.count + loop.grain - 1) / loop.grain);
    // The loop before has no part left whatever its number of parts is now; who sees anything of
    // this loop sees that, too.
    std::uint64_t ticket = ticket_.load(std::memory_order_relaxed) | (one_loop - 1);
    ticket_.store(ticket, std::memory_order_relaxed);
    body_.store(loop.body, std::memory_order_release);
    call_.store(loop.call, std::memory_order_release);
    count_.store(loop.count, std::memory_order_release);
    grain_.store(loop.grain, std::memory_order_release);
    parts_.store(parts, std::memory_order_release);
    done_.store(0, std::memory_order_relaxed);
    // Sequentially consistent, as is a worker's look at it after it said that it sleeps: one of the
    // two sees the other.
    ticket_.store(++ticket);
    if (asleep_.load() > 0) {
        { const std::lock_guard lock(mutex_); }
        wake_.notify_all();
    }
    while (run_part(ticket)) {
    }
    for (unsigned turn = 0; done_.load(std::memory_order_acquire) < parts; ++turn)
        wait_a_moment(turn);
    if (failure_) {
        const std::exception_ptr failure = std::exchange(failure_, nullptr);
        std::rethrow_exception(failure);
    }
}

// Takes the next part of the loop in hand and runs it; false when there is none. That the ticket is
// still the one that was read says that the loop was not done, so what was read of it was its own.
bool TaskPool::run_part(std::uint64_t &ticket) {
    Loop loop;
    do {
        ticket = ticket_.load(std::memory_order_acquire);
        if (part_of(ticket) >= parts_.load(std::memory_order_acquire))
            return false;
        loop = {body_.load(std::memory_order_acquire), call_.load(std::memory_order_acquire),
                count_.load(std::memory_order_acquire), grain_.load(std::memory_order_acquire)};
    } while (!ticket_.compare_exchange_weak(ticket, ticket + 1, std::memory_order_acq_rel,
                                            std::memory_order_relaxed));
    const std::size_t begin = part_of(ticket) * loop.grain;
    std::uint32_t done = 1;
    try {
        loop.call(loop.body, begin, std::min(begin + loop.grain, loop.count));
    } catch (...) {
        const std::lock_guard lock(mutex_);
        failure_ = std::current_exception();
        // Nobody begins what is left.
        const std::uint32_t parts = parts_.load(std::memory_order_relaxed);
        std::uint64_t left = ticket_.load();
        while (part_of(left) < parts &&
               !ticket_.compare_exchange_weak(left, left / one_loop * one_loop + parts)) {
        }
        done += part_of(left) < parts ? parts - part_of(left) : 0;
    }
    done_.fetch_add(done, std::memory_order_acq_rel);
    return true;
}

void TaskPool::wait_for_loop(std::uint64_t seen, const std::stop_token &stop) {
    const auto is_new = [&] { return ticket_.load() / one_loop != seen / one_loop; };
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

void TaskPool::work(const std::stop_token &stop) {
    std::uint64_t ticket = 0;
    while (!stop.stop_requested()) {
        while (run_part(ticket)) {
        }
        wait_for_loop(ticket, stop);
    }
}

} // namespace plumb
