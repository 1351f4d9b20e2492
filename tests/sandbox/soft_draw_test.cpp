// Particles, springs and cloth: drawing, picking and dragging.
#include "app/sandbox/draw/soft_draw.h"

#include "app/sandbox/draw/framing.h"
#include "app/sandbox/draw/world_draw.h"
#include "app/sandbox/sandbox.h"
#include "engine/scene/scene_file.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace plumb {
namespace {

constexpr const char *soft_scene = R"([world]
gravity = [0, 0, 0]
[camera]
target = [0, 0, 0]
distance = 8
yaw_deg = 0
pitch_deg = 0
[[particle]]
name = "bob"
position = [2, 0, 0]
radius = 0.1
color = [1, 0, 0]
[[particle]]
name = "nail"
position = [2, 1, 0]
radius = 0.1
pinned = true
[[spring]]
name = "spring"
a = "nail"
b = "bob"
stiffness = 10
[[cloth]]
name = "sheet"
cells = [6, 4]
size = [1.5, 1]
rotation_deg = [90, 0, 0]
pins = [[0, 0]]
)";

class SoftDraw : public testing::Test {
  protected:
    SoftDraw()
        : scene(parse_scene(soft_scene, "soft.toml").scene),
          simulation(Simulation::create(scene, {}, nullptr)), frame(simulation->read()) {}
    SoftView view() const {
        return {simulation->soft_parts(), frame.bodies, frame.particles, frame.torn};
    }
    SceneDesc scene;
    std::unique_ptr<Simulation> simulation;
    Frame frame;
};

TEST_F(SoftDraw, ParticlesAreBallsAndClothIsASurface) {
    const DrawList list = draw_world(*simulation, camera_of(scene.camera));
    const auto balls = std::ranges::count(list.shapes, DrawKind::sphere, &DrawShape::kind);
    EXPECT_EQ(balls, 3); // two particles, and the cloth's pin
    EXPECT_GT(std::ranges::count(list.shapes, DrawKind::capsule, &DrawShape::kind), 20); // a coil
    EXPECT_EQ(list.shapes.front().colour, glm::vec3(1, 0, 0));
    ASSERT_EQ(list.meshes.size(), 1U);
    EXPECT_EQ(list.meshes[0].corners->size(), 3U * 2 * 6 * 4);
    EXPECT_EQ(list.meshes[0].normals->size(), list.meshes[0].corners->size());
}

// A flat sheet has one normal; a sheet bent into a cylinder has radial normals.
TEST_F(SoftDraw, NormalsAreThoseOfTheSurface) {
    const ClothSurface flat = cloth_surface(simulation->soft_parts().cloths[0], view());
    for (const glm::vec3 &normal : *flat.normals)
        EXPECT_LT(glm::distance(normal, glm::vec3(0, 0, 1)), 1e-5f);
    const double radius = 1;
    for (std::size_t i = 2; i < frame.particles.size(); ++i) {
        glm::dvec3 &p = frame.particles[i].position;
        p = {radius * std::sin(p.x / radius), p.y, radius * std::cos(p.x / radius)};
    }
    const ClothSurface bent = cloth_surface(simulation->soft_parts().cloths[0], view());
    for (std::size_t i = 0; i < bent.corners->size(); ++i) {
        const glm::vec3 out = glm::normalize((*bent.corners)[i] * glm::vec3(1, 0, 1));
        EXPECT_GT(glm::dot((*bent.normals)[i], out), std::cos(0.13f)); // half a cell at the border
    }
}

// Tearing one side of a triangle opens it; a lone spring is no longer drawn.
TEST_F(SoftDraw, TornSpringsOpenTheSurface) {
    const ClothInfo &cloth = simulation->soft_parts().cloths[0];
    const std::uint32_t side = cloth.triangles[10].sides[0];
    const auto with_it = std::ranges::count_if(cloth.triangles, [&](const auto &triangle) {
        return std::ranges::find(triangle.sides, side) != triangle.sides.end();
    });
    ASSERT_GE(with_it, 1);
    frame.torn[side] = 1;
    EXPECT_EQ(cloth_surface(cloth, view()).corners->size(),
              3 * (cloth.triangles.size() - static_cast<std::size_t>(with_it)));
    DrawList list;
    frame.torn[0] = 1;
    draw_soft_parts(list, view(), {}, {});
    EXPECT_EQ(std::ranges::count(list.shapes, DrawKind::capsule, &DrawShape::kind), 0);
}

TEST_F(SoftDraw, RayPicksTheNearest) {
    const glm::dvec3 eye(0, 0, 8);
    const auto pick = [&](const glm::dvec3 &at, double aperture = 0) {
        return pick_particle(view(), eye, glm::normalize(at - eye), aperture);
    };
    const auto bob = pick({2, 0.05, 0});
    ASSERT_TRUE(bob);
    EXPECT_EQ(bob->particle, 0U);
    EXPECT_FALSE(pick({2, 0.3, 0}));
    EXPECT_TRUE(pick({2, 0.3, 0}, 0.05)); // with a wide pointer
    const auto sheet = pick({0.26, 0.24, 0});
    ASSERT_TRUE(sheet);
    EXPECT_EQ(simulation->soft_parts().particle_name(sheet->particle), "sheet[4,1]");
    EXPECT_NEAR(sheet->t, glm::length(glm::dvec3(0.26, 0.24, -8)), 1e-6);
    frame.particles[0].position = {0.13, 0.12, 4}; // now in front of it
    EXPECT_EQ(pick({0.26, 0.24, 0})->particle, 0U);
}

TEST_F(SoftDraw, FramingHoldsThem) {
    const Around all = around(*simulation);
    for (const ParticleState &particle : frame.particles)
        EXPECT_LE(glm::distance(glm::dvec3(all.centre), particle.position),
                  static_cast<double>(all.radius));
    EXPECT_TRUE(plane_behind(scene)); // a floor, because something is pinned
    EXPECT_LT(plane_behind(scene)->position.y, -0.5f);
}

// With the mouse: a click selects a particle, and a Ctrl-drag pulls the cloth along.
TEST_F(SoftDraw, IsDragged) {
    Sandbox sandbox{Session()};
    ASSERT_TRUE(sandbox.open(scene));
    const glm::vec2 viewport(800, 800);
    sandbox.view().camera = camera_of(scene.camera);
    const auto pixel_of = [&](const glm::vec3 &at) {
        const glm::vec4 clip =
            sandbox.view().camera.projection(1) * sandbox.view().camera.view() * glm::vec4(at, 1);
        return glm::vec2(0.5f + 0.5f * clip.x / clip.w, 0.5f - 0.5f * clip.y / clip.w) * viewport;
    };
    const auto send = [&](PointerEvent::Kind kind, const glm::vec2 &at, bool ctrl) {
        PointerEvent event;
        event.kind = kind;
        event.position = at;
        event.ctrl = ctrl;
        sandbox.handle(event, viewport);
    };
    using Kind = PointerEvent::Kind;
    const glm::vec2 bob = pixel_of({2, 0, 0});
    send(Kind::press, bob, false);
    send(Kind::release, bob, false);
    EXPECT_EQ(sandbox.view().selected_particle, 0U);
    EXPECT_FALSE(sandbox.view().selected);
    const glm::vec2 corner = pixel_of({0.7, -0.45, 0});
    send(Kind::press, corner, true);
    ASSERT_EQ(sandbox.tools().drag(), Tools::Drag::grab);
    const std::size_t held =
        *sandbox.session().simulation()->soft_parts().find_particle("sheet[6,4]");
    EXPECT_EQ(sandbox.view().selected_particle, held);
    send(Kind::move, pixel_of({0.7, -1.2, 0}), true);
    for (int i = 0; i < 30; ++i)
        sandbox.session().step();
    EXPECT_LT(sandbox.session().present().particles[held].position.y, -0.7);
    send(Kind::release, pixel_of({0.7, -1.2, 0}), true);
    EXPECT_FALSE(sandbox.session().grabbed());
}

TEST(SoftBlend, GoesFromTheOneToTheOther) {
    const std::vector<ParticleState> from{{{0, 0, 0}, {1, 0, 0}}, {{4, 0, 0}, {}}};
    const std::vector<ParticleState> to{{{2, 4, 0}, {3, 0, 0}}, {{4, 8, 0}, {}}};
    EXPECT_EQ(blend(from, to, 0.25)[0].position, glm::dvec3(0.5, 1, 0));
    EXPECT_EQ(blend(from, to, 0)[1].position, from[1].position);
    EXPECT_EQ(blend(from, to, 1)[1].position, to[1].position);
    EXPECT_EQ(blend({}, to, 0.5)[0].position, to[0].position);
}

} // namespace
} // namespace plumb
