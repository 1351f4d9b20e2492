#include "app/lab/map/answers.h"
#include "tests/lab/falling_ball.h"

#include "app/lab/map/stability_map.h"
#include "tests/lab/csv_reader.h"

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace plumb {
namespace {

SceneDesc swing_of_one_bob() {
    SceneDesc scene;
    scene.bodies.emplace_back().name = "bob";
    scene.joints.emplace_back().name = "rod";
    return scene;
}

ExpectDesc stated(const char *quantity, const char *reduce, ExpectDesc::Relation relation,
                  double value) {
    ExpectDesc expect;
    expect.quantity = quantity;
    expect.reduce = reduce;
    expect.relation = relation;
    expect.value = value;
    return expect;
}

// Which of these hold whatever the axis: a letter for each that does, in that order.
std::string hold(const SceneDesc &scene, const std::string &axis) {
    using enum ExpectDesc::Relation;
    const MapAxis along = parse_map_axis(axis + "=0.25,0.5");
    std::string held;
    for (const auto &[letter, expect] :
         {std::pair{'p', stated("position.x", "period", equals, 2.15)},
          std::pair{'s', stated("displacement", "max", at_most, 0.01)},
          std::pair{'d', stated("joint_drift", "max", at_most, 1e-3)},
          std::pair{'n', stated("penetration", "max", at_most, 0.01)},
          std::pair{'g', stated("energy_error", "max", at_most, 1e-3)},
          std::pair{'e', stated("energy_error", "drift", at_most, 1e-3)},
          std::pair{'h', stated("energy_error", "last", at_most, -0.5)}})
        held += holds_whatever(scene, expect, along) ? letter : '-';
    return held;
}

TEST(MapAnswers, HoldWhateverVariesIfTheyAreLaws) {
    SceneDesc scene = swing_of_one_bob();
    for (const char *axis : {"gravity.y", "body.bob.mass", "material.steel.friction"})
        EXPECT_EQ(hold(scene, axis), "--dng--") << axis;
    EXPECT_EQ(hold(scene, "joint.rod.motor_speed"), "---n---");
    EXPECT_EQ(hold(scene, "body.bob.torque.x"), "---n---");
    EXPECT_EQ(hold(scene, "body.bob.repeat.count"), "-sdngeh");
    scene.joints[0].frequency = 2;
    EXPECT_EQ(hold(scene, "gravity.y"), "---n---");
    scene.joints[0].frequency = 0;
    scene.joints[0].motor_speed = 1;
    EXPECT_EQ(hold(scene, "gravity.y"), "--dn---");
    scene.joints[0].motor_speed.reset();
    scene.bodies.back().torque.y = 1;
    EXPECT_EQ(hold(scene, "gravity.y"), "--dn---");
}

TEST(MapAnswers, AreChangedByNumbersOfTheSceneAlone) {
    for (const char *axis :
         {"dt", "penetration_slop", "methods.xpbd.iterations", "expect.height.tolerance"})
        EXPECT_FALSE(varies_the_scene(parse_map_axis(std::string(axis) + "=0.25,0.5"))) << axis;
    for (const char *axis : {"gravity.x", "body.bob.mass", "mass"})
        EXPECT_TRUE(varies_the_scene(parse_map_axis(std::string(axis) + "=0.25,0.5"))) << axis;
}

// Over a slope of gravity, friction of 0.5 holds the box up to 26.6 degrees; over any mass.
TEST(MapAnswers, AreKeptWhereAnAccurateRunMeetsThem) {
    const SceneText on_slope{"scene.toml", R"(
[world]
gravity = [4, -9, 0]
[[body]]
name = "ground"
shape = "plane"
[[body]]
name = "box"
shape = "box"
half_extents = [0.5, 0.5, 0.5]
mass = 1
position = [0, 0.5, 0]
[[expect]]
name = "stays"
quantity = "displacement"
body = "box"
reduce = "max"
to = 0.5
at_most = 0.01
source = "Coulomb"
)"};
    const auto outdated = [&](const char *y) {
        MapOptions options;
        options.methods = {"tgs_soft"};
        return map_scene(on_slope, parse_map_axis("dt=1/60,1/30"), parse_map_axis(y), options)
            .outdated;
    };
    const std::vector<std::string> stays{"stays"};
    EXPECT_TRUE(outdated("mass=1,1000").empty());
    EXPECT_TRUE(outdated("gravity.x=0,4.4").empty());
    EXPECT_EQ(outdated("gravity.x=0,5"), stays);
}

// By s = g t^2 / 2 the ball is elsewhere under another gravity, and just as far down at any mass.
TEST(MapAnswers, AreLeftOutOfAMapThatMakesThemWrong) {
    const SceneText one_fall{"scene.toml", falling_ball};
    MapOptions options;
    options.methods = {"rk4"};
    const MapAxis dt = parse_map_axis("dt=1/60,1/30");
    const StabilityMap over_gravity =
        map_scene(one_fall, dt, parse_map_axis("gravity.y=-9.81,-3.7"), options);
    const StabilityMap over_mass = map_scene(one_fall, dt, parse_map_axis("mass=1,100"), options);
    EXPECT_EQ(over_gravity.outdated, std::vector<std::string>{"height"});
    EXPECT_TRUE(over_mass.outdated.empty());
    EXPECT_TRUE(over_mass.unjudged.empty());
    for (const StabilityMap *map : {&over_gravity, &over_mass})
        for (const auto &cell : map->methods[0].cells) {
            EXPECT_EQ(cell->failing.failing, Failing::none) << cell->failing.what;
            EXPECT_NEAR(cell->time, 1, 1e-6) << "as long as the file asks";
        }
    ASSERT_EQ(over_gravity.unjudged.size(), 2U);
    EXPECT_NE(over_gravity.unjudged[0].find("gravity.y: \"height\""), std::string::npos);
    std::ostringstream text, csv;
    print(text, over_gravity);
    EXPECT_NE(text.str().find(over_gravity.unjudged[0]), std::string::npos);
    write_map_csv(csv, over_gravity);
    const auto rows = read_csv(csv.str());
    const auto column = std::ranges::find(rows[0], "not_judged") - rows[0].begin();
    EXPECT_EQ(rows.at(1).at(static_cast<std::size_t>(column)), "height");
    // Explicit Euler is too high at once, at any mass.
    options.methods = {"explicit_euler"};
    const StabilityMap missed = map_scene(one_fall, dt, parse_map_axis("mass=1,100"), options);
    for (const auto &cell : missed.methods[0].cells)
        EXPECT_EQ(cell->failing.failing, Failing::missed);
}

} // namespace
} // namespace plumb
