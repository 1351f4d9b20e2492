// How far long work has come, on a terminal or in a log.
#pragma once

#include <chrono>
#include <functional>
#include <ostream>
#include <string>

namespace plumb {

// Called with the fraction done (0..1) and what is being done.
using Progress = std::function<void(double fraction, const std::string &what)>;

// Prints progress: on a terminal one line that is rewritten up to ten times a second; elsewhere a
// line at most every ten seconds.
class ProgressLine {
  public:
    // `out` must outlive it.
    ProgressLine(std::ostream &out, bool terminal);
    ~ProgressLine(); // clears the line
    ProgressLine(const ProgressLine &) = delete;
    ProgressLine &operator=(const ProgressLine &) = delete;

    void show(double fraction, const std::string &what);
    // Clears the line, so that something else can be printed.
    void clear();

  private:
    std::ostream &out_;
    bool terminal_;
    std::size_t shown_ = 0; // characters on the line
    std::chrono::steady_clock::time_point start_;
    std::chrono::steady_clock::time_point last_;
};

// Whether standard error is a terminal.
[[nodiscard]] bool stderr_is_terminal();

} // namespace plumb
