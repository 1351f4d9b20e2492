// Errors of single steps: orders, the same states for all, what counts as off, and their chart.
#include "app/lab/chart/one_step.h"

#include "app/lab/chart/chart_rows.h"
#include "engine/scene/scene_file.h"
#include "tests/lab/chart/falling.h"

#include <cmath>
#include <sstream>

#include <gtest/gtest.h>

namespace plumb {
namespace {

SceneDesc scene_of(const std::string &text) {
    SceneFileResult file = parse_scene(text, "test.toml");
    EXPECT_TRUE(file.ok()) << (file.messages.empty() ? std::string() : file.messages.front().what);
    return std::move(file.scene);
}

// It swings at 0.25 Hz.
SceneDesc slow_spring() {
    return scene_of(R"(
[[particle]]
name = "bob"
position = [0, 0, 0]
[[spring]]
name = "spring"
b = "bob"
anchor_a = [0, 1, 0]
frequency = 0.25
)");
}

SceneDesc boxes() {
    return scene_of(R"(
[[body]]
name = "ground"
shape = "plane"
[[body]]
name = "box"
shape = "box"
half_extents = [0.5, 0.5, 0.5]
position = [0, 0.5, 0]
repeat = { kind = "stack", count = 4 }
)");
}

OneStepStates::Make maker(std::string_view method, Precision precision = Precision::f64) {
    RunOptions run;
    run.method = method;
    run.precision = precision;
    return [run](const SceneDesc &scene) { return Simulation::create(scene, run, nullptr); };
}

TEST(OneStep, OfAMethodOfOrderPTheErrorGoesWithDtToThePowerOfPPlus1) {
    const auto errors = [](double dt) {
        SceneDesc scene = slow_spring();
        scene.world.settings.give(&StepSettings::dt, dt);
        OneStepOptions options;
        options.duration = 20;
        const OneStepStates states(scene, options);
        EXPECT_DOUBLE_EQ(states.frame(), dt);
        EXPECT_EQ(states.instants(), static_cast<std::size_t>(std::lround(20 / dt)) - 16);
        std::vector<double> all{states.own_error().rms};
        for (const char *method : {"semi_implicit_euler", "stormer_verlet", "soft_step", "rk4"})
            all.push_back(states.error_of(maker(method)).rms);
        return all;
    };
    const std::vector<double> fine = errors(1.0 / 30), coarse = errors(1.0 / 15);
    const std::vector<int> orders{1, 2, 2, 4};
    for (std::size_t i = 0; i < orders.size(); ++i) {
        EXPECT_NEAR(std::log2(coarse[i + 1] / fine[i + 1]), orders[i] + 1, 0.1) << i;
        EXPECT_GT(fine[i + 1], 100 * fine[0]) << i;
    }
}

TEST(OneStep, AFrameIsAsManyStepsAsMake60Hz) {
    SceneDesc scene = slow_spring();
    scene.world.settings.give(&StepSettings::dt, 1.0 / 240);
    OneStepOptions options;
    options.duration = 0.1;
    const OneStepStates states(scene, options);
    EXPECT_DOUBLE_EQ(states.frame(), 1.0 / 60);
    EXPECT_EQ(states.instants(), 3U); // of six; half only warm up the solver
    RunOptions run;
    run.method = "rk4";
    run.settings.give(&StepSettings::dt, 1.0 / 50);
    const OneStepError error = states.error_of(
        [&](const SceneDesc &state) { return Simulation::create(state, run, nullptr); });
    EXPECT_EQ(error.failure, "steps of 1/50 s do not add up to the frame of 1/60 s");
}

TEST(OneStep, EveryMethodStepsFromTheSameStates) {
    OneStepOptions options;
    options.duration = 0.5;
    const OneStepStates states(boxes(), options);
    const auto poses = [&](const OneStepStates::Make &make) {
        std::vector<glm::dvec3> all;
        (void)states.error_of([&](const SceneDesc &scene) {
            for (const BodyDesc &body : scene.bodies) {
                all.push_back(body.position);
                all.push_back(body.velocity);
            }
            return make(scene);
        });
        return all;
    };
    const std::vector<glm::dvec3> of_one = poses(maker("soft_step"));
    EXPECT_EQ(of_one.size(), 30U * 5 * 2);
    EXPECT_EQ(of_one, poses(maker("sequential_impulses", Precision::f32)));
    EXPECT_EQ(of_one, poses(maker("avbd")));
}

TEST(OneStep, WhatASolverRemembersIsItsOwn) {
    OneStepOptions options;
    options.duration = 1;
    const OneStepStates states(boxes(), options);
    const OneStepStates::Make make = maker("sequential_impulses");
    const OneStepError warm = states.error_of(make);
    const OneStepError cold = states.error_of([&](SceneDesc scene) {
        scene.contacts.clear();
        return make(scene);
    });
    EXPECT_LT(5 * warm.rms, cold.rms);
    EXPECT_GE(warm.worst, warm.rms);
}

// A tumbling box: the accurate run uses soft_step, and these methods treat contacts differently.
TEST(OneStep, AnotherMethodWithAShortDtComesToTheSame) {
    const SceneDesc scene = scene_of(R"(
[[body]]
name = "ground"
shape = "plane"
[[body]]
name = "box"
shape = "box"
half_extents = [0.3, 0.2, 0.1]
position = [0, 0.6, 0]
velocity = [2, 0, 0.5]
angular_velocity = [1, 2, 3]
)");
    OneStepOptions options;
    options.duration = 1;
    const OneStepStates states(scene, options);
    const auto error = [&](const char *method, double dt) {
        RunOptions run;
        run.method = method;
        run.precision = Precision::f64;
        run.settings.give(&StepSettings::dt, dt);
        return states
            .error_of(
                [&](const SceneDesc &state) { return Simulation::create(state, run, nullptr); })
            .rms;
    };
    for (const char *method : {"sequential_impulses", "avbd"})
        EXPECT_LT(5 * error(method, 1.0 / 3840), error(method, 1.0 / 60)) << method;
}

TEST(OneStep, TurningIsALengthAtTheRadiusOfGyration) {
    SceneDesc scene = scene_of(R"(
[world]
gravity = [0, 0, 0]
[[body]]
name = "ball"
shape = "sphere"
radius = 0.5
velocity = [3, 0, 0]
angular_velocity = [0, 2, 0]
)");
    OneStepOptions options;
    options.duration = 1;
    const OneStepStates states(scene, options);
    const OneStepStates::Make make = maker("rk4");
    EXPECT_LT(states.error_of(make).worst, 1e-10); // rk4 itself errs by (w h / 2)^5 / 120
    OneStepError error = states.error_of([&](SceneDesc state) {
        state.bodies[0].angular_velocity = {};
        return make(state);
    });
    EXPECT_NEAR(error.rms, std::sqrt(0.6) * 0.5 * 2 / 60, 1e-9); // I = 2/5 m r^2 about each axis
    EXPECT_NEAR(error.worst, error.rms, 1e-9);
    error = states.error_of([&](SceneDesc state) {
        state.bodies[0].velocity = {3, 4, 0};
        return make(state);
    });
    EXPECT_NEAR(error.rms, 4.0 / 60, 1e-9);
}

TEST(OneStep, WhatHasNoStepToTakeIsRefused) {
    SceneDesc scene = boxes();
    OneStepOptions options;
    options.duration = 0.001;
    EXPECT_THROW(OneStepStates(scene, options), std::invalid_argument);
    scene.bodies.resize(1); // the ground
    options.duration = 1;
    EXPECT_THROW(OneStepStates(scene, options), std::invalid_argument);
}

ChartOptions one_step_chart() {
    ChartOptions options;
    options.one_step = true;
    options.methods = {"stormer_verlet", "rk4"};
    options.sweep = {parse_sweep("substeps=1,2")};
    options.precisions = {Precision::f64};
    options.repeats = 1;
    options.duration = options.timed = 0.2;
    return options;
}

TEST(OneStepChart, IsOfTheseErrorsAndComesBackFromItsTables) {
    const SceneDesc scene = slow_spring();
    ChartOptions options = one_step_chart();
    const std::string fingerprint = chart_fingerprint(scene, options);
    const SceneChart chart = chart_scene(scene, options);
    ASSERT_TRUE(chart.steps_from);
    ASSERT_EQ(chart.runs.size(), 4U);
    EXPECT_EQ(chart.measure.unit, "m");
    EXPECT_EQ(chart.steps_from->accurate, "rk4 substeps=4 iterations=1 dt=1/3840 s double");
    for (const ChartRun &run : chart.runs) {
        EXPECT_EQ(run.status, ChartStatus::fine);
        EXPECT_EQ(run.error, run.one_step.rms);
        EXPECT_GT(run.cost, 0);
    }
    EXPECT_NEAR(chart.runs[0].error / chart.runs[1].error, 4, 0.5); // second order
    std::ostringstream table;
    print(table, chart);
    EXPECT_NE(table.str().find("m  fine, Pareto front; farthest "), std::string::npos)
        << table.str();

    std::ostringstream csv;
    write_chart_csv(csv, chart, fingerprint);
    const SceneChart merged = merged_chart(scene, {{"a", csv.str()}});
    ASSERT_TRUE(merged.steps_from);
    EXPECT_EQ(merged.steps_from->accurate, chart.steps_from->accurate);
    EXPECT_EQ(merged.steps_from->floor(), chart.steps_from->floor());
    EXPECT_EQ(merged.measure.explanation, chart.measure.explanation);
    ASSERT_EQ(merged.runs.size(), 4U);
    for (std::size_t i = 0; i < 4; ++i)
        EXPECT_EQ(merged.runs[i].error, chart.runs[i].error);

    // Resumed, only the accurate run is repeated.
    std::istringstream in(csv.str());
    options.known = read_known_runs(in, scene, fingerprint);
    EXPECT_EQ(options.known.size(), 4U);
    options.make = [](const SceneDesc &, const RunOptions &) -> std::unique_ptr<Simulation> {
        throw std::logic_error("run again");
    };
    EXPECT_EQ(chart_scene(scene, options).runs.at(3).error, chart.runs[3].error);
    options.one_step = false;
    EXPECT_NE(chart_fingerprint(scene, options), fingerprint);
}

TEST(OneStepChart, FailuresAreCrossesAndSayWhy) {
    ChartOptions options = one_step_chart();
    options.methods = {"rk4"};
    options.sweep = {parse_sweep("dt=1/60,1/50")};
    const ChartContent content = chart_content(chart_scene(slow_spring(), options), "");
    ASSERT_EQ(content.failures.size(), 1U);
    EXPECT_EQ(content.failures[0],
              "Runge-Kutta 4, 1/50 s: no result: steps of 1/50 s do not add up "
              "to the frame of 1/60 s");
    EXPECT_EQ(content.marks.at(1).failed, true);
    for (const auto &change : {+[](ChartOptions &o) { o.convergence = true; },
                               +[](ChartOptions &o) { o.expect = "x"; }}) {
        options = one_step_chart();
        change(options);
        EXPECT_THROW((void)chart_scene(slow_spring(), options), std::invalid_argument);
    }
}

TEST(OneStepChart, WhatIsNotTenTimesAsFarOffAsTheAccurateRunIsNotToldApart) {
    SceneChart chart;
    chart.scene = falling_scene();
    chart.steps_from = {1.0 / 60, 24, "accurate", {1e-6, 1e-5, {}}};
    chart.sweep = {parse_sweep("substeps=1..4")};
    for (const auto &[n, cost, error] :
         {std::tuple{1, 1.0, 3e-5}, {2, 2.0, 9e-6}, {4, 3.0, 2e-6}}) {
        ChartRun run;
        run.resolved.method = find_method_info("soft_step");
        run.resolved.settings.substeps = n;
        run.point = {static_cast<double>(n)};
        run.timings = {cost};
        run.cost = run.cost_low = run.cost_high = cost;
        run.one_step.rms = error;
        chart.runs.push_back(run);
    }
    finish_chart(chart);
    EXPECT_TRUE(chart.told_apart(chart.runs[0]));
    EXPECT_FALSE(chart.told_apart(chart.runs[1]));
    EXPECT_TRUE(chart.runs[0].pareto && chart.runs[1].pareto);
    EXPECT_FALSE(chart.runs[2].pareto); // costs more, and not known to be more accurate
    const ChartContent content = chart_content(chart, "");
    EXPECT_EQ(content.floor_label, "not resolved below 10 µm");
    const auto size = [](std::string_view text, float height) {
        return glm::vec2(0.5f * height * static_cast<float>(text.size()), height);
    };
    const ChartLayout layout = lay_out(content, size);
    ASSERT_TRUE(layout.floor_line);
    EXPECT_GT(*layout.floor_line, layout.marks[0].y);
    EXPECT_LT(*layout.floor_line, layout.marks[1].y);
    chart.steps_from->own_error.rms = 1e-12; // far below all of them: it takes no space
    EXPECT_FALSE(lay_out(chart_content(chart, ""), size).floor_line);
}

} // namespace
} // namespace plumb
