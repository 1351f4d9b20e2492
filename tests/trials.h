// How many random inputs or steps a test runs.
#pragma once

#include <cstdlib>

namespace plumb {

// `full` divided by the environment variable PLUMB_TRIALS_DIVISOR, which slow instrumented builds
// set; at least 1.
inline int trials(int full) {
    // NOLINTNEXTLINE(concurrency-mt-unsafe): nothing sets it while tests run
    const char *text = std::getenv("PLUMB_TRIALS_DIVISOR");
    const int divisor = text == nullptr ? 1 : std::atoi(text);
    return divisor > 1 && full > divisor ? full / divisor : full;
}

} // namespace plumb
