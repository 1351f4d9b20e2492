#include "app/lab/map/axis_names.h"

#include "app/lab/map/stability_map.h"
#include "engine/scene/file/change.h"
#include "engine/scene/scene_file.h"

#include <sstream>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

namespace plumb {
namespace {

MapAxis resolved(const std::string &text, const std::string &name) {
    const SceneFileResult result = parse_scene(text, "scene.toml", {});
    EXPECT_TRUE(result.ok()) << (result.messages.empty() ? "" : result.messages[0].what);
    return named_axis(parse_map_axis(name + "=1..2"), text, result.scene);
}

// The name's numbers when the axis is at `value`: "body.a.mass=3, ...".
std::string numbers_of(const std::string &text, const std::string &name, double value) {
    std::ostringstream said;
    for (const ChangedNumber &number : changed_numbers(resolved(text, name), value))
        said << (said.str().empty() ? "" : ", ") << number.path << '=' << number.value;
    return said.str();
}

std::string refusal(const std::string &text, const std::string &name) {
    try {
        return "none: " + resolved(text, name).name;
    } catch (const std::invalid_argument &error) {
        return error.what();
    }
}

void expect_said(const std::string &said, std::initializer_list<const char *> parts) {
    for (const char *part : parts)
        EXPECT_NE(said.find(part), std::string::npos) << said << "\nlacks: " << part;
}

// "NAME" a ball of that mass at x, moving with those velocities.
std::string ball_at(const std::string &name, const std::string &mass, const std::string &x,
                    const std::string &velocity = "0, 0, 0") {
    return "[[body]]\nname = \"" + name + "\"\nshape = \"sphere\"\nradius = 0.1\n" + mass +
           "\nposition = [" + x + ", 2, 0]\nvelocity = [" + velocity + "]\n";
}

constexpr const char *static_wall = R"(
[[body]]
name = "wall"
kind = "static"
shape = "box"
half_extents = [0.1, 9, 9]
)";

constexpr const char *bob_on_coil = R"(
[[particle]]
name = "bob"
mass = 2
position = [0, -1, 0]
[[spring]]
name = "coil"
b = "bob"
anchor_a = [0, 0, 0]
)";

TEST(AxisNames, TakeAKeyForTheOneNumberThatHasIt) {
    const std::string scene = R"(
        [world]
        seed = 3
        [[particle]]
        name = "p"
        mass = 2
        [[particle]]
        name = "q"
        mass = 2
        position = [0, 3, 0]
        [[spring]]
        name = "left"
        a = "p"
        b = "q"
        stiffness = 100
        [[body]]
        name = "a.b"
        shape = "sphere"
        radius = 0.5
        mass = 1
        position = [0, 1, 0]
        velocity = [0, 0, 0]
        repeat = { kind = "stack", count = 4 }
        [camera]
        distance = 4
    )";
    const auto path = [&](const std::string &key) { return resolved(scene, key).name; };
    EXPECT_EQ(path("count"), "body.a.b.repeat.count");
    EXPECT_EQ(path("seed"), "world.seed");
    EXPECT_EQ(path("rest_height.y"), "rest_height.y") << "a path, checked when it is used";
    EXPECT_EQ(path("substeps"), "substeps");
    EXPECT_EQ(path("body.a.b.position.y"), "body.a.b.position.y");
    expect_said(refusal(scene, "mass"), {"3; give one of body.a.b.mass, particle.p.mass"});
    expect_said(refusal(scene, "velocity"), {"3; give one of body.a.b.velocity.x, "
                                             "body.a.b.velocity.y, body.a.b.velocity.z"});
    expect_said(refusal(scene, "substep"), {"did you mean \"substeps\"?"});
    expect_said(refusal(scene, "hieght"), {"did you mean \"height\"?"});
    expect_said(refusal(scene, "raduis"), {"did you mean \"radius\"?"});
}

// What is unknown is answered with the scene's own numbers.
TEST(AxisNames, OfNothingAreAnsweredWithWhatTheSceneHas) {
    const std::string said = refusal(static_wall + ball_at("a", "mass = 3", "1"), "wobble");
    expect_said(said, {"axis \"wobble\": ", "no such number in this scene",
                       "The numbers of this scene are ", "body.a.mass", "body.a.radius",
                       "body.wall.half_extents.x"});
    EXPECT_EQ(said.find("baumgarte"), std::string::npos) << said;
}

TEST(AxisNames, EachIsDeclaredOnceAndResolvesOrRefuses) {
    const std::string scene = ball_at("a", "mass = 3", "1");
    for (const AxisName &each : axis_names()) {
        EXPECT_FALSE(each.meaning.empty());
        const std::string said = refusal(scene, std::string(each.name));
        EXPECT_EQ(said.find("no such setting"), std::string::npos) << said;
    }
    EXPECT_EQ(axis_names().size(), 7U);
}

TEST(AxisNames, StiffnessIsInNewtonsPerMetreHoweverTheFileGivesIt) {
    for (const char *given : {"stiffness = 100\n", "frequency = 2\n"}) {
        const std::string scene = std::string(bob_on_coil) + given;
        EXPECT_EQ(resolved(scene, "stiffness").name, "spring.coil.stiffness") << given;
        EXPECT_EQ(resolved(scene, "damping").name, "spring.coil.damping") << given;
        MapOptions options;
        options.methods = {"rk4"};
        options.duration = 0.1;
        const StabilityMap map =
            map_scene({"scene.toml", scene}, parse_map_axis("dt=1/60,1/30"),
                      parse_map_axis("spring.coil.stiffness=100,1000"), options);
        EXPECT_EQ(axis_title(map.y), "spring.coil.stiffness (N/m)");
    }
    const std::string hung = R"(
[[cloth]]
name = "flag"
pins = "edge"
[[body]]
name = "bob"
shape = "sphere"
radius = 0.5
position = [9, 0, 0]
[[joint]]
name = "soft"
type = "ball"
body_b = "bob"
anchor = [9, 2, 0]
frequency = 3
)";
    EXPECT_EQ(resolved(hung, "stiffness").name, "joint.soft.frequency");
    const std::string alone = "[[cloth]]\nname = \"flag\"\npins = \"edge\"\n";
    EXPECT_EQ(resolved(alone, "stiffness").name, "cloth.flag.stretch");
    EXPECT_EQ(resolved(alone, "damping").name, "cloth.flag.damping");
    expect_said(refusal(std::string(bob_on_coil) + "stiffness = 1\n[[spring]]\nname = \"other\"\n"
                                                   "b = \"bob\"\nanchor_a = [1, 0, 0]\n"
                                                   "frequency = 3\n",
                        "stiffness"),
                {"2; give one of spring.coil.stiffness, spring.other.stiffness"});
    expect_said(refusal(ball_at("a", "mass = 3", "1"), "stiffness"),
                {"no spring, cloth or soft joint", "body.a.mass"});
}

TEST(AxisNames, FrictionIsThatOfTheOneMaterial) {
    const std::string ice = "[[material]]\nname = \"ice\"\n", given = "friction = 0.1\n";
    const std::string body = ball_at("a", "", "0");
    EXPECT_EQ(resolved(ice + given + body, "friction").name, "material.ice.friction");
    EXPECT_EQ(resolved(ice + body, "friction").name, "material.ice.friction") << "at its default";
    expect_said(refusal(ice + given + "[[material]]\nname = \"wood\"\n" + given + body, "friction"),
                {"2; give one of material.ice.friction, material.wood.friction"});
    expect_said(refusal(body, "friction"), {"no material"});
}

TEST(AxisNames, MassRatioScalesTheHeaviest) {
    const std::string three = static_wall + ball_at("light", "mass = 2", "1") +
                              ball_at("heavy", "density = 1e5", "2") +
                              ball_at("middle", "mass = 3", "3");
    EXPECT_EQ(numbers_of(three, "mass_ratio", 50), "body.heavy.mass=100");
    EXPECT_EQ(numbers_of(three, "mass_ratio", 1), "body.heavy.mass=2");
    EXPECT_EQ(axis_title(resolved(three, "mass_ratio")), "mass_ratio by body.heavy.mass");
    // The number must take effect although the file gives a density.
    const std::vector<ChangedNumber> changed = changed_numbers(resolved(three, "mass_ratio"), 50);
    EXPECT_EQ(parse_scene(three, "scene.toml", {}, changed).scene.bodies[2].mass, 100);
    expect_said(
        refusal(ball_at("a", "mass = 2", "1") + ball_at("b", "mass = 2", "2"), "mass_ratio"),
        {"2; give one of body.a.mass, body.b.mass"});
    expect_said(refusal(static_wall + ball_at("a", "mass = 2", "1"), "mass_ratio"),
                {"no two bodies", "body.a.mass"});
}

TEST(AxisNames, HeightIsThatOfAPileOrOfWhatIsHighest) {
    const std::string box = "[[body]]\nname = \"box\"\nshape = \"box\"\n"
                            "half_extents = [0.5, 0.5, 0.5]\nposition = [0, 0.5, 0]\nrepeat = ";
    const std::string high = ball_at("ball", "", "9");
    for (const auto &[repeat, path] :
         {std::pair{"{ kind = \"stack\", count = 3 }", "body.box.repeat.count"},
          std::pair{"{ kind = \"line\", count = 3, step = [0, 2, 0] }", "body.box.repeat.count"},
          std::pair{"{ kind = \"grid\", count = [2, 3, 1], spacing = [2, 2, 2] }",
                    "body.box.repeat.count.y"},
          std::pair{"{ kind = \"pyramid\", base = 3, spacing = [1, 1] }", "body.box.repeat.base"},
          std::pair{"{ kind = \"line\", count = 3, step = [2, 0, 0] }", "body.ball.position.y"},
          std::pair{"{ kind = \"ring\", count = 3, radius = 4 }", "body.ball.position.y"}})
        EXPECT_EQ(resolved(box + repeat + "\n" + high, "height").name, path) << repeat;
    const std::string joint =
        "[[joint]]\nname = \"rod\"\ntype = \"ball\"\nbody_b = \"ball\"\nanchor = [9, 3, 0]\n";
    expect_said(refusal(high + joint, "height"),
                {"neither a stack nor anything that moves freely", "body.ball.position.y"});
    expect_said(refusal(high + ball_at("other", "", "1"), "height"),
                {"2; give one of body.ball.position.y, body.other.position.y"});
}

TEST(AxisNames, SpeedKeepsTheDirectionOfTheFastest) {
    const std::string thrown =
        ball_at("slow", "", "5", "1, 0, 0") + ball_at("fast", "", "1", "3, 0, -4") + static_wall;
    EXPECT_EQ(numbers_of(thrown, "speed", 10), "body.fast.velocity.x=6, body.fast.velocity.z=-8");
    EXPECT_EQ(axis_title(resolved(thrown, "speed")), "speed (m/s) by body.fast.velocity");
    // Along an axis it is that component, so that whatever is known of it holds.
    EXPECT_EQ(resolved(ball_at("a", "", "1", "7, 0, 0"), "speed").name, "body.a.velocity.x");
    EXPECT_EQ(numbers_of(ball_at("a", "", "1", "0, -7, 0"), "speed", 2), "body.a.velocity.y=-2");
    expect_said(refusal(ball_at("a", "", "1"), "speed"),
                {"nothing in this scene moves at the start"});
    expect_said(
        refusal(ball_at("a", "", "1", "1, 0, 0") + ball_at("b", "", "5", "0, 1, 0"), "speed"),
        {"2; give one of body.a.velocity, body.b.velocity"});
}

TEST(AxisNames, DistanceIsFromTheFastestToWhatIsNearestToIt) {
    const std::string scene = static_wall + ball_at("target", "", "1") +
                              ball_at("fast", "", "4", "-9, 0, 0") + ball_at("far", "", "8");
    EXPECT_EQ(numbers_of(scene, "distance", 5), "body.fast.position.x=6");
    EXPECT_EQ(axis_title(resolved(scene, "distance")), "distance (m) by body.fast.position.x");
    const std::string orbit = "[[attractor]]\nname = \"sun\"\nposition = [0, 2, 3]\n" +
                              ball_at("planet", "", "-4", "0, 1, 0");
    EXPECT_EQ(numbers_of(orbit, "distance", 10),
              "body.planet.position.x=-8, body.planet.position.z=-3");
    expect_said(refusal(ball_at("a", "", "1"), "distance"), {"nothing in this scene moves"});
    expect_said(refusal(ball_at("a", "", "1", "1, 0, 0"), "distance"),
                {"there is nothing else in this scene for body.a"});
    expect_said(
        refusal(ball_at("a", "", "0", "1, 0, 0") + ball_at("b", "", "3") + ball_at("c", "", "-3"),
                "distance"),
        {"as far from several things"});
}

TEST(AxisNames, AreMappedAndNoNumberIsOnBothAxes) {
    const std::string scene = "[world]\ngravity = [0, 0, 0]\n" + ball_at("light", "mass = 2", "1") +
                              ball_at("heavy", "mass = 20", "4", "-3, 0, 4");
    MapOptions options;
    options.methods = {"soft_step"};
    options.duration = 0.1;
    const StabilityMap map = map_scene({"scene.toml", scene}, parse_map_axis("mass_ratio=1,100"),
                                       parse_map_axis("speed=1,1e6"), options);
    std::ostringstream said;
    print(said, map);
    expect_said(said.str(), {"x: mass_ratio by body.heavy.mass, from 1 to 100",
                             "y: speed (m/s) by body.heavy.velocity"});
    EXPECT_TRUE(map.methods.at(0).cells.back().has_value());
    try {
        (void)map_scene({"scene.toml", scene}, parse_map_axis("speed=1,2"),
                        parse_map_axis("body.heavy.velocity.z=1,2"), options);
        ADD_FAILURE();
    } catch (const std::invalid_argument &error) {
        expect_said(error.what(), {"body.heavy.velocity.z is on both axes"});
    }
}

} // namespace
} // namespace plumb
