#include "app/lab/progress.h"

#include <chrono>
#include <sstream>
#include <string>
#include <thread>

#include <gtest/gtest.h>

namespace plumb {
namespace {

using namespace std::chrono_literals;

TEST(ProgressLine, SpeaksAfterTwoSecondsThoughNothingMoves) {
    std::ostringstream out;
    {
        ProgressLine line(out, false);
        line.show(0.25, "one long step");
        std::this_thread::sleep_for(1500ms);
        line.clear();
        EXPECT_EQ(out.str(), "");
        line.show(0.25, "one long step");
        std::this_thread::sleep_for(1s);
    }
    EXPECT_EQ(out.str(), "one long step, 25 % (6 s left)\n");
}

TEST(ProgressLine, IsSilentAfterClear) {
    std::ostringstream out;
    ProgressLine line(out, true);
    line.show(0, "reading");
    std::this_thread::sleep_for(2300ms);
    line.clear();
    const std::string before = out.str();
    EXPECT_NE(before.find("\rreading"), std::string::npos);
    EXPECT_TRUE(before.ends_with("\r       \r")) << before;
    std::this_thread::sleep_for(500ms);
    EXPECT_EQ(out.str(), before);
}

} // namespace
} // namespace plumb
