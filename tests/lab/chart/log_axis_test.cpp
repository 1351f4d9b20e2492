#include "app/lab/chart/log_axis.h"

#include "engine/core/random.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace plumb {
namespace {

TEST(LogAxis, RangeHoldsAllPositiveValuesAndAtLeastADecade) {
    const LogRange range = log_range({0.002, 5, 0, -3, INFINITY, NAN});
    EXPECT_LT(range.low, 0.002);
    EXPECT_GT(range.high, 5);
    const LogRange narrow = log_range({3, 3.1});
    EXPECT_GE(narrow.high / narrow.low, 10);
    EXPECT_LT(narrow.low, 3);
    EXPECT_GT(narrow.high, 3.1);
    const LogRange none = log_range({0, -1});
    EXPECT_EQ(none.low, 1);
    EXPECT_EQ(none.high, 10);
    const LogRange extreme = log_range({std::numeric_limits<double>::denorm_min(), 1e308});
    EXPECT_GT(extreme.low, 0);
    EXPECT_TRUE(std::isfinite(extreme.high));
}

TEST(LogAxis, PositionIsTheLogarithm) {
    const LogRange range{0.1, 1000};
    EXPECT_DOUBLE_EQ(log_position(range, 0.1), 0);
    EXPECT_DOUBLE_EQ(log_position(range, 10), 0.5);
    EXPECT_DOUBLE_EQ(log_position(range, 1000), 1);
}

TEST(LogAxis, TicksOfOneDecade) {
    const std::vector<Tick> ticks = log_ticks({1, 10}, "m");
    ASSERT_EQ(ticks.size(), 10U);
    for (std::size_t i = 0; i < 10; ++i)
        EXPECT_EQ(ticks[i].value, static_cast<double>(i + 1));
    EXPECT_TRUE(ticks[0].decade);
    EXPECT_TRUE(ticks[9].decade);
    EXPECT_FALSE(ticks[4].decade);
    EXPECT_EQ(ticks[0].label, "1 m");
    EXPECT_EQ(ticks[1].label, "2 m");
    EXPECT_EQ(ticks[2].label, "");
    EXPECT_EQ(ticks[4].label, "5 m");
    EXPECT_EQ(ticks[9].label, "10 m");
}

TEST(LogAxis, TicksAscendLieInTheRangeAndAreLabelledSparingly) {
    Random random(11);
    for (int trial = 0; trial < 500; ++trial) {
        const double low = std::pow(10, random.next_in(-12, 6));
        const LogRange range = log_range({low, low * std::pow(10, random.next_in(0, 14))});
        const std::vector<Tick> ticks = log_ticks(range, "m", 10);
        int labels = 0;
        for (std::size_t i = 0; i < ticks.size(); ++i) {
            ASSERT_GE(ticks[i].value, range.low);
            ASSERT_LE(ticks[i].value, range.high);
            if (i > 0) {
                ASSERT_LT(ticks[i - 1].value, ticks[i].value);
            }
            labels += ticks[i].label.empty() ? 0 : 1;
        }
        // A range of d decades holds at most d + 1 powers of ten, or 3 d + 1 ticks with 2s and 5s.
        ASSERT_LE(labels, 11);
        ASSERT_GE(labels, 2);
    }
}

TEST(LogAxis, ShortQuantities) {
    EXPECT_EQ(short_quantity(0.00002, "m"), "20 µm");
    EXPECT_EQ(short_quantity(0.005, "s"), "5 ms");
    EXPECT_EQ(short_quantity(1, "s"), "1 s");
    EXPECT_EQ(short_quantity(100, "s"), "100 s");
    EXPECT_EQ(short_quantity(1000, "J"), "1 kJ");
    EXPECT_EQ(short_quantity(999.9, "J"), "1 kJ"); // three digits
    EXPECT_EQ(short_quantity(-0.25, "m/s"), "−250 mm/s");
    EXPECT_EQ(short_quantity(0, "m"), "0 m");
    EXPECT_EQ(short_quantity(0.02, "1"), "0.02");
    EXPECT_EQ(short_quantity(300, "1"), "300");
    EXPECT_EQ(short_quantity(1e-5, "1"), std::string("10") + raised_from + "−5");
    EXPECT_EQ(short_quantity(2e6, "1"), std::string("2×10") + raised_from + "6");
    EXPECT_EQ(short_quantity(0, "1"), "0");
    EXPECT_EQ(short_quantity(INFINITY, "m"), "∞");
}

} // namespace
} // namespace plumb
