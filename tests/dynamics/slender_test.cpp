// Slender rods, and small bobs on long arms: they turn so much more easily than they move that what
// holds them is the small difference of large numbers.
#include "tests/dynamics/worlds.h"

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace trial;

// 1 kg, along x from the origin.
BodyDef rod(double length, double radius) {
    const double half = length / 2 - radius;
    return dynamic_body(Capsule{narrow(V{-half, 0, 0}), narrow(V{half, 0, 0}), Real(radius)}, 1,
                        V{length / 2, 0, 0});
}

JointDef at_the_end(JointType type, BodyId body, double length) {
    JointDef def;
    def.type = type;
    def.b = body;
    def.anchor_b_local = narrow(V{-length / 2, 0, 0});
    return def;
}

constexpr double slenderness[] = {5e-4, 1e-3, 3e-3, 5e-3, 9e-3, 9.5e-3, 0.012, 0.015, 0.02, 0.05};

// A flagpole: one joint bears the weight of the whole rod at half its length.
TEST(Slender, ARodThatIsWeldedOnStaysWhereItIs) {
    for (const double length : {0.05, 1.0, 10.0})
        for (const double share : slenderness)
            for (const int rate : {30, 60, 240}) {
                StepSettings settings = settings_for("soft_step");
                settings.dt = 1.0 / rate;
                World world("soft_step", settings);
                const BodyId id = world.add_body(rod(length, share * length));
                const JointId joint = world.add_joint(at_the_end(JointType::fixed, id, length));
                run(world, 5 * rate);
                EXPECT_LT(double(world.joint_error(joint.index)), 2e-4) << length << ' ' << share;
                EXPECT_NEAR(position_of(world, id).y, 0, 2e-4 * length) << length << ' ' << share;
                EXPECT_TRUE(all_sleep(world)) << length << ' ' << share << ' ' << rate;
            }
}

// A barrier on its stop, and one that its motor holds.
TEST(Slender, ARodOnAHingeStopsAtItsLimit) {
    for (const double share : slenderness)
        for (const bool is_motor : {false, true}) {
            World world("soft_step", settings_for("soft_step"));
            JointDef def = at_the_end(JointType::hinge, world.add_body(rod(1, share)), 1);
            // The hinge's axis is the frames' x axis; here it is horizontal, across the rod.
            def.frame_a_local = def.frame_b_local =
                narrow(glm::angleAxis(-pi / 2, glm::dvec3{0, 1, 0}));
            if (is_motor)
                def.motor = JointMotor{Real(0), Real(1000)};
            else
                def.limits = JointLimits{Real(-0.3), Real(0.3)};
            world.add_joint(def);
            double lowest = 0;
            for (int i = 0; i < 600; ++i) {
                run(world, 1);
                lowest = std::min(lowest, position_of(world, def.b).y);
            }
            const double least = is_motor ? -0.005 : -0.5 * std::sin(0.301);
            EXPECT_GT(lowest, least) << share;
            EXPECT_NEAR(position_of(world, def.b).y, is_motor ? 0 : -0.5 * std::sin(0.3), 0.005);
        }
}

// Of two beads on massless arms, each on a hinge.
TEST(Slender, ADoublePendulumOfBeadsKeepsItsEnergy) {
    for (const double radius : {0.001, 0.003, 0.005, 0.006, 0.01, 0.05})
        for (const int rate : {30, 60, 240}) {
            StepSettings settings = settings_for("soft_step");
            settings.dt = 1.0 / rate;
            World world("soft_step", settings);
            BodyId before;
            for (int i = 1; i <= 2; ++i) {
                JointDef def;
                def.type = JointType::hinge;
                def.a = before;
                def.b = before = world.add_body(dynamic_body(ball(radius), 1, V{double(i), 0, 0}));
                def.anchor_b_local = narrow(V{-1, 0, 0});
                def.frame_a_local = def.frame_b_local =
                    narrow(glm::angleAxis(-pi / 2, glm::dvec3{0, 1, 0}));
                world.add_joint(def);
            }
            const double start = double(world.energy());
            run(world, 10 * rate);
            EXPECT_NEAR(world.energy(), start, 0.05 * 3 * gravity) << radius << ' ' << rate;
        }
}

// A small ball that is whirled around on a long arm.
TEST(Slender, ASlingKeepsItsEnergy) {
    for (const JointType type : {JointType::hinge, JointType::ball})
        for (const double radius : {0.005, 0.01, 0.03, 0.04, 0.07, 0.08, 0.1})
            for (const double spin : {20.0, 40.0, 100.0}) {
                World world("soft_step", weightless(settings_for("soft_step")));
                BodyDef bob = dynamic_body(ball(radius), 1, V{1, 0, 0});
                bob.velocity = narrow(V{0, spin, 0});
                bob.angular_velocity = narrow(V{0, 0, spin});
                JointDef def;
                def.type = type;
                def.b = world.add_body(bob);
                def.anchor_b_local = narrow(V{-1, 0, 0});
                def.frame_a_local = def.frame_b_local =
                    narrow(glm::angleAxis(-pi / 2, glm::dvec3{0, 1, 0}));
                world.add_joint(def);
                const double start = world.energy();
                run(world, 1800);
                EXPECT_NEAR(world.energy() / start, 1, 0.02) << radius << ' ' << spin;
            }
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
