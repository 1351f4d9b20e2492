// Ctrl-C and SIGTERM as polite requests.
#pragma once

#include <csignal>

namespace plumb {

// While a guard exists, the first SIGINT or SIGTERM is only recorded; the next of the same kind
// ends the program as usual. One guard at a time.
class InterruptGuard {
  public:
    InterruptGuard();
    ~InterruptGuard();
    InterruptGuard(const InterruptGuard &) = delete;
    InterruptGuard &operator=(const InterruptGuard &) = delete;

    [[nodiscard]] static bool requested();
    // 128 plus the signal number, the shell convention; 0 if nothing was requested.
    [[nodiscard]] static int exit_code();

  private:
    struct sigaction previous_interrupt_ {};
    struct sigaction previous_terminate_ {};
};

} // namespace plumb
