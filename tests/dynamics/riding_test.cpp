// Bodies on others that turn: on turntables and on a swing.
#include "tests/dynamics/worlds.h"

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace trial;

// Lets a table turn about the vertical through its middle.
JointDef axle_of(BodyId table, double height) {
    JointDef axle;
    axle.type = JointType::hinge;
    axle.b = table;
    axle.anchor_a_local = narrow(V{0, height, 0});
    axle.frame_a_local = axle.frame_b_local = narrow(glm::angleAxis(pi / 2, V{0, 0, 1}));
    return axle;
}

// A box on a turntable goes round with it for 10 s; friction times `share` is what holding it
// takes.
TEST(Riding, BoxesStayOnATurntable) {
    for (const double share : {0.3, 0.5, 0.7, 0.82, 0.95}) {
        const double friction = 0.5, spin = std::sqrt(share * friction * gravity);
        World world("soft_step", settings_for("soft_step"));
        BodyDef table = with_material(static_body(block(V{3, 0.1, 3}), V{0, -0.1, 0}), friction, 0);
        table.kind = BodyKind::kinematic;
        table.angular_velocity = narrow(V{0, spin, 0});
        world.add_body(table);
        BodyDef rider = dynamic_body(block(V{0.05, 0.02, 0.05}), 1, V{1, 0.02, 0}, V{0, 0, -spin});
        rider.angular_velocity = narrow(V{0, spin, 0});
        const BodyId id = world.add_body(with_material(rider, friction, 0));
        run(world, 600);
        const V at = position_of(world, id);
        EXPECT_NEAR(std::hypot(at.x, at.z), 1, 1e-4) << share;
        EXPECT_NEAR(std::remainder(std::atan2(-at.z, at.x) - 10 * spin, 2 * pi), 0, 1e-4) << share;
    }
}

// Also where the table is a body on a hinge, with or without a motor, and no matter how slowly it
// turns: a rider that left along the tangent in each step would wander off within minutes.
TEST(Riding, BoxesStayOnATableOnAHinge) {
    constexpr double half = 0.03; // thickness of the rider
    for (const bool is_driven : {false, true})
        for (const double mass : {20.0, 1e4})
            for (const double spin : {0.2, 2.0, 3.5})
                for (const double share : {0.5, 0.9}) {
                    const double friction = spin * spin / gravity / share;
                    World world("soft_step", settings_for("soft_step"));
                    BodyDef table = with_material(dynamic_body(block(V{1.5, 0.1, 1.5}), mass, V{0}),
                                                  friction, 0);
                    table.angular_velocity = narrow(V{0, spin, 0});
                    JointDef axle = axle_of(world.add_body(table), 0);
                    if (is_driven)
                        axle.motor = JointMotor{Real(spin), Real(1e6)};
                    world.add_joint(axle);
                    BodyDef rider = dynamic_body(block(V{0.1, half, 0.1}), 2, V{1, 0.1 + half, 0},
                                                 V{0, 0, -spin});
                    rider.angular_velocity = narrow(V{0, spin, 0});
                    const BodyId id = world.add_body(with_material(rider, friction, 0));
                    const double energy = world.measure().kinetic_energy;
                    run(world, 600);
                    const V at = glm::inverse(wide(motion_of(world, axle.b).rotation)) *
                                 position_of(world, id);
                    EXPECT_LT(glm::distance(at, V{1, 0.1 + half, 0}), 5e-4)
                        << is_driven << ", " << mass << " kg, " << spin << " rad/s, " << share;
                    EXPECT_NEAR(world.measure().kinetic_energy / energy, 1, 2e-3);
                }
}

// A ball that rolls on a turntable goes in a circle, 2/7 as fast as the table turns: Weckesser
// 1997, "A ball rolling on a freely spinning turntable".
TEST(Riding, BallsRollInCircles) {
    constexpr double radius = 0.1;
    for (const bool is_kinematic : {false, true})
        for (const double spin : {1, 3, 6, 12}) {
            World world("soft_step", settings_for("soft_step"));
            const Box plate = block(V{10, 0.1, 10});
            BodyDef table = is_kinematic ? static_body(plate, V{0, -0.1, 0})
                                         : dynamic_body(plate, 1e6, V{0, -0.1, 0});
            table.kind = is_kinematic ? BodyKind::kinematic : BodyKind::dynamic;
            table.angular_velocity = narrow(V{0, spin, 0});
            const BodyId turning = world.add_body(with_material(table, 1, 0));
            if (!is_kinematic)
                world.add_joint(axle_of(turning, -0.1));
            const V from{0.5, radius, 0}, velocity{0.3, 0, 0.2}, up{0, 1, 0};
            BodyDef rolls = dynamic_body(ball(radius), 1, from, velocity);
            const V beneath =
                glm::cross(V{0, spin, 0}, from) - velocity; // of the table, to the ball
            rolls.angular_velocity = narrow(V{-beneath.z, 0, beneath.x} / radius);
            const BodyId id = world.add_body(with_material(rolls, 1, 0));
            const double rate = 2.0 / 7.0 * spin;
            const V middle = from + glm::cross(up, velocity) / rate;
            double worst = 0;
            for (int i = 0; i < 600; ++i) {
                world.step(nullptr);
                const V expected =
                    middle + glm::angleAxis(rate * world.time(), up) * (from - middle);
                worst = std::max(worst, glm::distance(position_of(world, id), expected));
            }
            EXPECT_LT(worst, is_kinematic ? 4e-3 : 0.012) << is_kinematic << ", " << spin;
        }
}

// A box on a swing that hangs from a hinge on two rods of 2 m: nothing slides, nothing is lost.
TEST(Riding, ASwingWithARiderSwingsOn) {
    for (const double angle : {0.05, 0.1, 0.3, 0.6})
        for (const double mass : {1.0, 20.0}) {
            constexpr double length = 2, seat = 20; // kg
            World world("soft_step", settings_for("soft_step"));
            const glm::dquat tilt = glm::angleAxis(angle, V{0, 0, 1});
            BodyDef def = dynamic_body(block(V{0.5, 0.05, 0.5}), seat, tilt * V{0, -length, 0});
            def.pose.rotation = narrow(tilt);
            JointDef hinge;
            hinge.type = JointType::hinge;
            hinge.b = world.add_body(with_material(def, 1, 0));
            hinge.anchor_b_local = narrow(V{0, length, 0});
            hinge.frame_a_local = hinge.frame_b_local = narrow(glm::angleAxis(-pi / 2, V{0, 1, 0}));
            world.add_joint(hinge);
            BodyDef rider =
                dynamic_body(block(V{0.1, 0.1, 0.1}), mass, tilt * V{0, -(length - 0.15), 0});
            rider.pose.rotation = narrow(tilt);
            const BodyId id = world.add_body(with_material(rider, 1, 0));
            const double lowest = -gravity * (seat * length + mass * (length - 0.15));
            const double begun = world.energy() - lowest;
            run(world, 1800);
            EXPECT_NEAR((world.energy() - lowest) / begun, 1, 0.004) << angle << ", " << mass;
            const V at = glm::inverse(wide(motion_of(world, hinge.b).rotation)) *
                         (position_of(world, id) - position_of(world, hinge.b));
            EXPECT_LT(glm::distance(at, V{0, 0.15, 0}), 5e-4) << angle << ", " << mass;
        }
}

// A round roller's surface stays where it is however fast it turns: what rests on it without
// friction is not moved.
TEST(Riding, AFastRollerDoesNotThrowWhatLiesOnIt) {
    for (const double radius : {0.05, 0.5, 5.0})
        for (const double turn : {0.05, 0.25, 1.0}) // rad a step
            for (const bool is_capsule : {false, true})
                for (const double width : {0.04, 1.0}) {
                    World world("soft_step", settings_for("soft_step"));
                    const Vec3 end = narrow(V{0, 0, 2 * radius});
                    BodyDef roller =
                        static_body(is_capsule ? Shape{Capsule{-end, end, Real(radius)}}
                                               : Shape{Cylinder{-end, end, Real(radius)}},
                                    V{0, -radius, 0});
                    roller.kind = BodyKind::kinematic;
                    roller.angular_velocity = narrow(V{0, 0, -60 * turn});
                    world.add_body(with_material(roller, 0, 0));
                    const double half = width * radius;
                    BodyDef plate = with_material(
                        dynamic_body(block(V{half, 0.2 * half, half}), 1, V{0, 0.2 * half, 0}), 0,
                        0);
                    plate.locked = {true, false, true, true, true, true};
                    const BodyId id = world.add_body(plate);
                    double highest = 0;
                    for (int i = 0; i < 120; ++i) {
                        run(world, 1);
                        highest = std::max(highest, position_of(world, id).y);
                    }
                    EXPECT_NEAR(highest, 0.2 * half, 1e-3 * radius)
                        << radius << ' ' << turn << ' ' << is_capsule << ' ' << width;
                }
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
