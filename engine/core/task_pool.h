// Threads that share out a loop.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace plumb {

// `threads` workers in all, the calling thread among them. Which thread runs which part is not
// determined, so work that shall give the same bits writes only to its own items.
class TaskPool {
  public:
    explicit TaskPool(int threads); // >= 1
    ~TaskPool();
    TaskPool(const TaskPool &) = delete;
    TaskPool &operator=(const TaskPool &) = delete;

    int threads() const { return static_cast<int>(workers_.size()) + 1; }

    // Calls body(begin, end) for parts of [0, count), of at most `grain` items when there are
    // several threads and in one part when there is one; returns when all are done. Not reentrant.
    // An exception from a part reaches the caller.
    void for_parts(std::size_t count, std::size_t grain,
                   const std::function<void(std::size_t, std::size_t)> &body);

  private:
    void work(const std::stop_token &stop);
    void run_parts();

    std::mutex mutex_;
    std::condition_variable_any wake_;
    std::condition_variable done_;
    const std::function<void(std::size_t, std::size_t)> *body_ = nullptr;
    std::size_t count_ = 0;
    std::size_t grain_ = 1;
    std::atomic<std::size_t> next_{0};
    std::size_t round_ = 0;
    std::size_t busy_ = 0;
    std::exception_ptr failure_;
    std::vector<std::jthread> workers_; // last: they stop before the rest goes
};

} // namespace plumb
