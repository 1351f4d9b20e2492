// What falls between two walls that face each other.
#include "tests/dynamics/worlds.h"

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace trial;

// Two walls that lean outwards by an angle (rad), from a line through the origin.
void add_walls(World &world, double lean, double friction) {
    for (const double side : {-1.0, 1.0}) {
        const glm::dquat turn = glm::angleAxis(-side * lean, V{0, 0, 1});
        BodyDef wall = static_body(block(V{0.5, 4, 4}));
        wall.pose = {narrow(turn * V{side * 0.5, 4, 0}), narrow(turn)};
        world.add_body(with_material(wall, friction, 0));
    }
}

// The most that its energy rises again (J) and its greatest kinetic energy, of a thin rod or plate
// that falls askew into a V.
struct Fall {
    double gained = 0;
    double fastest = 0;
};
Fall fall_into_a_v(Random random, int rate) {
    const double lean = random.next_in(10, 30) * pi / 180; // of each wall
    const double friction = random.next_in(0.2, 1);
    const double length = random.next_in(0.1, 1);
    V half{length, length * random.next_in(0.02, 0.06), length * random.next_in(0.02, 0.06)};
    if (random.next_unit() < 0.5)
        half.y = length * random.next_in(0.4, 1);
    StepSettings settings = settings_for("soft_step");
    settings.dt = 1.0 / rate;
    World world("soft_step", settings);
    add_walls(world, lean, friction);
    // Above where it fits in any pose.
    const double height = glm::length(half) / std::sin(lean) + random.next_in(0.1, 1);
    BodyDef body = dynamic_body(block(half), 1, V{random.next_in(-0.02, 0.02), height, 0});
    body.pose.rotation = narrow(any_rotation(random));
    world.add_body(with_material(body, friction, 0));
    Fall fall;
    double least = world.energy();
    for (int step = 0; step < 4 * rate; ++step) {
        world.step(nullptr);
        const Measures now = world.measure();
        fall.fastest = std::max(fall.fastest, now.kinetic_energy);
        least = std::min(least, now.energy());
        fall.gained = std::max(fall.gained, now.energy() - least);
    }
    return fall;
}

// With few substeps it was pressed into both walls, and thrown out when more made them stiffer: of
// 240 at 10 to 20 degrees one in eight regained a twentieth of its energy, one in twenty a fifth.
TEST(Wedge, WhatFallsIntoAVIsNotThrownOut) {
    Random random(3);
    int gained_much = 0;
    for (int trial = 0; trial < 60; ++trial) {
        const Fall fall = fall_into_a_v(Random(random.next_u64()), trial % 2 == 0 ? 60 : 120);
        EXPECT_LT(fall.gained, 0.25 * fall.fastest) << trial;
        gained_much += fall.gained > 0.05 * fall.fastest ? 1 : 0;
    }
    EXPECT_LE(gained_much, 2);
}

// Dropped into a slot of its own angle, it is driven into the walls. It was thrown up by 1.7 m at 3
// degrees to a side, half a metre at 5, and 0.4 with a friction of 0.05.
TEST(Wedge, AWedgeThatDropsIntoItsSlotHardlyRises) {
    constexpr double low = 0.3, height = 0.4;
    for (const double degrees : {3.0, 5.0, 8.0, 12.0, 17.0, 25.0})
        for (const double friction : {0.0, 0.05, 0.1, 0.2}) {
            const double lean = degrees * pi / 180;
            World world("soft_step", settings_for("soft_step"));
            add_walls(world, lean, friction);
            std::vector<Vec3> corners;
            for (const double y : {0.0, height})
                for (const double x : {-1.0, 1.0})
                    for (const double z : {-0.2, 0.2})
                        corners.push_back(narrow(V{x * (low + y) * std::tan(lean), y, z}));
            const auto mesh = std::make_shared<const HullMesh>(*convex_hull(corners, 64).mesh);
            BodyDef wedge = dynamic_body(ConvexHull{mesh.get(), Vec3{Real(0)}, identity_rotation},
                                         1, V{0, low + 0.1, 0});
            wedge.colliders[0].hull = mesh;
            world.add_body(with_material(wedge, friction, 0));
            const BodyId id = world.body_id(2);
            double least = position_of(world, id).y, rise = 0;
            for (int step = 0; step < 240; ++step) {
                world.step(nullptr);
                const double y = position_of(world, id).y;
                least = std::min(least, y);
                rise = std::max(rise, y - least);
            }
            EXPECT_LT(rise, friction > 0  ? 0.04
                            : degrees < 5 ? 0.25
                                          : 0.08)
                << degrees << ", " << friction;
        }
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
