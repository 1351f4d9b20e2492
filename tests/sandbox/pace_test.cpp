#include "app/sandbox/session/pace.h"

#include "app/sandbox/panels/widgets.h"
#include "app/sandbox/sandbox.h"
#include "tests/sandbox/fake_simulation.h"

#include <gtest/gtest.h>

namespace plumb {
namespace {

TEST(Pace, IsTheMeanOfTheLastHalfSecond) {
    Pace pace;
    for (int frame = 0; frame < 49; ++frame)
        pace.add(0.0101, 0.002);
    EXPECT_EQ(pace.frames_per_second(), 0); // not yet
    pace.add(0.0101, 0.002);
    EXPECT_NEAR(pace.frames_per_second(), 1 / 0.0101, 1e-9);
    EXPECT_NEAR(pace.of_real_time(), 0.002 / 0.0101, 1e-12);
    pace.add(0.3, 0);
    EXPECT_NEAR(pace.frames_per_second(), 1 / 0.0101, 1e-9);
    pace.add(0.3, 0.6);
    EXPECT_NEAR(pace.frames_per_second(), 2 / 0.6, 1e-9);
    EXPECT_NEAR(pace.of_real_time(), 1, 1e-12);
    pace.clear();
    EXPECT_EQ(pace.frames_per_second(), 0);
}

// Frames of a fifth of a second: at most max_catch_up steps of 1/60 s are caught up per frame.
TEST(Pace, TellsWhenTheWorldIsSlowerThanAsked) {
    Sandbox sandbox(Session({}, nullptr, make_fake()));
    ASSERT_TRUE(sandbox.open(two_balls()));
    for (int frame = 0; frame < 10; ++frame)
        sandbox.advance(200'000'000);
    const Fonts fonts;
    const Pace &pace = sandbox.panel_context(fonts).pace;
    EXPECT_NEAR(pace.frames_per_second(), 5, 1e-9);
    EXPECT_GT(pace.of_real_time(), 0);
    EXPECT_LE(pace.of_real_time(), StepClock::max_catch_up / 60.0 / 0.2 + 1e-9);
    sandbox.perform(Action::pause);
    sandbox.advance(200'000'000);
    EXPECT_EQ(pace.frames_per_second(), 0);
}

TEST(Duration, HasTheUnitThatSuits) {
    EXPECT_EQ(duration(2.5), "2.5 s");
    EXPECT_EQ(duration(1.254e-3), "1.25 ms");
    EXPECT_EQ(duration(999.7e-6), "1 ms");
    EXPECT_EQ(duration(3.4e-4), "340 µs");
    EXPECT_EQ(duration(8.52e-8), "85.2 ns");
    EXPECT_EQ(duration(0), "0 ns");
}

} // namespace
} // namespace plumb
