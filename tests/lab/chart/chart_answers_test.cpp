// A chart over gravity judges by what holds at any gravity.
#include "app/lab/chart/chart_rows.h"
#include "tests/lab/csv_reader.h"
#include "tests/lab/falling_ball.h"

#include "engine/scene/scene_file.h"

#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace plumb {
namespace {

// A fall, whose end is a matter of gravity, above a floor that nothing may sink into.
SceneDesc fall_onto_floor(const std::string &more) {
    const SceneFileResult read = parse_scene(std::string(falling_ball) + R"(
[[body]]
name = "floor"
shape = "plane"
)" + more,
                                             "fall.toml", {"rk4", "tgs_soft"});
    EXPECT_TRUE(read.ok());
    SceneDesc scene = read.scene;
    scene.name = "fall";
    return scene;
}

constexpr const char *nothing_sinks = R"(
[[expect]]
name = "solid"
quantity = "penetration"
reduce = "max"
to = 1
at_most = 0.02
source = "solids"
)";

SceneChart swept(const SceneDesc &scene, const std::string &sweep, const std::string &expect = "") {
    ChartOptions options;
    options.methods = {"tgs_soft"};
    options.repeats = 1;
    options.timed = 0.1;
    options.expect = expect;
    add_sweep(options, sweep);
    SceneChart chart = chart_scene(scene, options);
    finish_chart(chart);
    return chart;
}

TEST(ChartAnswers, OnlyThoseThatHoldAtAnyGravityCountOverIt) {
    const SceneDesc scene = fall_onto_floor(nothing_sinks);
    const SceneChart chart = swept(scene, "gravity.y=-9.81,-5,-1");
    EXPECT_EQ(chart.outdated, std::vector<std::string>{"height"});
    ASSERT_EQ(chart.runs.size(), 3U);
    for (const ChartRun &run : chart.runs) {
        EXPECT_EQ(run.status, ChartStatus::fine) << "the ball is elsewhere, and may be";
        EXPECT_EQ(run.run.outcomes[0].verdict, Verdict::unseen);
        EXPECT_EQ(run.run.outcomes[1].verdict, Verdict::met);
        EXPECT_NEAR(run.run.time, 1, 1e-6) << "as long as the file asks";
    }
    EXPECT_EQ(chart.measure.name, "solid");
    const std::string left_out = "stated for the file's own gravity.y: \"height\"";
    EXPECT_EQ(not_judged(chart), std::vector<std::string>{left_out});
    std::ostringstream said;
    print(said, chart);
    EXPECT_NE(said.str().find("\n  not judged: " + left_out + "\n"), std::string::npos)
        << said.str();
    const std::vector<std::string> shown = chart_content(chart, "").left_out;
    EXPECT_NE(std::ranges::find(shown, left_out), shown.end());
    EXPECT_THROW((void)swept(scene, "gravity.y=-9.81,-1", "height"), std::invalid_argument);
}

TEST(ChartAnswers, AreAllTheFilesOwnOverAnySetting) {
    const SceneChart chart = swept(fall_onto_floor(nothing_sinks), "substeps=1,64");
    EXPECT_TRUE(chart.outdated.empty());
    EXPECT_TRUE(not_judged(chart).empty());
    EXPECT_EQ(chart.measure.kind, ErrorMeasure::Kind::worst);
    EXPECT_EQ(chart.runs.at(0).status, ChartStatus::outside) << "by g h t / 2";
    EXPECT_EQ(chart.runs.at(1).status, ChartStatus::fine);
    // Nor where it does not matter: sideways, the ball falls no faster.
    EXPECT_TRUE(swept(fall_onto_floor(nothing_sinks), "gravity.x=-1,0,1").outdated.empty());
}

// As for a scene without expectations.
TEST(ChartAnswers, WhereNoneIsLeftTheErrorThatAppliesIsCharted) {
    const SceneChart chart = swept(fall_onto_floor(""), "gravity.y=-9.81,-1");
    EXPECT_TRUE(expects_nothing(chart));
    EXPECT_EQ(chart.measure.kind, ErrorMeasure::Kind::energy);
    for (const ChartRun &run : chart.runs)
        EXPECT_EQ(run.status, ChartStatus::fine);
}

TEST(ChartAnswers, AreLeftOutOfWhatIsReadBack) {
    for (const char *more : {nothing_sinks, ""}) {
        const SceneDesc scene = fall_onto_floor(more);
        const SceneChart chart = swept(scene, "gravity.y=-9.81,-1");
        std::ostringstream csv;
        write_chart_csv(csv, chart, "print");
        const SceneChart merged = merged_chart(scene, {{"fall.csv", csv.str()}});
        EXPECT_EQ(merged.outdated, chart.outdated);
        EXPECT_EQ(not_judged(merged), not_judged(chart));
        EXPECT_EQ(merged.measure.name, chart.measure.name);
        std::ostringstream again;
        write_chart_csv(again, merged, "print");
        EXPECT_EQ(again.str(), csv.str());
    }
}

} // namespace
} // namespace plumb
