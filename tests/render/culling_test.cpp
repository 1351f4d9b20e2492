#include "app/render/culling.h"

#include "app/render/camera.h"
#include "engine/core/random.h"
#include "tests/trials.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace plumb {
namespace {

glm::vec3 any_vector(Random &random, double reach) {
    const auto x = static_cast<float>(random.next_in(-reach, reach));
    const auto y = static_cast<float>(random.next_in(-reach, reach));
    const auto z = static_cast<float>(random.next_in(-reach, reach));
    return {x, y, z};
}

DrawShape any_shape(Random &random, double reach) {
    DrawShape shape;
    shape.kind = random.next_index(2) == 0 ? DrawKind::sphere : DrawKind::box;
    shape.position = any_vector(random, reach);
    shape.size = 0.1f + glm::abs(any_vector(random, 0.5));
    return shape;
}

// Whether the shape's centre projects into the picture: then it must be drawn.
bool is_projected_inside(const glm::mat4 &view_projection, const DrawShape &shape) {
    const glm::vec4 clip = view_projection * glm::vec4(shape.position, 1);
    return clip.w > 0 && std::abs(clip.x) < clip.w && std::abs(clip.y) < clip.w &&
           std::abs(clip.z) < clip.w;
}

TEST(Culling, LeavesOutNothingThatIsInView) {
    Random random(1);
    std::vector<DrawShape> shapes;
    for (int i = 0; i < 2000; ++i)
        shapes.push_back(any_shape(random, 30));
    Culling culling;
    std::size_t shown = 0, looked = 0;
    for (int frame = 0; frame < std::max(20, trials(500)); ++frame) {
        // Some shapes move, now and then far beyond where they all started, and some come or go.
        for (int i = 0; i < 50; ++i) {
            DrawShape &shape = shapes[random.next_index(static_cast<std::uint32_t>(shapes.size()))];
            shape.position += any_vector(random, random.next_index(10) == 0 ? 100 : 1);
        }
        if (frame % 50 == 49)
            shapes.resize(shapes.size() - 10);
        Camera camera;
        camera.target = any_vector(random, 20);
        camera.distance = static_cast<float>(random.next_in(2, 30));
        camera.yaw = static_cast<float>(random.next_in(-3, 3));
        camera.pitch = static_cast<float>(random.next_in(-1.5, 1.5));
        const glm::mat4 matrix = camera.projection(1.6f) * camera.view();
        culling.update(shapes);
        const std::span<const std::uint8_t> in_view = culling.in_view(frustum_of(matrix));
        ASSERT_EQ(in_view.size(), shapes.size());
        for (std::size_t i = 0; i < shapes.size(); ++i) {
            ++looked;
            shown += in_view[i];
            if (is_projected_inside(matrix, shapes[i])) {
                ASSERT_TRUE(in_view[i]) << "frame " << frame << ", shape " << i;
            }
        }
    }
    // And it does cull most of the shapes out of view.
    EXPECT_LT(shown, looked / 2);
    EXPECT_GT(shown, 0);
}

TEST(Culling, OfNothingIsNothing) {
    Culling culling;
    culling.update({});
    EXPECT_TRUE(culling.in_view(frustum_of(Camera().projection(1) * Camera().view())).empty());
}

} // namespace
} // namespace plumb
