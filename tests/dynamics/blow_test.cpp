// Impacts: a body that lands flat stays flat, thin bodies are not flung off, small ones stand and
// fall as large ones do, and squeezed ones are not launched.
#include "tests/dynamics/worlds.h"

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace trial;

double tilt_of(const World &world, BodyId id) {
    const V up = wide(motion_of(world, id).rotation) * V{0, 1, 0};
    return std::acos(std::clamp(up.y, -1.0, 1.0));
}

// By symmetry they land flat; a single Gauss-Seidel pass over the corners tilts them a little.
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
            EXPECT_LT(most_tilt(2, drop * side, side), 0.01) << side << ", " << drop;
        }
}

// A dropped stack lands as one and stays down: the impact is shared equally by all corners of all
// cubes, and pushing overlapping cubes apart adds no velocity.
TEST(SoftStepBlow, StacksLandUpright) {
    for (const int count : {3, 4, 6, 10})
        for (const double drop : {0.01, 0.04, 0.1, 0.2, 0.5, 2.0}) {
            World world("soft_step", settings_for("soft_step"));
            world.add_body(ground(0.5, 0));
            BodyId top;
            for (int i = 0; i < count; ++i)
                top = world.add_body(dynamic_body(block(V{0.1}), 8, V{0, drop + 0.1 + 0.2 * i, 0}));
            const double speed = std::sqrt(2 * gravity * drop);
            double most = 0, up = 0;
            for (int step = 0; step < 360; ++step) {
                world.step(nullptr);
                most = std::max(most, tilt_of(world, top));
                up = std::max(up, velocity_of(world, top).y);
            }
            EXPECT_LT(most, 0.05) << count << ", " << drop;
            EXPECT_LT(up, 0.2 * speed + 0.2) << count << ", " << drop;
        }
}

// For any height and cube size.
TEST(SoftStepBlow, TallStacksStayDown) {
    for (const double side : {0.05, 0.2, 1.0})
        for (const int count : {5, 20, 30})
            for (const double drop : {1.0, 5.0, 10.0}) { // in cube sides
                World world("soft_step", settings_for("soft_step"));
                world.add_body(ground(0.5, 0));
                BodyId top;
                for (int i = 0; i < count; ++i)
                    top = world.add_body(dynamic_body(block(V{side / 2}), 1000 * side * side * side,
                                                      V{0, (drop + 0.5 + i) * side, 0}));
                const double speed = std::sqrt(2 * gravity * drop * side);
                double up = 0;
                for (int step = 0; step < 300; ++step) {
                    world.step(nullptr);
                    up = std::max(up, velocity_of(world, top).y);
                }
                EXPECT_LT(up, 0.45 * speed) << count << " of " << side << ", " << drop;
                EXPECT_LT(tilt_of(world, top), 0.1) << count << " of " << side << ", " << drop;
                EXPECT_NEAR(position_of(world, top).y, (count - 0.5) * side, 0.1 * side)
                    << count << " of " << side << ", " << drop;
            }
}

// A slab up to eleven times as heavy as the pile it lands on.
TEST(SoftStepBlow, AHeavySlabStaysDown) {
    for (const double mass : {10.0, 100.0, 300.0}) {
        World world("soft_step", settings_for("soft_step"));
        world.add_body(ground(0.5, 0));
        for (int i = 0; i < 27; ++i)
            world.add_body(
                dynamic_body(block(V{0.1}), 1,
                             V{0.204 * (i % 3 - 1), 0.1 + 0.2 * (i / 9), 0.204 * (i / 3 % 3 - 1)}));
        const BodyId slab =
            world.add_body(dynamic_body(block(V{0.5, 0.1, 0.5}), mass, V{0, 1.2, 0}));
        double up = 0;
        for (int step = 0; step < 240; ++step) {
            world.step(nullptr);
            up = std::max(up, velocity_of(world, slab).y);
        }
        EXPECT_LT(up, mass < 200 ? 0.5 : 1) << mass; // it hit at 3.1 m/s
        EXPECT_LT(tilt_of(world, slab), 0.02) << mass;
        EXPECT_NEAR(position_of(world, slab).y, 0.7, 2e-3) << mass;
    }
}

// The light ones are caught between the heavy one and the ground: each pass takes from the heavy
// one only their share of the masses.
TEST(SoftStepBlow, AHeavyBallOnALightOneDoesNotBounce) {
    for (const double mass : {3.0, 10.0, 50.0, 200.0, 1000.0})
        for (const double rate : {60.0, 120.0, 480.0})
            for (const double speed : {1.0, 3.0, 10.0}) {
                const double r = 0.25;
                StepSettings settings = settings_for("soft_step");
                settings.dt = 1 / rate;
                World world("soft_step", settings);
                world.add_body(ground(0.5, 0));
                world.add_body(dynamic_body(ball(r), 1, V{0, r, 0}));
                const BodyId heavy = world.add_body(
                    dynamic_body(ball(r), mass, V{0, 3 * r + 0.05, 0}, V{0, -speed, 0}));
                double up = 0, down = 0;
                for (int step = 0; step < int(0.4 * rate); ++step) {
                    world.step(nullptr);
                    up = std::max(up, velocity_of(world, heavy).y);
                    down = std::max(down, 3 * r - position_of(world, heavy).y);
                }
                EXPECT_LT(up, 0.03 * speed + 0.02) << mass << ", " << rate << ", " << speed;
                EXPECT_LT(down, 0.01) << mass << ", " << rate << ", " << speed;
            }
}

TEST(SoftStepBlow, AHeavyBodyOnLightOnesDoesNotBounce) {
    for (const int count : {1, 2, 5})
        for (const double mass : {5.0, 30.0, 300.0})
            for (const double rate : {60.0, 240.0})
                for (const Shape &shape : {Shape{block(V{0.25})}, Shape{ball(0.25)}}) {
                    StepSettings settings = settings_for("soft_step");
                    settings.dt = 1 / rate;
                    World world("soft_step", settings);
                    world.add_body(ground(0.5, 0));
                    for (int i = 0; i < count; ++i)
                        world.add_body(dynamic_body(block(V{0.25}), 1, V{0, 0.25 + 0.5 * i, 0}));
                    const double rest = 0.25 + 0.5 * count;
                    const double drop = 0.5;
                    const BodyId heavy =
                        world.add_body(dynamic_body(shape, mass, V{0.01, rest + drop, 0}));
                    double up = 0;
                    for (int step = 0; step < int(3 * rate); ++step) {
                        world.step(nullptr);
                        up = std::max(up, velocity_of(world, heavy).y);
                    }
                    EXPECT_LT(up, 0.05 * std::sqrt(2 * gravity * drop))
                        << count << ", " << mass << ", " << rate << ", " << shape.index();
                    EXPECT_NEAR(position_of(world, heavy).y, rest, 0.002)
                        << count << ", " << mass << ", " << rate << ", " << shape.index();
                }
}

// From half a metre onto the end of a lighter plate that a joint holds.
TEST(SoftStepBlow, ALoadOnAJoinedPlateDoesNotBounce) {
    for (const JointType type : {JointType::fixed, JointType::hinge, JointType::slider})
        for (const double mass : {20.0, 100.0, 300.0, 1000.0})
            for (const double rate : {60.0, 240.0}) {
                StepSettings settings = settings_for("soft_step");
                settings.dt = 1 / rate;
                World world("soft_step", settings);
                JointDef joint;
                joint.type = type;
                joint.b = world.add_body(dynamic_body(block(V{1, 0.05, 0.5}), 10, V{0}));
                // The axis along z, or y for the slider; its lower limit holds the plate.
                joint.frame_a_local = joint.frame_b_local =
                    narrow(type == JointType::hinge ? glm::angleAxis(-pi / 2, V{0, 1, 0})
                                                    : glm::angleAxis(pi / 2, V{0, 0, 1}));
                joint.anchor_a_local = joint.anchor_b_local =
                    narrow(V{type == JointType::slider ? 0.0 : -1.0, 0, 0});
                if (type != JointType::fixed)
                    joint.limits = JointLimits{Real(0), Real(1)};
                world.add_joint(joint);
                const BodyId load =
                    world.add_body(dynamic_body(block(V{0.2}), mass, V{0.5, 0.25 + 0.5, 0}));
                double up = 0;
                for (int step = 0; step < int(2 * rate); ++step) {
                    world.step(nullptr);
                    up = std::max(up, velocity_of(world, load).y);
                }
                EXPECT_LT(up, 0.06 * std::sqrt(2 * gravity * 0.5))
                    << int(type) << ", " << mass << ", " << rate;
                EXPECT_NEAR(position_of(world, load).y, 0.25, 0.002)
                    << int(type) << ", " << mass << ", " << rate;
            }
}

// However thin and fast spinning: a needle, a match, a blade, a pole.
TEST(SoftStepBlow, WhatIsThinAndSpinsGainsNoEnergy) {
    for (const double restitution : {0.0, 0.5})
        for (const V &half : {V{0.0002, 0.05, 0.0002}, V{0.001, 0.0225, 0.001}, V{0.002, 0.3, 0.02},
                              V{0.02, 2, 0.02}})
            for (const double spin : {0.0, 30.0, 200.0})
                for (int degrees = 0; degrees < 90; degrees += 15) {
                    World world("soft_step", settings_for("soft_step"));
                    world.add_body(ground(0.5, restitution));
                    BodyDef stick =
                        with_material(dynamic_body(block(half), 64000 * half.x * half.y * half.z,
                                                   V{0, 2.1 * half.y, 0}),
                                      0.5, restitution);
                    stick.pose.rotation = narrow(glm::angleAxis(degrees * pi / 180, V{0, 0, 1}) *
                                                 glm::angleAxis(0.3, V{1, 0, 0}));
                    stick.angular_velocity = narrow(spin * V{0.5, 1, 0.1});
                    world.add_body(stick);
                    const double before = world.energy();
                    double most = before;
                    for (int step = 0; step < 180; ++step) {
                        world.step(nullptr);
                        most = std::max(most, world.energy());
                    }
                    EXPECT_LE(most, 1.05 * before)
                        << restitution << ", " << half.y << ", " << spin << ", " << degrees;
                }
}

// Inelastic impacts of a stick that falls on its end, over a range of angles.
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

// Contacts do no work on them: capsules and cylinders that spin about their own axes and about the
// vertical, nearly on their sides.
TEST(SoftStepBlow, WhatSpinsOnAFloorGainsNoEnergy) {
    const std::vector<Shape> shapes{
        upright_capsule(0.15, 0.05),
        Cylinder{narrow(V{0, -0.15, 0}), narrow(V{0, 0.15, 0}), Real(0.05)}};
    for (const Shape &shape : shapes)
        for (const double friction : {0.0, 0.5})
            for (const double own : {20.0, 60.0, 150.0})
                for (const double vertical : {5.0, 25.0}) {
                    World world("soft_step", settings_for("soft_step"));
                    world.add_body(ground(friction, 0));
                    BodyDef top = with_material(dynamic_body(shape, 1, V{0, 0.07, 0}), friction, 0);
                    top.pose.rotation = narrow(glm::angleAxis(pi / 2 - 0.1, V{0, 0, 1}));
                    const V axis = wide(top.pose.rotation) * V{0, 1, 0};
                    top.angular_velocity = narrow(own * axis + V{0, vertical, 0});
                    world.add_body(top);
                    const double before = world.energy();
                    double most = before;
                    for (int step = 0; step < 1200; ++step) {
                        world.step(nullptr);
                        most = std::max(most, world.energy());
                    }
                    EXPECT_LE(most, 1.001 * before)
                        << shape.index() << ", " << friction << ", " << own << ", " << vertical;
                }
}

// Froude scaling: whether a domino hit near its top falls does not depend on its size.
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

// A body hit at one end turns, and its other end comes down where nothing touched at the start of
// the step.
TEST(SoftStepBlow, WhatSpinsIsStruckAtBothEnds) {
    Random random(11);
    double deepest = 0;
    for (int trial = 0; trial < 400; ++trial) {
        World world("soft_step", weightless(settings_for("soft_step")));
        const auto thrown = [&](const Shape &shape, const V &position, const V &velocity) {
            BodyDef def = dynamic_body(shape, 100, position, velocity);
            def.pose.rotation = narrow(any_rotation(random));
            def.angular_velocity = narrow(any_vector(random, 25));
            world.add_body(with_material(def, 0.5, 0));
        };
        thrown(block(V{0.3, 0.2, 0.25}), V{0}, V{0});
        const V speed{0, -random.next_in(2, 10), 0};
        if (trial % 2 == 0)
            thrown(upright_capsule(0.2, 0.2), V{0, 0.9, 0}, speed);
        else
            thrown(block(V{0.3, 0.2, 0.25}), V{0, 0.9, 0}, speed);
        for (int step = 0; step < 25; ++step) {
            world.step(nullptr);
            deepest = std::max(deepest, world.measure().max_penetration);
        }
    }
    EXPECT_LT(deepest, 0.06); // 0.18 with the first manifold alone
}

// Cubes under an unstoppable plate have nowhere to go: they slip out or penetrate, and their loads
// stay those of the contact springs. With rigid contacts, eight cubes would leave at thousands of
// m/s.
TEST(SoftStepBlow, WhatIsSqueezedIsNotShotAway) {
    constexpr double side = 0.3;
    for (const double speed : {0.5, 2.0})
        for (const int count : {1, 8}) {
            Random random(2);
            World world("soft_step", settings_for("soft_step"));
            world.add_body(ground(0.5, 0));
            BodyDef plate = static_body(block(V{2, 0.25, 2}), V{0, count == 1 ? 0.7 : 0.86, 0});
            plate.kind = BodyKind::kinematic;
            plate.velocity = narrow(V{0, -speed, 0});
            world.add_body(with_material(plate, 0.5, 0));
            std::vector<BodyId> cubes;
            for (int i = 0; i < count; ++i) {
                BodyDef cube = dynamic_body(
                    block(V{side / 2}), 1,
                    V{0.31 * (i % 2), side * (0.5 + double(i / 4)), 0.31 * (i / 2 % 2)});
                if (count == 1)
                    cube.pose.rotation = narrow(any_rotation(random));
                cubes.push_back(world.add_body(with_material(cube, 0.5, 0)));
            }
            double fastest = 0;
            for (int step = 0; step < int(20 / speed); ++step) {
                world.step(nullptr);
                for (const BodyId cube : cubes)
                    fastest = std::max(fastest, glm::length(velocity_of(world, cube)));
            }
            EXPECT_LT(fastest, 2 * speed + 5) << speed << ", " << count;
        }
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
