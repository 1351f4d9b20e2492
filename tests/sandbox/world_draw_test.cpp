#include "app/sandbox/world_draw.h"

#include "app/render/palette.h"
#include "engine/scene/scene_file.h"
#include "tests/sandbox/fake_simulation.h"

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
    EXPECT_EQ(list.shapes[0].colour, colours::fixed);
    EXPECT_EQ(list.shapes[1].kind, DrawKind::box);
    EXPECT_EQ(list.shapes[1].size, glm::vec3(0.5f, 0.25f, 0.75f));
    EXPECT_EQ(list.shapes[1].colour, palette_colour(2)); // by its index among the bodies
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
    std::vector<Pose> poses = poses_of(*simulation);
    poses[2].position = {7, 8, 9};
    EXPECT_EQ(draw_world(*simulation, camera, {}, poses).shapes[1].position, glm::vec3(7, 8, 9));
}

TEST_F(WorldDraw, ContactsBoundsAndVelocitiesWhenAskedFor) {
    for (int i = 0; i < 30; ++i)
        simulation->step();
    WorldDrawOptions options;
    options.contacts = true;
    DrawList list = draw_world(*simulation, camera, options);
    EXPECT_EQ(list.points.size(), simulation->contacts().size());
    EXPECT_GE(list.points.size(), 4u); // the box on its four corners
    options = {};
    options.bounds = true;
    list = draw_world(*simulation, camera, options);
    EXPECT_EQ(list.lines.size(), 12 * simulation->bounds().size());
    EXPECT_FALSE(list.lines.empty());
    options = {};
    options.velocities = true;
    EXPECT_FALSE(draw_world(*simulation, camera, options).lines.empty());
}

TEST_F(WorldDraw, WhatMovesIsFramedNotTheFloor) {
    const Around all = around(*simulation);
    // The box and the capsule, within x = [-0.94, 3.7]: the wall of 80 m does not count.
    EXPECT_LT(all.radius, 4);
    EXPECT_NEAR(all.centre.x, 1.4, 0.1);
    const Around wall = around(*simulation, 1);
    EXPECT_EQ(wall.centre, glm::vec3(0, 1, -60));
    EXPECT_GT(wall.radius, 40);
}

} // namespace
} // namespace plumb
