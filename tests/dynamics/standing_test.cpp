// Things with joints that stand on the ground or carry others: what a foot bears is not its own
// mass. Their contacts and joints are solved in turns, and must agree.
#include "tests/dynamics/worlds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace trial;

// With its axis or slide along y, or a hinge's along z.
JointDef joint_along(World &world, JointType type, BodyId a, BodyId b, const V &at) {
    JointDef def;
    def.type = type;
    def.a = a;
    def.b = b;
    def.anchor_a_local = narrow(at - position_of(world, a));
    def.anchor_b_local = narrow(at - position_of(world, b));
    const V axis = type == JointType::slider ? V{0, 0, 1} : V{0, 1, 0};
    const double turn = type == JointType::slider ? pi / 2 : -pi / 2;
    def.frame_a_local = def.frame_b_local = narrow(glm::angleAxis(turn, axis));
    return def;
}

struct Stood {
    double gain = 0; // the most energy above that at the start, J
    double kinetic = 0;
    double depth = 0;
};
Stood let_stand(World &world, double seconds) {
    Stood seen;
    const double first = world.energy();
    for (int step = 0; step < seconds / world.settings().dt; ++step) {
        world.step(nullptr);
        const Measures now = world.measure();
        seen.gain = std::max(seen.gain, now.energy() - first);
        seen.kinetic = std::max(seen.kinetic, now.kinetic_energy);
        seen.depth = std::max(seen.depth, now.max_penetration);
    }
    return seen;
}

World ground_world(double dt) {
    StepSettings settings = settings_for("soft_step");
    settings.dt = dt;
    World world("soft_step", settings);
    world.add_body(ground(1, 0));
    return world;
}

// Cubes of 60 cm, the upper one heavier, joined 5 cm apart.
TEST(Standing, AHeavyBodyOnALightFoot) {
    for (const JointType type : {JointType::fixed, JointType::slider, JointType::hinge})
        for (const double ratio : {1.0, 3.0, 10.0, 30.0, 100.0})
            for (const double rate : {30.0, 60.0, 240.0}) {
                World world = ground_world(1 / rate);
                const BodyId foot = world.add_body(
                    with_material(dynamic_body(block(V{0.3}), 1, {0, 0.3, 0}), 1, 0));
                const BodyId top = world.add_body(
                    with_material(dynamic_body(block(V{0.3}), ratio, {0, 0.95, 0}), 1, 0));
                JointDef joint = joint_along(world, type, foot, top, {0, 0.625, 0});
                if (type != JointType::fixed)
                    joint.limits = JointLimits{Real(0), Real(0)};
                world.add_joint(joint);
                const Stood seen = let_stand(world, 5);
                const double weight = ratio * gravity * 0.95;
                SCOPED_TRACE(std::to_string(static_cast<int>(type)) + ", " + std::to_string(ratio) +
                             " times, " + std::to_string(rate) + " Hz");
                EXPECT_LT(seen.gain, 1e-5 * weight);
                EXPECT_LT(seen.kinetic, 1e-5 * weight);
                EXPECT_LT(glm::distance(position_of(world, top), V(0, 0.95, 0)), 1e-3);
                EXPECT_TRUE(all_sleep(world));
            }
}

// A top of 10 kg on four welded legs of 2 kg, and on it a box.
struct LaidTable {
    World world;
    BodyId box;

    LaidTable(double load, double drop, double dt) : world(ground_world(dt)) {
        const auto add = [&](const V &half, double mass, const V &at) {
            return world.add_body(with_material(dynamic_body(block(half), mass, at), 0.5, 0));
        };
        const BodyId top = add({0.6, 0.02, 0.4}, 10, {0, 0.74, 0});
        for (const double x : {-0.55, 0.55})
            for (const double z : {-0.35, 0.35}) {
                const BodyId leg = add({0.03, 0.36, 0.03}, 2, {x, 0.36, z});
                world.add_joint(joint_along(world, JointType::fixed, top, leg, {x, 0.72, z}));
            }
        box = add(V{0.2}, load, {0, 0.96 + drop, 0});
    }
};

TEST(Standing, ATableComesToRestUnderItsLoad) {
    for (const double load : {1.0, 10.0, 30.0, 100.0, 300.0})
        for (const double rate : {30.0, 60.0, 120.0}) {
            LaidTable table(load, 0, 1 / rate);
            const Stood seen = let_stand(table.world, 5);
            SCOPED_TRACE(std::to_string(load) + " kg, " + std::to_string(rate) + " Hz");
            EXPECT_LT(seen.kinetic, 1e-4 * load * gravity);
            EXPECT_TRUE(all_sleep(table.world));
        }
}

TEST(Standing, ATableDoesNotThrowWhatFallsOnIt) {
    for (const double load : {10.0, 30.0, 100.0}) {
        LaidTable table(load, 0.3, 1 / 60.0);
        const Stood seen = let_stand(table.world, 5);
        SCOPED_TRACE(std::to_string(load) + " kg");
        EXPECT_LT(seen.gain, 1e-3 * load * gravity * 0.3);
        EXPECT_LT(glm::distance(position_of(table.world, table.box), V(0, 0.96, 0)), 0.05);
        EXPECT_TRUE(all_sleep(table.world));
    }
}

// A chassis of 1000 kg on four hubs that slide on springs of 2 Hz, with wheels of 30 kg.
TEST(Standing, AParkedCarComesToRest) {
    for (const double rate : {30.0, 60.0, 120.0}) {
        World world = ground_world(1 / rate);
        const BodyId chassis = world.add_body(
            with_material(dynamic_body(block({1, 0.2, 0.5}), 1000, {0, 0.5, 0}), 0.5, 0));
        for (const double x : {-0.7, 0.7})
            for (const double z : {-0.7, 0.7}) {
                const V at{x, 0.3, z};
                const BodyId wheel = world.add_body(with_material(
                    dynamic_body(Cylinder{narrow(V{0, 0, -0.1}), narrow(V{0, 0, 0.1}), Real(0.3)},
                                 30, at),
                    1, 0));
                BodyDef def = dynamic_body(block(V{0.05}), 9, at);
                def.colliders[0].filter = {0, 1};
                const BodyId hub = world.add_body(def);
                JointDef slide = joint_along(world, JointType::slider, chassis, hub, at);
                slide.limits = JointLimits{Real(-0.15), Real(0.15)};
                world.add_joint(slide);
                world.add_joint(joint_along(world, JointType::hinge, hub, wheel, at));
                const double stiffness = std::pow(2 * pi * 2, 2) * 250;
                JointDef spring;
                spring.type = JointType::distance;
                spring.a = chassis;
                spring.b = hub;
                spring.anchor_a_local = narrow(V{x, 0.3, z});
                set_length(spring, Real(0.5 + 250 * gravity / stiffness));
                spring.frequency = Real(6);
                spring.damping_ratio = Real(0.5);
                world.add_joint(spring);
            }
        const Stood seen = let_stand(world, 15);
        SCOPED_TRACE(std::to_string(rate) + " Hz");
        EXPECT_LT(seen.depth, 1e-3);
        EXPECT_TRUE(all_sleep(world));
    }
}

// A box of 5 kg that is open above, with twelve balls in it.
void add_full_cage(World &world, double ball_mass, BodyId &cage, std::vector<BodyId> &balls) {
    BodyDef def;
    const auto wall = [&](const V &at, const V &half) {
        def.colliders.emplace_back().shape = Box{narrow(at), identity_rotation, narrow(half)};
    };
    wall({0, -0.5, 0}, {0.5, 0.02, 0.5});
    for (const double side : {-0.5, 0.5}) {
        wall({side, 0, 0}, {0.02, 0.5, 0.5});
        wall({0, 0, side}, {0.5, 0.5, 0.02});
    }
    def.mass = Real(5);
    def.pose.position = narrow(V{0, 2, 0});
    cage = world.add_body(def);
    for (const double y : {1.7, 2.0})
        for (const double z : {-0.2, 0.1})
            for (const double x : {-0.3, 0.0, 0.3})
                balls.push_back(world.add_body(dynamic_body(ball(0.12), ball_mass, {x, y, z})));
}

TEST(Standing, ARopeDoesNotStretchUnderAFullCage) {
    for (const double ball_mass : {3.0, 10.0, 30.0, 100.0}) {
        World world("soft_step", settings_for("soft_step"));
        BodyId cage;
        std::vector<BodyId> balls;
        add_full_cage(world, ball_mass, cage, balls);
        JointDef rope;
        rope.type = JointType::distance;
        rope.b = cage;
        rope.anchor_a_local = narrow(V{0, 4, 0});
        rope.anchor_b_local = narrow(V{0, 0.5, 0});
        rope.max_length = Real(1.5);
        world.add_joint(rope);
        double drift = 0;
        for (int step = 0; step < 600; ++step) {
            world.step(nullptr);
            drift = std::max(drift, world.measure().max_joint_drift);
        }
        EXPECT_LT(drift, 0.02) << ball_mass << " kg";
    }
}

// The floor, between the balls and two beams, is thrown about at first. Fast pushing of balls that
// had sunk into it kept it so, and they sank right through: at 90 and 120 Hz about half of the
// time.
TEST(Standing, HeavyBallsStayInALightBox) {
    for (const auto &[ball_mass, rate] : {std::pair(20.0, 30.0),
                                          {20.0, 60.0},
                                          {50.0, 30.0},
                                          {50.0, 60.0},
                                          {100.0, 30.0},
                                          {100.0, 60.0},
                                          {20.0, 90.0},
                                          {20.0, 120.0},
                                          {70.0, 120.0}}) {
        StepSettings settings = settings_for("soft_step");
        settings.dt = 1 / rate;
        World world("soft_step", settings);
        BodyId cage;
        std::vector<BodyId> balls;
        add_full_cage(world, ball_mass, cage, balls);
        for (const double side : {-0.4, 0.4})
            world.add_body(static_body(block({0.05, 0.1, 0.6}), {side, 1.38, 0}));
        run(world, static_cast<int>(8 * rate));
        for (const BodyId one : balls)
            EXPECT_GT(position_of(world, one).y, 1.5) << ball_mass << " kg, " << rate << " Hz";
    }
}

// A beam put down askew across two round rails comes to rest: each holds it over its whole width.
TEST(Standing, ABeamOnRoundRailsComesToRest) {
    for (const bool is_capsule : {false, true})
        for (const double scale : {0.1, 1.0, 10.0})
            for (const int rate : {30, 60, 120})
                for (const double roll : {0.01, 0.3, 1.0})
                    for (const double yaw : {0.0, 7.0, 30.0}) {
                        StepSettings settings = settings_for("soft_step");
                        settings.dt = 1.0 / rate;
                        World world("soft_step", settings);
                        const Vec3 end = narrow(V{0, 0, 3 * scale});
                        const Real radius = Real(0.1 * scale);
                        for (const double x : {-0.4, 0.4})
                            world.add_body(with_material(
                                static_body(is_capsule ? Shape{Capsule{-end, end, radius}}
                                                       : Shape{Cylinder{-end, end, radius}},
                                            V{x * scale, -0.1 * scale, 0}),
                                0.2, 0));
                        BodyDef beam =
                            with_material(dynamic_body(block(V{1, 0.1, 0.1} * scale), 8,
                                                       V{0.05 * scale, 0.102 * scale, 0}),
                                          0.2, 0);
                        beam.pose.rotation =
                            glm::normalize(narrow(glm::angleAxis(yaw * pi / 180, V{0, 1, 0}) *
                                                  glm::angleAxis(roll * pi / 180, V{1, 0, 0})));
                        const BodyId id = world.add_body(beam);
                        run(world, 10 * rate);
                        EXPECT_LT(glm::length(velocity_of(world, id)) +
                                      scale * glm::length(spin_of(world, id)),
                                  2e-3 * std::sqrt(scale))
                            << is_capsule << ' ' << scale << ' ' << rate << ' ' << roll << ' '
                            << yaw;
                    }
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
