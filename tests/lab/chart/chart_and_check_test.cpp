// A chart calls a run fine exactly when `check` finds it within tolerance.
#include "app/lab/chart/chart.h"
#include "app/lab/run/check.h"

#include "engine/core/random.h"
#include "engine/scene/expect.h"
#include "engine/scene/scene_file.h"
#include "tests/lab/chart/falling.h"
#include "tests/trials.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

namespace plumb {
namespace {

SceneDesc scene(const std::string &path) {
    const SceneFileResult file = load_scene(std::string(PLUMB_SOURCE_DIR "/scenes/") + path);
    EXPECT_TRUE(file.ok()) << path;
    return file.scene;
}

RunOptions options_of(const ChartRun &run) {
    RunOptions options;
    options.method = std::string(run.resolved.method->name);
    for (const SettingNumber number : setting_numbers())
        options.settings.give(number, setting_value(run.resolved.settings, number));
    return options;
}

void expect_agreement(const SceneChart &chart) {
    for (const ChartRun &run : chart.runs) {
        const CheckOutcome checked = check_scene(chart.scene, options_of(run), nullptr);
        const std::string which = chart.scene.name + ", " + std::string(run.resolved.method->name) +
                                  " " + std::to_string(run.resolved.settings.substeps) + "x" +
                                  std::to_string(run.resolved.settings.iterations) + ": " +
                                  std::string(status_name(run.status));
        EXPECT_EQ(run.status == ChartStatus::fine, exit_code(checked) == ExitCode::fine) << which;
        EXPECT_EQ(run.status == ChartStatus::diverged, exit_code(checked) == ExitCode::diverged)
            << which;
        if (run.pareto) {
            EXPECT_EQ(run.status, ChartStatus::fine) << which;
        }
        if (chart.measure.limit && run.status != ChartStatus::diverged &&
            chart.measure.kind == ErrorMeasure::Kind::worst) {
            EXPECT_EQ(run.error <= *chart.measure.limit, exit_code(checked) == ExitCode::fine)
                << which << " " << run.error;
        }
    }
}

struct Case {
    const char *name, *scene, *method, *substeps, *iterations;
};

class ChartAndCheck : public testing::TestWithParam<Case> {};

TEST_P(ChartAndCheck, Agree) {
    ChartOptions options;
    options.methods = {GetParam().method};
    options.sweep = {parse_sweep(GetParam().substeps), parse_sweep(GetParam().iterations)};
    options.repeats = 1;
    options.timed = 0.05;
    const SceneChart chart = chart_scene(scene(GetParam().scene), options);
    ASSERT_EQ(chart.runs.size(), chart.planned);
    expect_agreement(chart);
}

// Settings where a chart that used only the first expectation disagreed with `check`.
INSTANTIATE_TEST_SUITE_P(Settings, ChartAndCheck,
                         testing::Values(Case{"ten_boxes", "stacking/ten_box_stack.toml",
                                              "sequential_impulses", "substeps=4,8",
                                              "iterations=2"},
                                         Case{"heavy_chain", "joints/heavy_chain.toml",
                                              "sequential_impulses", "substeps=4", "iterations=8"},
                                         Case{"pyramid", "stacking/pyramid.toml", "soft_step",
                                              "substeps=2", "iterations=1"},
                                         Case{"cradle", "joints/newtons_cradle.toml", "soft_step",
                                              "substeps=1", "iterations=1"}),
                         [](const auto &each) { return std::string(each.param.name); });

// Free fall against random expectations close to the actual result: about half are missed.
TEST(ChartAndCheck, AgreeOnAnythingThatABallIsHeldTo) {
    Random random(11);
    int fine = 0, outside = 0;
    const int rounds = std::max(20, trials(60));
    for (int round = 0; round < rounds; ++round) {
        SceneDesc scene;
        scene.name = "ball";
        BodyDesc ball;
        ball.name = "ball";
        ball.colliders.emplace_back().shape = SphereDesc{0.5};
        ball.velocity = {1, 4, 0};
        scene.bodies.push_back(ball);
        for (int i = 0; i < 2; ++i) {
            ExpectDesc expect;
            expect.name = std::to_string(i);
            expect.body = "ball";
            constexpr std::array quantities{"position.y", "velocity.y", "displacement", "speed"};
            constexpr std::array reductions{"last", "min", "max", "mean", "drift", "crossings"};
            expect.quantity = quantities[random.next_index(quantities.size())];
            expect.reduce = reductions[random.next_index(reductions.size())];
            expect.to = random.next_in(0.2, 0.7);
            expect.relation = static_cast<ExpectDesc::Relation>(random.next_index(3));
            expect.value = random.next_index(8) == 0 ? 0 : random.next_in(-2, 5);
            if (expect.relation == ExpectDesc::Relation::equals)
                expect.tolerance = random.next_in(0.1, 5);
            if (expect.tolerance > 0 && find_reduction(expect.reduce)->of_distance &&
                random.next_index(2) == 0) {
                expect.value = 0;
                for (int value = 0; value < 6; ++value)
                    expect.curve.push_back(random.next_in(-2, 5));
            }
            scene.expects.push_back(expect);
        }
        ChartOptions options;
        options.sweep = {parse_sweep("substeps=1,2")};
        options.repeats = 1;
        options.timed = 0.02;
        const SceneChart chart = chart_scene(scene, options);
        expect_agreement(chart);
        for (const ChartRun &run : chart.runs)
            ++(run.status == ChartStatus::fine ? fine : outside);
    }
    EXPECT_GT(fine, rounds * 5 / 6);
    EXPECT_GT(outside, rounds * 5 / 6);
}

// A scene's probes count too.
TEST(ChartAndCheck, AgreeOnProbes) {
    SceneDesc scene = falling_scene();
    ExpectDesc &expect = scene.expects.front();
    expect.quantity = "position.y";
    expect.to = 0.5;
    expect.value = 0;
    expect.tolerance = 0;
    expect.relation = ExpectDesc::Relation::at_most;
    ProbeDesc probe;
    probe.name = "origin";
    probe.question = ProbeQuestion::contains;
    probe.shapes.resize(1);
    probe.shapes[0].shape = SphereDesc{1};
    probe.points = {glm::dvec3(0)};
    for (const double is : {1.0, 0.0}) {
        probe.expects = {{"inside", is}};
        scene.probes = {probe};
        ChartOptions options;
        options.methods = {"rk4"};
        options.sweep = {parse_sweep("substeps=1")};
        options.repeats = 1;
        const SceneChart chart = chart_scene(scene, options);
        expect_agreement(chart);
        ASSERT_EQ(chart.runs.size(), 1U);
        EXPECT_EQ(chart.runs[0].status, is == 1 ? ChartStatus::fine : ChartStatus::outside);
        EXPECT_EQ(chart.runs[0].worst, is == 1 ? std::nullopt : std::optional<std::size_t>(1));
    }
}

// The dominoes fall with every setting that runs them, so that bound is always met, and the chart
// tells the settings apart by the scene's other expectations.
TEST(ChartAndCheck, TheDominoesHaveSomethingToShow) {
    ChartOptions options;
    options.methods = {"soft_step"};
    options.sweep = {parse_sweep("substeps=2,4")};
    options.repeats = 1;
    options.timed = 0.05;
    const SceneChart chart = chart_scene(scene("stacking/domino_run.toml"), options);
    for (const ChartRun &run : chart.runs)
        EXPECT_GT(run.error, 0);
    expect_agreement(chart);
}

} // namespace
} // namespace plumb
