// Judging against motions that are known in closed form.
#include "app/lab/expectation.h"

#include "app/lab/quantity_probe.h"
#include "tests/lab/fake_simulation.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace plumb {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double g = 9.81;

ExpectDesc expect_of(const std::string &quantity, const std::string &reduce, double from, double to,
                     double value, double tolerance) {
    ExpectDesc desc;
    desc.name = quantity + " " + reduce;
    desc.quantity = quantity;
    desc.body = "ball";
    desc.reduce = reduce;
    desc.from = from;
    desc.to = to;
    desc.value = value;
    desc.tolerance = tolerance;
    return desc;
}

SceneDesc scene_of(std::vector<ExpectDesc> expects) {
    SceneDesc scene;
    scene.name = "fake";
    scene.expects = std::move(expects);
    return scene;
}

FakeSimulation falling(double dt) {
    FakeSimulation fake(dt);
    fake.state_at = [](double t) {
        BodyState state;
        state.position = {3 * t, 100 - 0.5 * g * t * t, 0};
        state.velocity = {3, -g * t, 0};
        return state;
    };
    return fake;
}

TEST(Expectation, FreeFall) {
    FakeSimulation fake = falling(0.01);
    const SceneDesc scene = scene_of({
        expect_of("position.y", "last", 0, 2, 100 - 2 * g, 1e-9),
        expect_of("velocity.y", "last", 0, 1, -g, 1e-9),
        expect_of("speed", "max", 0, 2, std::hypot(3.0, 2 * g), 1e-9),
        expect_of("displacement", "last", 0, 1, std::hypot(3.0, 0.5 * g), 1e-9),
        expect_of("position.y", "last", 0, 2, 100 - 2 * g + 0.5, 0.25),
    });
    const JudgedRun run = judge_run(fake, scene);
    EXPECT_EQ(run.steps, 200U);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_TRUE(run.outcomes[i].passed) << i << ": " << run.outcomes[i].measured;
        EXPECT_TRUE(run.outcomes[i].judged);
    }
    EXPECT_FALSE(run.outcomes[4].passed);
    // The measured height is exact but for rounding (a dozen roundings of numbers below 128).
    EXPECT_NEAR(run.outcomes[4].error, 0.5, 1e-12);
    EXPECT_EQ(run.outcomes[4].limit, 0.25);
    EXPECT_FALSE(run.all_passed());
    EXPECT_EQ(fake.measure_calls, 0); // none of these quantities needs it
}

TEST(Expectation, WindowEdgesBetweenStepsAreInterpolated) {
    // x = 3 t is linear, so the interpolated value is exact; 0.07 does not divide 1.
    FakeSimulation fake = falling(0.07);
    const SceneDesc scene = scene_of({expect_of("position.x", "last", 0, 1, 3, 1e-12),
                                      expect_of("position.x", "drift", 0.5, 1, 1.5, 1e-12),
                                      expect_of("position.x", "mean", 0.5, 1, 2.25, 1e-12),
                                      expect_of("position.x", "last", 0.73, 0.73, 2.19, 1e-12)});
    const JudgedRun run = judge_run(fake, scene);
    EXPECT_EQ(run.steps, 15U); // the first step past 1 s
    for (const ExpectOutcome &outcome : run.outcomes)
        EXPECT_TRUE(outcome.passed) << outcome.desc.name << ": " << outcome.measured;
}

TEST(Expectation, SineHasItsPeriodAndAmplitude) {
    FakeSimulation fake(0.01);
    fake.state_at = [](double t) {
        BodyState state;
        state.position.x = 0.4 * std::sin(2 * pi * t / 0.7 + 0.3);
        return state;
    };
    // A chord misses the sine by up to (omega dt)^2 / 8 = 1e-3 of the amplitude near its peak, and
    // by third order near a crossing: 1e-5 s is generous there. The peak is sampled within half a
    // step: 1 - cos(omega dt / 2) = 1.0e-3 of 0.4 m.
    const SceneDesc scene = scene_of({expect_of("position.x", "period", 0, 5, 0.7, 1e-5),
                                      expect_of("position.x", "max_abs", 0, 5, 0.4, 4.1e-4)});
    const JudgedRun run = judge_run(fake, scene);
    EXPECT_TRUE(run.outcomes[0].passed) << run.outcomes[0].measured;
    EXPECT_EQ(run.outcomes[0].unit, "s");
    EXPECT_TRUE(run.outcomes[1].passed) << run.outcomes[1].measured;
}

TEST(Expectation, PeriodThatNeverComesFails) {
    FakeSimulation fake = falling(0.01);
    const JudgedRun run =
        judge_run(fake, scene_of({expect_of("position.y", "period", 0, 1, 1, 1e9)}));
    EXPECT_TRUE(run.outcomes[0].judged);
    EXPECT_FALSE(run.outcomes[0].passed);
    EXPECT_TRUE(std::isinf(run.outcomes[0].error));
}

TEST(Expectation, Bounds) {
    ExpectDesc desc = expect_of("position.y", "last", 0, 1, 2, 0);
    desc.relation = ExpectDesc::Relation::at_most;
    EXPECT_TRUE(judge(desc, 2).passed);
    EXPECT_FALSE(judge(desc, 2.001).passed);
    EXPECT_EQ(judge(desc, 1.5).error, 1.5);
    EXPECT_EQ(judge(desc, 1.5).limit, 2);
    EXPECT_EQ(judge(desc, -5).error, 0);
    EXPECT_TRUE(judge(desc, -5).passed);
    EXPECT_FALSE(judge(desc, NAN).passed);
    EXPECT_FALSE(judge(desc, INFINITY).passed);
    desc.value = -1;
    EXPECT_TRUE(judge(desc, -1.5).passed);
    EXPECT_FALSE(judge(desc, -0.75).passed);
    EXPECT_EQ(judge(desc, -0.75).error, 0.25);
    EXPECT_EQ(judge(desc, -0.75).limit, 0);
    desc.relation = ExpectDesc::Relation::at_least;
    EXPECT_TRUE(judge(desc, -1).passed);
    EXPECT_FALSE(judge(desc, -1.5).passed);
    EXPECT_EQ(judge(desc, -1.5).error, 0.5);
    EXPECT_FALSE(judge(desc, -INFINITY).passed);
    EXPECT_FALSE(judge(desc, NAN).passed);
}

TEST(Expectation, DivergenceEndsTheRunAndSaysWhenAndWhere) {
    FakeSimulation fake = falling(0.1);
    fake.nan_from_step = 7;
    const SceneDesc scene = scene_of({expect_of("position.x", "last", 0, 0.5, 1.5, 1e-9),
                                      expect_of("position.x", "last", 0, 2, 6, 1e-9)});
    const JudgedRun run = judge_run(fake, scene);
    ASSERT_TRUE(run.divergence);
    EXPECT_EQ(run.steps, 7U);
    EXPECT_EQ(run.divergence->step, 7U);
    EXPECT_DOUBLE_EQ(run.divergence->time, 0.7);
    EXPECT_EQ(run.divergence->body, "ball");
    ASSERT_TRUE(run.divergence->last_position);
    EXPECT_DOUBLE_EQ(run.divergence->last_position->x, 3 * 0.6);
    EXPECT_TRUE(run.outcomes[0].passed); // its window ended before
    EXPECT_FALSE(run.outcomes[1].judged);
    EXPECT_FALSE(run.outcomes[1].passed);
    EXPECT_FALSE(run.all_passed());
    EXPECT_NE(describe(*run.divergence).find("step 7 (0.7 s): body \"ball\""), std::string::npos)
        << describe(*run.divergence);
}

TEST(Expectation, FailedCheckIsADivergence) {
    FakeSimulation fake = falling(0.1);
    fake.throw_at_step = 3;
    const JudgedRun run =
        judge_run(fake, scene_of({expect_of("position.x", "last", 0, 2, 6, 1e-9)}));
    ASSERT_TRUE(run.divergence);
    EXPECT_EQ(run.divergence->step, 3U);
    EXPECT_NE(describe(*run.divergence).find("told to fail"), std::string::npos);
}

TEST(Expectation, StopEndsTheRun) {
    FakeSimulation fake = falling(0.1);
    JudgeOptions options;
    options.stop = [&] { return fake.step_count() == 4; };
    const JudgedRun run =
        judge_run(fake, scene_of({expect_of("position.x", "last", 0, 2, 6, 1e-9)}), options);
    EXPECT_TRUE(run.stopped);
    EXPECT_EQ(run.steps, 4U);
    EXPECT_FALSE(run.outcomes[0].judged);
    EXPECT_FALSE(run.all_passed());
}

TEST(Expectation, FollowedErrorsAreTheWorstOfTheRun) {
    FakeSimulation fake(0.125); // a power of two: t = 0.5 is met exactly
    fake.measures_at = [](double t) {
        Measures measures;
        measures.kinetic_energy = 3 + t * t; // grows to 4
        measures.potential_energy = -1;
        measures.max_penetration = t * (1 - t); // at most 0.25
        measures.max_joint_drift = 0.1 * t;
        return measures;
    };
    JudgeOptions options;
    options.follow_errors = true;
    options.duration = 1;
    bool at_time = false;
    options.at_time_seconds = 0.5;
    options.at_time = [&] {
        at_time = true;
        EXPECT_DOUBLE_EQ(fake.time(), 0.5);
    };
    const JudgedRun run = judge_run(fake, scene_of({}), options);
    EXPECT_TRUE(at_time);
    EXPECT_TRUE(run.had_contacts);
    EXPECT_DOUBLE_EQ(run.max_penetration, 0.25);
    EXPECT_DOUBLE_EQ(run.max_joint_drift, 0.1);
    EXPECT_DOUBLE_EQ(run.max_energy_change, 1);
    EXPECT_DOUBLE_EQ(run.max_energy_error, 0.25); // of 3 + |-1|
    EXPECT_EQ(fake.measure_calls, 1 + 9);         // the probe's start, and each sample: once
}

TEST(QuantityProbe, ReadsBodiesAndScales) {
    FakeSimulation fake(0.5);
    const double s = std::sqrt(0.5);
    fake.state_at = [&](double t) {
        BodyState state;
        state.position = {1, 0, 0};
        state.velocity = {0, 3, 4};
        state.angular_velocity = {0, 0, 5};
        if (t > 0)
            state.orientation = glm::dquat(s, s, 0, 0); // a quarter turn about x
        return state;
    };
    fake.measures_at = [](double t) {
        Measures measures;
        measures.linear_momentum = {t, 0, 0};
        measures.angular_momentum = {0, t, 0};
        return measures;
    };
    const QuantityProbe probe(fake, {{"tilt", "ball"},
                                     {"angular_velocity_local.y", "ball"},
                                     {"angular_velocity_local.z", "ball"},
                                     {"linear_momentum_error", ""},
                                     {"angular_momentum_error", ""}});
    EXPECT_TRUE(probe.measures());
    fake.step();
    const std::vector<double> values = probe.sample(fake);
    constexpr double rounding = 1e-15;
    EXPECT_NEAR(values[0], pi / 2, rounding);
    EXPECT_NEAR(values[1], 5, 5 * rounding); // the world's z is the body's y now
    EXPECT_NEAR(values[2], 0, 5 * rounding);
    EXPECT_NEAR(values[3], 0.5 / (2 * 5), rounding);         // m |v| = 2 * 5
    EXPECT_NEAR(values[4], 0.5 / (2 * 5 + 3 * 5), rounding); // |r x m v| + |I w|, r normal to v
    EXPECT_THROW(QuantityProbe(fake, {{"position.y", "nobody"}}), std::invalid_argument);
    EXPECT_THROW(QuantityProbe(fake, {{"nothing", "ball"}}), std::invalid_argument);
}

} // namespace
} // namespace plumb
