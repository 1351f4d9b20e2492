#include "tests/bench/bench_scenes.h"

#include "tests/bench/scene_parts.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace plumb {

namespace {

using namespace parts;

int scaled(int count, double size) {
    return std::max(2, static_cast<int>(std::lround(count * size)));
}
int scaled_root(int count, double size) {
    return scaled(count, std::sqrt(size));
}
int scaled_cube_root(int count, double size) {
    return scaled(count, std::cbrt(size));
}

SceneDesc pyramid_scene(double size) {
    SceneDesc scene = on_ground();
    add_pyramid(scene, scaled_root(100, size), 0);
    return scene;
}

SceneDesc many_pyramids(double size) {
    SceneDesc scene = on_ground();
    const int count = scaled(30, size);
    for (int i = 0; i < count; ++i)
        add_pyramid(scene, 10, 3.0 * i);
    return scene;
}

// Walls of a pit of so many metres each way.
void add_pit(SceneDesc &scene, double half) {
    for (const double side : {-1.0, 1.0}) {
        add(scene, "wall", BoxDesc{{0.5, 20, half + 1}}, {side * (half + 0.5), 20, 0}).kind =
            BodyKind::static_body;
        add(scene, "wall", BoxDesc{{half + 1, 20, 0.5}}, {0, 20, side * (half + 0.5)}).kind =
            BodyKind::static_body;
    }
}

// The corners of a box-like rock, mirrored at its three planes: its frame is that of its mass.
HullDesc rock(double across) {
    std::vector<glm::dvec3> points;
    for (const glm::dvec3 &corner :
         {glm::dvec3(1, 0.35, 0.4), glm::dvec3(0.55, 0.85, 0.35), glm::dvec3(0.4, 0.5, 0.8)})
        for (int mirror = 0; mirror < 8; ++mirror)
            points.push_back(0.5 * across * corner *
                             glm::dvec3((mirror & 1) != 0 ? -1 : 1, (mirror & 2) != 0 ? -1 : 1,
                                        (mirror & 4) != 0 ? -1 : 1));
    return {std::make_shared<const std::vector<glm::dvec3>>(std::move(points)), std::nullopt};
}

// `shapes` in turn, in a block above the ground, each a little aside and turned.
void add_block(SceneDesc &scene, glm::ivec3 count, double spacing, double above,
               const std::vector<ShapeDesc> &shapes) {
    int i = 0;
    for (int y = 0; y < count.y; ++y)
        for (int z = 0; z < count.z; ++z)
            for (int x = 0; x < count.x; ++x, ++i) {
                const auto shift = [i](int of) { return 0.1 * std::sin(of * (i + 1.0)); };
                BodyDesc &body =
                    add(scene, "body", shapes[static_cast<std::size_t>(i) % shapes.size()],
                        {(x - 0.5 * (count.x - 1) + shift(1)) * spacing, above + y * spacing,
                         (z - 0.5 * (count.z - 1) + shift(2)) * spacing});
                body.orientation =
                    glm::angleAxis(0.7 * i, glm::normalize(glm::dvec3(1, 0.3 * (i % 7), 0.5)));
            }
}

SceneDesc pile(double size) {
    SceneDesc scene = on_ground();
    const int side = scaled_cube_root(10, size);
    add_pit(scene, 0.5 * side);
    add_block(scene, {side, 2 * side, side}, 0.9, 1,
              {BoxDesc{{0.3, 0.2, 0.25}}, SphereDesc{0.3}, CapsuleDesc{0.2, 0.2}});
    return scene;
}

SceneDesc hulls(double size) {
    SceneDesc scene = on_ground();
    const int side = scaled_cube_root(10, size);
    add_pit(scene, 0.5 * side);
    add_block(scene, {side, side, side}, 0.9, 1, {rock(0.8)});
    return scene;
}

// Balls of 1 kg on ball joints, level, a metre apart.
SceneDesc net(double size, bool by_edge) {
    SceneDesc scene;
    add_net(scene, scaled_root(40, size), by_edge);
    return scene;
}

// Half along x, half above them along z.
SceneDesc chains(double size) {
    SceneDesc scene = on_ground();
    const int count = scaled(50, size), links = 20;
    for (int i = 0; i < count; ++i) {
        const bool along_x = i % 2 == 0;
        const double aside = 0.4 * (i / 2 - 0.25 * count);
        const glm::dvec3 direction = along_x ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 0, 1);
        const glm::dvec3 start = along_x ? glm::dvec3(-5, 0.3, aside) : glm::dvec3(aside, 0.6, -5);
        for (int link = 0; link < links; ++link) {
            BodyDesc &body =
                add(scene, "link", CapsuleDesc{0.2, 0.05}, start + (0.5 * link) * direction);
            body.orientation = from_y_to(direction);
            if (link > 0)
                add_joint(scene, JointType::ball, scene.bodies.size() - 2, scene.bodies.size() - 1,
                          start + (0.5 * link - 0.25) * direction);
        }
    }
    return scene;
}

SceneDesc ragdolls(double size) {
    SceneDesc scene = on_ground();
    const int count = scaled(100, size);
    for (int i = 0; i < count; ++i)
        add_ragdoll(scene, {2.0 * (i % 5), 0.3 + 0.6 * (i / 25), 0.9 * (i / 5 % 5)});
    return scene;
}

// A kinematic drum of planks that turns about z, between two walls.
SceneDesc drum(double size) {
    SceneDesc scene;
    const int side = scaled_cube_root(13, size);
    const double inside = 0.62 * side, half_length = 0.26 * side;
    BodyDesc &body = add(scene, "drum", BoxDesc{}, {0, 0, 0});
    body.kind = BodyKind::kinematic;
    body.angular_velocity = {0, 0, 0.8};
    body.colliders.clear();
    constexpr int planks = 24;
    for (int i = 0; i < planks; ++i) {
        const double angle = 2 * std::numbers::pi * i / planks;
        const double half_width = (inside + 0.5) * std::tan(std::numbers::pi / planks);
        ColliderDesc &plank = body.colliders.emplace_back();
        plank.shape = BoxDesc{{half_width, 0.25, half_length}};
        plank.position = (inside + 0.25) * glm::dvec3(-std::sin(angle), std::cos(angle), 0);
        plank.orientation = glm::angleAxis(angle, glm::dvec3(0, 0, 1));
    }
    for (const double end : {-1.0, 1.0})
        add(scene, "wall", BoxDesc{{inside + 1, inside + 1, 0.5}},
            {0, 0, end * (half_length + 0.5)})
            .kind = BodyKind::static_body;
    add_block(scene, {side, side, side - 1}, 0.5, -0.25 * side,
              {BoxDesc{{0.15, 0.15, 0.15}}, SphereDesc{0.17}, CapsuleDesc{0.1, 0.12}});
    return scene;
}

// Stacks of five, which have nothing to do with each other.
SceneDesc boxes(int count) {
    SceneDesc scene = on_ground();
    const int side = static_cast<int>(std::ceil(std::sqrt(count / 5.0)));
    for (int i = 0; i < count; ++i) {
        const int stack = i / 5;
        add(scene, "box", BoxDesc{},
            {2.0 * (stack % side - side / 2), 0.5 + i % 5, 2.0 * (stack / side - side / 2)});
    }
    return scene;
}

} // namespace

std::vector<BenchScene> bench_scenes() {
    std::vector<BenchScene> scenes{
        {"pyramid", 2, true, pyramid_scene},
        {"many_pyramids", 2, true, many_pyramids},
        {"pile", 5, false, pile},
        {"hulls", 5, false, hulls},
        {"net_by_edge", 4, false, [](double size) { return net(size, true); }},
        {"net_by_corners", 4, false, [](double size) { return net(size, false); }},
        {"chains", 4, false, chains},
        {"ragdolls", 4, false, ragdolls},
        {"drum", 4, false, drum},
    };
    for (const int count : {100, 1000, 10'000, 100'000})
        scenes.push_back({"boxes_" + std::to_string(count), count > 10'000 ? 0.25 : 1, true,
                          [count](double size) { return boxes(scaled(count, size)); }});
    return scenes;
}

} // namespace plumb
