// Each row of the table of settings, everywhere a setting can be given.
#include "engine/scene/scene_file.h"
#include "engine/scene/simulation.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <stdexcept>

#include <gtest/gtest.h>

namespace plumb {
namespace {

// A non-default value in the row's range.
double another_value(SettingNumber number) {
    const SettingRow &row = number.setting();
    const double value = row.min + 0.37 * (row.max - row.min) / (1 + number.component);
    return is_whole(row) ? std::floor(value) : value;
}

StepSettings other_settings() {
    StepSettings settings;
    for (const SettingNumber number : setting_numbers())
        set_setting(settings, number, another_value(number));
    return settings;
}

bool same(const StepSettings &a, const StepSettings &b) {
    return GivenSettings::differences(a, b).empty();
}

SceneDesc parsed(const std::string &text) {
    const SceneFileResult result = parse_scene(text, "s.toml");
    EXPECT_TRUE(result.ok()) << format_message("s.toml", result.messages.front()) << '\n' << text;
    return result.scene;
}

std::string complaint(const std::function<void()> &action) {
    try {
        action();
    } catch (const std::invalid_argument &error) {
        return error.what();
    }
    return "";
}

TEST(Settings, NamesAndReasonsAreGivenOnceEach) {
    std::set<std::string_view> names, reasons;
    for (const SettingRow &row : setting_rows) {
        EXPECT_TRUE(names.insert(row.name).second) << row.name;
        EXPECT_TRUE(reasons.insert(row.reason).second) << row.name;
        EXPECT_TRUE(row.reason.ends_with('.')) << row.name;
        EXPECT_EQ(find_setting(row.name), &row);
        EXPECT_LT(row.min, row.max) << row.name;
    }
    for (const MethodInfo &method : method_infos())
        EXPECT_NO_THROW(check_settings(method.defaults)) << method.name;
}

TEST(Settings, EachGoesThroughASceneFile) {
    for (const MethodInfo &method : method_infos())
        for (const SettingNumber number : setting_numbers()) {
            SceneDesc scene;
            scene.world.method = "soft_step";
            StepSettings expected = method.defaults;
            set_setting(expected, number, another_value(number));
            const bool own = method.name == scene.world.method;
            GivenSettings &given = own || number.setting().group == SettingGroup::world
                                       ? scene.world.settings
                                       : scene.world.other_methods[std::string(method.name)];
            given.give(number, another_value(number));
            const SceneDesc back = parsed(write_scene(scene));
            EXPECT_TRUE(same(settings_of(back.world, method), expected))
                << method.name << ' ' << setting_name(number) << '\n'
                << write_scene(scene);
        }
}

TEST(Settings, OfOneMethodAreNotThoseOfAnother) {
    SceneDesc scene;
    scene.world.method = "soft_step";
    scene.world.settings = GivenSettings::differences({}, other_settings());
    const MethodInfo &other = *find_method_info("sequential_impulses");
    StepSettings expected = other.defaults;
    expected.gravity = other_settings().gravity;
    expected.dt = other_settings().dt;
    EXPECT_TRUE(same(settings_of(scene.world, other), expected));
}

TEST(Settings, EachIsTakenFromTextAsTheCommandLineHasIt) {
    for (const SettingNumber number : setting_numbers()) {
        const double value = another_value(number);
        StepSettings settings, expected;
        parse_setting(setting_name(number) + "=" + number_or_fraction(value)).apply_to(settings);
        set_setting(expected, number, value);
        EXPECT_TRUE(same(settings, expected)) << setting_name(number);
    }
    for (const SettingRow &row : setting_rows) {
        const StepSettings all = other_settings();
        const GivenSettings given =
            parse_setting(std::string(row.name) + "=" + setting_text(row, all));
        for (const SettingNumber number : setting_numbers())
            EXPECT_EQ(given.find(number), &number.setting() == &row
                                              ? std::optional(setting_value(all, number))
                                              : std::nullopt)
                << setting_name(number);
    }
}

TEST(Settings, OutOfRangeIsRefusedEverywhereWithNameAndRange) {
    for (const SettingNumber number : setting_numbers()) {
        const SettingRow &row = number.setting();
        const std::string range = range_text(row);
        for (const double value : {row.min - 1, row.max + 1 + 1e-6 * row.max}) {
            const double bad = is_whole(row) ? std::floor(value) : value;
            const std::string said = setting_name(number) + " must be " + range + ", got ";
            EXPECT_NE(complaint([&] {
                          (void)parse_setting(setting_name(number) + "=" + number_or_fraction(bad));
                      }).find(said),
                      std::string::npos)
                << setting_name(number);
            RunOptions options;
            options.settings.give(number, bad);
            EXPECT_NE(complaint([&] { (void)resolve_run({}, options); }).find(said),
                      std::string::npos)
                << setting_name(number);

            SceneDesc scene;
            scene.world.settings.give(number, bad);
            const SceneFileResult result = parse_scene(write_scene(scene), "s.toml");
            ASSERT_EQ(result.messages.size(), 1u) << write_scene(scene);
            EXPECT_TRUE(result.messages[0].what.starts_with(row.name)) << result.messages[0].what;
            EXPECT_NE(result.messages[0].suggestion.find(range), std::string::npos)
                << result.messages[0].suggestion;
        }
        if (is_whole(row)) {
            EXPECT_NE(complaint([&] {
                          (void)parse_setting(std::string(row.name) + "=1.5");
                      }).find("a whole number"),
                      std::string::npos);
        }
    }
}

TEST(Settings, MistakesInTextAreExplained) {
    const auto said = [](const std::string &text) {
        return complaint([&] { (void)parse_setting(text); });
    };
    EXPECT_EQ(said("baumgart=0.1"),
              "there is no setting \"baumgart\"; did you mean \"baumgarte\"?");
    EXPECT_EQ(said("substeps"), "\"substeps\" gives no value; write NAME=VALUE, as in substeps=8");
    EXPECT_EQ(said("substeps="), "\"\" is not a number");
    EXPECT_EQ(said("dt=1/x"), "\"x\" is not a number");
    EXPECT_EQ(said("dt=1/0"), "division by zero in \"1/0\"");
    EXPECT_EQ(said("dt=1,2"), "dt takes 1 number, got 2");
    EXPECT_EQ(said("gravity=-9.81"), "gravity takes 3 numbers, as in gravity=0,-9.81,0, got 1");
}

TEST(Settings, TheCommandLineGoesBeforeTheFile) {
    SceneDesc scene = parsed("[world]\ngravity = [1, 2, 3]\nsubsteps = 3\n");
    RunOptions options;
    options.settings.give(parse_setting("gravity.y=-4"));
    options.settings.give(parse_setting("baumgarte=1/8"));
    const StepSettings settings = resolve_run(scene, options).settings;
    EXPECT_EQ(settings.gravity, glm::dvec3(1, -4, 3));
    EXPECT_EQ(settings.substeps, 3);
    EXPECT_EQ(settings.baumgarte, 0.125);
}

constexpr const char *contact_scene = R"([world]
method = "METHOD"
[[material]]
name = "m"
restitution = 0.5
[[body]]
name = "ground"
shape = "plane"
material = "m"
[[body]]
name = "crate"
shape = "box"
half_extents = [0.2, 0.1, 0.3]
position = [0, 0.35, 0]
rotation_deg = [0, 20, 3]
angular_velocity = [4, 1, 2]
material = "m"
repeat = { kind = "stack", count = 3, spacing = 0.25 }
[[body]]
name = "bob"
shape = "sphere"
radius = 0.1
position = [2, 2, 0]
[[joint]]
name = "rope"
type = "ball"
body_a = "bob"
anchor = [1, 2.5, 0]
[[body]]
name = "torn"
shape = "sphere"
radius = 0.1
position = [4, 2, 0]
[[joint]]
name = "apart"
type = "ball"
body_b = "torn"
anchor_a_local = [4, 2.6, 0]
anchor_b_local = [0, 0.5, 0]
[[body]]
name = "leaving"
kind = "kinematic"
shape = "sphere"
radius = 0.1
position = [5, 2, 0]
velocity = [0.5, 0, 0]
[[joint]]
name = "out of reach"
type = "ball"
body_a = "torn"
body_b = "leaving"
anchor = [4.5, 2, 0]
)";

constexpr const char *free_scene = R"([world]
method = "METHOD"
[[body]]
name = "book"
shape = "box"
half_extents = [0.2, 0.1, 0.3]
angular_velocity = [4, 1, 2]
)";

SceneDesc scene_for(const MethodInfo &method) {
    std::string text = method.contacts ? contact_scene : free_scene;
    text.replace(text.find("METHOD"), 6, method.name);
    SceneDesc scene = parsed(text);
    if (!method.joints)
        scene.joints.clear();
    return scene;
}

TEST(Settings, ASavedWorldKeepsThemAll) {
    for (const MethodInfo &method : method_infos())
        for (const Precision precision : {Precision::f32, Precision::f64}) {
            SceneDesc scene = scene_for(method);
            scene.world.precision = precision;
            const auto before = Simulation::create(scene, {}, nullptr);
            before->step();
            before->set_settings(other_settings());
            const auto after =
                Simulation::create(parsed(write_scene(before->describe())), {}, nullptr);
            EXPECT_TRUE(same(after->settings(), other_settings())) << method.name;
            EXPECT_EQ(after->hash(), before->hash()) << method.name;
        }
}

// With another dt it continues from the same time.
TEST(Settings, ASavedWorldKeepsItsTimeAtAnotherStep) {
    SceneDesc scene = scene_for(*find_method_info("soft_step"));
    scene.world.settings.give(&StepSettings::dt, 0.01);
    const auto before = Simulation::create(scene, {}, nullptr);
    for (int i = 0; i < 20; ++i)
        before->step();
    RunOptions finer;
    finer.settings.give(&StepSettings::dt, 0.002);
    const auto after = Simulation::create(parsed(write_scene(before->describe())), finer, nullptr);
    EXPECT_EQ(after->step_count(), 20u);
    EXPECT_NEAR(after->time(), 0.2, 1e-12);
    after->step();
    EXPECT_NEAR(after->time(), 0.202, 1e-12);
    finer.settings.give(&StepSettings::dt, 0.004);
    const auto again = Simulation::create(parsed(write_scene(after->describe())), finer, nullptr);
    EXPECT_NEAR(again->time(), 0.202, 1e-12);
    EXPECT_EQ(Simulation::create(scene, finer, nullptr)->time(), 0);
}

// Saved with a method other than the scene's, which keeps its own settings.
TEST(Settings, ASavedWorldKeepsThoseOfTheMethodThatItLeft) {
    SceneDesc scene = scene_for(*find_method_info("soft_step"));
    scene.world.settings.give(&StepSettings::substeps, 7);
    scene.world.settings.give(&StepSettings::dt, 0.01);
    const auto simulation = Simulation::create(scene, {}, nullptr);
    simulation->set_method("sequential_impulses");
    StepSettings changed = simulation->settings();
    changed.dt = 0.02;
    changed.baumgarte = 0.3;
    simulation->set_settings(changed);
    const SceneDesc saved = parsed(write_scene(simulation->describe()));
    EXPECT_EQ(saved.world.method, "sequential_impulses");
    EXPECT_TRUE(same(settings_of(saved.world, simulation->method()), changed));
    const StepSettings left = settings_of(saved.world, *find_method_info("soft_step"));
    EXPECT_EQ(left.substeps, 7);
    EXPECT_EQ(left.dt, 0.02); // the world's
    EXPECT_EQ(left.baumgarte, StepSettings{}.baumgarte);
}

std::vector<BodyState> motion_with(const SceneDesc &scene, const StepSettings &settings) {
    const auto simulation = Simulation::create(scene, {}, nullptr);
    simulation->set_settings(settings);
    for (int step = 0; step < 90; ++step)
        simulation->step();
    return simulation->read().bodies;
}

bool same_motion(const std::vector<BodyState> &a, const std::vector<BodyState> &b) {
    return std::ranges::equal(a, b, [](const BodyState &s, const BodyState &t) {
        return s.position == t.position && s.orientation == t.orientation &&
               s.velocity == t.velocity && s.angular_velocity == t.angular_velocity;
    });
}

// The panel, the reference and charts rely on this: the motion depends on a setting exactly where
// the method's row says so.
TEST(Settings, MethodsReadWhatTheySay) {
    for (const MethodInfo &method : method_infos()) {
        const SceneDesc scene = scene_for(method);
        StepSettings by_default = method.defaults;
        by_default.impact_sweeps =
            std::max(by_default.impact_sweeps, 8); // other settings are theirs
        const std::vector<BodyState> motion = motion_with(scene, by_default);
        for (const SettingNumber number : setting_numbers()) {
            const SettingRow &row = number.setting();
            const double value = setting_value(by_default, number);
            bool differs = false;
            for (const double other : {value + 1, 0.5 * value, row.min}) {
                if (!why_refused(number, other).empty() || other < -100)
                    continue;
                StepSettings settings = by_default;
                set_setting(settings, number, other);
                differs = differs || !same_motion(motion_with(scene, settings), motion);
            }
            EXPECT_EQ(differs, reads(method, row)) << method.name << ' ' << setting_name(number);
        }
    }
}

} // namespace
} // namespace plumb
