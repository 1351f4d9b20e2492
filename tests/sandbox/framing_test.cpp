#include "app/sandbox/draw/framing.h"

#include "engine/core/random.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace plumb {
namespace {

// Looks along -z from 10 m; the half-height of the view at the target is 5 m.
Camera front() {
    Camera camera;
    camera.target = {0, 0, 0};
    camera.distance = 10;
    camera.yaw = 0;
    camera.pitch = 0;
    camera.fov = 2 * std::atan(0.5f);
    return camera;
}

DrawShape ball(const glm::vec3 &place, float radius) {
    DrawShape shape;
    shape.position = place;
    shape.size = glm::vec3(radius);
    return shape;
}

TEST(AspectNeeded, IsAsWideAsWhatIsSeenButAtLeastSquare) {
    DrawList list;
    list.camera = front();
    EXPECT_EQ(aspect_needed(list), 1);
    list.shapes = {ball({-5, 0, 0}, 1)};
    EXPECT_NEAR(aspect_needed(list), 1.1f * 6 / 5, 1e-5f);
    list.shapes.push_back(ball({0, -40, 0}, 30)); // a floor
    EXPECT_NEAR(aspect_needed(list), 1.1f * 6 / 5, 1e-5f);
    list.lines.push_back({{0, 0, 0}, {40, 0, 0}, {}, 1}); // beyond a 16:9 picture
    EXPECT_NEAR(aspect_needed(list), 16.0f / 9, 1e-5f);
}

TEST(ShiftToSee, BringsTheNearestPlaceJustIntoThePicture) {
    const Camera camera = front();
    const std::vector<glm::vec3> inside{{0, 0, 0}, {100, 0, 0}};
    EXPECT_EQ(shift_to_see(camera, 1, inside), glm::vec3(0));
    EXPECT_EQ(shift_to_see(camera, 1, {}), glm::vec3(0));
    // 5 m to the border, of which a tenth is margin.
    const std::vector<glm::vec3> below{{0, -20, 0}, {0, -300, 0}};
    EXPECT_LT(glm::distance(shift_to_see(camera, 1, below), glm::vec3(0, -20 + 5 / 1.1f, 0)),
              1e-5f);
    const std::vector<glm::vec3> aside{{20, 0, 0}};
    EXPECT_LT(glm::distance(shift_to_see(camera, 1.5f, aside), glm::vec3(20 - 7.5f / 1.1f, 0, 0)),
              1e-5f);
    // Along the view direction it may be as far beyond the target as the target is away.
    const std::vector<glm::vec3> far{{0, 0, -50}};
    EXPECT_LT(glm::distance(shift_to_see(camera, 1, far), glm::vec3(0, 0, -40)), 1e-4f);
}

TEST(ShiftToSee, APlaceIsSeenAfterwardsWhereverItIs) {
    Random random(5);
    for (int i = 0; i < 1000; ++i) {
        Camera camera = front();
        camera.yaw = static_cast<float>(random.next_in(-3, 3));
        camera.pitch = static_cast<float>(random.next_in(-1.4, 1.4));
        const auto coordinate = [&] { return static_cast<float>(random.next_in(-60, 60)); };
        const std::vector<glm::vec3> place{{coordinate(), coordinate(), coordinate()}};
        camera.target += shift_to_see(camera, 1, place);
        const glm::vec3 seen = camera.project(place[0], {200, 200});
        EXPECT_GT(seen.x, 9);
        EXPECT_LT(seen.x, 191);
        EXPECT_GT(seen.y, 9);
        EXPECT_LT(seen.y, 191);
        EXPECT_LT(seen.z, 1);
        const float depth = glm::dot(place[0] - camera.eye(), camera.forward());
        EXPECT_LT(depth, 20.01f);
    }
}

SceneDesc swing() {
    SceneDesc scene;
    BodyDesc ball;
    ball.name = "ball";
    ball.colliders.emplace_back().shape = SphereDesc{0.5};
    ball.position = {0, 3, 0};
    scene.bodies.push_back(ball);
    scene.joints.emplace_back();
    scene.camera.target = {0, 3, 0};
    scene.camera.pitch = 0;
    scene.camera.yaw = 0;
    return scene;
}

TEST(PlaneBehind, IsAFloorUnderWhatIsHeldAndAWallBehindWhatFalls) {
    SceneDesc scene = swing();
    const auto floor = plane_behind(scene);
    ASSERT_TRUE(floor);
    EXPECT_EQ(floor->rotation, glm::quat(1, 0, 0, 0));
    const float half = 10 * std::tan(0.4f); // half the picture's height, m
    EXPECT_NEAR(floor->position.y, 3 - 0.85f * half, 1e-4f);
    scene.bodies[0].position.y = -4;
    EXPECT_NEAR(plane_behind(scene)->position.y, -4.5f, 1e-5f);

    scene.joints.clear();
    const auto wall = plane_behind(scene);
    ASSERT_TRUE(wall);
    EXPECT_LT(glm::distance(wall->rotation * glm::vec3(0, 1, 0), glm::vec3(0, 0, 1)), 1e-6f);
    EXPECT_LT(wall->position.z, -0.5f);
    scene.world.settings.give(&StepSettings::gravity, glm::dvec3(0));
    EXPECT_EQ(plane_behind(scene)->rotation, glm::quat(1, 0, 0, 0));

    BodyDesc ground;
    ground.name = "ground";
    ground.colliders.emplace_back().shape = PlaneDesc{};
    scene.bodies.push_back(ground);
    EXPECT_FALSE(plane_behind(scene));
}

} // namespace
} // namespace plumb
