// Running particles, springs and cloth: saved and loaded, recorded and replayed, grabbed, torn.
#include "engine/scene/recording.h"
#include "engine/scene/scene_file.h"
#include "engine/scene/simulation.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace plumb {
namespace {

constexpr const char *scene_text = R"([world]
dt = "1/120"
precision = "PRECISION"
[[material]]
name = "silk"
friction = 0.3
[[body]]
name = "ground"
shape = "plane"
[[body]]
name = "ball"
shape = "sphere"
radius = 0.3
position = [0, 1.5, 0]
[[body]]
name = "weight"
shape = "box"
half_extents = [0.1, 0.2, 0.1]
mass = 1
position = [3, 1, 0]
rotation_deg = [10, 0, 30]
[[particle]]
name = "bob"
position = [3, 2, 0.5]
mass = 0.5
material = "silk"
[[particle]]
name = "nail"
position = [2, 3, 0]
pinned = true
[[cloth]]
name = "sheet"
cells = [8, 6]
size = [2, 1.5]
position = [0, 1.1, 0]
pins = "corners"
material = "silk"
tear_strain = 0.05
stretch = 100
[[spring]]
name = "upper"
a = "nail"
b = "bob"
frequency = 2
damping_ratio = 0.1
[[spring]]
name = "lower"
a = "bob"
b = "weight"
anchor_b_local = [0, 0.2, 0]
stiffness = 300
damping = 1
[[spring]]
name = "string"
a = "sheet[4,0]"
anchor_b = [0, 2, -1]
stiffness = 20
[[expect]]
name = "e"
quantity = "strain"
spring = "lower"
to = 1
at_most = 9
source = "none"
)";

SceneDesc scene(const std::string &precision = "float") {
    std::string text = scene_text;
    text.replace(text.find("PRECISION"), 9, precision);
    const SceneFileResult result = parse_scene(text, "soft.toml");
    for (const SceneMessage &message : result.messages)
        ADD_FAILURE() << format_message("soft.toml", message);
    return result.scene;
}

std::unique_ptr<Simulation> run(const SceneDesc &of, int steps) {
    auto simulation = Simulation::create(of, {}, nullptr);
    for (int i = 0; i < steps; ++i)
        simulation->step();
    return simulation;
}

std::size_t torn_springs(const Simulation &simulation) {
    std::size_t count = 0;
    for (const std::uint8_t torn : simulation.read().torn)
        count += torn;
    return count;
}

// Saved to a file after any step and read back, it goes on bit for bit.
TEST(SoftSimulation, GoesOnTheSameFromASavedFile) {
    for (const char *precision : {"float", "double"}) {
        const auto simulation = run(scene(precision), 60);
        EXPECT_GT(torn_springs(*simulation), 0U);
        const std::string text = write_scene(simulation->describe());
        const SceneFileResult read = parse_scene(text, "soft.toml");
        ASSERT_TRUE(read.ok()) << format_message("soft.toml", read.messages.front());
        const auto again = Simulation::create(read.scene, {}, nullptr);
        EXPECT_EQ(again->hash(), simulation->hash());
        EXPECT_EQ(write_scene(again->describe()), text);
        for (int i = 0; i < 60; ++i) {
            simulation->step();
            again->step();
        }
        EXPECT_EQ(again->hash(), simulation->hash());
        EXPECT_EQ(torn_springs(*again), torn_springs(*simulation));
    }
}

TEST(SoftSimulation, FrameSaysWhereParticlesAre) {
    const auto simulation = Simulation::create(scene(), {}, nullptr);
    const SoftParts &parts = simulation->soft_parts();
    const Frame frame = simulation->read();
    ASSERT_EQ(frame.particles.size(), 2U + 9 * 7);
    ASSERT_EQ(frame.torn.size(), parts.springs.size());
    EXPECT_EQ(frame.particles[*parts.find_particle("bob")].position, glm::dvec3(3, 2, 0.5));
    const std::size_t corner = *parts.find_particle("sheet[8,6]");
    EXPECT_LT(glm::distance(frame.particles[corner].position, glm::dvec3(1, 1.1, 0.75)), 1e-6);
    EXPECT_EQ(parts.particle_name(corner), "sheet[8,6]");
    EXPECT_TRUE(parts.particles[corner].pinned);
}

TEST(SoftSimulation, SpringsGoWithTheirBody) {
    const auto simulation = run(scene(), 10);
    simulation->apply(RemoveBody{"weight"});
    EXPECT_EQ(simulation->read().torn[*simulation->soft_parts().find_spring("lower")], 1);
    const SceneDesc left = simulation->describe();
    EXPECT_EQ(left.springs.size(), 2U);
    EXPECT_TRUE(left.expects.empty()); // its spring is gone
    const SceneFileResult read = parse_scene(write_scene(left), "soft.toml");
    ASSERT_TRUE(read.ok()) << format_message("soft.toml", read.messages.front());
    const auto again = Simulation::create(read.scene, {}, nullptr);
    EXPECT_EQ(again->hash(), simulation->hash());
    again->step();
    simulation->step();
    EXPECT_EQ(again->hash(), simulation->hash());
}

TEST(SoftSimulation, NamesOfParticlesAndClothsAreTaken) {
    const auto simulation = Simulation::create(scene(), {}, nullptr);
    EXPECT_EQ(simulation->free_name("bob"), "bob_2");
    EXPECT_EQ(simulation->free_name("sheet"), "sheet_2");
    BodyDesc body;
    body.name = "bob";
    body.colliders.emplace_back();
    EXPECT_THROW(simulation->apply(AddBody{body}), std::invalid_argument);
}

// A grabbed particle comes to its target, and the recording replays bit for bit from a file.
TEST(SoftSimulation, GrabIsRecorded) {
    const auto simulation = Simulation::create(scene(), {}, nullptr);
    Recorder recorder(*simulation);
    const auto apply = [&](const Command &command) {
        simulation->apply(command);
        recorder.add(*simulation, command);
    };
    const glm::dvec3 target(0.3, 2.2, 0.4);
    for (int step = 0; step < 180; ++step) {
        if (step == 5)
            apply(GrabParticle{"sheet[4,3]", {0.5, 2, 0}, 500});
        if (step == 10)
            apply(MoveGrab{target});
        if (step == 170)
            apply(ReleaseGrab{});
        if (step == 169) {
            const std::size_t held = *simulation->soft_parts().find_particle("sheet[4,3]");
            EXPECT_LT(glm::distance(simulation->read().particles[held].position, target), 0.3);
        }
        recorder.before_step(*simulation);
        simulation->step();
    }
    const std::string text = write_recording(recorder.recording(*simulation));
    const RecordingResult read = parse_recording(text, "soft.toml");
    ASSERT_TRUE(read.ok()) << format_message("soft.toml", read.messages.front());
    const auto again = Simulation::create(read.recording.scene, {}, nullptr);
    Replay replay(read.recording);
    while (true) {
        ASSERT_TRUE(replay.obey(*again)) << replay.difference(*again);
        if (replay.is_at_end(*again))
            break;
        again->step();
    }
    EXPECT_EQ(again->hash(), simulation->hash());
    EXPECT_THROW(simulation->apply(GrabParticle{"sheet[9,0]", {}, 1}), std::invalid_argument);
}

TEST(SoftSimulation, MethodsSayWhatTheyCannotRun) {
    SceneDesc soft = scene();
    for (const MethodInfo &method : method_infos()) {
        const std::string why = why_not(method, soft);
        EXPECT_EQ(why.empty(), method.springs && method.contacts) << method.name << ": " << why;
    }
    soft.bodies.clear();
    soft.springs.clear();
    soft.expects.clear();
    for (const MethodInfo &method : method_infos())
        EXPECT_EQ(why_not(method, soft).empty(), method.springs) << method.name;
}

// Particles under gravity alone fall correctly, whatever their mass, with every method.
TEST(SoftSimulation, LooseParticlesFall) {
    const SceneDesc falling =
        parse_scene("[world]\nprecision = \"double\"\ndt = \"1/1000\"\n[[particle]]\nname = "
                    "\"p\"\nvelocity = [1, 2, 0]\n",
                    "s")
            .scene;
    for (const MethodInfo &method : method_infos()) {
        if (!why_not(method, falling).empty())
            continue;
        RunOptions options;
        options.method = std::string(method.name);
        const auto simulation = Simulation::create(falling, options, nullptr);
        for (int i = 0; i < 1000; ++i)
            simulation->step();
        const ParticleState p = simulation->read().particles.at(0);
        EXPECT_NEAR(p.position.x, 1, 1e-9) << method.name;
        EXPECT_NEAR(p.position.y, 2 - 0.5 * 9.81, 6e-3) << method.name; // g dt / 2 at first order
        EXPECT_NEAR(p.velocity.y, 2 - 9.81, 1e-9) << method.name;
    }
}

} // namespace
} // namespace plumb
