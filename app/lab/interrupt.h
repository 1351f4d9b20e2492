// Ctrl-C as a polite request.
#pragma once

#include <csignal>

namespace plumb {

// While one lives, the first SIGINT is only noted, and the next ends the program as usual. One at a
// time.
class InterruptGuard {
  public:
    InterruptGuard();
    ~InterruptGuard();
    InterruptGuard(const InterruptGuard &) = delete;
    InterruptGuard &operator=(const InterruptGuard &) = delete;

    [[nodiscard]] static bool requested();

  private:
    struct sigaction previous_ {};
};

} // namespace plumb
