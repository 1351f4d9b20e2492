// Orders of convergence, the curves of a chart, its budget and its SVG.
#include "app/lab/chart/convergence.h"

#include "app/lab/chart/chart_svg.h"
#include "app/lab/provenance.h"
#include "app/lab/queries/query_chart.h"
#include "engine/scene/scene_file.h"
#include "tests/lab/chart/falling.h"

#include <cmath>
#include <sstream>

#include <gtest/gtest.h>

namespace plumb {
namespace {

TEST(Convergence, TheOrderIsThatOfThePowerLawAlone) {
    std::vector<std::pair<double, double>> points;
    for (int k = 0; k < 8; ++k) {
        const double dt = std::pow(0.5, k);
        // Two steps that are too coarse, then 3 dt^2, then the round-off floor.
        points.emplace_back(dt, k < 2 ? 1e6 * std::pow(dt, 9) : std::max(3 * dt * dt, 2e-3));
    }
    const auto fitted = fitted_order(points);
    ASSERT_TRUE(fitted);
    EXPECT_NEAR(fitted->slope, 2, 1e-12);
    EXPECT_EQ(fitted->from, 4U);
    points.resize(2);
    EXPECT_FALSE(fitted_order(points));
    EXPECT_FALSE(fitted_order({{1, 1e-16}, {0.5, 1.1e-16}, {0.25, 0}, {0.125, 1e-16}}));
}

TEST(Convergence, SmoothMethodsHaveTheirOrder) {
    const SceneFileResult file = load_scene(PLUMB_SOURCE_DIR "/scenes/springs/mass_on_spring.toml");
    ASSERT_TRUE(file.ok());
    ChartOptions options;
    options.convergence = true;
    options.expect = "period";
    options.methods = {"velocity_verlet", "rk4"};
    options.sweep = {parse_sweep("dt=1/480..1/60")};
    const SceneChart chart = chart_scene(file.scene, options);
    const std::vector<CurveOrder> orders = curve_orders(chart);
    ASSERT_EQ(orders.size(), 2U);
    ASSERT_TRUE(orders[0].fitted && orders[1].fitted);
    EXPECT_NEAR(orders[0].fitted->slope, 2, 0.1);
    EXPECT_NEAR(orders[1].fitted->slope, 4, 0.1);
    EXPECT_TRUE(chart.runs[0].timings.empty());
    EXPECT_EQ(chart.runs[0].resolved.precision, Precision::f64);
    EXPECT_EQ(chart.runs[0].resolved.settings.substeps, 1);
    const ChartContent content = chart_content(chart, "");
    EXPECT_EQ(content.cost_title, "dt");
    EXPECT_EQ(content.series.at(1).name, "Runge-Kutta 4: " + order_text(orders[1]));
    EXPECT_DOUBLE_EQ(content.marks.at(0).cost, 1.0 / 480);
    EXPECT_FALSE(content.budget);
    options.sweep = {parse_sweep("substeps=1,2")};
    EXPECT_THROW((void)chart_scene(file.scene, options), std::invalid_argument);
}

// By default it is judged by values at a given time: an extreme among samples is off by dt^2 of its
// own, whatever the method.
TEST(Convergence, IsOfValuesAtATimeUnlessTold) {
    for (const auto &[path, measured] :
         {std::pair{"springs/two_masses", "worst"}, std::pair{"springs/mass_on_spring", "worst"},
          std::pair{"springs/damped_springs", "worst"},
          std::pair{"free/kepler_orbit", "back after two turns"},
          std::pair{"free/spinning_book", "spin about the middle axis after 8 s"}}) {
        const SceneFileResult file =
            load_scene(std::string(PLUMB_SOURCE_DIR "/scenes/") + path + ".toml");
        ASSERT_TRUE(file.ok()) << path;
        ChartOptions options;
        options.convergence = true;
        options.methods = {"velocity_verlet", "rk4"};
        const SceneChart chart = chart_scene(file.scene, options);
        EXPECT_EQ(chart.measure.name, measured);
        for (const ChartRun &run : chart.runs) {
            ASSERT_TRUE(run.worst) << path;
            if (chart.measure.kind == ErrorMeasure::Kind::worst) {
                EXPECT_EQ(run.run.outcomes[*run.worst].desc.reduce, "last") << path;
            }
        }
        const std::vector<CurveOrder> orders = curve_orders(chart);
        ASSERT_EQ(orders.size(), 2U);
        ASSERT_TRUE(orders[0].fitted && orders[1].fitted) << path;
        EXPECT_NEAR(orders[0].fitted->slope, 2, 0.1) << path;
        EXPECT_NEAR(orders[1].fitted->slope, 4, 0.2) << path;
    }
}

TEST(Convergence, SaysWhereThereIsNoOrder) {
    SceneChart chart;
    chart.scene = falling_scene();
    chart.convergence = true;
    chart.sweep = {parse_sweep("dt=1/240..1/30")};
    for (const auto &[method, wrong] : {std::pair{"rk4", true}, {"explicit_euler", false}})
        for (const double dt : chart.sweep[0].values) {
            ChartRun run;
            run.resolved.method = find_method_info(method);
            run.resolved.settings.dt = dt;
            run.point = {dt};
            run.cost = 1;
            run.error = wrong ? 1e-9 + (dt > 0.01 ? 1e-12 : 0) : 0;
            run.status = ChartStatus::fine;
            chart.runs.push_back(run);
        }
    const std::vector<CurveOrder> orders = curve_orders(chart);
    ASSERT_EQ(orders.size(), 2U);
    EXPECT_FALSE(orders[0].fitted || orders[1].fitted);
    std::ostringstream table;
    print(table, chart);
    for (const char *line : {"Runge-Kutta 4: no order: the error does not fall steadily\n",
                             "Explicit Euler: no order: fewer than three errors above 0\n"})
        EXPECT_NE(table.str().find(line), std::string::npos) << table.str();
    EXPECT_EQ(chart_content(chart, "").series.at(0).name, "Runge-Kutta 4: no order");
}

TEST(ChartSweep, PrecisionAndThreadsAreCurvesOfTheirOwn) {
    ChartOptions options = quick({});
    for (const char *sweep : {"precision=float,double", "threads=1,2"})
        add_sweep(options, sweep);
    SceneDesc scene = falling_scene();
    options.sweep = {parse_sweep("substeps=1,2")};
    const SceneChart chart = chart_scene(scene, options);
    EXPECT_EQ(chart.runs.size(), 8U);
    EXPECT_TRUE(chart.wall_clock);
    const ChartContent content = chart_content(chart, "");
    ASSERT_EQ(content.series.size(), 4U);
    EXPECT_EQ(content.series[0].name, "Soft step, float, 1 thread");
    EXPECT_EQ(content.series[3].name, "Soft step, double, 2 threads");
    EXPECT_EQ(content.cost_title, "Wall time per simulated second");
    for (const char *wrong : {"precision=half", "threads=0", "threads=2,", "precision="})
        EXPECT_THROW(add_sweep(options, wrong), std::invalid_argument) << wrong;
}

TEST(ChartBudget, IsALineWithTheCornerShadedOrSaysWhereItIs) {
    const auto measure = [](std::string_view text, float size) {
        return glm::vec2(0.5f * size * static_cast<float>(text.size()), size);
    };
    ChartContent content;
    content.limit = 1;
    content.budget = 1;
    content.budget_label = "60 Hz";
    content.series.push_back({"one", 0, {{0, 1}}});
    for (const double cost : {0.2, 0.8}) {
        ChartMark mark;
        mark.cost = cost;
        mark.error = 3 - 3 * cost;
        content.marks.push_back(mark);
    }
    ChartLayout layout = lay_out(content, measure);
    ASSERT_TRUE(layout.budget_line && layout.corner);
    EXPECT_GT(*layout.budget_line, layout.marks[1].x);
    EXPECT_EQ(layout.corner->max.x, *layout.budget_line);
    EXPECT_EQ(layout.corner->min.y, *layout.limit_line);
    EXPECT_EQ(layout.budget_label, "60 Hz: 1 s");
    EXPECT_FALSE(layout.budget_text.overlaps(layout.limit_text));
    content.budget = 1000;
    layout = lay_out(content, measure);
    EXPECT_FALSE(layout.budget_line);
    EXPECT_EQ(layout.corner->max.x, layout.plot.max.x); // everything within tolerance
    EXPECT_EQ(layout.budget_label, "60 Hz: 1 ks »");
    content.budget = 1e-6;
    layout = lay_out(content, measure);
    EXPECT_FALSE(layout.budget_line);
    EXPECT_FALSE(layout.corner); // nothing is within the budget
}

TEST(ChartFailures, ACrossSaysWhy) {
    const ChartContent content = chart_content(chart_scene(falling_scene(), quick(fakes(2))), "");
    EXPECT_TRUE(content.marks.at(1).failed);
    EXPECT_EQ(content.marks[1].label, "2 not finite");
    ASSERT_EQ(content.failures.size(), 1U);
    EXPECT_EQ(content.failures[0].substr(0, 50),
              "Soft step, 2: not finite after step 30 (0.5 s): bo");
}

TEST(ChartSvg, SaysWhatThePictureSays) {
    SceneDesc scene = falling_scene();
    scene.title = "Fall < rise & so on";
    std::ostringstream out;
    write_chart_svg(out, chart_content(chart_scene(scene, quick(fakes(2))), "the command"));
    const std::string svg = out.str();
    EXPECT_EQ(svg.rfind("<svg xmlns=", 0), 0U);
    EXPECT_TRUE(svg.ends_with("</svg>\n"));
    for (const char *text : {">Fall &lt; rise &amp; so on: what accuracy costs<", ">the command<",
                             ">2 not finite<", ">8<", ">Soft step<", "#0072b2"})
        EXPECT_NE(svg.find(text), std::string::npos) << text;
    EXPECT_EQ(svg.find('&'), svg.find("&lt;")); // no bare ampersand before it
    std::size_t opened = 0, closed = 0;
    for (std::size_t i = svg.find("<text"); i != std::string::npos; i = svg.find("<text", i + 1))
        ++opened;
    for (std::size_t i = svg.find("</text>"); i != std::string::npos;
         i = svg.find("</text>", i + 1))
        ++closed;
    EXPECT_GT(opened, 20U);
    EXPECT_EQ(opened, closed);
}

TEST(ChartSvg, OfQueriesSaysWhatMadeIt) {
    QueryChart chart;
    chart.options.repeats = 1;
    QueryRun run;
    run.query = "ray against sphere";
    run.timings = {2e-9};
    run.cost = 2e-9;
    run.families = {{"all of them", 100, 1}};
    chart.runs = {run};
    const PanelChart panels = panel_chart(chart, "the command");
    for (const std::string &text :
         {std::string("one timing of batches"), machine(), "commit " + build_commit()})
        EXPECT_NE(panels.footer.at(0).find(text), std::string::npos) << panels.footer.at(0);
    std::ostringstream out;
    write_chart_svg(out, panels);
    for (const char *text : {"<svg xmlns=", ">ray against sphere<", ">the command<", "</svg>\n"})
        EXPECT_NE(out.str().find(text), std::string::npos) << text;
}

} // namespace
} // namespace plumb
