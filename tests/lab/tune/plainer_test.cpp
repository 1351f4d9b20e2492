// What scenes can do without, and what they cannot.
#include "tests/lab/tune/printed.h"

#include "engine/scene/scene_file.h"

#include <algorithm>
#include <sstream>

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
    EXPECT_EQ(tuning.plainer.size(), 3U);
    EXPECT_TRUE(without(tuning, "sleep").is_enough) << printed(tuning);
    EXPECT_TRUE(without(tuning, "the rotation of box").is_enough) << printed(tuning);
    EXPECT_TRUE(without(tuning, "the box of box (a sphere will do)").is_enough) << printed(tuning);
    EXPECT_EQ(tuning.plainest().resolved.settings.sleep_after, 0);
    EXPECT_NE(printed(tuning).find("It can do without sleep, the rotation of box and the box of "
                                   "box (a sphere will do): that costs "),
              std::string::npos)
        << printed(tuning);
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
    EXPECT_GT(awake.times_as_dear, 2);
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
