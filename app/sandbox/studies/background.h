// Work on a background thread that yields to all others.
#pragma once

#include <atomic>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <pthread.h>

namespace plumb {

// From now on the calling thread only runs when a processor would be idle.
void give_way_to_others();
// Back to normal scheduling: a thread being waited for must not wait for others. The system may
// refuse.
void hurry(std::jthread::native_handle_type thread);

// One job at a time. It publishes results as it goes; they can be read at any time.
template <typename Result> class Background {
    struct State {
        std::mutex mutex; // guards the two below
        std::shared_ptr<const Result> result;
        std::string failure;
        std::atomic<double> done = 0; // 0..1
        std::atomic<bool> running = true;
    };

  public:
    Background() = default;
    ~Background() { stop(); } // also waits for earlier, stopped jobs
    Background(Background &&) noexcept = default;
    Background &operator=(Background &&) noexcept = default;
    Background(const Background &) = delete;
    Background &operator=(const Background &) = delete;

    // The job's interface to its Background.
    class Desk {
      public:
        Desk(State &state, std::stop_token stop) : state_(state), stop_(std::move(stop)) {}
        // The job should end soon, with the results it has.
        [[nodiscard]] bool stopped() const { return stop_.stop_requested(); }
        void publish(Result result) {
            auto shared = std::make_shared<const Result>(std::move(result));
            const std::scoped_lock lock(state_.mutex);
            state_.result = std::move(shared);
        }
        void set_done(double fraction) { state_.done = fraction; }

      private:
        State &state_;
        std::stop_token stop_;
    };

    // Asks the previous job to end, without waiting for it. A job that throws has failed; the
    // exception's text is kept.
    void start(std::function<void(Desk &)> work) {
        stop();
        std::erase_if(threads_, [](const Running &each) { return !each.state->running; });
        state_ = std::make_shared<State>();
        threads_.push_back(
            {state_, std::jthread([work = std::move(work), state = state_](std::stop_token stop) {
                 give_way_to_others();
                 if (stop.stop_requested()) // stopped before the thread got this far
                     hurry(pthread_self());
                 Desk desk(*state, std::move(stop));
                 try {
                     work(desk);
                 } catch (const std::exception &failure) {
                     const std::scoped_lock lock(state->mutex);
                     state->failure = failure.what();
                 }
                 state->running = false;
             })});
    }
    // Asks the job to end; its results stay.
    void stop() {
        if (threads_.empty())
            return;
        threads_.back().thread.request_stop();
        if (threads_.back().state->running)
            hurry(threads_.back().thread.native_handle());
    }
    // Stops the job and drops its results.
    void clear() {
        stop();
        state_.reset();
    }

    [[nodiscard]] bool running() const { return state_ && state_->running; }
    [[nodiscard]] double done() const { return state_ ? state_->done.load() : 0; }
    // The latest published result; null before the first.
    [[nodiscard]] std::shared_ptr<const Result> result() const {
        if (!state_)
            return nullptr;
        const std::scoped_lock lock(state_->mutex);
        return state_->result;
    }
    [[nodiscard]] std::string failure() const {
        if (!state_)
            return "";
        const std::scoped_lock lock(state_->mutex);
        return state_->failure;
    }

  private:
    std::shared_ptr<State> state_; // of the latest job
    struct Running {
        std::shared_ptr<State> state;
        std::jthread thread; // its destructor asks to stop and joins
    };
    std::vector<Running> threads_;
};

} // namespace plumb
