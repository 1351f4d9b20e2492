// States to step back to: how many are kept, in how much memory, and that each is unchanged.
#include "app/sandbox/session/history.h"

#include "engine/scene/scene_file.h"
#include "tests/sandbox/fake_simulation.h"

#include <string>

#include <gtest/gtest.h>

namespace plumb {
namespace {

std::unique_ptr<Simulation> simulation_of(const std::string &text) {
    const SceneFileResult result = parse_scene(text, "history.toml");
    EXPECT_TRUE(result.ok()) << format_message("history.toml", result.messages.front());
    return Simulation::create(result.scene, {}, nullptr);
}

// A thousand boxes lying around, plus `more`.
std::string boxes(const std::string &more) {
    return R"(title = "boxes"
[[body]]
name = "ground"
shape = "plane"
[[body]]
name = "box"
shape = "box"
half_extents = [0.2, 0.2, 0.2]
position = [0, 0.2, 0]
repeat = { kind = "grid", count = [40, 1, 25], spacing = [1, 1, 1] }
)" + more;
}

TEST(History, KeepsTheNewestStates) {
    FakeSimulation simulation(SceneDesc{});
    History history;
    for (std::size_t i = 0; i < History::most_states + 5; ++i) {
        history.remember(simulation);
        simulation.step();
    }
    EXPECT_EQ(history.size(), History::most_states);
    ASSERT_TRUE(history.recall(simulation));
    EXPECT_EQ(simulation.step_count(), History::most_states + 4);
}

TEST(History, KeepsWithinItsMemory) {
    FakeSimulation simulation(SceneDesc{});
    History history;
    for (const std::size_t bytes : {History::memory_limit / 10, History::memory_limit / 3,
                                    History::memory_limit * 2, History::memory_limit / 10}) {
        simulation.set_save_bytes(bytes);
        for (int i = 0; i < 30; ++i) {
            history.remember(simulation);
            simulation.step();
            ASSERT_GE(history.size(), 1U);
            ASSERT_TRUE(history.bytes() <= History::memory_limit || history.size() == 1);
        }
        EXPECT_EQ(history.size(), std::max<std::size_t>(History::memory_limit / bytes, 1));
        EXPECT_EQ(history.bytes(), history.size() * bytes);
    }
    while (history.recall(simulation)) {
    }
    EXPECT_EQ(history.bytes(), 0U);
}

// A minute at rest takes as much memory as a few of its states.
TEST(History, RestIsKeptOnce) {
    const std::unique_ptr<Simulation> simulation = simulation_of(boxes(""));
    while (simulation->step_count() < 120)
        simulation->step();
    History history;
    history.remember(*simulation);
    const std::size_t one = history.bytes();
    EXPECT_GT(one, 1000U * 100U);
    EXPECT_LE(one, 1001U * 300U); // bytes per resting body, including its contacts
    while (history.size() < History::most_states) {
        simulation->step();
        history.remember(*simulation);
    }
    EXPECT_LE(history.bytes(), 2 * one);
}

TEST(History, EachStateIsAsItWas) {
    const std::unique_ptr<Simulation> simulation = simulation_of(boxes(R"(
[[body]]
name = "ball"
shape = "sphere"
radius = 0.2
position = [0.1, 6, 0.1]
)"));
    while (simulation->step_count() < 50)
        simulation->step();
    History history;
    std::vector<std::uint64_t> hashes;
    for (int i = 0; i < 90; ++i) { // the ball falls, hits a box and wakes it
        history.remember(*simulation);
        hashes.push_back(simulation->hash());
        simulation->step();
    }
    for (; !hashes.empty(); hashes.pop_back()) {
        ASSERT_TRUE(history.recall(*simulation));
        ASSERT_EQ(simulation->hash(), hashes.back());
    }
    EXPECT_FALSE(history.recall(*simulation));
    EXPECT_EQ(history.bytes(), 0U);
}

} // namespace
} // namespace plumb
