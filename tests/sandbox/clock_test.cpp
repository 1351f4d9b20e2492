#include "app/sandbox/session/clock.h"

#include "engine/core/check.h"
#include "engine/core/random.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace plumb {
namespace {

constexpr std::int64_t second = 1'000'000'000;

// However the time is split into frames, the step count is what fits into the total time.
TEST(Clock, CountsStepsByTheWholeTimeNotByFrames) {
    for (const double dt : {1.0 / 60, 1.0 / 144, 0.01, 1.0 / 1920}) {
        Random random(7);
        StepClock clock(dt);
        std::int64_t passed = 0;
        std::int64_t steps = 0;
        // Frames too short ever to hit the cap.
        const auto longest = static_cast<std::uint32_t>(dt * 1e9 * StepClock::max_catch_up);
        for (int frame = 0; frame < 200'000; ++frame) {
            const std::int64_t duration = random.next_index(longest) + 1;
            passed += duration;
            steps += clock.advance(duration);
            // In exact arithmetic floor(passed / dt). The product in doubles may round across an
            // integer, which is one step late or early at that very nanosecond.
            ASSERT_NEAR(static_cast<double>(steps), static_cast<double>(passed) * 1e-9 / dt - 0.5,
                        0.5 + 1e-6);
        }
    }
}

TEST(Clock, OneFrameAStepGivesOneStepAFrame) {
    StepClock clock(0.01);
    for (int frame = 0; frame < 100'000; ++frame)
        ASSERT_EQ(clock.advance(10'000'000), 1);
}

TEST(Clock, DropsWhatItCannotCatchUpWith) {
    StepClock clock(1.0 / 60);
    EXPECT_EQ(clock.advance(10 * second), StepClock::max_catch_up);
    // None of the ten seconds is owed afterwards.
    EXPECT_EQ(clock.advance(second / 60 / 2), 0);
    EXPECT_EQ(clock.advance(second / 60 / 2 + 10), 1);
}

// If steps take longer than the time they simulate, the clock must not ask for ever more of them.
TEST(Clock, NoSpiralOfDeath) {
    StepClock clock(1.0 / 60);
    std::int64_t frame = second / 60;
    for (int i = 0; i < 1000; ++i) {
        const int steps = clock.advance(frame);
        ASSERT_LE(steps, StepClock::max_catch_up);
        frame = std::max<std::int64_t>(1, steps) * (second / 10); // each step takes 100 ms
    }
    EXPECT_LE(frame, StepClock::max_catch_up * (second / 10));
}

TEST(Clock, SpeedScalesStepsAndKeepsTheFraction) {
    StepClock clock(0.1);
    EXPECT_EQ(clock.advance(50'000'000), 0); // half a step has passed
    clock.set_speed(2);
    EXPECT_NEAR(clock.alpha(), 0.5, 1e-12);
    EXPECT_EQ(clock.advance(24'000'000), 0); // 0.98
    EXPECT_EQ(clock.advance(2'000'000), 1);  // 1.02
    clock.set_speed(1e9);
    EXPECT_EQ(clock.speed(), StepClock::max_speed);
    clock.set_speed(0);
    EXPECT_EQ(clock.speed(), StepClock::min_speed);
}

TEST(Clock, AFastClockMayCatchUpMore) {
    StepClock clock(1.0 / 60);
    clock.set_speed(16);
    // A frame of 1/60 s at 16 times the speed is 16 steps: more than max_catch_up, none dropped.
    int steps = 0;
    for (int frame = 0; frame < 60; ++frame)
        steps += clock.advance(second / 60);
    EXPECT_NEAR(steps, 960, 1);
}

TEST(Clock, AlphaIsTheFractionOfAStep) {
    StepClock clock(0.1);
    EXPECT_EQ(clock.alpha(), 0);
    EXPECT_EQ(clock.advance(25'000'000), 0);
    EXPECT_NEAR(clock.alpha(), 0.25, 1e-12);
    EXPECT_EQ(clock.advance(100'000'000), 1);
    EXPECT_NEAR(clock.alpha(), 0.25, 1e-12);
}

TEST(Clock, PausedItCountsNothingAndShowsTheStateItself) {
    StepClock clock(0.1);
    EXPECT_EQ(clock.advance(50'000'000), 0);
    clock.set_paused(true);
    EXPECT_EQ(clock.alpha(), 1);
    EXPECT_EQ(clock.advance(10 * second), 0);
    clock.set_paused(false);
    EXPECT_EQ(clock.advance(99'000'000), 0); // the half step from before is not owed
    EXPECT_EQ(clock.advance(2'000'000), 1);
}

TEST(Clock, TimeThatGoesBackwardsIsNone) {
    StepClock clock(0.1);
    EXPECT_EQ(clock.advance(-second), 0);
    EXPECT_EQ(clock.alpha(), 0);
}

TEST(Clock, RefusesAStepOfNoLength) {
    EXPECT_THROW(StepClock(0.0), CheckFailure);
    StepClock clock(0.1);
    EXPECT_THROW(clock.set_dt(-1), CheckFailure);
}

// How far a spring of 20 rad/s swings in 20 s of its own time, released 1 m from rest, with
// semi-implicit Euler, which is stable up to w dt = 2.
double greatest_swing(double dt, int steps) {
    double x = 1;
    double v = 0;
    double greatest = 1;
    for (int i = 0; i < steps; ++i) {
        v -= 400 * x * dt;
        x += v * dt;
        greatest = std::max(greatest, std::abs(x));
    }
    return greatest;
}

// Clocks that stretch their steps for a higher rate fail here: at eight times the speed w dt is
// 2.7, and the spring explodes. This one takes more steps, and the motion is the same.
TEST(Clock, TakesMoreStepsAtAHigherSpeedNotLargerOnes) {
    constexpr double dt = 1.0 / 60;
    EXPECT_GT(greatest_swing(8 * dt, 150), 1e6);

    StepClock clock(dt);
    clock.set_speed(8);
    int steps = 0;
    for (int frame = 0; frame < 150; ++frame)
        steps += clock.advance(second / 60);
    EXPECT_NEAR(steps, 1200, 1);
    EXPECT_EQ(clock.dt(), dt);
    EXPECT_LT(greatest_swing(clock.dt(), steps), 1.1);
}

} // namespace
} // namespace plumb
