#include "app/sandbox/draw/world_draw.h"

#include "app/render/palette.h"
#include "engine/scene/scene_file.h"
#include "tests/sandbox/fake_simulation.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace plumb {
namespace {

constexpr const char *scene_text = R"(
[[body]]
name = "ground"
shape = "plane"
[[body]]
name = "wall"
kind = "static"
shape = "box"
half_extents = [40, 1, 0.1]
position = [0, 1, -60]
[[body]]
name = "box"
shape = "box"
half_extents = [0.5, 0.25, 0.75]
position = [0, 0.25, 0]
[[body]]
name = "red"
shape = "capsule"
half_height = 0.5
radius = 0.2
position = [3, 0.7, 0]
velocity = [2, 0, 0]
color = [1, 0, 0]
)";

class WorldDraw : public testing::Test {
  protected:
    WorldDraw() : simulation(Simulation::create(parse_scene(scene_text, "x").scene, {}, nullptr)) {}
    std::unique_ptr<Simulation> simulation;
    Camera camera;
};

TEST_F(WorldDraw, EveryBodyOnceInItsPlace) {
    const DrawList list = draw_world(*simulation, camera);
    ASSERT_EQ(list.planes.size(), 1u);
    ASSERT_EQ(list.shapes.size(), 3u);
    EXPECT_TRUE(list.lines.empty());
    EXPECT_TRUE(list.points.empty());
    EXPECT_EQ(list.shapes[0].colour, colours::static_body);
    EXPECT_EQ(list.shapes[1].kind, DrawKind::box);
    EXPECT_EQ(list.shapes[1].size, glm::vec3(0.5f, 0.25f, 0.75f));
    EXPECT_EQ(list.shapes[1].colour, palette_colour(2)); // by its body index
    EXPECT_EQ(list.shapes[2].kind, DrawKind::capsule);
    EXPECT_EQ(list.shapes[2].size.x, 0.2f);
    EXPECT_EQ(list.shapes[2].size.y, 0.5f);
    EXPECT_EQ(list.shapes[2].position, glm::vec3(3, 0.7f, 0));
    EXPECT_EQ(list.shapes[2].colour, glm::vec3(1, 0, 0));
}

TEST_F(WorldDraw, ARemovedBodyIsGone) {
    simulation->remove_body(*simulation->find_body("box"));
    EXPECT_EQ(draw_world(*simulation, camera).shapes.size(), 2u);
}

TEST_F(WorldDraw, SelectionAndHoverMarkOneBodyEach) {
    WorldDrawOptions options;
    options.selected = 2;
    options.hovered = 3;
    const DrawList list = draw_world(*simulation, camera, options);
    EXPECT_TRUE(list.shapes[1].selected);
    EXPECT_FALSE(list.shapes[2].selected);
    EXPECT_TRUE(list.shapes[2].highlighted);
    EXPECT_FALSE(list.shapes[1].highlighted);
}

TEST_F(WorldDraw, ShowsTheGivenPoses) {
    std::vector<BodyState> poses = simulation->read().bodies;
    poses[2].position = {7, 8, 9};
    EXPECT_EQ(draw_world(*simulation, camera, {}, poses).shapes[1].position, glm::vec3(7, 8, 9));
}

TEST_F(WorldDraw, ContactsBoundsAndVelocitiesWhenAskedFor) {
    for (int i = 0; i < 30; ++i)
        simulation->step();
    WorldDrawOptions options;
    options.contacts = true;
    DrawList list = draw_world(*simulation, camera, options);
    EXPECT_EQ(list.points.size(), simulation->read({.contacts = true}).contacts.size());
    EXPECT_GE(list.points.size(), 4u); // the box on its four corners
    options = {};
    options.bounds = true;
    list = draw_world(*simulation, camera, options);
    EXPECT_EQ(list.lines.size(), 12 * 3u); // none around the plane
    options = {};
    options.velocities = true;
    EXPECT_FALSE(draw_world(*simulation, camera, options).lines.empty());
}

TEST_F(WorldDraw, WhatMovesIsFramedNotTheFloor) {
    const Around all = around(*simulation);
    // The box and the capsule, within x = [-0.94, 3.7]; the 80 m wall does not count.
    EXPECT_LT(all.radius, 4);
    EXPECT_NEAR(all.centre.x, 1.4, 0.1);
    const Around wall = around(*simulation, 1);
    EXPECT_EQ(wall.centre, glm::vec3(0, 1, -60));
    EXPECT_GT(wall.radius, 40);
}

// A weightless ball on a rod from the origin, held in the given direction.
std::unique_ptr<Simulation> rod_towards(const glm::dvec3 &direction) {
    SceneDesc scene;
    scene.name = "rod";
    scene.world.settings.give(&StepSettings::gravity, glm::dvec3(0));
    scene.world.precision = Precision::f64;
    BodyDesc ball;
    ball.name = "ball";
    ball.colliders.emplace_back().shape = SphereDesc{0.1};
    ball.position = direction;
    scene.bodies.push_back(ball);
    JointDesc rod;
    rod.name = "rod";
    rod.type = JointType::distance;
    rod.body_b = "ball";
    rod.min_length = rod.max_length = glm::length(direction);
    scene.joints.push_back(rod);
    return Simulation::create(scene, {}, nullptr);
}

// The shortest rotation from up has no axis straight down: off by a hair, by a little, exactly.
TEST(Rods, ReachFromEndToEndInEveryDirection) {
    std::vector<glm::dvec3> directions{{0, -1, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, -1}};
    for (double off = 1e-9; off < 1; off *= 3)
        for (const glm::dvec3 aside : {glm::dvec3(off, 0, 0), glm::dvec3(0.6 * off, 0, -0.8 * off)})
            for (const double down : {-1.0, 1.0})
                directions.push_back(glm::normalize(aside + glm::dvec3(0, down, 0)));
    for (const glm::dvec3 &direction : directions) {
        const DrawList list = draw_world(*rod_towards(direction), Camera());
        ASSERT_EQ(list.shapes.size(), 2u);
        const DrawShape &rod = list.shapes[1];
        const glm::vec3 half = rod.rotation * glm::vec3(0, rod.size.y, 0);
        const glm::vec3 to(direction);
        const float miss = std::min(glm::distance(rod.position + half, to),
                                    glm::distance(rod.position - half, to));
        EXPECT_LT(miss, 1e-6f) << direction.x << ", " << direction.y << ", " << direction.z;
        const glm::quat &q = rod.rotation;
        EXPECT_NEAR(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z, 1, 1e-6f);
    }
}

// Between two steps everything drawn for a body moves with it: anchors, rods, contacts and bounds.
TEST(WorldDrawn, BetweenTwoStepsEverythingIsOfOneMoment) {
    const auto simulation = rod_towards({0.6, -0.8, 0});
    WorldDrawOptions options;
    options.joints = options.bounds = true;
    std::vector<BodyState> poses = simulation->read().bodies;
    poses[0].position = {0, -1, 0};
    poses[0].orientation = glm::angleAxis(1.0, glm::dvec3(0, 0, 1));
    const DrawList list = draw_world(*simulation, Camera(), options, poses);
    ASSERT_EQ(list.shapes.size(), 2u);
    EXPECT_EQ(list.shapes[1].position, glm::vec3(0, -0.5f, 0));
    ASSERT_EQ(list.points.size(), 2u);
    EXPECT_EQ(list.points[1].position, glm::vec3(0, -1, 0));
    glm::vec3 low(1e9f);
    ASSERT_GE(list.lines.size(), 12u);
    for (std::size_t i = list.lines.size() - 12; i < list.lines.size(); ++i)
        low = glm::min(low, glm::min(list.lines[i].a, list.lines[i].b));
    EXPECT_LT(glm::distance(low, glm::vec3(-0.1f, -1.1f, -0.1f)), 1e-6f);
}

TEST_F(WorldDraw, ContactsGoAlongWithTheBodiesThatAreShown) {
    for (int i = 0; i < 30; ++i)
        simulation->step();
    WorldDrawOptions options;
    options.contacts = true;
    std::vector<BodyState> poses = simulation->read().bodies;
    const DrawList now = draw_world(*simulation, camera, options, poses);
    for (BodyState &pose : poses)
        pose.position.x -= 0.25;
    const DrawList before = draw_world(*simulation, camera, options, poses);
    ASSERT_EQ(now.points.size(), before.points.size());
    ASSERT_GE(now.points.size(), 4u);
    for (std::size_t i = 0; i < now.points.size(); ++i)
        EXPECT_NEAR(before.points[i].position.x, now.points[i].position.x - 0.25f, 1e-5f);
}

// A ring of 16 lines and a stalk for each impact passed in, smaller the older it is.
TEST_F(WorldDraw, ImpactsAreDrawnWhereTheyWereAndHowHard) {
    WorldDrawOptions options;
    options.contacts = true;
    const std::size_t without = draw_world(*simulation, camera, options).lines.size();
    const auto reach_of = [&](double impulse, double age) {
        options.impacts = {{ImpactView{0, 2, {3, 2, 1}, {0, 1, 0}, impulse}, age}};
        const DrawList list = draw_world(*simulation, camera, options);
        EXPECT_EQ(list.lines.size(), without + 17);
        const glm::vec3 at(3, 2, 1);
        const float reach = glm::distance(list.lines.back().b, at);
        for (std::size_t i = without; i < list.lines.size(); ++i)
            EXPECT_NEAR(glm::distance(list.lines[i].a, at), reach, 1e-5f);
        return reach;
    };
    EXPECT_NEAR(reach_of(4, 0), 2 * reach_of(1, 0), 1e-5f);
    EXPECT_NEAR(reach_of(1, Session::impact_shown / 2), reach_of(1, 0) / 2, 1e-5f);
    options.contacts = false;
    EXPECT_LT(draw_world(*simulation, camera, options).lines.size(), without + 17);
}

} // namespace
} // namespace plumb
