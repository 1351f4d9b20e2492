// Ctrl-C and SIGTERM as polite requests.
#pragma once

#include <csignal>

namespace plumb {

// While one lives, the first SIGINT or SIGTERM is only noted, and the next of the same kind ends
// the program as usual. One at a time.
class InterruptGuard {
  public:
    InterruptGuard();
    ~InterruptGuard();
    InterruptGuard(const InterruptGuard &) = delete;
    InterruptGuard &operator=(const InterruptGuard &) = delete;

    [[nodiscard]] static bool requested();
    // 128 and the signal's number, as shells have it; 0 when nothing was requested.
    [[nodiscard]] static int exit_code();

  private:
    struct sigaction previous_interrupt_ {};
    struct sigaction previous_terminate_ {};
};

} // namespace plumb
