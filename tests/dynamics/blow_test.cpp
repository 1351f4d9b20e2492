// Blows: what comes down flat stays flat, what is thin is not flung off, what is small stands and
// falls as what is large does.
#include "tests/dynamics/worlds.h"

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace trial;

double tilt_of(const World &world, BodyId id) {
    const V up = wide(motion_of(world, id).rotation) * V{0, 1, 0};
    return std::acos(std::clamp(up.y, -1.0, 1.0));
}

// By symmetry; a single pass over the corners one after another tilts them a little.
TEST(SoftStepBlow, CubesLandFlat) {
    const auto most_tilt = [](int count, double drop, double side) {
        World world("soft_step", settings_for("soft_step"));
        world.add_body(ground(0.5, 0));
        std::vector<BodyId> cubes;
        for (int i = 0; i < count; ++i)
            cubes.push_back(world.add_body(dynamic_body(
                block(V{side / 2}), 1000 * side * side * side, V{0, drop + (i + 0.5) * side, 0})));
        double most = 0;
        for (int step = 0; step < 240; ++step) {
            world.step(nullptr);
            for (const BodyId id : cubes)
                most = std::max(most, tilt_of(world, id));
        }
        return most;
    };
    for (const double side : {0.1, 0.2, 1.0})
        for (const double drop : {0.05, 0.2, 0.5, 1.0, 2.0}) {
            EXPECT_LT(most_tilt(1, drop * side, side), 0.003) << side << ", " << drop;
            EXPECT_LT(most_tilt(2, drop * side, side), 0.1) << side << ", " << drop;
        }
}

// Inelastic: each angle of a stick that falls on its end.
TEST(SoftStepBlow, SticksGainNoEnergy) {
    for (const V &half : {V{0.001, 0.0225, 0.001}, V{0.002, 0.05, 0.002}, V{0.02, 0.4, 0.02}})
        for (const double drop : {1.0, 5.0})
            for (int degrees = 0; degrees < 90; degrees += 9) {
                World world("soft_step", settings_for("soft_step"));
                world.add_body(ground(0.5, 0));
                const double reach = glm::length(half);
                BodyDef stick = dynamic_body(block(half), 8000 * half.x * half.y * half.z,
                                             V{0, reach + drop * half.y, 0});
                stick.pose.rotation = narrow(glm::angleAxis(degrees * pi / 180, V{0, 0, 1}) *
                                             glm::angleAxis(0.3, V{1, 0, 0}));
                world.add_body(stick);
                const double before = world.energy();
                double most = before;
                for (int step = 0; step < 180; ++step) {
                    world.step(nullptr);
                    most = std::max(most, world.energy());
                }
                EXPECT_LE(most, 1.01 * before) << half.y << ", " << drop << ", " << degrees;
            }
}

// Froude's law: a domino hit near its top falls, or does not, at any size.
TEST(SoftStepBlow, SmallDominoesFallAsLargeOnes) {
    for (const double height : {0.02, 0.04, 0.1, 0.4, 1.0}) {
        World world("soft_step", settings_for("soft_step"));
        world.add_body(ground(0.5, 0));
        const V half{0.05 * height, 0.5 * height, 0.25 * height};
        const BodyId domino =
            world.add_body(dynamic_body(block(half), half.x * half.y * half.z, V{0, half.y, 0}));
        world.add_body(dynamic_body(ball(0.1 * height), half.x * half.y * half.z,
                                    V{-0.2 * height, 0.9 * height, 0},
                                    V{std::sqrt(gravity * height), 0, 0}));
        run(world, 120);
        EXPECT_GT(tilt_of(world, domino), 1) << height;
    }
}

// A capsule on its side rolls on, as a ball does.
TEST(SoftStepBlow, ACapsuleRollsOnAtAnySpeed) {
    for (const double radius : {0.02, 0.3})
        for (const double turn : {0.1, 0.5, 1.0, 2.0}) { // a step
            World world("soft_step", settings_for("soft_step"));
            world.add_body(ground(0.5, 0));
            const double speed = 60 * turn * radius;
            BodyDef capsule = dynamic_body(upright_capsule(2 * radius, radius), 1, V{0, radius, 0},
                                           V{speed, 0, 0});
            capsule.pose.rotation = narrow(glm::angleAxis(pi / 2, V{1, 0, 0}));
            capsule.angular_velocity = narrow(V{0, 0, -speed / radius});
            const BodyId id = world.add_body(capsule);
            run(world, 120);
            EXPECT_NEAR(velocity_of(world, id).x, speed, 1e-3 * speed) << radius << ", " << turn;
            EXPECT_NEAR(position_of(world, id).y, radius, 0.01 * radius) << radius << ", " << turn;
        }
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
