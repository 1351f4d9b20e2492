// A fake engine with closed-form motion, seen through the adaptor.
#include "app/lab/engines/engine_simulation.h"

#include "app/lab/chart/chart.h"
#include "app/lab/chart/chart_rows.h"
#include "app/lab/csv.h"
#include "app/lab/run/judged_run.h"
#include "engine/scene/scene_file.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include <gtest/gtest.h>

namespace plumb {
namespace {

constexpr double gravity = 9.81;

// Falls correctly except for an error that each iteration halves.
class FallingEngine final : public Engine {
  public:
    explicit FallingEngine(const EngineScene &scene) : scene_(scene) {}
    void step() override { ++steps_; }
    StepWork work() const override { return {0, 3, 5}; }
    std::vector<BodyState> states() const override {
        const double t = static_cast<double>(steps_) * scene_.dt();
        std::vector<BodyState> states;
        for (const BodyDesc &body : scene_.desc.bodies)
            states.push_back({body.position, body.orientation, body.velocity});
        states[1].position.y -= 0.5 * gravity * t * t * (1 + std::pow(0.5, scene_.iterations()));
        states[1].velocity.y = -gravity * t;
        return states;
    }

  private:
    const EngineScene &scene_;
    int steps_ = 0;
};

OtherEngine falling_engine() {
    OtherEngine engine;
    engine.info.name = "pretended";
    engine.info.title = "Pretended";
    engine.info.reads = {SettingGroup::constraints};
    engine.info.defaults = {.substeps = 1, .iterations = 4};
    engine.precision = Precision::f64;
    engine.create = [](const EngineScene &scene) { return std::make_unique<FallingEngine>(scene); };
    return engine;
}

SceneDesc ball_above_floor() {
    SceneDesc scene;
    scene.name = "ball";
    BodyDesc floor;
    floor.name = "floor";
    floor.kind = BodyKind::static_body;
    floor.colliders.emplace_back().shape = PlaneDesc{};
    BodyDesc ball;
    ball.name = "ball";
    ball.mass = 2;
    ball.position.y = 5.2;
    ball.colliders.emplace_back().shape = SphereDesc{0.5};
    scene.bodies = {floor, ball};
    ExpectDesc expect;
    expect.name = "y";
    expect.quantity = "position.y";
    expect.body = "ball";
    expect.to = 1;
    expect.value = 5.2 - 0.5 * gravity;
    expect.tolerance = 0.1;
    scene.expects = {expect};
    return scene;
}

TEST(EngineSimulation, IsMeasuredByItsPosesAndVelocities) {
    const OtherEngine engine = falling_engine();
    const SceneDesc scene = ball_above_floor();
    EXPECT_EQ(why_not(engine, scene), "");
    GivenSettings given;
    given.give(&StepSettings::iterations, 40); // practically exact
    given.give(&StepSettings::substeps, 4);
    const ResolvedRun run = resolve_run(engine, scene, given);
    const auto simulation = engine_simulation(engine, scene, run);
    const auto start = simulation->save();
    for (int i = 0; i < 60; ++i)
        simulation->step();
    EXPECT_NEAR(simulation->time(), 1, 1e-12);
    EXPECT_NEAR(simulation->read().bodies.at(1).position.y, 5.2 - 0.5 * gravity, 1e-9);
    const Measures now = simulation->measure();
    EXPECT_NEAR(now.kinetic_energy, 0.5 * 2 * gravity * gravity, 1e-9);
    EXPECT_NEAR(now.potential_energy, 2 * gravity * (5.2 - 0.5 * gravity), 1e-9);
    EXPECT_NEAR(now.linear_momentum.y, -2 * gravity, 1e-9);
    EXPECT_NEAR(now.max_penetration, 0.5 - (5.2 - 0.5 * gravity), 1e-9); // ball in plane
    EXPECT_EQ(simulation->report().constraint_passes, 4U * 5);
    EXPECT_TRUE(simulation->report().finite);
    simulation->restore(*start);
    EXPECT_EQ(simulation->read().bodies.at(1).position.y, 5.2);
    EXPECT_THROW(simulation->set_method("soft_step"), std::invalid_argument);
}

TEST(EngineSimulation, StandsOnTheChartBesideTheMethods) {
    const OtherEngine engine = falling_engine();
    ChartOptions options;
    options.methods = {"soft_step"};
    options.engines = {&engine};
    options.sweep = {parse_sweep("iterations=1,2,8")};
    options.repeats = 2;
    const SceneChart chart = chart_scene(ball_above_floor(), options);
    std::vector<double> errors;
    for (const ChartRun &run : chart.runs)
        if (run.resolved.method == &engine.info) {
            errors.push_back(run.error);
            EXPECT_EQ(run.timings.size(), 2U);
        }
    ASSERT_EQ(errors.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_NEAR(errors[i], 0.5 * gravity * std::pow(0.5, std::array{1, 2, 8}[i]), 1e-9);
    EXPECT_EQ(chart_content(chart, "").series.back().name, "Pretended, double");
}

// Other engines tell no contact forces: what is about them does not count against them, and the
// chart says so, also once it is read back from its table.
TEST(EngineSimulation, IsJudgedByWhatCanBeMeasured) {
    const OtherEngine engine = falling_engine();
    SceneDesc scene = ball_above_floor();
    scene.expects[0].tolerance = 1;
    ExpectDesc &residual = scene.expects.emplace_back();
    residual.name = "is not pushed apart";
    residual.quantity = "signorini_residual";
    residual.reduce = "max";
    residual.to = 0.2;
    residual.relation = ExpectDesc::Relation::at_most;
    residual.value = 1;
    ChartOptions options;
    options.methods = {"soft_step"};
    options.engines = {&engine};
    options.sweep = {parse_sweep("iterations=8")};
    options.repeats = 1;
    SceneChart chart = chart_scene(scene, options);
    ASSERT_EQ(chart.runs.size(), 2U);
    const ChartRun &run = chart.runs.back();
    EXPECT_EQ(run.status, ChartStatus::fine) << run.failure;
    EXPECT_NEAR(run.error, 0.5 * gravity * std::pow(0.5, 8), 1e-9);
    EXPECT_EQ(chart.runs.front().run.outcomes[1].verdict, Verdict::met); // measured for ours
    const std::string note = "\"is not pushed apart\" cannot be measured for Pretended";
    EXPECT_EQ(not_judged(chart), std::vector{note});
    EXPECT_EQ(chart_content(chart, "").left_out.front(), note);
    std::ostringstream text, table;
    print(text, chart);
    EXPECT_NE(text.str().find("not judged: " + note), std::string::npos) << text.str();
    chart.runs[1].resolved.method = chart.runs[0].resolved.method; // one a reader knows
    write_chart_csv(table, chart);
    std::istringstream in(table.str());
    CsvReader rows(in);
    ASSERT_TRUE(rows.next());
    EXPECT_EQ(rows.cell("not_judged"), "");
    ASSERT_TRUE(rows.next());
    EXPECT_EQ(rows.cell("not_judged"), "is not pushed apart");
    EXPECT_EQ(rows.cell("status"), "fine");
    const SceneChart merged = merged_chart(scene, {{"table", table.str()}});
    EXPECT_EQ(merged.runs[1].status, ChartStatus::fine);
    EXPECT_EQ(merged.runs[1].run.outcomes[1].verdict, Verdict::unseen);

    options.expect = residual.name; // asked for by name
    const SceneChart alone = chart_scene(scene, options);
    EXPECT_EQ(alone.runs.back().status, ChartStatus::no_result);
    EXPECT_EQ(alone.runs.back().failure, "no result: is not pushed apart");
}

// Semi-implicit Euler that counts the calls of put().
class SteppedEngine final : public Engine {
  public:
    explicit SteppedEngine(const EngineScene &scene) : dt_(scene.dt()) {
        for (const BodyDesc &body : scene.desc.bodies)
            states_.push_back({body.position, body.orientation, body.velocity});
    }
    void step() override {
        states_[1].velocity.y -= gravity * dt_;
        states_[1].position.y += states_[1].velocity.y * dt_;
    }
    StepWork work() const override { return {}; }
    std::vector<BodyState> states() const override { return states_; }
    void put(const std::vector<BodyState> &states) override {
        states_ = states;
        most_puts = std::max(most_puts, ++puts_);
    }

    static inline int most_puts = 0;

  private:
    double dt_;
    std::vector<BodyState> states_;
    int puts_ = 0;
};

TEST(EngineSimulation, SingleStepsAreOfOneEngineThatIsPutFromStateToState) {
    OtherEngine engine = falling_engine();
    engine.create = [](const EngineScene &scene) { return std::make_unique<SteppedEngine>(scene); };
    SceneDesc scene = ball_above_floor();
    scene.expects[0].to = 0.5;
    ChartOptions options;
    options.one_step = true;
    options.methods = {"rk4", "semi_implicit_euler"};
    options.engines = {&engine};
    options.sweep = {parse_sweep("substeps=2")};
    options.repeats = 1;
    SteppedEngine::most_puts = 0;
    const SceneChart chart = chart_scene(scene, options);
    const ChartRun &run = chart.runs.back();
    ASSERT_EQ(run.resolved.method, &engine.info);
    const double h = 1.0 / 120; // g h t / 2
    EXPECT_NEAR(run.one_step.rms, 0.5 * gravity * h / 60, 1e-9);
    EXPECT_NEAR(run.one_step.worst, run.one_step.rms, 1e-9);
    EXPECT_EQ(SteppedEngine::most_puts, 29); // of 30 states; it was created with the first
}

TEST(EngineSimulation, WhatTheAdapterDoesNotSupportIsLeftOutWithAReason) {
    const OtherEngine engine = falling_engine();
    SceneDesc scene = ball_above_floor();
    scene.bodies[1].linear_damping = 0.1;
    EXPECT_EQ(why_not(engine, scene),
              "pretended cannot run this scene: the adapter does not support bodies with damping "
              "or a gravity scale");
    scene = ball_above_floor();
    scene.bodies[1].center_of_mass = glm::dvec3(0.1, 0, 0);
    EXPECT_NE(why_not(engine, scene).find("frame"), std::string::npos);
    scene = ball_above_floor();
    JointDesc joint;
    joint.type = JointType::slider;
    joint.body_b = "ball";
    joint.name = "rail";
    joint.anchor_a_local = {0, 5.2, 0};
    scene.joints = {joint};
    EXPECT_NE(why_not(engine, scene).find("joints other than ball and hinge"), std::string::npos);
    ChartOptions options;
    options.methods = {"soft_step"};
    options.engines = {&engine};
    options.repeats = 1;
    options.sweep = {parse_sweep("substeps=1")};
    const SceneChart chart = chart_scene(scene, options);
    ASSERT_FALSE(chart.left_out.empty());
    EXPECT_EQ(chart.left_out.back(), why_not(engine, scene));
    EXPECT_THROW((void)find_other_engines({"no_such_engine"}), std::invalid_argument);
}

} // namespace
} // namespace plumb
