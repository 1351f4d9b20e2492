#include "app/lab/map/standing.h"

#include "app/lab/map/stability_map.h"

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace plumb {
namespace {

// Boxes with half extents and centres as given, on the ground.
struct PiledBox {
    glm::dvec3 half, center;
};

SceneDesc pile(const std::vector<PiledBox> &boxes) {
    SceneDesc scene;
    scene.name = "pile";
    BodyDesc &ground = scene.bodies.emplace_back();
    ground.name = "ground";
    ground.kind = BodyKind::static_body;
    ground.colliders.emplace_back().shape = PlaneDesc{};
    for (const PiledBox &box : boxes) {
        BodyDesc &body = scene.bodies.emplace_back();
        body.name = "box " + std::to_string(scene.bodies.size() - 2);
        body.colliders.emplace_back().shape = BoxDesc{box.half};
        body.position = box.center;
    }
    return scene;
}

bool is_watched(const SceneDesc &scene, const RunOptions &options = {}) {
    const auto simulation = Simulation::create(scene, options, nullptr);
    return StandingWatch(scene, *simulation).watches();
}

constexpr glm::dvec3 cube(0.5), plate(2, 0.1, 0.5);

TEST(StandingWatch, IsOfPilesThatMustStand) {
    EXPECT_TRUE(is_watched(pile({{cube, {0, 0.5, 0}}})));
    EXPECT_TRUE(
        is_watched(pile({{cube, {0, 0.5, 0}}, {cube, {0.2, 1.5, 0}}, {cube, {0, 2.5, 0}}})));
    // A bridge, with its load over either pier.
    EXPECT_TRUE(is_watched(pile({{cube, {-1.5, 0.5, 0}},
                                 {cube, {1.5, 0.5, 0}},
                                 {plate, {0, 1.1, 0}},
                                 {cube, {1.5, 1.7, 0}}})));
}

TEST(StandingWatch, LeavesWhatMayFallAlone) {
    EXPECT_FALSE(is_watched(pile({}))) << "nothing";
    EXPECT_FALSE(is_watched(pile({{cube, {0, 0.7, 0}}}))) << "hovers";
    EXPECT_FALSE(is_watched(pile({{cube, {0, 0.4, 0}}}))) << "is pushed out";
    EXPECT_FALSE(is_watched(pile({{cube, {0, 0.5, 0}}, {cube, {0.49, 1.5, 0}}}))) << "at an edge";
    EXPECT_FALSE(is_watched(pile({{cube, {0, 0.5, 0}}, {cube, {0.6, 1.5, 0}}}))) << "over an edge";
    EXPECT_FALSE(
        is_watched(pile({{cube, {0, 0.5, 0}}, {plate, {0, 1.1, 0}}, {cube, {1.5, 1.7, 0}}})))
        << "a load beside its support";
    SceneDesc scene = pile({{cube, {0, 0.5, 0}}, {cube, {5, 0.5, 0}}});
    EXPECT_TRUE(is_watched(scene));
    RunOptions tilted;
    tilted.settings = parse_setting("gravity=1,-9.81,0");
    EXPECT_FALSE(is_watched(scene, tilted));
    SceneDesc ball = scene;
    ball.bodies.back().colliders[0].shape = SphereDesc{0.5};
    EXPECT_FALSE(is_watched(ball)) << "on a point";
    SceneDesc moving = scene;
    moving.bodies.back().velocity.x = 1;
    EXPECT_FALSE(is_watched(moving));
    SceneDesc joined = scene;
    joined.particles.emplace_back().name = "bob";
    EXPECT_FALSE(is_watched(joined));
}

// A tower that a weak solver cannot hold up; nothing in the scene says that it should stand.
TEST(StandingWatch, TellsTheMapOfATowerThatFalls) {
    const std::string tower = R"(
[[body]]
name = "ground"
shape = "plane"
[[body]]
name = "box"
shape = "box"
half_extents = [0.5, 0.5, 0.5]
position = [0, 0.5, 0]
repeat = { kind = "stack", count = 10 }
)";
    MapOptions options;
    options.methods = {"soft_step", "tgs_soft"};
    options.duration = 10;
    const auto kinds = [&](const std::string &scene) {
        const StabilityMap map = map_scene({"scene.toml", scene}, parse_map_axis("dt=1/120,1/20"),
                                           parse_map_axis("substeps=1,4"), options);
        std::vector<Failing> found;
        for (const MethodMap &of_method : map.methods)
            for (const auto &cell : of_method.cells) {
                found.push_back(cell->failing.failing);
                EXPECT_EQ(cell->failing.what.starts_with("box"), found.back() == Failing::fell);
            }
        return found;
    };
    const std::vector<Failing> found = kinds(tower);
    for (std::size_t i = 0; i < 4; ++i)
        EXPECT_EQ(found[i], Failing::none) << "soft_step, cell " << i;
    EXPECT_NE(std::ranges::find(found, Failing::fell), found.end());
    options.duration.reset();
    // An expectation about a body is the scene's own word on what should stand.
    for (const Failing each : kinds(tower + R"(
[[expect]]
name = "stays low"
quantity = "position.y"
body = "box_0"
to = 10
at_most = 1
source = "it is the lowest"
)"))
        EXPECT_EQ(each, Failing::none);
}

} // namespace
} // namespace plumb
