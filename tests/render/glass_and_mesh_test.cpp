// Pixel tests of flat triangles, glass and cylinders.
#include "app/render/renderer.h"

#include <cmath>

#include "app/render/palette.h"
#include "tests/render/off_screen.h"

namespace plumb {
namespace {

constexpr glm::ivec2 picture_size{160, 120};
constexpr glm::vec3 red{0.8f, 0.2f, 0.1f};

int red_over_blue(const glm::u8vec3 &c) {
    return static_cast<int>(c.x) - static_cast<int>(c.z);
}

// Seen from +z, with the target in the middle.
DrawList facing() {
    DrawList list = plain_list();
    list.camera.target = glm::vec3(0);
    list.camera.yaw = 0;
    list.camera.pitch = 0;
    list.camera.distance = 5;
    return list;
}

DrawMesh square(float z, bool turned) {
    DrawMesh mesh;
    mesh.colour = red;
    Corners corners{{-1, -1, z}, {1, -1, z}, {1, 1, z}, {-1, -1, z}, {1, 1, z}, {-1, 1, z}};
    if (turned)
        for (std::size_t i = 0; i < corners.size(); i += 3)
            std::swap(corners[i], corners[i + 1]);
    mesh.corners = std::make_shared<const Corners>(std::move(corners));
    return mesh;
}

TEST_F(OffScreen, ATriangleIsSeenAlikeFromBothSides) {
    Image images[2];
    for (const bool turned : {false, true}) {
        DrawList list = facing();
        list.meshes.push_back(square(0, turned));
        images[turned ? 1 : 0] = render_image(renderer, list, picture_size);
        EXPECT_GT(red_over_blue(images[turned ? 1 : 0].at(80, 60)), 60);
        EXPECT_LT(red_over_blue(images[turned ? 1 : 0].at(4, 60)), 20); // beside it
    }
    EXPECT_EQ(images[0], images[1]);
}

TEST_F(OffScreen, GlassShowsWhatIsBehindAndTints) {
    DrawList list = facing();
    const Image nothing = render_image(renderer, list, picture_size);
    DrawShape ball;
    ball.colour = red;
    ball.size = glm::vec3(1);
    list.shapes.push_back(ball);
    const Image solid = render_image(renderer, list, picture_size);
    list.shapes.front().glass = true;
    const Image glass = render_image(renderer, list, picture_size);
    const int tint = red_over_blue(glass.at(80, 60));
    EXPECT_GT(tint, red_over_blue(nothing.at(80, 60)) + 15);
    EXPECT_LT(tint, red_over_blue(solid.at(80, 60)) - 15);
    // A line behind it is fully visible: glass hides nothing.
    list.lines.push_back({{-0.9f, 0, -0.3f}, {0.9f, 0, -0.3f}, colours::ink, 4});
    const Image with_line = render_image(renderer, list, picture_size);
    EXPECT_LT(static_cast<int>(with_line.at(80, 60).x), 90);
}

TEST_F(OffScreen, ACylinderIsAsWideAndHighAsItSays) {
    DrawList list = facing();
    DrawShape cylinder;
    cylinder.kind = DrawKind::cylinder;
    cylinder.size = {0.5f, 1.0f, 0};
    cylinder.colour = red;
    list.shapes.push_back(cylinder);
    const Image image = render_image(renderer, list, picture_size);
    const auto is_in = [&](glm::vec3 place) {
        const glm::vec2 at(list.camera.project(place, glm::vec2(picture_size)));
        return red_over_blue(image.at(static_cast<int>(at.x), static_cast<int>(at.y))) > 60;
    };
    EXPECT_TRUE(is_in({0.42f, 0.85f, 0}));
    EXPECT_TRUE(is_in({-0.42f, -0.85f, 0}));
    EXPECT_FALSE(is_in({0.6f, 0, 0}));
    EXPECT_FALSE(is_in({0, 1.2f, 0}));
}

TEST_F(OffScreen, FlatTrianglesWithoutAreaOrWithNumbersThatAreNoneAreLeftOut) {
    DrawList list = facing();
    const Image nothing = render_image(renderer, list, picture_size);
    DrawMesh mesh;
    const float nan = std::nanf("");
    mesh.corners = std::make_shared<const Corners>(
        Corners{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {nan, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    list.meshes.push_back(mesh);
    EXPECT_EQ(render_image(renderer, list, picture_size), nothing);
}

} // namespace
} // namespace plumb
