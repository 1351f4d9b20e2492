// Progress of long work, on a terminal or in a log.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <ostream>
#include <string>
#include <thread>

namespace plumb {

// Called with the fraction done (0..1) and what is being done.
using Progress = std::function<void(double fraction, const std::string &what)>;

// Prints the progress of work that takes longer than two seconds, even within a single step: on a
// terminal one line, rewritten ten times a second; elsewhere a line every five seconds.
class ProgressLine {
  public:
    // `err` must outlive this. Checks for a terminal only if `err` is std::cerr.
    explicit ProgressLine(std::ostream &err);
    ProgressLine(std::ostream &err, bool terminal);
    ~ProgressLine(); // clears the line
    ProgressLine(const ProgressLine &) = delete;
    ProgressLine &operator=(const ProgressLine &) = delete;

    // From now until clear() it may print at any time from its own thread.
    void show(double fraction, std::string what);
    // Clears the line, so that something else can be printed.
    void clear();

  private:
    using Clock = std::chrono::steady_clock;

    void tick(const std::stop_token &stop);
    void print(Clock::time_point now);

    std::ostream &err_;
    const bool terminal_;
    const Clock::time_point start_ = Clock::now();
    std::mutex mutex_; // guards everything below
    std::condition_variable_any wake_;
    bool showing_ = false;
    double fraction_ = 0;
    std::string what_;
    std::size_t printed_ = 0; // characters on the line
    Clock::time_point next_ = start_ + std::chrono::seconds(2);
    std::jthread ticker_; // last: stops before the rest is destroyed
};

} // namespace plumb
