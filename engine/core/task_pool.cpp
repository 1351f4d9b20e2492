#include "engine/core/task_pool.h"

#include "engine/core/check.h"

#include <algorithm>
#include <exception>

namespace plumb {

TaskPool::TaskPool(int threads) {
    PLUMB_CHECK(threads >= 1 && threads <= 1024, "threads must be 1 to 1024, got " << threads);
    for (int i = 1; i < threads; ++i)
        workers_.emplace_back([this](const std::stop_token &stop) { work(stop); });
}

TaskPool::~TaskPool() = default;

void TaskPool::for_parts(std::size_t count, std::size_t grain,
                         const std::function<void(std::size_t, std::size_t)> &body) {
    grain = std::max<std::size_t>(grain, 1);
    if (workers_.empty() || count <= grain) {
        if (count > 0)
            body(0, count);
        return;
    }
    {
        const std::lock_guard lock(mutex_);
        body_ = &body;
        count_ = count;
        grain_ = grain;
        next_ = 0;
        failure_ = nullptr;
        busy_ = workers_.size();
        ++round_;
    }
    wake_.notify_all();
    run_parts();
    std::unique_lock lock(mutex_);
    done_.wait(lock, [this] { return busy_ == 0; });
    if (failure_)
        std::rethrow_exception(failure_);
}

void TaskPool::run_parts() {
    try {
        for (std::size_t begin = next_.fetch_add(grain_); begin < count_;
             begin = next_.fetch_add(grain_))
            (*body_)(begin, std::min(begin + grain_, count_));
    } catch (...) {
        const std::lock_guard lock(mutex_);
        failure_ = std::current_exception();
        next_ = count_;
    }
}

void TaskPool::work(const std::stop_token &stop) {
    std::size_t seen = 0;
    while (true) {
        {
            std::unique_lock lock(mutex_);
            if (!wake_.wait(lock, stop, [&] { return round_ != seen; }))
                return;
            seen = round_;
        }
        run_parts();
        const std::lock_guard lock(mutex_);
        if (--busy_ == 0)
            done_.notify_one();
    }
}

} // namespace plumb
