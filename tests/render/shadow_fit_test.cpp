#include "app/render/shadow_fit.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

namespace plumb {
namespace {

const glm::vec3 light{0.45f, -1.0f, -0.55f};

std::vector<DrawShape> row() {
    std::vector<DrawShape> shapes(9);
    for (std::size_t i = 0; i < shapes.size(); ++i) {
        shapes[i].kind = static_cast<DrawKind>(i % 3);
        shapes[i].position = {static_cast<float>(i) - 4, 0.5f, 0};
        shapes[i].rotation = glm::angleAxis(static_cast<float>(i), glm::vec3(0.6f, 0.8f, 0));
        shapes[i].size = {0.4f, 0.6f, 0.2f};
    }
    return shapes;
}

TEST(ShadowFit, HoldsEveryShapeInView) {
    const std::vector<DrawShape> shapes = row();
    const Camera camera;
    const auto fit = fit_shadow(shapes, camera, 1.6f, light, camera.target, 1024);
    ASSERT_TRUE(fit);
    for (const DrawShape &shape : shapes) {
        // Points on each shape: poles, corners, ends.
        for (const glm::vec3 &at : {glm::vec3(1, 1, 1), {1, -1, 1}, {-1, 1, -1}, {-1, -1, 1}}) {
            const glm::vec3 local = shape.kind == DrawKind::box ? at * shape.size
                                    : shape.kind == DrawKind::sphere
                                        ? glm::normalize(at) * shape.size.x
                                        : glm::vec3(0, at.y * (shape.size.x + shape.size.y), 0);
            const glm::vec3 world = shape.position + shape.rotation * local;
            const glm::vec4 seen = fit->texture_from_relative * glm::vec4(world - camera.target, 1);
            for (int c = 0; c < 3; ++c) {
                EXPECT_GT(seen[c], 0);
                EXPECT_LT(seen[c], 1);
            }
        }
    }
}

TEST(ShadowFit, PointsAlongTheLightShareATexelAndGrowInDepth) {
    const Camera camera;
    const auto fit = fit_shadow(row(), camera, 1.6f, light, camera.target, 1024);
    ASSERT_TRUE(fit);
    const glm::vec4 first = fit->texture_from_relative * glm::vec4(0.3f, 1, 0.2f, 1);
    const glm::vec4 second =
        fit->texture_from_relative * glm::vec4(glm::vec3(0.3f, 1, 0.2f) + light, 1);
    EXPECT_NEAR(first.x, second.x, 1e-5f);
    EXPECT_NEAR(first.y, second.y, 1e-5f);
    EXPECT_GT(second.z, first.z);
}

TEST(ShadowFit, MovesInWholeTexelsWithTheCamera) {
    const std::vector<DrawShape> shapes = row();
    Camera camera;
    const auto before = fit_shadow(shapes, camera, 1.6f, light, camera.target, 1024);
    camera.orbit({7, 3}, 720);
    camera.target += glm::vec3(0.013f, 0, 0.007f);
    const auto after = fit_shadow(shapes, camera, 1.6f, light, glm::vec3(0, 1, 0), 1024);
    ASSERT_TRUE(before && after);
    EXPECT_EQ(before->texel, after->texel);
    EXPECT_EQ(before->texture_from_relative, after->texture_from_relative);
}

TEST(ShadowFit, AFloorOrAnOutlierDoesNotCoarsenTheMap) {
    std::vector<DrawShape> shapes = row();
    const Camera camera;
    const float alone = fit_shadow(shapes, camera, 1.6f, light, camera.target, 1024)->texel;
    DrawShape floor;
    floor.kind = DrawKind::box;
    floor.position = {0, -1, 0};
    floor.size = {100, 1, 100};
    shapes.push_back(floor);
    EXPECT_EQ(fit_shadow(shapes, camera, 1.6f, light, camera.target, 1024)->texel, alone);
    DrawShape fallen;
    fallen.position = {0, -5000, 0};
    shapes.push_back(fallen);
    // Bounded by what the camera sees, within 6 times its distance: some 60 m here.
    EXPECT_LT(fit_shadow(shapes, camera, 1.6f, light, camera.target, 1024)->texel, 100.0f / 1024);
}

TEST(ShadowFit, ThereIsNoneWithoutShapesInReach) {
    const Camera camera;
    EXPECT_FALSE(fit_shadow({}, camera, 1.6f, light, camera.target, 1024));
    std::vector<DrawShape> behind(1);
    behind[0].position = {5000, 0, 5000};
    EXPECT_FALSE(fit_shadow(behind, camera, 1.6f, light, camera.target, 1024));
}

} // namespace
} // namespace plumb
