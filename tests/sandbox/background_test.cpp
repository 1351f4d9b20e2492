#include "app/sandbox/studies/background.h"

#include "tests/sandbox/hurry.h"

#include <chrono>
#include <stdexcept>

#include <sched.h>

#include <gtest/gtest.h>

namespace plumb {
namespace {

using namespace std::chrono_literals;

TEST(Background, PublishesBitByBitAndGivesWay) {
    Background<int> background;
    EXPECT_EQ(background.result(), nullptr);
    std::atomic<bool> go_on = false;
    std::atomic<int> policy = -1;
    background.start([&](Background<int>::Desk &desk) {
        policy = sched_getscheduler(0);
        desk.publish(1);
        desk.set_done(0.5);
        while (!go_on)
            std::this_thread::sleep_for(1ms);
        desk.publish(2);
    });
    while (!background.result())
        std::this_thread::sleep_for(1ms);
    EXPECT_EQ(*background.result(), 1);
    EXPECT_TRUE(background.running());
    go_on = true;
    ASSERT_TRUE(wait_for(background));
    EXPECT_EQ(*background.result(), 2);
    EXPECT_EQ(background.done(), 0.5);
    EXPECT_EQ(policy, SCHED_IDLE);
    background.clear();
    EXPECT_EQ(background.result(), nullptr);
}

TEST(Background, IsReplacedWithoutWaitingAndEndsWhenAsked) {
    std::atomic<int> ended = 0;
    {
        Background<int> background;
        for (int i = 0; i < 3; ++i)
            background.start([&, i](Background<int>::Desk &desk) {
                desk.publish(i);
                while (!desk.stopped())
                    std::this_thread::sleep_for(1ms);
                desk.publish(-1); // nobody sees the results of replaced work
                ++ended;
            });
        while (!background.result())
            std::this_thread::sleep_for(1ms);
        EXPECT_EQ(*background.result(), 2);
        background.stop();
        ASSERT_TRUE(wait_for(background));
        EXPECT_EQ(*background.result(), -1);
    }
    EXPECT_EQ(ended, 3);
}

// On a busy machine, work that yields to everything else would never end.
TEST(Background, GivesWayNoMoreWhenItIsToEnd) {
    std::atomic<int> policy = SCHED_IDLE;
    Background<int> background;
    background.start([&](Background<int>::Desk &desk) {
        desk.publish(1);
        while (!desk.stopped())
            std::this_thread::sleep_for(1ms);
        for (int i = 0; i < 1000 && policy == SCHED_IDLE; ++i) {
            std::this_thread::sleep_for(1ms);
            policy = sched_getscheduler(0);
        }
    });
    while (!background.result())
        std::this_thread::sleep_for(1ms);
    background.stop();
    ASSERT_TRUE(wait_for(background));
    const sched_param none{}; // some systems let only root do this
    const bool may = sched_setscheduler(0, SCHED_IDLE, &none) == 0 &&
                     sched_setscheduler(0, SCHED_OTHER, &none) == 0;
    if (may) {
        EXPECT_EQ(policy, SCHED_OTHER);
    }
}

TEST(Background, KeepsWhyItFailed) {
    Background<int> background;
    background.start([](Background<int>::Desk &) { throw std::runtime_error("no luck"); });
    ASSERT_TRUE(wait_for(background));
    EXPECT_EQ(background.failure(), "no luck");
}

} // namespace
} // namespace plumb
