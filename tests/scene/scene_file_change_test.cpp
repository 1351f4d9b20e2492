#include "engine/scene/file/change.h"

#include <stdexcept>

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
