// A thread pool for parallel loops.
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

// `threads` workers, including the calling thread. Which thread runs which part is not determined,
// so work that must be bit-reproducible writes only to its own items.
class TaskPool { // NOLINT(clang-analyzer-optin.performance.Padding): cache lines of their own
  public:
    // `single` makes every part one item: slow, for finding races.
    enum class Parts { large, single };
    static constexpr std::size_t most_parts = (std::size_t{1} << 20) - 1; // of a loop
    explicit TaskPool(int threads, Parts parts = Parts::large);           // 1 to 1024
    ~TaskPool();
    TaskPool(const TaskPool &) = delete;
    TaskPool &operator=(const TaskPool &) = delete;

    int threads() const { return static_cast<int>(workers_.size()) + 1; }

    // For loops whose items cost the same: at least `least` items per part, and no more parts than
    // it takes to keep all threads busy to the end.
    std::size_t equal_grain(std::size_t count, std::size_t least) const {
        if (parts_ == Parts::single)
            return 1;
        const auto parts = static_cast<std::size_t>(4 * threads());
        return std::max(least, (count + parts - 1) / parts);
    }

    // For other loops: as given, unless that makes too many parts.
    std::size_t grain(std::size_t count, std::size_t given) const {
        return std::max(parts_ == Parts::single ? 1 : given, (count + most_parts - 1) / most_parts);
    }

    // Calls body(begin, end) for parts of [0, count) of at most `grain` items, or once for
    // everything if there is only one thread; returns when all parts are done. Parts begin at
    // multiples of `grain`. Not reentrant. An exception in a part reaches the caller, and parts not
    // yet started are skipped. Allocates nothing.
    template <class Body> void for_parts(std::size_t count, std::size_t grain, Body &&body) {
        using Plain = std::remove_reference_t<Body>;
        run({std::addressof(body),
             [](const void *what, std::size_t begin, std::size_t end) {
                 (*static_cast<Plain *>(const_cast<void *>(what)))(begin, end);
             },
             count, grain});
    }

    // While one of these lives, idle workers spin until the next loop, which then starts within a
    // microsecond instead of tens. For runs of short loops, such as a step. Null does nothing.
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
    // The parts of the current loop that one thread takes first: the loop's number (24 bits), the
    // end of its parts and the next part (20 bits each). A thread gets the same share of every
    // loop, so its data are still in its cache; when it is done, it helps the others.
    struct alignas(64) Share {
        std::atomic<std::uint64_t> parts = 0;
    };
    void run(Loop loop);
    std::uint32_t run_share(Share &share);
    void run_shares(std::size_t thread);
    std::uint32_t give_up();
    void work(std::size_t thread, const std::stop_token &stop);
    void wait_for_loop(const Share &share, std::uint64_t seen, const std::stop_token &stop);

    // The current loop. Used only by threads that then take a part of it; it does not change until
    // all its parts are done.
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
    std::vector<std::jthread> workers_; // last: they stop before the rest is destroyed
};

// For items that cost the same, at least `least` per part. Without a pool the caller runs them as
// one part.
template <class Body>
void for_parts(TaskPool *tasks, std::size_t count, std::size_t least, Body &&body) {
    if (tasks != nullptr)
        tasks->for_parts(count, tasks->equal_grain(count, least), body);
    else if (count > 0)
        body(std::size_t{0}, count);
}

} // namespace plumb
