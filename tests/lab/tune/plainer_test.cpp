// What scenes can do without and what they need.
#include "tests/lab/tune/printed.h"

#include "app/lab/tune/plainer.h"
#include "engine/scene/scene_file.h"

#include <algorithm>
#include <sstream>
#include <string_view>

#include <gtest/gtest.h>

namespace plumb {
namespace {

TuneOptions of_soft_step() {
    TuneOptions options;
    options.methods = {"soft_step"};
    options.starts = 1;
    options.base.precision = Precision::f32;
    for (const char *setting : {"dt=1/60", "substeps=4", "iterations=1", "max_substeps=1"})
        options.base.settings.give(parse_setting(setting));
    return options;
}

const PlainerModel &without(const Tuning &tuning, const std::string &what) {
    const auto found = std::ranges::find(tuning.plainer, what, &PlainerModel::what);
    if (found == tuning.plainer.end())
        throw std::logic_error(what + " was not tried");
    return *found;
}

std::vector<std::string> collisions_of(const Tuning &tuning) {
    std::vector<std::string> names;
    for (const PlainerModel &model : tuning.plainer)
        if (model.what.find("collisions") != std::string::npos)
            names.push_back(model.what);
    return names;
}

// Three balls in a row fall from 10 m, each with these lines added; the first has an expectation.
std::string falling_balls(std::string_view lines) {
    return R"(
[[body]]
name = "ball"
shape = "sphere"
radius = 0.5
position = [0, 10, 0]
repeat = { kind = "line", count = 3, step = [3, 0, 0] }
)" + std::string(lines) +
           R"(
[[expect]]
name = "height"
quantity = "position.y"
body = "ball_1"
to = 1
equals = 5.095
tolerance = 0.001
source = "s = g t^2 / 2"
)";
}

// A ball dropped on the floor, another one flying free, and a post far away.
constexpr const char *one_lands = R"(
[[body]]
name = "floor"
shape = "box"
half_extents = [2, 0.5, 2]
kind = "static"
position = [0, -0.5, 0]
[[body]]
name = "ball"
shape = "sphere"
radius = 0.5
position = [0, 1, 0]
[[body]]
name = "flier"
shape = "sphere"
radius = 0.5
position = [20, 0, 0]
velocity = [0, 20, 0]
repeat = { kind = "line", count = 30, step = [3, 0, 0] }
[[expect]]
name = "lies"
quantity = "position.y"
body = "ball"
to = 3
equals = 0.5
tolerance = 0.01
source = "it lies on the floor"
[[expect]]
name = "flies"
quantity = "position.y"
body = "flier_1"
to = 3
equals = 15.855
tolerance = 0.1
source = "v t - g t^2 / 2"
)";

TEST(Plainer, AFallingBoxNeedsNeitherSleepNorRotationNorItsShape) {
    const Tuning tuning = tune_scene({"fall.toml", R"(
[[body]]
name = "box"
shape = "box"
half_extents = [0.5, 0.2, 0.1]
position = [0, 10, 0]
angular_velocity = [3, 1, 2]
repeat = { kind = "line", count = 2, step = [3, 0, 0] }
[[expect]]
name = "height"
quantity = "position.y"
body = "box_1"
to = 1
equals = 5.095
tolerance = 0.001
source = "s = g t^2 / 2"
)"},
                                     of_soft_step());
    ASSERT_TRUE(tuning.chosen);
    EXPECT_EQ(tuning.plainer.size(), 4U);
    EXPECT_TRUE(without(tuning, "sleep").is_enough) << printed(tuning);
    EXPECT_TRUE(without(tuning, "collisions").is_enough) << printed(tuning);
    EXPECT_TRUE(without(tuning, "the rotation of box").is_enough) << printed(tuning);
    EXPECT_TRUE(without(tuning, "the box of box (a sphere will do)").is_enough) << printed(tuning);
    EXPECT_EQ(tuning.plainest().resolved.settings.sleep_after, 0);
    EXPECT_NE(printed(tuning).find("It can do without sleep, collisions, the rotation of box and "
                                   "the box of box (a sphere will do)"),
              std::string::npos)
        << printed(tuning);
    EXPECT_NE(printed(tuning).find(" Keeping them would buy nothing: the worst error is "),
              std::string::npos)
        << printed(tuning);
}

TEST(Plainer, BallsThatNeverMeetNeedNoCollisions) {
    const Tuning tuning = tune_scene({"balls.toml", falling_balls("")}, of_soft_step());
    ASSERT_TRUE(tuning.chosen);
    EXPECT_TRUE(without(tuning, "collisions").is_enough) << printed(tuning);
    // Once all collisions are off, those of single bodies are not tried as well.
    EXPECT_EQ(collisions_of(tuning), (std::vector<std::string>{"collisions"}));
}

TEST(Plainer, CollisionsThatAreOffAreNotTried) {
    for (const char *off : {"ignores = [0]", "layer = 3\nignores = [3]"}) {
        const Tuning tuning = tune_scene({"balls.toml", falling_balls(off)}, of_soft_step());
        ASSERT_TRUE(tuning.chosen);
        EXPECT_EQ(collisions_of(tuning), std::vector<std::string>{}) << off;
    }
}

// With no collisions nothing overlaps, but that is not what such an expectation means.
TEST(Plainer, WhatIsExpectedOfContactsNeedsThem) {
    const std::string text = falling_balls("") + R"(
[[expect]]
name = "solid"
quantity = "penetration"
reduce = "max"
to = 1
at_most = 0.01
source = "what is solid does not go through what is solid"
)";
    const Tuning tuning = tune_scene({"balls.toml", text}, of_soft_step());
    ASSERT_TRUE(tuning.chosen);
    EXPECT_EQ(collisions_of(tuning), std::vector<std::string>{});
}

TEST(Plainer, WhatLandsMustCollideAndWhatFliesNeedNot) {
    const Tuning tuning = tune_scene({"one_lands.toml", one_lands}, of_soft_step());
    ASSERT_TRUE(tuning.chosen) << printed(tuning);
    EXPECT_EQ(collisions_of(tuning),
              (std::vector<std::string>{"collisions", "the collisions of floor",
                                        "the collisions of ball", "the collisions of flier"}));
    for (const char *needed : {"collisions", "the collisions of floor", "the collisions of ball"}) {
        EXPECT_EQ(without(tuning, needed).run.verdict, TuneVerdict::missed) << needed;
        EXPECT_FALSE(without(tuning, needed).is_enough) << needed;
    }
    EXPECT_TRUE(without(tuning, "the collisions of flier").is_enough) << printed(tuning);
}

// Without the floor's collisions the ball has nothing left to hit.
TEST(Plainer, OfTwoBodiesNeitherIsTriedByItself) {
    std::string text = one_lands;
    const std::size_t from = text.find("[[body]]\nname = \"flier\"");
    text.erase(from, text.find("[[expect]]") - from);
    text.erase(text.rfind("[[expect]]"));
    const Tuning tuning = tune_scene({"land.toml", text}, of_soft_step());
    ASSERT_TRUE(tuning.chosen) << printed(tuning);
    EXPECT_EQ(collisions_of(tuning), (std::vector<std::string>{"collisions"}));
    EXPECT_EQ(without(tuning, "collisions").run.verdict, TuneVerdict::missed);
}

// Noise is not reported as a cost.
TEST(Plainer, SaysTheCostWhereItIsLess) {
    Tuning tuning;
    tuning.runs.emplace_back().resolved = resolve_run({}, {});
    tuning.chosen = 0;
    PlainerModel model{"sleep", tuning.runs[0], 1.02, true};
    tuning.plainer = {model};
    EXPECT_NE(printed(tuning, false).find("do without sleep at the same cost. Keeping it would"),
              std::string::npos)
        << printed(tuning, false);
    tuning.plainer[0].times_as_dear = 0.5;
    EXPECT_NE(
        printed(tuning, false).find("do without sleep: that costs 0.5 times as much. Keeping it"),
        std::string::npos)
        << printed(tuning, false);
}

TEST(Plainer, EachPartOfAModelIsInTheHelp) {
    EXPECT_EQ(model_parts_text(), "sleep, collisions, a body's rotation and its shape");
}

TEST(Plainer, ABoxThatLandsNeedsSleepAndItsShape) {
    const Tuning tuning = tune_scene({"land.toml", R"(
[[body]]
name = "floor"
shape = "plane"
[[body]]
name = "box"
shape = "box"
half_extents = [0.5, 0.5, 0.5]
position = [0, 1, 0]
[[expect]]
name = "lies"
quantity = "position.y"
body = "box"
to = 20
equals = 0.5
tolerance = 0.01
source = "it lies on a face"
)"},
                                     of_soft_step());
    ASSERT_TRUE(tuning.chosen);
    const PlainerModel &awake = without(tuning, "sleep");
    EXPECT_EQ(awake.run.verdict, TuneVerdict::met);
    EXPECT_FALSE(awake.is_enough);
    EXPECT_GT(awake.run.work, 2 * tuning.runs[*tuning.chosen].work);
    const PlainerModel &sphere = without(tuning, "the box of box (a sphere will do)");
    EXPECT_EQ(sphere.run.verdict, TuneVerdict::missed);
    EXPECT_FALSE(sphere.is_enough);
    EXPECT_GT(tuning.plainest().resolved.settings.sleep_after, 0);
}

TEST(Plainer, WhatRollsNeedsItsRotation) {
    std::vector<SceneMessage> messages;
    const std::string path = PLUMB_SOURCE_DIR "/scenes/contact/slide_to_roll.toml";
    const Tuning tuning =
        tune_scene({path, read_scene_text(path, messages).value()}, of_soft_step());
    ASSERT_TRUE(tuning.chosen);
    const PlainerModel &locked = without(tuning, "the rotation of ball");
    EXPECT_EQ(locked.run.verdict, TuneVerdict::missed);
    EXPECT_FALSE(locked.is_enough);
}

TEST(Plainer, WhatIsGivenIsKept) {
    TuneOptions options = of_soft_step();
    options.base.settings.give(&StepSettings::sleep_after, 0.5);
    std::vector<SceneMessage> messages;
    const std::string path = PLUMB_SOURCE_DIR "/scenes/contact/bounce_half.toml";
    const Tuning tuning = tune_scene({path, read_scene_text(path, messages).value()}, options);
    EXPECT_EQ(std::ranges::find(tuning.plainer, "sleep", &PlainerModel::what),
              tuning.plainer.end());
}

} // namespace
} // namespace plumb
