// The cheapest settings for scenes with closed-form errors, and for some that ship.
#include "tests/lab/falling_ball.h"
#include "tests/lab/tune/printed.h"

#include "app/lab/tune/starts.h"
#include "engine/scene/cloth.h"
#include "engine/scene/file/change.h"
#include "engine/scene/scene_file.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include <gtest/gtest.h>

namespace plumb {
namespace {

// Semi-implicit Euler falls g h t / 2 too far in t = 1 s, with h the substep.
const std::string falling_box = std::string(R"(
[world]
dt = "1/60"
method = "semi_implicit_euler"
precision = "double"
substeps = 40
)") + falling_ball;

double fall_error(int substeps, double dt = 1.0 / 60) {
    return 9.81 * (dt / substeps) / 2 / 0.01; // of its tolerance
}

TuneOptions quick(const std::vector<std::string> &methods,
                  const std::vector<std::string> &settings) {
    TuneOptions options;
    options.methods = methods;
    options.repeats = 1;
    options.starts = 1;
    options.plainer = false;
    options.base.precision = Precision::f64;
    for (const std::string &setting : settings)
        options.base.settings.give(parse_setting(setting));
    return options;
}

SceneText shipped(const std::string &name) {
    std::vector<SceneMessage> messages;
    const std::string path = PLUMB_SOURCE_DIR "/scenes/" + name;
    return {path, read_scene_text(path, messages).value()};
}

TEST(Tune, FindsTheFewestSubstepsThatTheMarginAllows) {
    for (const double tolerance : {1.0, 0.8, 0.3}) {
        TuneOptions options = quick({"semi_implicit_euler"}, {"dt=1/60"});
        options.tolerance = tolerance;
        const Tuning tuning = tune_scene({"fall.toml", falling_box}, options);
        ASSERT_TRUE(tuning.found()) << printed(tuning);
        const TunedRun &chosen = tuning.runs[*tuning.chosen];
        const int n = chosen.resolved.settings.substeps;
        EXPECT_LE(fall_error(n), tolerance) << n;
        EXPECT_GT(fall_error(n - 1), tolerance) << n;
        EXPECT_NEAR(chosen.error, fall_error(n), 1e-3);
        EXPECT_EQ(chosen.worst, "height");
        EXPECT_EQ(chosen.starts, 2);
        ASSERT_TRUE(tuning.dearer);
        EXPECT_EQ(tuning.runs[*tuning.dearer].resolved.settings.substeps, 2 * n);
        EXPECT_NEAR(tuning.runs[*tuning.dearer].error, fall_error(2 * n), 1e-3);
        // Doubling, then bisection, plus the scene's own settings and twice the chosen ones.
        EXPECT_LE(tuning.runs.size(), 12U) << printed(tuning);
        for (const TunedRun &run : tuning.runs) {
            const StepSettings &s = run.resolved.settings;
            const bool met = fall_error(s.substeps, s.dt) <= tolerance;
            EXPECT_EQ(run.verdict, met ? TuneVerdict::met : TuneVerdict::missed) << s.substeps;
        }
    }
}

TEST(Tune, NothingThatIsMoreWorkThanWhatMetIsRun) {
    const Tuning tuning =
        tune_scene({"fall.toml", falling_box}, quick({"semi_implicit_euler"}, {}));
    ASSERT_TRUE(tuning.found()) << printed(tuning);
    const std::vector<TunedRun> &runs = tuning.runs;
    for (std::size_t i = 1; i < runs.size(); ++i)
        for (std::size_t j = 0; j < i && i != tuning.dearer; ++j)
            if (runs[j].verdict == TuneVerdict::met) {
                const bool coarser = runs[i].resolved.settings.dt > runs[j].resolved.settings.dt;
                EXPECT_LT(runs[i].work, (coarser ? 1.3 : 1) * runs[j].work)
                    << i << " after " << j << '\n'
                    << printed(tuning);
            }
}

TEST(Tune, WhatIsGivenStays) {
    TuneOptions options = quick({"semi_implicit_euler", "rk4"}, {"dt=1/120", "substeps=9"});
    const Tuning tuning = tune_scene({"fall.toml", falling_box}, options);
    for (const TunedRun &run : tuning.runs) {
        EXPECT_EQ(run.resolved.settings.substeps, 9);
        EXPECT_EQ(run.resolved.settings.dt, 1.0 / 120);
        EXPECT_EQ(run.resolved.precision, Precision::f64);
    }
    EXPECT_EQ(tuning.runs.size(), 2U);
    EXPECT_FALSE(tuning.dearer);
}

TEST(Tune, WhatNothingMeetsIsSaidWithWhatComesNearest) {
    TuneOptions options = quick({"semi_implicit_euler"}, {"dt=1/60", "substeps=4"});
    const Tuning tuning = tune_scene({"fall.toml", falling_box}, options);
    EXPECT_FALSE(tuning.chosen);
    EXPECT_FALSE(tuning.found());
    const std::string said = printed(tuning);
    EXPECT_NE(said.find("nothing tried meets its expectation within 0.8"), std::string::npos)
        << said;
    EXPECT_NE(said.find("worst error at least 2.04 of its tolerance (height)"), std::string::npos)
        << said;
}

TEST(Tune, ABudgetThatIsTooSmallIsNotMet) {
    TuneOptions options = quick({"rk4"}, {"dt=1/60"});
    options.budget = 1e-15;
    const Tuning tuning = tune_scene({"fall.toml", falling_box}, options);
    EXPECT_TRUE(tuning.chosen);
    EXPECT_FALSE(tuning.found());
    EXPECT_NE(printed(tuning).find("over the budget"), std::string::npos);
    EXPECT_DOUBLE_EQ(parse_budget("1ms"), 0.06);
    EXPECT_DOUBLE_EQ(parse_budget("200us"), 0.012);
    EXPECT_DOUBLE_EQ(parse_budget("0.5 s"), 30);
    for (const char *wrong : {"", "1", "ms", "-1ms", "0s", "1 min"})
        EXPECT_THROW((void)parse_budget(wrong), std::invalid_argument) << wrong;
}

TEST(Tune, OneStopKeepsWhatIsDone) {
    TuneOptions options = quick({"semi_implicit_euler"}, {"dt=1/60"});
    int asked = 0;
    options.stop = [&] { return ++asked > 400; };
    const Tuning tuning = tune_scene({"fall.toml", falling_box}, options);
    EXPECT_TRUE(tuning.interrupted);
    ASSERT_TRUE(tuning.chosen) << printed(tuning); // the scene's own, at least
    EXPECT_NE(printed(tuning).find("the cheapest so far"), std::string::npos);
}

TEST(Tune, TakesDoubleOnlyWhereFloatIsTooCoarse) {
    for (const bool far : {false, true}) {
        std::string text = falling_box;
        if (far) { // where floats are 6 cm apart
            text.replace(text.find("[0, 10, 0]"), 10, "[0, 1000010, 0]");
            text.replace(text.find("5.095"), 5, "1000005.095");
        }
        TuneOptions options = quick({"rk4"}, {"dt=1/60", "substeps=1"});
        options.base.precision.reset();
        options.starts = 0; // other starts differ by a millionth of the position
        const Tuning tuning = tune_scene({"fall.toml", text}, options);
        ASSERT_TRUE(tuning.found()) << printed(tuning);
        EXPECT_EQ(tuning.runs[*tuning.chosen].resolved.precision,
                  far ? Precision::f64 : Precision::f32)
            << printed(tuning);
    }
}

TEST(Tune, ASceneThatIsHeldToNothingIsRefused) {
    const std::string text = falling_box;
    const std::string silent = text.substr(0, text.find("[[expect]]"));
    EXPECT_THROW((void)tune_scene({"fall.toml", silent}, quick({"rk4"}, {})),
                 std::invalid_argument);
    EXPECT_THROW((void)tune_scene(shipped("geometry/points.toml"), quick({}, {})),
                 std::invalid_argument);
    TuneOptions options = quick({"rk5"}, {});
    EXPECT_THROW((void)tune_scene({"fall.toml", falling_box}, options), std::invalid_argument);
    options = quick({"rk4"}, {});
    options.tolerance = 0;
    EXPECT_THROW((void)tune_scene({"fall.toml", falling_box}, options), std::invalid_argument);
}

// Against every combination one by one: none that meets the scene costs less work.
TEST(Tune, NothingThatMeetsASceneIsLessWork) {
    for (const char *name : {"contact/bounce_half.toml", "contact/slide_to_roll.toml"}) {
        const SceneText text = shipped(name);
        const TuneOptions options = quick({"soft_step"}, {"dt=1/60"});
        const Tuning tuning = tune_scene(text, options);
        ASSERT_TRUE(tuning.found()) << printed(tuning);
        double least = tuning.runs[*tuning.chosen].work;
        for (const TunedRun &run : tuning.runs)
            if (run.verdict == TuneVerdict::met)
                least = std::min(least, run.work);
        for (const int substeps : {1, 2, 3, 4, 5, 6})
            for (const int iterations : {1, 2, 4})
                for (const int most : {1, 64}) {
                    TuneOptions one = options;
                    one.base.settings.give(&StepSettings::substeps, substeps);
                    one.base.settings.give(&StepSettings::iterations, iterations);
                    one.base.settings.give(&StepSettings::max_substeps, most);
                    const Tuning single = tune_scene(text, one);
                    ASSERT_EQ(single.runs.size(), 1U);
                    EXPECT_TRUE(single.runs[0].verdict != TuneVerdict::met ||
                                single.runs[0].work >= least * (1 - 1e-9))
                        << name << ' ' << substeps << " substeps, at most " << most << ", "
                        << iterations << " iterations\n"
                        << printed(tuning);
                }
    }
}

TEST(TuneStarts, AreTheSceneAndOthersAHairAway) {
    const SceneText text = shipped("joints/pendulum.toml");
    const std::vector<SceneDesc> starts = starts_of(text, 3);
    ASSERT_EQ(starts.size(), 4U);
    const auto place = [&](std::size_t i) { return starts[i].bodies.at(0).position; };
    EXPECT_EQ(place(0), (glm::dvec3{0.8660254037844386, 1.5, 0}));
    for (std::size_t i = 1; i < 4; ++i) {
        for (std::size_t j = 0; j < i; ++j)
            EXPECT_NE(place(i), place(j));
        for (int axis = 0; axis < 3; ++axis)
            EXPECT_LE(std::abs(place(i)[axis] - place(0)[axis]), start_shift * 1.5);
    }
    const std::vector<SceneDesc> again = starts_of(text, 3);
    EXPECT_EQ(write_scene(again[3]), write_scene(starts[3])) << "the same each time";
}

TEST(TuneStarts, LeaveAloneWhatIsLockedOrStandsFast) {
    const std::string text = R"([[body]]
name = "floor"
shape = "box"
half_extents = [1, 1, 1]
kind = "static"
[[body]]
name = "bead"
shape = "sphere"
radius = 0.5
position = [0, 9, 0]
locked = ["x", "z"]
)";
    const std::vector<SceneDesc> starts = starts_of({"bead.toml", text}, 1);
    EXPECT_EQ(starts[1].bodies.at(0).position, glm::dvec3(0));
    const glm::dvec3 bead = starts[1].bodies.at(1).position;
    EXPECT_EQ(bead.x, 0);
    EXPECT_EQ(bead.z, 0);
    EXPECT_NE(bead.y, 9);
}

TEST(TuneStarts, ShiftParticlesAndClothButNotTheirPins) {
    const std::string text = R"([[particle]]
name = "nail"
position = [0, 2, 0]
pinned = true
[[particle]]
name = "bob"
position = [0, 1, 0]
[[cloth]]
name = "sheet"
cells = [2, 2]
position = [0, 3, 0]
pins = [[0, 0]]
)";
    const std::vector<SceneDesc> starts = starts_of({"sheet.toml", text}, 2);
    ASSERT_EQ(starts[1].particles.size(), 2U);
    EXPECT_EQ(starts[1].particles[0].position, (glm::dvec3{0, 2, 0}));
    const ClothDesc &still = starts[0].cloths.at(0);
    ASSERT_EQ(starts[1].cloths.at(0).particles.size(), 9U);
    EXPECT_EQ(starts[1].cloths[0].particles[0].position, start_of(still, 0).position);
    const auto check_shifted = [](const glm::dvec3 &moved, const glm::dvec3 &place, double size) {
        EXPECT_NE(moved, place);
        for (int axis = 0; axis < 3; ++axis)
            EXPECT_LE(std::abs(moved[axis] - place[axis]), start_shift * size);
    };
    for (std::size_t k = 1; k <= 2; ++k) {
        check_shifted(starts[k].particles[1].position, {0, 1, 0}, 1);
        for (std::uint32_t i = 1; i < 9; ++i)
            check_shifted(starts[k].cloths[0].particles[i].position, start_of(still, i).position,
                          3);
    }
    EXPECT_NE(starts[1].particles[1].position, starts[2].particles[1].position);
}

TEST(TuneStarts, ScatterOtherwise) {
    const std::vector<SceneDesc> starts = starts_of(shipped("showcase/wrecking_ball.toml"), 2);
    const auto differ = [](const SceneDesc &a, const SceneDesc &b) {
        double most = 0;
        for (std::size_t i = 0; i < a.bodies.size(); ++i)
            most = std::max(most, glm::length(a.bodies[i].position - b.bodies[i].position));
        return most;
    };
    EXPECT_GT(differ(starts[0], starts[1]), 0.01);
    EXPECT_GT(differ(starts[1], starts[2]), 0.01);
}

} // namespace
} // namespace plumb
