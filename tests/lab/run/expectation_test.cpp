// Judging motions known in closed form.
#include "app/lab/run/judged_run.h"

#include "app/lab/run/expectation_watch.h"
#include "app/lab/run/quantity_probe.h"
#include "engine/core/random.h"
#include "tests/lab/run/fake_simulation.h"

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
        EXPECT_EQ(run.outcomes[i].verdict, Verdict::met) << i << ": " << run.outcomes[i].measured;
        EXPECT_TRUE(run.outcomes[i].judged());
    }
    EXPECT_NE(run.outcomes[4].verdict, Verdict::met);
    // The measured height is exact up to round-off (a dozen round-offs of numbers below 128).
    EXPECT_NEAR(run.outcomes[4].error, 0.5, 1e-12);
    EXPECT_EQ(run.outcomes[4].limit, 0.25);
    EXPECT_FALSE(run.all_met());
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
        EXPECT_EQ(outcome.verdict, Verdict::met) << outcome.desc.name << ": " << outcome.measured;
}

double wave(double t) {
    return 0.4 * std::sin(2 * pi * t / 0.7 + 0.3);
}

// Expects the curve of the wave, sampled at `count` values.
ExpectDesc curve_of_wave(const std::string &reduce, double from, double to, int count,
                         double tolerance) {
    ExpectDesc desc = expect_of("position.x", reduce, from, to, 0, tolerance);
    for (int i = 0; i < count; ++i)
        desc.curve.push_back(wave(from + (to - from) * i / (count - 1)));
    return desc;
}

// Steps that fall neither on the window's edges nor on the curve's values. The curve itself is off
// by up to a (w h)^4 / 24 = 2e-6 m.
TEST(Expectation, CurvesAreMissedByTheirWorstOrTheirMean) {
    FakeSimulation fake(0.013);
    fake.state_at = [](double t) {
        BodyState state;
        state.position.x = wave(t) + 0.01 * t;
        return state;
    };
    const SceneDesc scene = scene_of(
        {curve_of_wave("max", 0.5, 4, 321, 0.041), curve_of_wave("mean", 0.5, 4, 321, 0.023),
         curve_of_wave("max", 0.5, 4, 321, 0.039), curve_of_wave("mean", 0.5, 4, 321, 0.022)});
    const JudgedRun run = judge_run(fake, scene);
    // Off by 0.01 t, at the first and the last step of the window at 0.507 and 3.991 s.
    constexpr double curve = 2e-6;
    EXPECT_NEAR(run.outcomes[0].measured, 0.03991, curve);
    EXPECT_NEAR(run.outcomes[1].measured, 0.5 * (0.00507 + 0.03991), curve);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(run.outcomes[i].verdict, i < 2 ? Verdict::met : Verdict::missed) << i;
        EXPECT_EQ(run.outcomes[i].error, run.outcomes[i].measured);
        EXPECT_EQ(run.outcomes[i].limit, scene.expects[i].tolerance);
        EXPECT_EQ(run.outcomes[i].unit, "m");
    }
    EXPECT_EQ(demand(run.outcomes[0]), "at most 0.041 m off its curve (max)");
}

TEST(Expectation, CurvesOfWhatIsNoNumberOrHasNoStepsAreMissed) {
    FakeSimulation fake(0.5);
    fake.state_at = [](double t) {
        BodyState state;
        state.position.x = t == 1 ? NAN : 0;
        return state;
    };
    const JudgedRun run = judge_run(
        fake, scene_of({curve_of_wave("max", 0.6, 0.9, 9, 9), curve_of_wave("mean", 0, 2, 9, 9)}));
    for (const ExpectOutcome &outcome : run.outcomes) {
        EXPECT_EQ(outcome.verdict, Verdict::missed);
        EXPECT_TRUE(std::isinf(outcome.error));
    }
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
    EXPECT_EQ(run.outcomes[0].verdict, Verdict::met) << run.outcomes[0].measured;
    EXPECT_EQ(run.outcomes[0].unit, "s");
    EXPECT_EQ(run.outcomes[1].verdict, Verdict::met) << run.outcomes[1].measured;
}

TEST(Expectation, PeriodThatNeverComesFails) {
    FakeSimulation fake = falling(0.01);
    const JudgedRun run =
        judge_run(fake, scene_of({expect_of("position.y", "period", 0, 1, 1, 1e9)}));
    EXPECT_TRUE(run.outcomes[0].judged());
    EXPECT_NE(run.outcomes[0].verdict, Verdict::met);
    EXPECT_TRUE(std::isinf(run.outcomes[0].error));
}

TEST(Expectation, Bounds) {
    ExpectDesc desc = expect_of("position.y", "last", 0, 1, 2, 0);
    desc.relation = ExpectDesc::Relation::at_most;
    EXPECT_EQ(judge(desc, 2).verdict, Verdict::met);
    EXPECT_EQ(judge(desc, 2.001).verdict, Verdict::missed);
    EXPECT_EQ(judge(desc, 1.5).error, 1.5);
    EXPECT_EQ(judge(desc, 1.5).limit, 2);
    EXPECT_EQ(judge(desc, -5).error, 0);
    EXPECT_EQ(judge(desc, -5).verdict, Verdict::met);
    EXPECT_EQ(judge(desc, NAN).verdict, Verdict::missed);
    EXPECT_EQ(judge(desc, INFINITY).verdict, Verdict::missed);
    desc.value = -1;
    EXPECT_EQ(judge(desc, -1.5).verdict, Verdict::met);
    EXPECT_EQ(judge(desc, -0.75).verdict, Verdict::missed);
    EXPECT_EQ(judge(desc, -0.75).error, 0.25);
    EXPECT_EQ(judge(desc, -0.75).limit, 0);
    desc.relation = ExpectDesc::Relation::at_least;
    EXPECT_EQ(judge(desc, -1).verdict, Verdict::met);
    EXPECT_EQ(judge(desc, -1.5).verdict, Verdict::missed);
    EXPECT_EQ(judge(desc, -1.5).error, 0.5);
    EXPECT_EQ(judge(desc, -INFINITY).verdict, Verdict::missed);
    EXPECT_EQ(judge(desc, NAN).verdict, Verdict::missed);
}

ExpectDesc bound(ExpectDesc::Relation relation, double value) {
    ExpectDesc desc = expect_of("position.y", "last", 0, 1, value, 0);
    desc.relation = relation;
    return desc;
}

// By hand, from the definition in the header.
TEST(Expectation, ErrorsInUnitsOfTheirTolerance) {
    using Relation = ExpectDesc::Relation;
    const ExpectDesc equals = expect_of("position.y", "last", 0, 1, 10, 0.5);
    EXPECT_EQ(judge(equals, 10).scaled_error, 0);
    EXPECT_EQ(judge(equals, 10.25).scaled_error, 0.5);
    EXPECT_EQ(judge(equals, 8).scaled_error, 4);
    EXPECT_EQ(judge(bound(Relation::at_most, 4), 1).scaled_error, 0.25);
    EXPECT_EQ(judge(bound(Relation::at_most, 4), 4).scaled_error, 1);
    EXPECT_EQ(judge(bound(Relation::at_most, 4), 12).scaled_error, 3);
    EXPECT_EQ(judge(bound(Relation::at_most, -4), -5).scaled_error, 0);
    EXPECT_EQ(judge(bound(Relation::at_most, -4), -3).scaled_error, 1.25);
    EXPECT_EQ(judge(bound(Relation::at_least, 4), 4).scaled_error, 0);
    EXPECT_EQ(judge(bound(Relation::at_least, 4), 1).scaled_error, 1.75);
    EXPECT_EQ(judge(bound(Relation::at_least, 0), -0.5).scaled_error, 1.5); // in its own unit
    EXPECT_TRUE(std::isinf(judge(equals, NAN).scaled_error));
    EXPECT_TRUE(std::isinf(judge(bound(Relation::at_most, 4), -INFINITY).scaled_error));
}

// Whatever the numbers and their round-off: met exactly when the scaled error is at most 1, and
// finite whenever the measured value is.
TEST(Expectation, TheScaledErrorAndTheVerdictNeverDisagree) {
    Random random(7);
    const auto any = [&] {
        const double sign = random.next_index(2) == 0 ? 1 : -1;
        return sign * std::pow(10, random.next_in(-320, 300));
    };
    int met = 0;
    for (int i = 0; i < 200'000; ++i) {
        ExpectDesc desc = expect_of("position.y", "last", 0, 1, any(), 0);
        desc.relation = static_cast<ExpectDesc::Relation>(random.next_index(3));
        if (desc.relation == ExpectDesc::Relation::equals)
            desc.tolerance = std::abs(any());
        if (random.next_index(16) == 0)
            desc.value = 0;
        double value = any();
        // As close to the edge as floating point allows.
        if (random.next_index(2) == 0) {
            value = desc.value + (random.next_index(2) == 0 ? desc.tolerance : -desc.tolerance);
            for (std::uint32_t ulps = random.next_index(4); ulps > 0; --ulps)
                value = std::nextafter(value, random.next_index(2) == 0 ? 1e308 : -1e308);
        }
        const ExpectOutcome outcome = judge(desc, value);
        ASSERT_EQ(outcome.verdict == Verdict::met, outcome.scaled_error <= 1)
            << desc.value << " " << desc.tolerance << " " << value;
        ASSERT_GE(outcome.scaled_error, 0);
        ASSERT_TRUE(std::isfinite(outcome.scaled_error) || !std::isfinite(outcome.error));
        met += outcome.verdict == Verdict::met ? 1 : 0;
    }
    EXPECT_GT(met, 40'000);
    EXPECT_LT(met, 160'000);
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
    EXPECT_EQ(run.outcomes[0].verdict, Verdict::met); // its window ended earlier
    EXPECT_FALSE(run.outcomes[1].judged());
    EXPECT_NE(run.outcomes[1].verdict, Verdict::met);
    EXPECT_FALSE(run.all_met());
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
    EXPECT_FALSE(run.outcomes[0].judged());
    EXPECT_FALSE(run.all_met());
}

TEST(Expectation, FollowedErrorsAreTheWorstOfTheRun) {
    FakeSimulation fake(0.125); // a power of two: t = 0.5 is hit exactly
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
    options.times_called = {0.5};
    options.at_time = [&](double) {
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
    EXPECT_DOUBLE_EQ(run.max_energy_gain, 0.25);
    EXPECT_EQ(fake.measure_calls, 1 + 9); // the probe's start, then once per sample
}

// What starts at rest at the origin has no energy; rounding of what it gains by falling is no gain.
TEST(Expectation, AnEnergyGainIsComparedWithTheMotionThereIs) {
    FakeSimulation fake(0.125);
    fake.measures_at = [](double t) {
        Measures measures;
        measures.kinetic_energy = 1000 * t * t;
        measures.potential_energy = -1001 * t * t + 3 * t; // 2 J too much after a second
        return measures;
    };
    JudgeOptions options;
    options.follow_errors = true;
    options.duration = 1;
    const JudgedRun run = judge_run(fake, scene_of({}), options);
    EXPECT_DOUBLE_EQ(run.max_energy_error, 2); // J, for want of a scale
    EXPECT_LT(run.max_energy_gain, 0.03);
}

// x grows by 1 m/s, and z falls at the same rate.
FakeSimulation moving(double dt) {
    FakeSimulation fake(dt);
    fake.state_at = [](double t) {
        BodyState state;
        state.position = {t, 0, -t};
        return state;
    };
    return fake;
}

TEST(ExpectationWatch, IsPendingUntilTheWindowEnds) {
    FakeSimulation fake = moving(0.125);
    ExpectationWatch watch(fake, {expect_of("position.x", "mean", 0.5, 1, 0.75, 1e-9),
                                  expect_of("position.x", "last", 0, 1, 1, 1e-9)});
    EXPECT_TRUE(std::isnan(watch.outcome(0).measured)); // its window has not begun
    EXPECT_EQ(watch.outcome(1).measured, 0);
    for (int step = 1; step <= 8; ++step) {
        for (std::size_t i = 0; i < 2; ++i)
            ASSERT_EQ(watch.outcome(i).verdict, Verdict::pending) << i << " before step " << step;
        fake.step();
        watch.sample(fake);
        ASSERT_EQ(watch.outcome(1).measured, 0.125 * step);
        if (step == 6) {
            EXPECT_EQ(watch.outcome(0).measured, 0.625); // of 0.5 to 0.75 s
        }
    }
    EXPECT_EQ(watch.outcome(0).verdict, Verdict::met) << watch.outcome(0).measured;
    EXPECT_EQ(watch.outcome(1).verdict, Verdict::met);
    // Later values change nothing.
    fake.step();
    watch.sample(fake);
    EXPECT_EQ(watch.outcome(1).measured, 1);
}

// As soon as no later value can help, and not a step earlier.
TEST(ExpectationWatch, WhatCanNoLongerBeMetIsMissedAtOnce) {
    using Relation = ExpectDesc::Relation;
    const auto with = [](const char *quantity, const char *reduce, Relation relation, double value,
                         double tolerance = 0) {
        ExpectDesc desc = expect_of(quantity, reduce, 0, 4, value, tolerance);
        desc.relation = relation;
        return desc;
    };
    const std::vector<ExpectDesc> doomed{
        with("position.x", "max", Relation::at_most, 0.5),
        with("position.x", "drift", Relation::at_most, 0.5),
        with("position.z", "max_abs", Relation::at_most, 0.5),
        with("position.z", "min", Relation::at_least, -0.5),
        with("position.x", "max", Relation::equals, 0.25, 0.25),
        with("position.z", "min", Relation::equals, -0.25, 0.25),
    };
    const std::vector<ExpectDesc> open{
        with("position.x", "last", Relation::at_most, 0.5),
        with("position.x", "mean", Relation::at_most, 0.125),
        with("position.x", "max", Relation::at_least, 100),
        with("position.z", "min", Relation::at_most, -100),
        with("position.x", "max", Relation::equals, 100, 0.1),
        with("position.x", "crossings", Relation::at_most, 0), // crossings of a moving level
    };
    std::vector<ExpectDesc> all = doomed;
    all.insert(all.end(), open.begin(), open.end());
    FakeSimulation fake = moving(0.125);
    ExpectationWatch watch(fake, all);
    for (int step = 1; step <= 31; ++step) {
        fake.step();
        watch.sample(fake);
        for (std::size_t i = 0; i < all.size(); ++i)
            ASSERT_EQ(watch.outcome(i).verdict,
                      i < doomed.size() && step > 4 ? Verdict::missed : Verdict::pending)
                << all[i].quantity << " " << all[i].reduce << " at step " << step;
    }
    fake.step();
    watch.sample(fake);
    for (std::size_t i = 0; i < all.size(); ++i)
        EXPECT_TRUE(watch.outcome(i).judged());
}

// The worst error is judged immediately once too large; the mean, which may yet fall, at the end.
TEST(ExpectationWatch, WhatIsTooFarFromItsCurveIsMissedAtOnce) {
    const auto at_rest = [](const char *reduce) {
        ExpectDesc desc = expect_of("position.x", reduce, 0, 4, 0, 0.5);
        desc.curve = {0, 0, 0, 0};
        return desc;
    };
    FakeSimulation fake = moving(0.125);
    ExpectationWatch watch(fake, {at_rest("max"), at_rest("mean")});
    EXPECT_EQ(watch.outcome(0).verdict, Verdict::pending);
    for (int step = 1; step < 32; ++step) {
        fake.step();
        watch.sample(fake);
        ASSERT_EQ(watch.outcome(0).verdict, step > 4 ? Verdict::missed : Verdict::pending) << step;
        ASSERT_EQ(watch.outcome(1).verdict, Verdict::pending) << step;
    }
    EXPECT_EQ(watch.missed_since(0), 0.625);
    fake.step();
    watch.sample(fake);
    EXPECT_EQ(watch.outcome(1).verdict, Verdict::missed);
    EXPECT_EQ(watch.outcome(1).measured, 2);
}

// A run that steps back and forth is judged like one that never did.
TEST(ExpectationWatch, GoingBackForgetsWhatCameAfter) {
    const std::vector<ExpectDesc> expects{expect_of("position.x", "max", 0, 1, 0.3, 0.01),
                                          expect_of("position.x", "mean", 0.2, 0.9, 0.55, 1e-9),
                                          expect_of("displacement", "last", 0, 1, 0, 9),
                                          curve_of_wave("max", 0.2, 0.9, 9, 0.2)};
    FakeSimulation fake = moving(0.07);
    ExpectationWatch watch(fake, expects);
    std::vector<std::unique_ptr<Simulation::Saved>> saved;
    Random random(3);
    for (int move = 0; move < 400; ++move) {
        if (random.next_index(3) > 0 || saved.empty()) {
            saved.push_back(fake.save());
            fake.step();
            watch.sample(fake);
        } else {
            const std::size_t back =
                1 + random.next_index(static_cast<std::uint32_t>(saved.size()));
            fake.restore(*saved[saved.size() - back]);
            saved.resize(saved.size() - back);
            watch.go_back(fake);
        }
        FakeSimulation straight = moving(0.07);
        ExpectationWatch fresh(straight, expects);
        while (straight.step_count() < fake.step_count()) {
            straight.step();
            fresh.sample(straight);
        }
        for (std::size_t i = 0; i < expects.size(); ++i) {
            const ExpectOutcome a = watch.outcome(i), b = fresh.outcome(i);
            ASSERT_EQ(a.verdict, b.verdict) << i << " at step " << fake.step_count();
            ASSERT_TRUE(a.measured == b.measured ||
                        (std::isnan(a.measured) && std::isnan(b.measured)));
        }
    }
}

// A run from a saved state has not seen the windows that began before it, nor the position that
// displacement counts from.
TEST(ExpectationWatch, WhatTheRunHasNotSeenIsNotJudged) {
    FakeSimulation fake = moving(0.125);
    for (int i = 0; i < 8; ++i)
        fake.step(); // t = 1 s
    const std::vector<ExpectDesc> expects{expect_of("position.x", "max", 0, 2, 2, 1e-9),
                                          expect_of("position.x", "last", 0, 2, 2, 1e-9),
                                          expect_of("position.x", "max", 1, 2, 2, 1e-9),
                                          expect_of("position.x", "last", 0, 0.5, 0.5, 1),
                                          expect_of("displacement", "max", 1, 2, 1, 9)};
    SceneDesc scene = scene_of(expects);
    const JudgedRun run = judge_run(fake, scene);
    using enum Verdict;
    const std::vector<Verdict> expected{unseen, met, met, unseen, unseen};
    for (std::size_t i = 0; i < expects.size(); ++i)
        EXPECT_EQ(run.outcomes[i].verdict, expected[i]) << i;
    EXPECT_TRUE(run.all_met());
    EXPECT_TRUE(run.any_judged());
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
    QuantityProbe probe(fake, {{"tilt", "ball"},
                               {"angular_velocity_local.y", "ball"},
                               {"angular_velocity_local.z", "ball"},
                               {"linear_momentum_error", ""},
                               {"angular_momentum_error", ""}});
    EXPECT_TRUE(probe.measures());
    fake.step();
    const std::vector<double> values = probe.sample(fake);
    constexpr double rounding = 1e-15;
    EXPECT_NEAR(values[0], pi / 2, rounding);
    EXPECT_NEAR(values[1], 5, 5 * rounding); // the world's z is now the body's y
    EXPECT_NEAR(values[2], 0, 5 * rounding);
    EXPECT_NEAR(values[3], 0.5 / (2 * 5), rounding);         // m |v| = 2 * 5
    EXPECT_NEAR(values[4], 0.5 / (2 * 5 + 3 * 5), rounding); // |r x m v| + |I w|, r normal to v
    EXPECT_THROW(QuantityProbe(fake, {{"position.y", "nobody"}}), std::invalid_argument);
    EXPECT_THROW(QuantityProbe(fake, {{"nothing", "ball"}}), std::invalid_argument);
}

} // namespace
} // namespace plumb
