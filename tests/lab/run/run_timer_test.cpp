// The parts of a run that are timed.
#include "app/lab/run/run_timer.h"

#include <gtest/gtest.h>

namespace plumb {
namespace {

TEST(RunTimer, PartsAreSpreadEvenlyOverTheRun) {
    const TimedParts parts = timed_parts(60, 2);
    ASSERT_EQ(parts.starts.size(), 8U);
    EXPECT_DOUBLE_EQ(parts.each, 0.25);
    for (std::size_t i = 0; i < parts.starts.size(); ++i)
        EXPECT_DOUBLE_EQ(parts.starts[i] + parts.each / 2, 60 * (static_cast<double>(i) + 0.5) / 8);
}

TEST(RunTimer, AShortRunIsTimedAsAWhole) {
    for (const double timed : {1.0, 2.0}) {
        const TimedParts parts = timed_parts(1, timed);
        ASSERT_EQ(parts.starts.size(), 1U);
        EXPECT_EQ(parts.starts[0], 0);
        EXPECT_EQ(parts.each, 1);
    }
}

} // namespace
} // namespace plumb
