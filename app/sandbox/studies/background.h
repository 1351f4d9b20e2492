// Work beside the play, on a thread of its own that gives way to all others.
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

// From now on the calling thread runs only where a processor would be idle.
void give_way_to_others();
// That thread runs as all do: what is waited for must not wait for others. A system may refuse it.
void hurry(std::jthread::native_handle_type thread);

// What is found is published piece by piece, and can be looked at at any time; one work at a time.
template <typename Result> class Background {
    struct State {
        std::mutex mutex; // of the two below
        std::shared_ptr<const Result> result;
        std::string failure;
        std::atomic<double> done = 0; // 0..1
        std::atomic<bool> running = true;
    };

  public:
    Background() = default;
    ~Background() { stop(); } // and waits, also for what was stopped before
    Background(Background &&) noexcept = default;
    Background &operator=(Background &&) noexcept = default;
    Background(const Background &) = delete;
    Background &operator=(const Background &) = delete;

    // What the work is given.
    class Desk {
      public:
        Desk(State &state, std::stop_token stop) : state_(state), stop_(std::move(stop)) {}
        // It is to end soon, with what there is.
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

    // What ran before is asked to end, and not waited for. A work that throws has failed, and its
    // exception's text is kept.
    void start(std::function<void(Desk &)> work) {
        stop();
        std::erase_if(threads_, [](const Running &each) { return !each.state->running; });
        state_ = std::make_shared<State>();
        threads_.push_back(
            {state_, std::jthread([work = std::move(work), state = state_](std::stop_token stop) {
                 give_way_to_others();
                 if (stop.stop_requested()) // meanwhile
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
    // Asks it to end, and keeps what it found.
    void stop() {
        if (threads_.empty())
            return;
        threads_.back().thread.request_stop();
        if (threads_.back().state->running)
            hurry(threads_.back().thread.native_handle());
    }
    // And forgets it.
    void clear() {
        stop();
        state_.reset();
    }

    [[nodiscard]] bool running() const { return state_ && state_->running; }
    [[nodiscard]] double done() const { return state_ ? state_->done.load() : 0; }
    // Of the last that was published; null before.
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
    std::shared_ptr<State> state_; // of the last
    struct Running {
        std::shared_ptr<State> state;
        std::jthread thread; // asks and waits when it goes
    };
    std::vector<Running> threads_;
};

} // namespace plumb
