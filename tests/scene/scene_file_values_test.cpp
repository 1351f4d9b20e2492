// The values that a scene file's keys give.
#include "engine/scene/scene_file.h"
#include "tests/temporary_folder.h"

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace plumb {
namespace {

constexpr double pi = std::numbers::pi;

SceneDesc parse(const std::string &text) {
    SceneFileResult result = parse_scene(text, "scenes/some scene.toml");
    for (const SceneMessage &message : result.messages)
        ADD_FAILURE() << format_message("s.toml", message);
    return std::move(result.scene);
}

const std::string ball = "[[body]]\nname = \"ball\"\nshape = \"sphere\"\nradius = 2\n";

// A few roundings of numbers near 1.
constexpr double rounding = 1e-15 * 8;

void expect_near(const glm::dvec3 &actual, const glm::dvec3 &expected) {
    EXPECT_NEAR(actual.x, expected.x, rounding);
    EXPECT_NEAR(actual.y, expected.y, rounding);
    EXPECT_NEAR(actual.z, expected.z, rounding);
}

TEST(SceneFileValues, EmptyFileIsTheDefaultScene) {
    const SceneDesc scene = parse("");
    EXPECT_EQ(scene.name, "some scene");
    EXPECT_TRUE(scene.bodies.empty());
    EXPECT_TRUE(scene.world.settings.empty());
}

TEST(SceneFileValues, World) {
    const SceneDesc scene = parse(R"(
title = "T"
description = """
two
lines"""
[world]
gravity = [1, -2.5, 3]
dt = "1/120"
method = "pgs"
substeps = 3
iterations = 40
precision = "double"
seed = 18
[methods.soft_step]
substeps = 8
[methods.xpbd]
iterations = 2
)");
    EXPECT_EQ(scene.title, "T");
    EXPECT_EQ(scene.description, "two\nlines");
    const StepSettings world = scene.world.settings.applied();
    EXPECT_EQ(world.gravity, glm::dvec3(1, -2.5, 3));
    EXPECT_EQ(world.dt, 1.0 / 120);
    EXPECT_EQ(scene.world.method, "pgs");
    EXPECT_EQ(world.substeps, 3);
    EXPECT_EQ(world.iterations, 40);
    EXPECT_EQ(scene.world.precision, Precision::f64);
    EXPECT_EQ(scene.world.seed, 18U);
    ASSERT_EQ(scene.world.other_methods.size(), 2U);
    EXPECT_EQ(scene.world.other_methods.at("soft_step").applied().substeps, 8);
    EXPECT_EQ(scene.world.other_methods.at("xpbd").applied().iterations, 2);
    EXPECT_EQ(parse("[world]\ndt = 0.005\n").world.settings.applied().dt, 0.005);
    EXPECT_EQ(parse("[world]\ndt = \" 0.5 / 60 \"\n").world.settings.applied().dt, 0.5 / 60);
    EXPECT_EQ(parse("[world]\nseed = \"18446744073709551615\"\n").world.seed,
              18446744073709551615U);
}

TEST(SceneFileValues, CameraInDegreesAndRadians) {
    const CameraDesc camera =
        parse("[camera]\ntarget = [1, 2, 3]\ndistance = 4\nyaw_deg = 90\npitch = 0.25\n"
              "fov_deg = 60\n")
            .camera;
    EXPECT_EQ(camera.target, glm::dvec3(1, 2, 3));
    EXPECT_EQ(camera.distance, 4);
    EXPECT_NEAR(camera.yaw, pi / 2, rounding);
    EXPECT_EQ(camera.pitch, 0.25);
    EXPECT_NEAR(camera.fov, pi / 3, rounding);
}

TEST(SceneFileValues, EulerAnglesAreIntrinsicXyz) {
    // About x by 90: y to z, z to -y. Then about the body's own (turned) z by 90.
    const glm::dquat q = parse(ball + "rotation_deg = [90, 0, 90]\n").bodies.at(0).orientation;
    // The body's x axis: turned about its own z by 90 first, it is the body's y, which the turn
    // about x takes to the world's z.
    expect_near(q * glm::dvec3(1, 0, 0), {0, 0, 1});
    expect_near(q * glm::dvec3(0, 1, 0), {-1, 0, 0});
    // The middle axis: about x by 90, then about the new y (which is the world's z) by 90.
    const glm::dquat p = parse(ball + "rotation_deg = [90, 90, 0]\n").bodies.at(0).orientation;
    expect_near(p * glm::dvec3(0, 1, 0), {0, 0, 1});
    expect_near(p * glm::dvec3(0, 0, 1), {1, 0, 0});
}

TEST(SceneFileValues, AxisAndAngle) {
    const glm::dquat q =
        parse(ball + "axis = [0, 1, 0]\nangle_deg = 90\n").bodies.at(0).orientation;
    expect_near(q * glm::dvec3(0, 0, 1), {1, 0, 0});
    // An axis rounded to three digits is normalised.
    const glm::dquat p =
        parse(ball + "axis = [0.577, 0.577, 0.577]\nangle_deg = 120\n").bodies.at(0).orientation;
    expect_near(p * glm::dvec3(1, 0, 0), {0, 1, 0});
}

TEST(SceneFileValues, OrientationIsNormalisedOnlyWhenItNeedsTo) {
    const double s = std::sqrt(0.5) * (1 + 1e-7);
    char text[200];
    std::snprintf(text, sizeof text, "orientation = [%.17g, 0, %.17g, 0]\n", s, s);
    const glm::dquat kept = parse(ball + text).bodies.at(0).orientation;
    EXPECT_EQ(kept.w, s);
    EXPECT_EQ(kept.y, s);
    const glm::dquat rounded =
        parse(ball + "orientation = [0.707, 0, 0.707, 0]\n").bodies.at(0).orientation;
    EXPECT_NEAR(rounded.w, std::sqrt(0.5), rounding);
    EXPECT_NEAR(rounded.y, std::sqrt(0.5), rounding);
}

TEST(SceneFileValues, MassFromDensity) {
    const auto mass = [](const std::string &body) {
        const SceneDesc scene = parse("[[body]]\nname = \"b\"\n" + body);
        return mass_of(scene, scene.bodies.at(0));
    };
    EXPECT_EQ(mass("shape = \"sphere\"\nradius = 2\nmass = 7\n"), 7);
    EXPECT_NEAR(mass("shape = \"sphere\"\nradius = 2\ndensity = 3\n"), 32 * pi, 1e-12);
    EXPECT_NEAR(mass("shape = \"box\"\nhalf_extents = [1, 2, 3]\ndensity = 0.5\n"), 24, 1e-13);
    // A cylinder of height 2 and two half spheres, all of radius 1.
    EXPECT_NEAR(mass("shape = \"capsule\"\nradius = 1\nhalf_height = 1\ndensity = 1\n"),
                2 * pi + 4 * pi / 3, 1e-13);
    EXPECT_NEAR(mass("shape = \"sphere\"\nradius = 2\n"), 1000 * 32 * pi / 3, 1e-9);
}

TEST(SceneFileValues, Bodies) {
    const SceneDesc scene = parse(R"(
[[material]]
name = "ice"
density = 917
friction = 0.02
restitution = 0.3
color = "#ff8000"
[[body]]
name = "floor"
shape = "plane"
[[body]]
name = "lift"
kind = "kinematic"
shape = "box"
half_extents = [1, 2, 3]
position = [0, 5, 0]
velocity = [0, 1, 0]
angular_velocity_deg = [0, 180, 0]
material = "ice"
color = [0, 0.25, 1]
)");
    ASSERT_EQ(scene.bodies.size(), 2U);
    EXPECT_EQ(scene.bodies[0].kind, BodyKind::static_body);
    EXPECT_EQ(scene.bodies[0].material, "");
    EXPECT_EQ(scene.bodies[1].kind, BodyKind::kinematic);
    EXPECT_EQ(scene.bodies[1].material, "ice");
    expect_near(scene.bodies[1].angular_velocity, {0, pi, 0});
    EXPECT_EQ(scene.bodies[1].colour, glm::vec3(0, 0.25F, 1));
    EXPECT_EQ(scene.materials.at(0).density, 917);
    EXPECT_EQ(scene.materials.at(0).friction, 0.02);
    EXPECT_EQ(scene.materials.at(0).restitution, 0.3);
    EXPECT_EQ(scene.materials.at(0).colour, glm::vec3(1, 128.0F / 255.0F, 0));
}

TEST(SceneFileValues, JointAnchors) {
    const SceneDesc scene = parse(R"(
[[body]]
name = "a"
shape = "sphere"
radius = 0.5
position = [1, 2, 3]
axis = [0, 0, 1]
angle_deg = 90
[[joint]]
name = "hook"
type = "ball"
body_b = "a"
anchor = [1, 3, 3]
[[joint]]
name = "rod"
type = "distance"
body_a = "world"
body_b = "a"
anchor_a = [1, 6, 3]
collide_connected = true
[[joint]]
name = "slack"
type = "distance"
body_a = "a"
anchor_a_local = [0.5, 0, 0]
anchor_b = [0, 0, 0]
length = 9
)");
    const JointDesc &hook = scene.joints.at(0);
    EXPECT_EQ(hook.body_a, "");
    EXPECT_EQ(hook.body_b, "a");
    EXPECT_EQ(hook.anchor_a_local, glm::dvec3(1, 3, 3));
    // Straight above the centre: along the body's x axis, which the turn about z points up.
    expect_near(hook.anchor_b_local, {1, 0, 0});
    EXPECT_FALSE(hook.collide_connected);
    const JointDesc &rod = scene.joints.at(1);
    EXPECT_EQ(rod.body_a, "");
    EXPECT_EQ(rod.anchor_b_local, glm::dvec3(0));
    EXPECT_EQ(rod.max_length, 4);
    EXPECT_TRUE(rod.collide_connected);
    EXPECT_EQ(scene.joints.at(2).anchor_a_local, glm::dvec3(0.5, 0, 0));
    EXPECT_EQ(scene.joints.at(2).max_length, 9);
}

TEST(SceneFileValues, Expects) {
    const SceneDesc scene = parse(ball + R"([[expect]]
name = "falls"
quantity = "position.y"
body = "ball"
reduce = "period"
level = -3
from = 0.5
to = 2
equals = -19.62
tolerance = 1e-3
estimate = 2e-5
source = "g t^2 / 2"
)");
    const ExpectDesc &expect = scene.expects.at(0);
    EXPECT_EQ(expect.line, 5U);
    EXPECT_EQ(expect.quantity, "position.y");
    EXPECT_EQ(expect.reduce, "period");
    EXPECT_EQ(expect.level, -3);
    EXPECT_EQ(expect.from, 0.5);
    EXPECT_EQ(expect.to, 2);
    EXPECT_EQ(expect.relation, ExpectDesc::Relation::equals);
    EXPECT_EQ(expect.value, -19.62);
    EXPECT_EQ(expect.tolerance, 1e-3);
    EXPECT_EQ(expect.estimate, 2e-5);
}

TEST(SceneFileValues, ExpectedCurves) {
    const SceneDesc scene = parse(ball + R"([[expect]]
name = "falls"
quantity = "position.y"
body = "ball"
reduce = "max"
to = 1.5
equals = [ # at 0, 0.5, 1 and 1.5 s
    0, -1.22625,
    -4.905, -11.03625,
]
tolerance = 0.1
source = "g t^2 / 2"
)");
    const ExpectDesc &expect = scene.expects.at(0);
    EXPECT_EQ(expect.curve, (std::vector<double>{0, -1.22625, -4.905, -11.03625}));
    EXPECT_EQ(expect.value, 0);
    EXPECT_EQ(expect.tolerance, 0.1);
    EXPECT_FALSE(expect.estimate);
}

TEST(SceneFileValues, LoadSaysWhenItCannotRead) {
    for (const auto &[path, why] :
         {std::pair{"/nonexistent/x.toml",
                    "the file cannot be read; check that it exists and is readable"},
          std::pair{"/", "this is a folder, not a scene file; give one of the files in it"}}) {
        const SceneFileResult result = load_scene(path);
        ASSERT_EQ(result.messages.size(), 1U);
        EXPECT_EQ(result.messages[0].line, 0U);
        EXPECT_EQ(format_message(path, result.messages[0]), std::string(path) + ": error: " + why);
    }
}

TEST(SceneFileValues, LoadReadsAFile) {
    const TemporaryFolder folder;
    const SceneFileResult result = load_scene(folder.write("plumb_scene_file_values.toml", ball));
    EXPECT_TRUE(result.ok());
    EXPECT_EQ(result.scene.name, "plumb_scene_file_values");
    EXPECT_EQ(result.scene.bodies.size(), 1U);
}

TEST(SceneFileValues, LoadRefusesAFileWithNothingToRun) {
    const TemporaryFolder folder;
    for (const std::string text : {"", "# nothing\n", "title = \"T\"\n[world]\ndt = 0.01\n",
                                   "[[material]]\nname = \"wood\"\n"}) {
        const SceneFileResult result = load_scene(folder.write("nothing.toml", text));
        EXPECT_FALSE(result.ok());
        ASSERT_EQ(result.messages.size(), 1U) << text;
        EXPECT_EQ(
            format_message("s.toml", result.messages[0]),
            "s.toml:1:1: error: the scene is empty: it has no body, no particle, no cloth and no "
            "probe; add a [[body]], a [[particle]], a [[cloth]] or a [[probe]]");
        EXPECT_TRUE(parse_scene(text, "s.toml").ok()); // as text it is a valid scene
    }
}

} // namespace
} // namespace plumb
