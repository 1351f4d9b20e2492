// Threads that share out a loop.
#pragma once

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>
#include <type_traits>
#include <vector>

namespace plumb {

// `threads` workers in all, the calling thread among them. Which thread runs which part is not
// determined, so work that must give the same bits writes only to its own items.
class TaskPool { // NOLINT(clang-analyzer-optin.performance.Padding): cache lines of their own
  public:
    // `single` makes parts of one item each: slow, to look for races with.
    enum class Parts { large, single };
    explicit TaskPool(int threads, Parts parts = Parts::large); // 1 to 1024
    ~TaskPool();
    TaskPool(const TaskPool &) = delete;
    TaskPool &operator=(const TaskPool &) = delete;

    int threads() const { return static_cast<int>(workers_.size()) + 1; }

    // For a loop whose parts are of equal work: at least `least` items in a part, and no more parts
    // than it takes to keep all threads busy to the end.
    std::size_t equal_grain(std::size_t count, std::size_t least) const {
        if (parts_ == Parts::single)
            return 1;
        const auto parts = static_cast<std::size_t>(4 * threads());
        return std::max(least, (count + parts - 1) / parts);
    }

    // For other loops: as given.
    std::size_t grain(std::size_t given) const { return parts_ == Parts::single ? 1 : given; }

    // Calls body(begin, end) for parts of [0, count), of at most `grain` items when there are
    // several threads and in one part when there is one; returns when all are done. Parts begin at
    // multiples of `grain`. Not reentrant. An exception from a part reaches the caller; parts not
    // yet begun are left out then. Allocates nothing.
    template <class Body> void for_parts(std::size_t count, std::size_t grain, Body &&body) {
        using Plain = std::remove_reference_t<Body>;
        run({std::addressof(body),
             [](const void *what, std::size_t begin, std::size_t end) {
                 (*static_cast<Plain *>(const_cast<void *>(what)))(begin, end);
             },
             count, grain});
    }

    // While one of these lives, idle workers wait for the next loop awake: it begins within a
    // microsecond instead of some tens. For stretches in which one short loop follows another, such
    // as a step; of null: nothing.
    class Awake {
      public:
        explicit Awake(TaskPool *pool);
        ~Awake();
        Awake(const Awake &) = delete;
        Awake &operator=(const Awake &) = delete;

      private:
        TaskPool *pool_;
    };

  private:
    struct Loop {
        const void *body = nullptr;
        void (*call)(const void *, std::size_t, std::size_t) = nullptr;
        std::size_t count = 0;
        std::size_t grain = 1;
    };
    // The parts of the loop in hand that one thread takes first: which loop it is (24 bits), where
    // its parts end and which is next (20 bits each). The same thread has the same share of every
    // loop, so that it finds in its cache what it worked on last; when it is done it helps others.
    struct alignas(64) Share {
        std::atomic<std::uint64_t> parts = 0;
    };
    void run(Loop loop);
    std::uint32_t run_share(Share &share);
    void run_shares(std::size_t thread);
    std::uint32_t give_up();
    void work(std::size_t thread, const std::stop_token &stop);
    void wait_for_loop(const Share &share, std::uint64_t seen, const std::stop_token &stop);

    // The loop in hand. Only used by who then takes a part of it, and it does not change before all
    // its parts are done.
    std::atomic<const void *> body_ = nullptr;
    std::atomic<void (*)(const void *, std::size_t, std::size_t)> call_ = nullptr;
    std::atomic<std::size_t> count_ = 0;
    std::atomic<std::size_t> grain_ = 1;
    Parts parts_;
    std::uint64_t loops_ = 0;
    std::vector<Share> shares_;
    alignas(64) std::atomic<std::uint32_t> done_ = 0; // parts
    alignas(64) std::atomic<int> awake_ = 0;
    std::atomic<int> asleep_ = 0; // workers
    std::mutex mutex_;
    std::condition_variable_any wake_;
    std::exception_ptr failure_;
    std::vector<std::jthread> workers_; // last: they stop before the rest goes
};

// Items of equal work, at least `least` of them in a part. Without a pool: in one part, by the
// caller.
template <class Body>
void for_parts(TaskPool *tasks, std::size_t count, std::size_t least, Body &&body) {
    if (tasks != nullptr)
        tasks->for_parts(count, tasks->equal_grain(count, least), body);
    else if (count > 0)
        body(std::size_t{0}, count);
}

} // namespace plumb
