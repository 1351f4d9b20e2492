// Charts of fake simulations with known errors, and of one real scene.
#include "app/lab/chart/chart.h"

#include "app/lab/chart/chart_image.h"
#include "app/lab/chart/pareto.h"
#include "tests/lab/chart/falling.h"
#include "tests/lab/csv_reader.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <sstream>

#include <gtest/gtest.h>

namespace plumb {
namespace {

TEST(Chart, ErrorsAreThoseOfAFullRun) {
    const SceneChart chart = chart_scene(falling_scene(), quick(fakes(2)));
    ASSERT_EQ(chart.runs.size(), 4U);
    EXPECT_EQ(chart.planned, 4U);
    EXPECT_FALSE(chart.interrupted);
    EXPECT_EQ(chart.measure.kind, ErrorMeasure::Kind::expectation);
    EXPECT_EQ(chart.measure.unit, "m");
    EXPECT_EQ(chart.measure.limit, 0.3);
    for (const ChartRun &run : chart.runs) {
        const int n = run.resolved.settings.substeps;
        EXPECT_GT(run.cost, 0);
        EXPECT_GE(run.cost, run.cost_low);
        EXPECT_LE(run.cost, run.cost_high);
        if (n == 2) {
            EXPECT_EQ(run.status, ChartStatus::diverged);
            EXPECT_TRUE(std::isinf(run.error));
            EXPECT_FALSE(run.pareto);
            EXPECT_TRUE(run.timings.empty());
            ASSERT_TRUE(run.run.divergence);
            EXPECT_EQ(run.run.divergence->step, 30U);
            continue;
        }
        EXPECT_NEAR(run.error, 1.0 / n, 1e-12); // round-off of a number near 1
        EXPECT_EQ(run.status, n == 1 ? ChartStatus::outside : ChartStatus::fine);
        EXPECT_EQ(run.timings.size(), 3U);
        // The fake's work: this many passes a step, 60 steps a second.
        EXPECT_NEAR(run.body_passes, 60 * 2, 1e-9);
        EXPECT_NEAR(run.constraint_passes, 60 * 3, 1e-9);
    }
    std::vector<CostAndError> choices;
    for (const ChartRun &run : chart.runs) // runs outside the tolerance are never on the front
        choices.push_back({run.cost, run.status == ChartStatus::fine
                                         ? run.error
                                         : std::numeric_limits<double>::infinity()});
    const std::vector<bool> front = pareto_front(choices);
    for (std::size_t i = 0; i < front.size(); ++i)
        EXPECT_EQ(chart.runs[i].pareto, front[i]);
}

// x is t (1 + 1 / substeps), and should be t.
TEST(Chart, ErrorsOfACurveAreItsWorstOrItsMean) {
    for (const bool mean : {false, true}) {
        SceneDesc scene = falling_scene();
        ExpectDesc &expect = scene.expects.front();
        expect.reduce = mean ? "mean" : "max";
        expect.value = 0;
        expect.curve = {0, 0.25, 0.5, 0.75, 1};
        const SceneChart chart = chart_scene(scene, quick(fakes()));
        EXPECT_EQ(chart.measure.title,
                  mean ? "Error: mean of |measured − true|" : "Error: max of |measured − true|");
        EXPECT_EQ(chart.measure.unit, "m");
        ASSERT_EQ(chart.runs.size(), 4U);
        for (const ChartRun &run : chart.runs) {
            const double error = (mean ? 0.5 : 1) / run.resolved.settings.substeps;
            EXPECT_NEAR(run.error, error, 1e-12); // round-off of numbers near 1
            EXPECT_EQ(run.status, error > 0.3 ? ChartStatus::outside : ChartStatus::fine);
        }
    }
}

TEST(Chart, FixedAndAdaptiveSubstepsAreTwoCurves) {
    ChartOptions options = quick(fakes());
    options.base = {};
    options.methods = {"soft_step", "tgs_soft"};
    options.sweep = {parse_sweep("substeps=1,4")};
    SceneDesc scene = falling_scene();
    scene.world.settings.give(&StepSettings::max_substeps, 1); // the scene's own; default 128
    const SceneChart chart = chart_scene(scene, options);
    std::vector<std::pair<int, int>> runs;
    for (const ChartRun &run : chart.runs)
        runs.emplace_back(run.resolved.settings.substeps, run.resolved.settings.max_substeps);
    EXPECT_EQ(runs, (std::vector<std::pair<int, int>>{
                        {1, 1}, {4, 1}, {1, 128}, {4, 128}, {1, 1}, {4, 1}}));
    const ChartContent content = chart_content(chart, "");
    ASSERT_EQ(content.series.size(), 3U);
    EXPECT_EQ(content.series[0].name, "Soft step, fixed substeps");
    EXPECT_EQ(content.series[1].name, "Soft step, adaptive substeps");
    EXPECT_EQ(content.series[2].name, "TGS Soft");
    EXPECT_NE(content.series[0].style, content.series[1].style);
    EXPECT_EQ(content.footer.at(0).find("max_substeps"), std::string::npos) << content.footer[0];
    std::ostringstream table;
    print(table, chart);
    EXPECT_NE(table.str().find(" 4..128 "), std::string::npos) << table.str();
    // If the maximum is given or swept, only that one.
    options.base.settings.give(&StepSettings::max_substeps, 8);
    EXPECT_EQ(chart_scene(scene, options).runs.size(), 4U);
    options.base = {};
    options.sweep.push_back(parse_sweep("max_substeps=1,16"));
    EXPECT_EQ(chart_scene(scene, options).runs.size(), 6U);
}

TEST(Chart, CsvHoldsEveryRunWithItsSettings) {
    const SceneChart chart = chart_scene(falling_scene(), quick(fakes(2)));
    std::ostringstream out;
    write_chart_csv(out, chart);
    const auto rows = read_csv(out.str());
    ASSERT_EQ(rows.size(), 1U + 4);
    std::map<std::string, std::size_t> column;
    for (std::size_t i = 0; i < rows[0].size(); ++i)
        column[rows[0][i]] = i;
    EXPECT_EQ(column.size(), rows[0].size()) << "a column's name comes twice";
    for (std::size_t k = 0; k < 4; ++k) {
        const auto &row = rows[k + 1];
        ASSERT_EQ(row.size(), rows[0].size());
        const ChartRun &run = chart.runs[k];
        EXPECT_EQ(row.at(column.at("scene")), "fall");
        EXPECT_EQ(row.at(column.at("method")), "soft_step");
        EXPECT_EQ(row.at(column.at("substeps")), std::to_string(1 << k));
        EXPECT_EQ(std::stod(row.at(column.at("dt_s"))), 1.0 / 60);
        EXPECT_EQ(std::stod(row.at(column.at("gravity_y_m_s2"))), -9.81);
        EXPECT_EQ(std::stod(row.at(column.at("cpu_s_per_s"))), run.cost);
        EXPECT_EQ(row.at(column.at("status")), status_name(run.status));
        if (run.status == ChartStatus::diverged) {
            EXPECT_EQ(row.at(column.at("error")), "inf");
            EXPECT_EQ(row.at(column.at("x.measured")), "");
            EXPECT_DOUBLE_EQ(std::stod(row.at(column.at("diverged_at_s"))), 0.5);
        } else {
            EXPECT_EQ(std::stod(row.at(column.at("error"))), run.error);
            EXPECT_NEAR(std::stod(row.at(column.at("x.measured"))), 1 + 1.0 / (1 << k), 1e-12);
            EXPECT_EQ(row.at(column.at("x.passed")), k == 0 ? "0" : "1");
        }
    }
    std::ostringstream table;
    print(table, chart);
    EXPECT_NE(table.str().find("diverged"), std::string::npos);
    EXPECT_NE(table.str().find("tolerance 300 mm"), std::string::npos);
}

TEST(Chart, InterruptedKeepsWhatIsThere) {
    ChartOptions options = quick(fakes());
    int calls = 0;
    std::size_t seen = 0;
    options.stop = [&] { return seen >= 2; };
    const SceneChart chart = chart_scene(falling_scene(), options, [&](const SceneChart &part) {
        ++calls;
        seen = part.runs.size();
    });
    EXPECT_TRUE(chart.interrupted);
    EXPECT_EQ(chart.runs.size(), 2U);
    EXPECT_EQ(chart.planned, 4U);
    EXPECT_EQ(calls, 2);
    const ChartContent content = chart_content(chart, "");
    EXPECT_EQ(content.marks.size(), 2U);
    EXPECT_NE(content.subtitle.find("INTERRUPTED: 2 of 4"), std::string::npos);
    std::ostringstream table;
    print(table, chart);
    EXPECT_NE(table.str().find("interrupted: 2 of 4 runs are done"), std::string::npos);
}

TEST(Chart, TheFooterSaysHowOftenItWasTimed) {
    ChartOptions options = quick(fakes());
    for (const int repeats : {1, 3}) {
        options.repeats = repeats;
        const std::string footer =
            chart_content(chart_scene(falling_scene(), options), "").footer.at(0);
        const bool once = repeats == 1;
        EXPECT_EQ(footer.find("one timing of ") != std::string::npos, once) << footer;
        EXPECT_EQ(footer.find("median of 3 interleaved timings") != std::string::npos, !once);
        EXPECT_EQ(footer.find("spread") != std::string::npos, !once) << footer;
    }
}

TEST(Chart, MistakesAreExplained) {
    ChartOptions options = quick(fakes());
    options.methods = {"no_such_method"};
    EXPECT_THROW((void)chart_scene(falling_scene(), options), std::invalid_argument);
    options = quick(fakes());
    options.expect = "y";
    EXPECT_THROW((void)chart_scene(falling_scene(), options), std::invalid_argument);
    options = quick(fakes());
    options.repeats = 0;
    EXPECT_THROW((void)chart_scene(falling_scene(), options), std::invalid_argument);
}

TEST(Chart, WithoutExpectationsTheErrorThatAppliesIsCharted) {
    ChartOptions options = quick([](const SceneDesc &scene, const RunOptions &run) {
        auto fake = std::make_unique<FakeSimulation>(resolve_run(scene, run).settings.dt);
        fake->measures_at = [](double t) {
            Measures measures;
            measures.kinetic_energy = 1 + t;
            measures.max_penetration = 0.125;
            measures.max_joint_drift = 0.25;
            return measures;
        };
        return std::unique_ptr<Simulation>(std::move(fake));
    });
    options.duration = 1;
    SceneDesc scene = falling_scene();
    scene.expects.clear();
    SceneChart chart = chart_scene(scene, options); // the fake reports contacts
    EXPECT_EQ(chart.measure.kind, ErrorMeasure::Kind::penetration);
    EXPECT_EQ(chart.runs.at(0).error, 0.125);
    EXPECT_FALSE(chart.measure.limit);
    JointDesc joint;
    joint.body_b = "ball";
    scene.joints.push_back(joint);
    chart = chart_scene(scene, options);
    EXPECT_EQ(chart.measure.kind, ErrorMeasure::Kind::joint_drift);
    EXPECT_EQ(chart.runs.at(0).error, 0.25);
}

// falling_scene, but the ball must also go no farther than 1.3 m. 1 substep misses both; 2 substeps
// miss only the distance, with 1.5 m instead of 1.3 m; 4 and 8 meet both.
SceneDesc two_expectations() {
    SceneDesc scene = falling_scene();
    scene.expects[0].tolerance = 0.6;
    ExpectDesc way = scene.expects[0];
    way.name = "y";
    way.relation = ExpectDesc::Relation::at_most;
    way.quantity = "displacement";
    way.value = 1.3;
    way.tolerance = 0;
    scene.expects.push_back(way);
    return scene;
}

TEST(Chart, TheErrorIsTheWorstOfAllInUnitsOfItsTolerance) {
    const SceneChart chart = chart_scene(two_expectations(), quick(fakes()));
    EXPECT_EQ(chart.measure.kind, ErrorMeasure::Kind::worst);
    EXPECT_EQ(chart.measure.limit, 1);
    ASSERT_EQ(chart.runs.size(), 4U);
    const auto expected_x = [](int n) { return 1.0 / n / 0.6; };
    const auto expected_y = [](int n) { return (1 + 1.0 / n) / 1.3; };
    for (const ChartRun &run : chart.runs) {
        const int n = run.resolved.settings.substeps;
        EXPECT_NEAR(run.error, std::max(expected_x(n), expected_y(n)), 1e-12) << n;
        ASSERT_TRUE(run.worst) << n;
        EXPECT_EQ(*run.worst, expected_x(n) > expected_y(n) ? 0U : 1U) << n;
        EXPECT_EQ(run.status, n <= 2 ? ChartStatus::outside : ChartStatus::fine) << n;
        EXPECT_TRUE(n > 2 || !run.pareto) << "what fails the scene is no choice";
    }
    std::ostringstream out;
    write_chart_csv(out, chart);
    const auto rows = read_csv(out.str());
    const auto cell = [&](std::size_t row, const std::string &column) {
        const auto found = std::find(rows[0].begin(), rows[0].end(), column);
        EXPECT_NE(found, rows[0].end()) << column;
        return rows[row].at(static_cast<std::size_t>(found - rows[0].begin()));
    };
    EXPECT_EQ(cell(1, "worst"), "x");
    EXPECT_EQ(cell(2, "worst"), "y");
    EXPECT_EQ(cell(2, "error_unit"), "tolerance");
    EXPECT_EQ(cell(2, "error"), cell(2, "y.scaled_error"));
    EXPECT_EQ(cell(2, "x.passed"), "1");
    EXPECT_EQ(cell(2, "y.passed"), "0");
    EXPECT_EQ(cell(2, "status"), "outside");
    std::ostringstream table;
    print(table, chart);
    EXPECT_NE(table.str().find("outside; worst: y"), std::string::npos) << table.str();
    // The picture shows one letter each, and a key to the letters.
    const ChartContent content = chart_content(chart, "");
    EXPECT_EQ(content.marks.at(0).label, "1 a");
    EXPECT_EQ(content.marks.at(1).label, "2 b");
    EXPECT_EQ(content.worst,
              (std::vector<std::string>{"a  x: 1 m ± 0.6 m", "b  y: at most 1.3 m"}));
    EXPECT_TRUE(content.marks[1].outside);
    EXPECT_FALSE(content.marks[2].outside);
}

TEST(Chart, OneOfSeveralExpectationsIsInItsOwnUnitAndTheVerdictStaysTheScenes) {
    ChartOptions options = quick(fakes());
    options.expect = "x";
    const SceneChart chart = chart_scene(two_expectations(), options);
    EXPECT_EQ(chart.measure.unit, "m");
    EXPECT_EQ(chart.measure.limit, 0.6);
    for (const ChartRun &run : chart.runs) {
        const int n = run.resolved.settings.substeps;
        EXPECT_NEAR(run.error, 1.0 / n, 1e-12) << n;
        EXPECT_EQ(run.status, n <= 2 ? ChartStatus::outside : ChartStatus::fine) << n;
    }
    const ChartContent content = chart_content(chart, "");
    EXPECT_TRUE(content.worst.empty());
    EXPECT_EQ(content.marks.at(1).label, "2");
    EXPECT_TRUE(content.marks[1].outside); // below the line, and yet outside its tolerance
    EXPECT_LT(content.marks[1].error, *content.limit);
    EXPECT_FALSE(content.marks[1].pareto);
    options.expect = "z";
    try {
        (void)chart_scene(two_expectations(), options);
        FAIL() << "charted what there is not";
    } catch (const std::invalid_argument &refusal) {
        EXPECT_NE(std::string(refusal.what()).find("it has \"x\", \"y\""), std::string::npos)
            << refusal.what();
    }
}

TEST(Chart, LinesJoinTheFirstAxisOfEachMethod) {
    ChartOptions options = quick(fakes());
    options.sweep = {parse_sweep("substeps=1..4"), parse_sweep("iterations=1,2")};
    const ChartContent content = chart_content(chart_scene(falling_scene(), options), "command");
    ASSERT_EQ(content.series.size(), 1U);
    ASSERT_EQ(content.series[0].lines.size(), 2U);
    EXPECT_EQ(content.series[0].lines[0], (std::vector<std::size_t>{0, 1, 2}));
    EXPECT_EQ(content.series[0].lines[1], (std::vector<std::size_t>{3, 4, 5}));
    EXPECT_EQ(content.marks[4].label, "2×2");
    EXPECT_EQ(content.footer.back(), "command");
}

// Every method can do free fall from rest; the truth is g t^2 / 2.
TEST(Chart, RealMethodsOnFreeFall) {
    SceneDesc scene = falling_scene();
    scene.world.precision = Precision::f64;
    scene.expects[0].quantity = "position.y";
    scene.expects[0].value = -0.5 * 9.81;
    scene.expects[0].tolerance = 0.1; // first-order methods are off by g dt t / 2 = 0.082 m
    ChartOptions options;
    options.sweep = {parse_sweep("substeps=1,2")};
    options.repeats = 1;
    const SceneChart chart = chart_scene(scene, options);
    EXPECT_TRUE(chart.left_out.empty());
    std::set<std::string_view> methods;
    for (const ChartRun &run : chart.runs) {
        methods.insert(run.resolved.method->name);
        EXPECT_EQ(run.status, ChartStatus::fine) << run.resolved.method->name << " " << run.error;
        EXPECT_GT(run.cost, 0);
    }
    EXPECT_EQ(methods.size(), method_infos().size());
}

TEST(ChartImage, IsDrawnAndDependsOnItsContent) {
    SceneChart chart = chart_scene(falling_scene(), quick(fakes(2)));
    ChartPainter painter(PLUMB_SOURCE_DIR "/shaders");
    const Image image = painter.paint(chart_content(chart, "command"));
    EXPECT_EQ(image.width, 1200);
    EXPECT_EQ(image.height, 800);
    std::set<int> colours;
    std::size_t inked = 0;
    const glm::u8vec3 background = image.at(2, 2);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const glm::u8vec3 c = image.at(x, y);
            colours.insert((c.r << 16) | (c.g << 8) | c.b);
            inked += c != background ? 1U : 0U;
        }
    // The plot itself is white on the tinted background: 836 x 536 of 1200 x 800.
    EXPECT_GT(inked, 836U * 500U);
    EXPECT_GT(colours.size(), 100U); // antialiased lines and letters
    // The last mark's own blue is there, in its place.
    const ChartContent content = chart_content(chart, "command");
    const ChartLayout layout =
        lay_out(content, [](std::string_view, float) { return glm::vec2(10, 10); });
    const auto at_mark = [&](std::size_t i) {
        return image.at(static_cast<int>(layout.marks[i].x), static_cast<int>(layout.marks[i].y));
    };
    EXPECT_EQ(at_mark(3), glm::u8vec3(0, 0x72, 0xb2));
    EXPECT_EQ(at_mark(0), glm::u8vec3(255));  // hollow, because it is outside
    EXPECT_EQ(painter.paint(content), image); // the same result again
    chart.runs[0].error *= 2;
    EXPECT_NE(painter.paint(chart_content(chart, "command")), image);
}

} // namespace
} // namespace plumb
