// A scene saved in the middle of a run and read again goes on with the same bits.
#include "engine/scene/scene_file.h"
#include "engine/scene/simulation.h"

#include <memory>
#include <string>

#include <gtest/gtest.h>

namespace plumb {
namespace {

std::unique_ptr<Simulation> simulation_of(const std::string &text, const RunOptions &options = {}) {
    const SceneFileResult result = parse_scene(text, "run.toml");
    EXPECT_TRUE(result.ok()) << format_message("run.toml", result.messages.front());
    return Simulation::create(result.scene, options, nullptr);
}

// Saves after every few steps, and compares the next ones.
void expect_same_when_read(Simulation &simulation, const std::string &what) {
    for (int save = 0; save < 8; ++save) {
        const auto read = simulation_of(write_scene(simulation.describe()));
        EXPECT_EQ(read->hash(), simulation.hash()) << what << ", save " << save;
        for (int i = 0; i < 20; ++i) {
            read->step();
            simulation.step();
            ASSERT_EQ(read->hash(), simulation.hash())
                << what << ", save " << save << ", step " << i;
        }
    }
}

constexpr const char *stack = R"([world]
[[body]]
name = "ground"
shape = "plane"
[[body]]
name = "crate"
shape = "box"
half_extents = [0.5, 0.4, 0.3]
position = [0, 0.4, 0]
repeat = { kind = "stack", count = 4 }
)";

// How long bodies have rested counts for soft_step even where nothing sleeps.
TEST(SavedRun, GoesOnWhereNothingSleeps) {
    GivenSettings awake;
    awake.give(&StepSettings::sleep_after, 0);
    const auto simulation = simulation_of(stack, {{}, awake, {}});
    expect_same_when_read(*simulation, "awake");
}

TEST(SavedRun, GoesOnWhenSubstepsAreFixedAndChosenAgain) {
    const auto simulation = simulation_of(stack);
    const int most = simulation->settings().max_substeps;
    for (const int max_substeps : {1, most, 1}) {
        StepSettings settings = simulation->settings();
        settings.max_substeps = max_substeps;
        simulation->set_settings(settings);
        expect_same_when_read(*simulation, std::to_string(max_substeps));
    }
}

TEST(SavedRun, GoesOnWithLockedAxesByEveryMethod) {
    constexpr const char *locked = R"([world]
[[body]]
name = "bracket"
shapes = [
    { shape = "box", half_extents = [0.2, 0.15, 0.3] },
    { shape = "box", half_extents = [0.2, 0.1, 0.3], position = [0.3, 0.1, 0] },
]
position = [0.5, 80, 0.2]
axis = [0.6, 0, 0.8]
angle_deg = 70
angular_velocity = [0.4, 0.3, 0.2]
locked = [LOCKED]
)";
    for (const char *axes : {"\"rotation_z\"", "\"rotation_x\", \"rotation_y\"", "\"x\""})
        for (const MethodInfo &method : method_infos()) {
            std::string text = locked;
            text.replace(text.find("LOCKED"), 6, axes);
            const auto simulation = simulation_of(text, {std::string(method.name), {}, {}});
            expect_same_when_read(*simulation, std::string(method.name) + ", " + axes);
        }
}

} // namespace
} // namespace plumb
