// The output of `plumb bench scenes`, read back.
#include "engine/scene/scene_file.h"
#include "tests/app/program.h"
#include "tests/bench/bench_scenes.h"
#include "tests/bench/benches.h"

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

} // namespace
} // namespace plumb
