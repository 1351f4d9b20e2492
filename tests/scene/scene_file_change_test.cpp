#include "engine/scene/file/change.h"

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace plumb {
namespace {

constexpr const char *text = R"(
[world]
dt = "1/60"
[[material]]
name = "steel"
[[body]]
name = "ball"
shape = "sphere"
radius = 0.1
material = "steel"
velocity = [8, 2, 0]
[[body]]
name = "ball.small"
shape = "sphere"
radius = 0.1
position = [0, 5, 0]
[[body]]
name = "box"
shapes = [{ shape = "box", half_extents = [1, 1, 1] }, { shape = "sphere", radius = 2 }]
position = [30, 5, 0]
repeat = { kind = "stack", count = 3 }
)";

SceneFileResult changed(const std::string &path, double value) {
    const ChangedNumber number{path, value};
    return parse_scene(text, "scene.toml", {}, {&number, 1});
}

SceneDesc scene(const std::string &path, double value) {
    const SceneFileResult result = changed(path, value);
    EXPECT_TRUE(result.ok()) << path << ": "
                             << (result.messages.empty() ? "" : result.messages[0].what);
    return result.scene;
}

std::string complaint(const std::string &path) {
    try {
        (void)changed(path, 1);
    } catch (const std::invalid_argument &error) {
        return error.what();
    }
    return "";
}

std::string mistake(const std::string &path, double value) {
    const SceneFileResult result = changed(path, value);
    EXPECT_FALSE(result.ok());
    return result.messages.front().what + "; " + result.messages.front().suggestion;
}

TEST(SceneFileChange, PutsANumberInThePlaceOfAnother) {
    EXPECT_EQ(scene("body.ball.velocity.y", -3.5).bodies[0].velocity, glm::dvec3(8, -3.5, 0));
    EXPECT_EQ(
        std::get<SphereDesc>(scene("body.ball.radius", 2).bodies[0].colliders[0].shape).radius, 2);
    EXPECT_EQ(scene("world.dt", 0.01).world.settings.find({1, 0}), 0.01);
    EXPECT_EQ(scene("body.box.repeat.count", 7).bodies.size(), 9U);
    const SceneDesc second = scene("body.box.shapes.0.half_extents.z", 4);
    EXPECT_EQ(std::get<BoxDesc>(second.bodies[2].colliders[0].shape).half_extents,
              glm::dvec3(1, 1, 4));
}

TEST(SceneFileChange, AddsAPlainNumberThatTheFileLeavesOut) {
    EXPECT_EQ(scene("material.steel.friction", 0.25).materials[0].friction, 0.25);
    EXPECT_EQ(scene("body.ball.mass", 12).bodies[0].mass, 12);
}

// A spring given by its frequency takes a stiffness all the same, and keeps its damping ratio.
TEST(SceneFileChange, ANumberReplacesTheOtherWayToGiveIt) {
    constexpr const char *given_otherwise = R"(
[[particle]]
name = "bob"
mass = 2
position = [0, -1, 0]
[[spring]]
name = "coil"
b = "bob"
anchor_a = [0, 0, 0]
frequency = 3
damping_ratio = 0.5
[[body]]
name = "ball"
shape = "sphere"
radius = 0.1
density = 3000
)";
    const auto with = [&](const char *path, double value) {
        const ChangedNumber number{path, value};
        const SceneFileResult result = parse_scene(given_otherwise, "scene.toml", {}, {&number, 1});
        EXPECT_TRUE(result.ok()) << path;
        return result.scene;
    };
    const SpringDesc stiff = with("spring.coil.stiffness", 200).springs.at(0);
    EXPECT_EQ(stiff.stiffness, 200);
    EXPECT_NEAR(stiff.damping, 2 * 0.5 * std::sqrt(200.0 * 2), 1e-9);
    EXPECT_EQ(with("spring.coil.damping", 7).springs.at(0).damping, 7);
    EXPECT_EQ(with("body.ball.mass", 5).bodies.at(0).mass, 5);
}

TEST(SceneFileChange, NumbersAndTablesAreFoundByTheirPaths) {
    EXPECT_EQ(number_paths(text),
              (std::vector<std::string>{
                  "body.ball.radius", "body.ball.velocity.x", "body.ball.velocity.y",
                  "body.ball.small.position.y", "body.ball.small.radius", "body.box.position.x",
                  "body.box.position.y", "body.box.repeat.count",
                  "body.box.shapes.0.half_extents.x", "body.box.shapes.0.half_extents.y",
                  "body.box.shapes.0.half_extents.z", "body.box.shapes.1.radius"}));
    EXPECT_EQ(table_paths(text, "body"),
              (std::vector<std::string>{"body.ball", "body.ball.small", "body.box"}));
    EXPECT_EQ(table_paths("[[particle]]\n[[particle]]\n", "particle"),
              (std::vector<std::string>{"particle.0", "particle.1"}));
    EXPECT_TRUE(table_paths(text, "spring").empty());
    EXPECT_TRUE(table_paths("no toml", "body").empty());
    EXPECT_TRUE(number_paths("no toml").empty());
}

TEST(SceneFileChange, ANameMayHaveDots) {
    EXPECT_EQ(scene("body.ball.small.position.x", 9).bodies[1].position, glm::dvec3(9, 5, 0));
}

TEST(SceneFileChange, SaysWhatAPathShouldBe) {
    EXPECT_EQ(complaint("bdy.ball.mass"),
              "\"bdy.ball.mass\": a scene has no \"bdy\"; did you mean \"body\"?");
    EXPECT_EQ(complaint("body.bal.mass"),
              "\"body.bal.mass\": there is no body \"bal\" in this scene; did you mean \"ball\"?");
    EXPECT_EQ(complaint("spring.line.stiffness"),
              "\"spring.line.stiffness\": there is no spring in this scene");
    EXPECT_NE(complaint("body.ball.velocity.w").find("write x, y or z"), std::string::npos);
    EXPECT_NE(complaint("body.ball.shape").find("is a string, not a number"), std::string::npos);
    EXPECT_NE(complaint("body.box.repeat").find("the only one is count"), std::string::npos)
        << complaint("body.box.repeat");
    EXPECT_NE(complaint("body.ball.small.velocity.x").find("the file has no "), std::string::npos)
        << complaint("body.ball.small.velocity.x");
    EXPECT_NE(complaint("body").find("is an array, not a number"), std::string::npos);
    EXPECT_FALSE(complaint("body.ball.radius.x").empty());
    EXPECT_FALSE(complaint("").empty());
}

// As if the file contained them.
TEST(SceneFileChange, ValuesOutOfPlaceAreErrorsOfTheScene) {
    EXPECT_NE(mistake("body.ball.radius", -1).find("radius"), std::string::npos);
    EXPECT_NE(mistake("body.box.repeat.count", 2.5).find("count"), std::string::npos);
    EXPECT_NE(mistake("material.steel.frction", 1).find("did you mean \"friction\"?"),
              std::string::npos);
}

} // namespace
} // namespace plumb
