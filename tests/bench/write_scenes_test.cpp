// The output of `plumb bench scenes` and `plumb bench problems`, read back.
#include "engine/scene/scene_file.h"
#include "tests/app/program.h"
#include "tests/bench/bench_scenes.h"
#include "tests/bench/benches.h"
#include "tests/bench/truth.h"

#include <filesystem>
#include <stdexcept>

#include <gtest/gtest.h>

namespace plumb {
namespace {

TEST(BenchSceneFiles, AreTheScenesThatAreTimed) {
    const TemporaryFolder folder;
    EngineBenchOptions options;
    options.size = 0.01;
    options.out_dir = folder.path() / "scenes";
    ASSERT_EQ(bench_scene_files(options), ExitCode::fine);
    for (const BenchScene &one : bench_scenes()) {
        const SceneDesc timed = one.make(options.size);
        const SceneFileResult read = load_scene(options.out_dir / (one.name + ".toml"));
        ASSERT_TRUE(read.ok()) << one.name;
        EXPECT_EQ(read.scene.bodies.size(), timed.bodies.size()) << one.name;
        EXPECT_EQ(read.scene.joints.size(), timed.joints.size()) << one.name;
        EXPECT_EQ(read.scene.expects.size(), timed.joints.empty() ? 1U : 2U) << one.name;
        for (std::size_t i = 0; i < timed.bodies.size() && i < read.scene.bodies.size(); ++i)
            EXPECT_EQ(read.scene.bodies[i].position, timed.bodies[i].position) << one.name;
    }
}

TEST(BenchSceneFiles, OfANameThatIsNoScenesAreNotWritten) {
    const TemporaryFolder folder;
    EngineBenchOptions options;
    options.only = {"drums"};
    options.out_dir = folder.path() / "scenes";
    EXPECT_THROW(bench_scene_files(options), std::invalid_argument);
    EXPECT_FALSE(std::filesystem::exists(options.out_dir));
}

// All but the large nets and pyramids, which take the longest to read.
TEST(BenchProblemFiles, AreScenesThatCanBeRun) {
    const TemporaryFolder folder;
    EngineBenchOptions options;
    options.out_dir = folder.path() / "problems";
    for (const Problem &problem : all_problems())
        if (!problem.name.starts_with("pyramid") && !problem.name.starts_with("pile") &&
            problem.name != "net_40")
            options.only.push_back(problem.name);
    ASSERT_EQ(bench_problem_files(options), ExitCode::fine);
    for (const std::string &name : options.only) {
        const SceneFileResult read = load_scene(options.out_dir / (name + ".toml"));
        ASSERT_TRUE(read.ok()) << name;
        EXPECT_EQ(read.scene.title, name);
        EXPECT_FALSE(read.scene.description.empty()) << name;
        const auto simulation = Simulation::create(read.scene, {}, nullptr);
        EXPECT_EQ(simulation->settings().sleep_after, 0) << name;
        simulation->step();
    }
    const SceneFileResult passing = load_scene(options.out_dir / "passing_fast.toml");
    ASSERT_EQ(passing.scene.bodies.size(), 2U);
    EXPECT_EQ(passing.scene.bodies[1].velocity, glm::dvec3(50, 0, 0));
    EXPECT_NEAR(passing.scene.bodies[1].position.y, 0.6, 1e-12);
}

} // namespace
} // namespace plumb
