#include "engine/core/check.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <thread>
#include <vector>

namespace plumb {
namespace {

std::string message_of(double radius) {
    try {
        PLUMB_CHECK(radius > 0, "radius must be positive, got " << radius << " m");
    } catch (const CheckFailure &failure) {
        return failure.what();
    }
    return {};
}

TEST(Check, PassesInSilence) {
    EXPECT_EQ(message_of(1.0), "");
}

TEST(Check, SaysValueConditionAndPlace) {
    const std::string text = message_of(-2.5);
    EXPECT_NE(text.find("radius must be positive, got -2.5 m"), std::string::npos) << text;
    EXPECT_NE(text.find("`radius > 0`"), std::string::npos) << text;
    EXPECT_NE(text.find("check_test.cpp:15"), std::string::npos) << text;
}

TEST(Check, NaNFailsAComparison) {
    EXPECT_NE(message_of(std::numeric_limits<double>::quiet_NaN()), "");
}

TEST(Check, IsOneStatement) {
    bool reached = false;
    if (false)
        PLUMB_CHECK(false, "not reached");
    else
        reached = true;
    EXPECT_TRUE(reached);
}

TEST(Check, MessageIsMadeOnlyOnFailure) {
    int made = 0;
    const auto make = [&] { return ++made; };
    PLUMB_CHECK(true, make());
    EXPECT_EQ(made, 0);
    EXPECT_THROW(PLUMB_CHECK(false, make()), CheckFailure);
    EXPECT_EQ(made, 1);
}

TEST(Check, DebugCheckIsThereInDebugBuildsOnly) {
#if defined(NDEBUG)
    EXPECT_NO_THROW(PLUMB_DEBUG_CHECK(false, "never looked at"));
#else
    EXPECT_THROW(PLUMB_DEBUG_CHECK(false, "looked at"), CheckFailure);
#endif
}

TEST(Rarely, GivesTheConditionAndCountsIt) {
    int odd = 0;
    for (int i = 0; i < 100; ++i)
        odd += PLUMB_RARELY("check_test.every_tenth", i % 10 == 0) ? 1 : 0;
    EXPECT_EQ(odd, 10);
    EXPECT_EQ(oddity("check_test.every_tenth").looked, 100U);
    EXPECT_EQ(oddity("check_test.every_tenth").met, 10U);
    EXPECT_EQ(oddity("check_test.never_met").looked, 0U);
}

TEST(Rarely, CountsFromManyThreads) {
    {
        std::vector<std::jthread> threads;
        threads.reserve(4);
        for (int t = 0; t < 4; ++t)
            threads.emplace_back([] {
                for (int i = 0; i < 1000; ++i)
                    PLUMB_RARELY("check_test.threads", i % 2 == 0);
            });
    }
    EXPECT_EQ(oddity("check_test.threads").looked, 4000U);
    EXPECT_EQ(oddity("check_test.threads").met, 2000U);
}

} // namespace
} // namespace plumb
