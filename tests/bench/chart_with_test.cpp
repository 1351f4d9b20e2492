// Other engines on a scene file's chart are judged like ours.
#include "app/lab/chart/chart.h"
#include "app/lab/engines/other_engines.h"
#include "engine/scene/scene_file.h"
#include "tests/lab/chart/falling.h"

#include <map>

#include <gtest/gtest.h>

namespace plumb {
namespace {

SceneDesc scene(const std::string &path) {
    const SceneFileResult file = load_scene(std::string(PLUMB_SOURCE_DIR "/scenes/") + path);
    EXPECT_TRUE(file.ok()) << path;
    return file.scene;
}

TEST(ChartWith, BulletAndOdeKeepAStackOfTenBoxes) {
    ChartOptions options;
    options.methods = {"soft_step"};
    for (const OtherEngine &engine : other_engines())
        options.engines.push_back(&engine);
    ASSERT_FALSE(options.engines.empty());
    options.sweep = {parse_sweep("substeps=4")};
    options.repeats = 1;
    options.timed = 0.1;
    const SceneChart chart = chart_scene(scene("stacking/ten_box_stack.toml"), options);
    std::map<std::string_view, const ChartRun *> by_engine;
    for (const ChartRun &run : chart.runs)
        by_engine[run.resolved.method->name] = &run;
    for (const OtherEngine *engine : options.engines) {
        ASSERT_TRUE(by_engine.contains(engine->info.name)) << engine->info.name;
        const ChartRun &run = *by_engine[engine->info.name];
        EXPECT_TRUE(run.failure.empty()) << run.failure;
        EXPECT_TRUE(std::isfinite(run.error));
        EXPECT_GT(run.error, 0);
        EXPECT_GT(run.cost, 0);
        EXPECT_GT(run.constraint_passes, 0);
        // Ten boxes rest on each other: by our geometry they penetrate slightly.
        EXPECT_LT(run.run.max_penetration, 0.05) << engine->info.name;
    }
}

TEST(ChartWith, AFallIsTheSameInAll) {
    SceneDesc fall = falling_scene();
    ExpectDesc &expect = fall.expects.front();
    expect.quantity = "position.y";
    expect.value = -0.5 * 9.81;
    ChartOptions options;
    options.methods = {"semi_implicit_euler"};
    for (const OtherEngine &engine : other_engines())
        options.engines.push_back(&engine);
    options.sweep = {parse_sweep("dt=1/60,1/120")};
    options.repeats = 1;
    for (const ChartRun &run : chart_scene(fall, options).runs)
        // All three are semi-implicit: off by g dt t / 2.
        EXPECT_NEAR(run.error, 0.5 * 9.81 * run.resolved.settings.dt, 1e-4)
            << run.resolved.method->name;
}

TEST(ChartWith, SingleStepsAreTakenFromTheSameStates) {
    SceneDesc fall = falling_scene();
    fall.bodies[0].velocity = {1, 2, 3};
    fall.bodies[0].angular_velocity = {3, 2, 1};
    ChartOptions options;
    options.one_step = true;
    options.methods = {"semi_implicit_euler"};
    for (const OtherEngine &engine : other_engines())
        options.engines.push_back(&engine);
    options.sweep = {parse_sweep("substeps=1")};
    options.repeats = 1;
    const SceneChart chart = chart_scene(fall, options);
    EXPECT_EQ(chart.runs.size(), 1 + options.engines.size());
    // All three are semi-implicit: a step is off by g dt^2 / 2.
    for (const ChartRun &run : chart.runs)
        EXPECT_NEAR(run.error, 0.5 * 9.81 / 3600, 2e-5) << run.resolved.method->name;
}

} // namespace
} // namespace plumb
