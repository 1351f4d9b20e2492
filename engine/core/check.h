// Checks in three grades.
//
//   PLUMB_CHECK(condition, message)         always: misuse by the caller (a NaN, a negative radius)
//   PLUMB_DEBUG_CHECK(condition, message)   debug builds only: our own invariants in hot code
//   PLUMB_RARELY(name, condition)           counts a numerical oddity; a test fails when it
//                                           is more frequent than stated
//
// `message` is streamed into an ostream and contains the offending value:
//   PLUMB_CHECK(radius > 0, "sphere radius must be positive, got " << radius);
// A failed check throws CheckFailure, so a program can report the error and lose nothing.
#pragma once

#include <atomic>
#include <cstdint>
#include <sstream>
#include <stdexcept>
#include <string>

namespace plumb {

class CheckFailure : public std::logic_error {
  public:
    using std::logic_error::logic_error;
};

[[noreturn]] void fail_check(const char *file, int line, const char *condition,
                             const std::string &message);

// How often an oddity was checked for, and how often it occurred. Thread-safe.
struct OddityCounter {
    std::atomic<std::uint64_t> looked{0};
    std::atomic<std::uint64_t> met{0};
};

// The counter with that name, created on first use; it lives as long as the program.
OddityCounter &oddity(const char *name);

} // namespace plumb

#define PLUMB_CHECK(condition, message)                                                            \
    do {                                                                                           \
        if (!(condition)) [[unlikely]] {                                                           \
            std::ostringstream plumb_check_stream;                                                 \
            plumb_check_stream << message;                                                         \
            ::plumb::fail_check(__FILE__, __LINE__, #condition, plumb_check_stream.str());         \
        }                                                                                          \
    } while (false)

#if defined(NDEBUG)
#define PLUMB_DEBUG_CHECK(condition, message) ((void)0)
#else
#define PLUMB_DEBUG_CHECK(condition, message) PLUMB_CHECK(condition, message)
#endif

// Evaluates to the condition, and counts it under `name`.
#define PLUMB_RARELY(name, condition)                                                              \
    ([&]() -> bool {                                                                               \
        static ::plumb::OddityCounter &plumb_counter = ::plumb::oddity(name);                      \
        plumb_counter.looked.fetch_add(1, std::memory_order_relaxed);                              \
        const bool plumb_met = (condition);                                                        \
        if (plumb_met)                                                                             \
            plumb_counter.met.fetch_add(1, std::memory_order_relaxed);                             \
        return plumb_met;                                                                          \
    }())
