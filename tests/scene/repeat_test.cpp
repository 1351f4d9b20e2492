#include "engine/scene/repeat.h"

#include "engine/scene/scene_file.h"

#include <cmath>
#include <numbers>
#include <string>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace plumb {
namespace {

constexpr double pi = std::numbers::pi;
const glm::dvec3 at{10, 20, 30};

std::vector<Placement> place(const Repeat &repeat, std::uint64_t seed = 1) {
    Random random(seed);
    std::vector<Placement> placed = placements(repeat, at, random);
    EXPECT_EQ(placed.size(), repeat_count(repeat));
    return placed;
}

// Positions are sums of a few terms of at most 100 m: a few ulps of 100.
constexpr double rounding = 1e-12;

void expect_near(const glm::dvec3 &actual, const glm::dvec3 &expected) {
    EXPECT_NEAR(actual.x, expected.x, rounding);
    EXPECT_NEAR(actual.y, expected.y, rounding);
    EXPECT_NEAR(actual.z, expected.z, rounding);
}

TEST(Repeat, GridIsCentredAndGrowsUp) {
    const std::vector<Placement> p = place(GridRepeat{{3, 4, 2}, {1, 2, 3}});
    ASSERT_EQ(p.size(), 24U);
    expect_near(p.front().position, at + glm::dvec3(-1, 0, -1.5));
    expect_near(p[1].position, at + glm::dvec3(0, 0, -1.5));  // along x first
    expect_near(p[3].position, at + glm::dvec3(-1, 0, 1.5));  // then z
    expect_near(p[6].position, at + glm::dvec3(-1, 2, -1.5)); // then up
    expect_near(p.back().position, at + glm::dvec3(1, 6, 1.5));
    // Centred: the mean is the position, raised by half the height.
    glm::dvec3 sum{0};
    for (const Placement &each : p)
        sum += each.position;
    expect_near(sum / 24.0, at + glm::dvec3(0, 3, 0));
}

TEST(Repeat, StackTurns) {
    const std::vector<Placement> p = place(StackRepeat{5, 0.5, pi / 2});
    ASSERT_EQ(p.size(), 5U);
    for (int i = 0; i < 5; ++i) {
        expect_near(p[static_cast<std::size_t>(i)].position, at + glm::dvec3(0, 0.5 * i, 0));
        // A quarter turn about +y takes +z to +x, +x to -z.
        const glm::dvec3 z = p[static_cast<std::size_t>(i)].turn * glm::dvec3(0, 0, 1);
        expect_near(z, {std::sin(i * pi / 2), 0, std::cos(i * pi / 2)});
    }
}

TEST(Repeat, LineSteps) {
    const std::vector<Placement> p = place(LineRepeat{4, {1, -2, 0.5}});
    ASSERT_EQ(p.size(), 4U);
    expect_near(p[0].position, at);
    expect_near(p[3].position, at + glm::dvec3(3, -6, 1.5));
}

TEST(Repeat, FlatPyramidIsTriangular) {
    const std::vector<Placement> p = place(PyramidRepeat{4, {1.5, 1}, false});
    ASSERT_EQ(p.size(), 4U + 3U + 2U + 1U);
    expect_near(p[0].position, at + glm::dvec3(-2.25, 0, 0));
    expect_near(p[3].position, at + glm::dvec3(2.25, 0, 0));
    expect_near(p[4].position, at + glm::dvec3(-1.5, 1, 0));
    expect_near(p[9].position, at + glm::dvec3(0, 3, 0));
}

TEST(Repeat, SquarePyramidHasSquareLayers) {
    const std::vector<Placement> p = place(PyramidRepeat{3, {2, 1}, true});
    ASSERT_EQ(p.size(), 9U + 4U + 1U);
    expect_near(p[0].position, at + glm::dvec3(-2, 0, -2));
    expect_near(p[8].position, at + glm::dvec3(2, 0, 2));
    expect_near(p[9].position, at + glm::dvec3(-1, 1, -1));
    expect_near(p[13].position, at + glm::dvec3(0, 2, 0));
}

TEST(Repeat, RingFacesOutwards) {
    const std::vector<Placement> p = place(RingRepeat{8, 2, true});
    ASSERT_EQ(p.size(), 8U);
    expect_near(p[0].position, at + glm::dvec3(0, 0, 2));
    expect_near(p[2].position, at + glm::dvec3(2, 0, 0));
    for (const Placement &each : p)
        expect_near(each.turn * glm::dvec3(0, 0, 1), 0.5 * (each.position - at));
    for (const Placement &each : place(RingRepeat{8, 2, false}))
        EXPECT_EQ(each.turn, glm::dquat(1, 0, 0, 0));
}

TEST(Repeat, ScatterKeepsItsDistance) {
    const ScatterRepeat scatter{300, {4, 1, 2}, 0.3, true};
    const std::vector<Placement> p = place(scatter);
    ASSERT_EQ(p.size(), 300U);
    for (std::size_t i = 0; i < p.size(); ++i) {
        const glm::dvec3 offset = p[i].position - at;
        EXPECT_LE(std::abs(offset.x), 4 + rounding);
        EXPECT_LE(std::abs(offset.y), 1 + rounding);
        EXPECT_LE(std::abs(offset.z), 2 + rounding);
        EXPECT_NEAR(glm::length(p[i].turn), 1, 1e-14);
        for (std::size_t j = 0; j < i; ++j)
            EXPECT_GE(glm::distance(p[i].position, p[j].position), 0.3 - rounding);
    }
}

TEST(Repeat, ScatterIsSeeded) {
    const ScatterRepeat scatter{20, {1, 1, 1}, 0, true};
    const std::vector<Placement> a = place(scatter, 5);
    const std::vector<Placement> b = place(scatter, 5);
    const std::vector<Placement> c = place(scatter, 6);
    for (std::size_t i = 0; i < a.size(); ++i) {
        EXPECT_EQ(a[i].position, b[i].position);
        EXPECT_EQ(a[i].turn, b[i].turn);
        EXPECT_NE(a[i].position, c[i].position);
    }
}

TEST(Repeat, ScatteredRotationsAreUniform) {
    // Uniform rotations take a fixed vector to every direction alike, so each component of the
    // image has mean 0 and mean square 1/3. Over 20000 samples the means have standard deviations
    // 1/sqrt(3 * 20000) = 0.0041 and sqrt(4/45 / 20000) = 0.0021; five of them are allowed.
    glm::dvec3 sum{0};
    glm::dvec3 squares{0};
    for (const Placement &each : place(ScatterRepeat{20000, {1, 1, 1}, 0, true})) {
        const glm::dvec3 image = each.turn * glm::dvec3(0.6, 0, 0.8);
        sum += image;
        squares += image * image;
    }
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(sum[axis] / 20000, 0, 5 * 0.0041);
        EXPECT_NEAR(squares[axis] / 20000, 1.0 / 3, 5 * 0.0021);
    }
}

TEST(Repeat, ScatterThatDoesNotFitGivesFewer) {
    Random random(1);
    const ScatterRepeat scatter{100, {1, 0, 0}, 0.5, false};
    const std::size_t placed = placements(scatter, at, random).size();
    EXPECT_GE(placed, 3U); // half a metre either side of each: 2 m cannot be full with two
    EXPECT_LE(placed, 5U); // 2 m hold at most five points half a metre apart
}

TEST(Repeat, CountsHugeNumbersWithoutOverflow) {
    constexpr int most = 2147483647;
    EXPECT_EQ(repeat_count(GridRepeat{{most, most, most}, {}}), std::size_t{1} << 63);
    EXPECT_EQ(repeat_count(PyramidRepeat{most, {}, false}), 2305843008139952128U);
    EXPECT_EQ(repeat_count(PyramidRepeat{most, {}, true}), std::size_t{1} << 63);
    EXPECT_EQ(repeat_count(PyramidRepeat{1000, {}, true}), 333833500U);
    EXPECT_ANY_THROW(repeat_count(StackRepeat{0, 1, 0}));
}

// ---- as bodies of a scene ----

SceneDesc parse(const std::string &text) {
    SceneFileResult result = parse_scene(text, "s.toml");
    for (const SceneMessage &message : result.messages)
        ADD_FAILURE() << format_message("s.toml", message);
    return std::move(result.scene);
}

TEST(RepeatedBody, IsNumbered) {
    const SceneDesc scene = parse(R"(
[[body]]
name = "brick"
shape = "box"
half_extents = [0.5, 0.25, 0.5]
position = [1, 0.25, 0]
velocity = [0, 0, 3]
repeat = { kind = "stack", count = 3 }
[[body]]
name = "after"
shape = "sphere"
radius = 1
position = [9, 0, 0]
)");
    ASSERT_EQ(scene.bodies.size(), 4U);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(scene.bodies[i].name, "brick_" + std::to_string(i));
        // Spaced by the box's height, so that they just touch.
        expect_near(scene.bodies[i].position, {1, 0.25 + 0.5 * static_cast<double>(i), 0});
        EXPECT_EQ(scene.bodies[i].velocity, glm::dvec3(0, 0, 3));
    }
    EXPECT_EQ(scene.bodies[3].name, "after");
}

TEST(RepeatedBody, HeightIsThatOfTheTurnedShape) {
    const std::string start = "[[body]]\nname = \"x\"\nrepeat = { kind = \"stack\", count = 2 }\n";
    const auto spacing = [&](const std::string &rest) {
        const SceneDesc scene = parse(start + rest);
        return scene.bodies.at(1).position.y - scene.bodies.at(0).position.y;
    };
    EXPECT_NEAR(spacing("shape = \"sphere\"\nradius = 0.3\n"), 0.6, rounding);
    EXPECT_NEAR(spacing("shape = \"capsule\"\nradius = 0.3\nhalf_height = 1\n"), 2.6, rounding);
    EXPECT_NEAR(spacing("shape = \"capsule\"\nradius = 0.3\nhalf_height = 1\n"
                        "rotation_deg = [0, 0, 90]\n"),
                0.6, rounding);
    EXPECT_NEAR(spacing("shape = \"box\"\nhalf_extents = [1, 2, 3]\nrotation_deg = [0, 0, 45]\n"),
                2 * (1 + 2) / std::sqrt(2.0), rounding);
}

TEST(RepeatedBody, RingTurnsVelocitiesToo) {
    const SceneDesc scene = parse(R"(
[[body]]
name = "x"
shape = "sphere"
radius = 0.1
velocity = [0, 0, 1]
angular_velocity = [1, 0, 0]
repeat = { kind = "ring", count = 4, radius = 2, facing = true }
)");
    ASSERT_EQ(scene.bodies.size(), 4U);
    expect_near(scene.bodies[1].velocity, {1, 0, 0});
    expect_near(scene.bodies[1].angular_velocity, {0, 0, -1});
}

TEST(RepeatedBody, ScatterStaysWhenAnotherBodyIsAdded) {
    const std::string other = "[[body]]\nname = \"first\"\nshape = \"sphere\"\nradius = 1\n"
                              "position = [0, 90, 0]\n"
                              "repeat = { kind = \"scatter\", count = 3, half_extents = [9, 0, 9], "
                              "min_distance = 3 }\n";
    const std::string body = "[[body]]\nname = \"x\"\nshape = \"sphere\"\nradius = 0.1\n"
                             "repeat = { kind = \"scatter\", count = 3, half_extents = [9, 9, 9], "
                             "min_distance = 1 }\n";
    const SceneDesc alone = parse(body);
    const SceneDesc second = parse(other + body);
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_EQ(alone.bodies.at(i).position, second.bodies.at(3 + i).position);
    const SceneDesc reseeded = parse("[world]\nseed = 2\n" + body);
    EXPECT_NE(alone.bodies.at(0).position, reseeded.bodies.at(0).position);
}

TEST(RepeatedBody, PileOfThousandsIsOneTable) {
    const SceneDesc scene = parse(R"(
[[body]]
name = "ball"
shape = "sphere"
radius = 0.1
position = [0, 0.1, 0]
repeat = { kind = "grid", count = [20, 25, 10], spacing = [0.2, 0.2, 0.2] }
)");
    EXPECT_EQ(scene.bodies.size(), 5000U);
    EXPECT_EQ(scene.bodies.back().name, "ball_4999");
}

TEST(Chain, JoinsEachCopyToTheNext) {
    const SceneDesc scene = parse(R"(
[[body]]
name = "link"
shape = "capsule"
half_height = 0.2
radius = 0.05
rotation_deg = [0, 0, 90]
repeat = { kind = "line", count = 4, step = [0.5, 0, 0] }
[[joint]]
name = "pin"
type = "ball"
chain = "link"
anchor_a_local = [0, -0.25, 0]
anchor_b_local = [0, 0.25, 0]
[[joint]]
name = "mid"
type = "ball"
chain = "link"
[[joint]]
name = "rod"
type = "distance"
chain = "link"
)");
    ASSERT_EQ(scene.joints.size(), 9U);
    const auto world = [&](const std::string &name, const glm::dvec3 &local) {
        for (const BodyDesc &body : scene.bodies)
            if (body.name == name)
                return body.position + body.orientation * local;
        ADD_FAILURE() << name;
        return local;
    };
    for (std::size_t i = 0; i < 9; ++i) {
        const JointDesc &joint = scene.joints[i];
        const std::size_t link = i % 3;
        EXPECT_EQ(joint.name, (i < 3 ? "pin_" : i < 6 ? "mid_" : "rod_") + std::to_string(link));
        EXPECT_EQ(joint.body_a, "link_" + std::to_string(link));
        EXPECT_EQ(joint.body_b, "link_" + std::to_string(link + 1));
        if (i < 6) {
            // Lying along x, half-way between the centres at 0.5 i and 0.5 (i + 1).
            const glm::dvec3 middle{0.5 * static_cast<double>(link) + 0.25, 0, 0};
            expect_near(world(joint.body_a, joint.anchor_a_local), middle);
            expect_near(world(joint.body_b, joint.anchor_b_local), middle);
        } else {
            EXPECT_NEAR(joint.max_length, 0.5, rounding);
        }
    }
}

} // namespace
} // namespace plumb
