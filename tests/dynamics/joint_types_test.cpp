// Hinges, sliders, fixed joints, ropes, springs, motors and limits against closed forms.
#include "engine/core/check.h"
#include "tests/dynamics/avbd_passes.h"
#include "tests/dynamics/worlds.h"

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace trial;

class JointTypes : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Methods, JointTypes, testing::ValuesIn(joint_methods()), name_of);

// The rotation that takes x to the axis.
Quat axis_frame(const V &axis) {
    const V from{1, 0, 0};
    const V half = glm::normalize(from + axis);
    const V cross = glm::cross(from, half);
    return narrow(glm::dquat(glm::dot(from, half), cross.x, cross.y, cross.z));
}

struct Joined {
    World world;
    BodyId id;
    std::uint32_t joint = 0;
};

// A body jointed to the world at the origin, about or along an axis.
Joined joined(const std::string &method, StepSettings settings, JointDef def, const BodyDef &body,
              const V &axis) {
    World world(method, settings);
    const BodyId id = world.add_body(body);
    def.b = id;
    def.anchor_b_local = -body.pose.position;
    def.frame_a_local = def.frame_b_local = axis_frame(axis);
    const std::uint32_t joint = world.add_joint(def).index;
    return {std::move(world), id, joint};
}

double place_of(const Joined &j) {
    const Joint &joint = j.world.joints()[j.joint];
    const Motion &a = j.world.joint_motion(joint.a);
    const Motion &b = j.world.joint_motion(joint.b);
    return double(place_of(joint, a, b).position);
}

StepSettings fine(const std::string &method, int substeps) {
    StepSettings settings = settings_for(method);
    settings.substeps = substeps;
    return settings;
}

// A plate on a hinge through its edge: a compound pendulum, T = 2 pi sqrt(I / (m g d)) for small
// swings, with I about the hinge.
TEST_P(JointTypes, AHingePendulumKeepsItsPeriod) {
    JointDef def;
    def.type = JointType::hinge;
    const V half{0.1, 0.5, 0.3};
    Joined j = joined(GetParam(), fine(GetParam(), 16), def,
                      dynamic_body(block(half), 2, V{0, -half.y, 0}), V{0, 0, 1});
    BodyDef start = dynamic_body(block(half), 2, V{0});
    const double amplitude = 0.05;
    const glm::dquat turn = glm::angleAxis(amplitude, V{0, 0, 1});
    j.world.set_motion(j.id, {narrow(turn * V{0, -half.y, 0}), narrow(turn)}, Vec3{Real(0)},
                       Vec3{Real(0)});
    const double inertia = 2 * (half.x * half.x + half.y * half.y) / 3 + 2 * half.y * half.y;
    const double period =
        2 * pi * std::sqrt(inertia / (2 * gravity * half.y)) * (1 + amplitude * amplitude / 16);
    double before = place_of(j), first = 0, last = 0;
    int crossings = 0;
    for (int i = 1; i <= 600; ++i) {
        j.world.step(nullptr);
        const double now = place_of(j);
        if (before > 0 && now <= 0) {
            const double t = (i - now / (now - before)) / 60;
            if (crossings++ == 0)
                first = t;
            last = t;
        }
        before = now;
    }
    ASSERT_GE(crossings, 4);
    EXPECT_NEAR((last - first) / (crossings - 1) / period, 1,
                GetParam() == "soft_step" ? 5e-4 : 0.02);
    EXPECT_LE(double(j.world.joint_error(j.joint)), 2e-3);
}

// A turn of 3e-8 rad in a substep is less than single precision can add to a quaternion.
TEST(SlowTurn, IsNotLostToRounding) {
    for (const char *method : {"soft_step", "tgs_soft"}) {
        StepSettings settings = weightless(fine(method, 64));
        settings.sleep_after = 0;
        JointDef def;
        def.type = JointType::hinge;
        BodyDef body = dynamic_body(block(V{0.1, 0.5, 0.3}), 2, V{0});
        body.angular_velocity = narrow(V{0, 1e-4, 0});
        Joined j = joined(method, settings, def, body, V{0, 1, 0});
        run(j.world, 60 * 20);
        EXPECT_NEAR(place_of(j), 20e-4, 20e-6) << method;
    }
}

// A motor with a bounded torque spins a disc up by w = torque t / I, then holds its speed.
TEST_P(JointTypes, AMotorSpinsUpByItsTorque) {
    JointDef def;
    def.type = JointType::hinge;
    def.motor = {Real(10), Real(0.5)};
    const double mass = 2, radius = 0.5;
    const double inertia = 0.4 * mass * radius * radius; // ball
    Joined j = joined(GetParam(), weightless(settings_for(GetParam())), def,
                      dynamic_body(ball(radius), mass, V{0}), V{0, 1, 0});
    run(j.world, 60);
    const double reached = 0.5 / inertia; // after 1 s
    // Known failing: each of AVBD's ten passes only halves a motor's speed error.
    const double lost = GetParam() == "xpbd" ? spin_lost_by_xpbd(j.world, std::pow(reached, 3) / 4)
                        : GetParam() == "avbd" ? left_by_avbd(j.world) * reached
                                               : 0;
    EXPECT_NEAR(spin_of(j.world, j.id).y, reached - lost, reached * (1e-4 + 500 * epsilon));
    run(j.world, 240); // it reaches 10 rad/s after 4 s
    EXPECT_NEAR(spin_of(j.world, j.id).y, 10, 1e-3);
}

// A motor stronger than its load reaches its speed immediately.
TEST_P(JointTypes, ASliderMotorHoldsItsSpeedAgainstGravity) {
    JointDef def;
    def.type = JointType::slider;
    def.motor = {Real(0.5), Real(1000)};
    Joined j = joined(GetParam(), settings_for(GetParam()), def,
                      dynamic_body(block(V{0.2}), 3, V{0}), V{0, 1, 0});
    run(j.world, 60);
    const double speed = 0.5 - speed_left_at_rest(j.world);
    EXPECT_NEAR(velocity_of(j.world, j.id).y, speed, 1e-3);
    EXPECT_NEAR(place_of(j), speed, 0.02);
}

// On an inclined rail a body falls by g sin(a) t^2 / 2 and stays on the rail.
TEST_P(JointTypes, ASliderFallsFreely) {
    for (const double angle : {pi / 2, pi / 6, 0.0}) {
        JointDef def;
        def.type = JointType::slider;
        const V axis{std::cos(angle), -std::sin(angle), 0};
        Joined j = joined(GetParam(), fine(GetParam(), 8), def,
                          dynamic_body(block(V{0.2, 0.1, 0.3}), 3, V{0}), axis);
        run(j.world, 60);
        const double fallen = 0.5 * gravity * std::sin(angle);
        const double h = substep_of(j.world);
        // The plain methods are half a substep of speed ahead.
        const double tolerance = GetParam() == "soft_step" ? 2e-3 : 0.5 * gravity * h + 2e-3;
        EXPECT_NEAR(place_of(j), fallen, tolerance) << angle;
        EXPECT_LE(glm::distance(position_of(j.world, j.id), axis * place_of(j)), 1e-3);
        EXPECT_LE(glm::length(spin_of(j.world, j.id)), 1e-3);
    }
}

TEST_P(JointTypes, LimitsStopASliderAndAHinge) {
    for (const JointType type : {JointType::slider, JointType::hinge}) {
        JointDef def;
        def.type = type;
        def.limits = {Real(-0.25), Real(0.5)};
        const bool slides = type == JointType::slider;
        Joined j = joined(GetParam(), settings_for(GetParam()), def,
                          dynamic_body(block(V{0.2, 0.1, 0.3}), 3, slides ? V{0} : V{0.5, 0, 0}),
                          slides ? V{0, -1, 0} : V{0, 0, -1});
        double least = 1, most = -1;
        for (int i = 0; i < 300; ++i) {
            j.world.step(nullptr);
            least = std::min(least, place_of(j));
            most = std::max(most, place_of(j));
        }
        // One pass does not split an impact exactly between the stop and the anchor.
        const double give = GetParam() == "tgs_soft" ? 0.003 : 0; // as published, it is softer
        EXPECT_LE(most, 0.5 + 0.02 + give);
        EXPECT_GE(least, -0.25 - 0.02);
        EXPECT_NEAR(place_of(j), 0.5 + (slides ? sag_of_joints(j.world) : 0), 0.005 + give);
        // Five passes from nothing do not split the weight between the hinge and its stop.
        const double shared = GetParam() == "naive_impulses" && !slides ? 3 : 1;
        EXPECT_LE(glm::length(velocity_of(j.world, j.id)),
                  0.01 + shared * 1.1 * speed_left_at_rest(j.world));
    }
}

// A distance joint with a frequency is a spring: x'' = -w^2 x, with w for the mass hanging on it.
TEST(Springs, SwingWithTheirFrequencyAndKeepTheirEnergy) {
    StepSettings settings = weightless(settings_for("soft_step"));
    World world("soft_step", settings);
    JointDef def;
    def.type = JointType::distance;
    set_length(def, Real(2));
    def.frequency = Real(1.5);
    def.damping_ratio = Real(0);
    def.b = world.add_body(dynamic_body(ball(0.1), 2, V{2.2, 0, 0}));
    world.add_joint(def);
    const double w = 2 * pi * 1.5;
    const double h = substep_of(world);
    for (int i = 1; i <= 600; ++i) {
        world.step(nullptr);
        const double t = i / 60.0;
        // The midpoint rule advances the phase by 2 atan(w h / 2) a substep.
        const double phase = 2 * std::atan(w * h / 2) / h * t;
        ASSERT_NEAR(position_of(world, def.b).x, 2 + 0.2 * std::cos(phase), 2e-4 + 600 * epsilon)
            << t;
    }
    // This phase is within (w h)^2 / 12 of the true one.
    EXPECT_LE(std::abs(2 * std::atan(w * h / 2) / (w * h) - 1), w * h * w * h / 12);
}

TEST(Springs, DieAwayWithTheirDampingRatio) {
    World world("soft_step", weightless(settings_for("soft_step")));
    JointDef def;
    def.type = JointType::distance;
    set_length(def, Real(2));
    def.frequency = Real(1);
    def.damping_ratio = Real(0.2);
    def.b = world.add_body(dynamic_body(ball(0.1), 2, V{2.2, 0, 0}));
    world.add_joint(def);
    const double w = 2 * pi, decay = 0.2 * w, wd = w * std::sqrt(1 - 0.04);
    for (int i = 1; i <= 240; ++i) {
        world.step(nullptr);
        const double t = i / 60.0;
        const double x =
            0.2 * std::exp(-decay * t) * (std::cos(wd * t) + decay / wd * std::sin(wd * t));
        ASSERT_NEAR(position_of(world, def.b).x, 2 + x, 2e-4) << t;
    }
}

// However stiff, an undamped spring gains no energy.
TEST(Springs, AreStableAtAnyStiffness) {
    for (const double frequency : {1e-30, 1.0, 30.0, 300.0, 3000.0, 1e9}) {
        World world("soft_step", weightless(settings_for("soft_step")));
        JointDef def;
        def.type = JointType::ball;
        def.frequency = Real(frequency);
        def.damping_ratio = Real(0);
        def.b = world.add_body(dynamic_body(ball(0.1), 2, V{0.01, 0, 0}));
        world.add_joint(def);
        double worst = 0;
        for (int i = 0; i < 600; ++i) {
            world.step(nullptr);
            worst = std::max(worst, glm::length(position_of(world, def.b)));
        }
        EXPECT_LE(worst, 0.01 * (1 + 1e-2)) << frequency;
    }
}

// Two bodies tumbling on a spring between them for a minute: the torques on them are opposite, and
// together they never have more energy than at the start. When the force acted at two anchors and
// the stiffness turned with both, their angular momentum changed by as much as there was, and some
// doubled their energy.
TEST(Springs, BetweenFreeBodiesKeepWhatThereIs) {
    Random random(8);
    for (const JointType type : {JointType::ball, JointType::hinge, JointType::slider,
                                 JointType::fixed, JointType::distance})
        for (const double damping : {0.0, 0.2})
            for (int trial = 0; trial < 8; ++trial) {
                World world("soft_step", weightless(settings_for("soft_step")));
                JointDef def;
                def.type = type;
                def.frequency = Real(random.next_in(0.5, 3));
                def.damping_ratio = Real(damping);
                set_length(def, Real(0.3));
                for (const double side : {-1.0, 1.0}) {
                    const V half{random.next_in(0.1, 0.5), random.next_in(0.1, 0.5),
                                 random.next_in(0.1, 0.5)};
                    const V at = side * V{half.x + 0.1, 0, 0};
                    BodyDef body = dynamic_body(block(half), random.next_in(1, 20), at,
                                                any_vector(random, 0.3));
                    body.angular_velocity = narrow(any_vector(random, 1));
                    body.colliders[0].filter = {0, 1};
                    (side < 0 ? def.a : def.b) = world.add_body(body);
                    const V off = type == JointType::distance ? side * V{0.15, 0, 0} : V{0};
                    (side < 0 ? def.anchor_a_local : def.anchor_b_local) = narrow(off - at);
                }
                def.frame_a_local = def.frame_b_local = narrow(any_rotation(random));
                world.add_joint(def);
                const Measures before = world.measure();
                double most = 0, lost = 0;
                for (int i = 0; i < 3600; ++i) {
                    world.step(nullptr);
                    const Measures now = world.measure();
                    most = std::max(most, now.kinetic_energy);
                    lost = std::max(lost,
                                    glm::distance(now.angular_momentum, before.angular_momentum));
                }
                // The rows are linear in a step, which undamped springs do not quite make up for.
                EXPECT_LT(most, (damping > 0 ? 1 : 1.15) * before.kinetic_energy)
                    << int(type) << ' ' << damping << ' ' << trial;
                EXPECT_LT(lost, 5e-3 * glm::length(before.angular_momentum))
                    << int(type) << ' ' << damping << ' ' << trial;
            }
}

// A rope does nothing until it is taut.
TEST_P(JointTypes, ARopeIsSlackUntilItIsTaut) {
    World world(GetParam(), settings_for(GetParam()));
    JointDef def;
    def.type = JointType::distance;
    def.min_length = Real(0);
    def.max_length = Real(1);
    def.b = world.add_body(dynamic_body(ball(0.1), 2, V{0, -0.2, 0}));
    world.add_joint(def);
    const double h = substep_of(world);
    for (int i = 1; i <= 20; ++i) { // 0.2 + g t^2 / 2 < 0.8 m
        world.step(nullptr);
        const double t = i / 60.0;
        ASSERT_NEAR(position_of(world, def.b).y, -0.2 - 0.5 * gravity * t * t,
                    0.5 * gravity * t * h + 1e-4);
    }
    double lowest = 0;
    for (int i = 0; i < 300; ++i) {
        world.step(nullptr);
        lowest = std::min(lowest, position_of(world, def.b).y);
    }
    EXPECT_GE(lowest, -1.02);
    EXPECT_NEAR(position_of(world, def.b).y, -1 - sag_of_joints(world), 5e-3);
}

// Two boxes that act as one: thrown, they keep their relative pose.
TEST_P(JointTypes, FixedBodiesMoveAsOne) {
    World world(GetParam(), fine(GetParam(), 8));
    BodyDef left = dynamic_body(block(V{0.5, 0.2, 0.3}), 2, V{-0.5, 0, 0});
    BodyDef right = dynamic_body(block(V{0.5, 0.3, 0.2}), 3, V{0.5, 0, 0});
    JointDef def;
    def.type = JointType::fixed;
    def.a = world.add_body(left);
    def.b = world.add_body(right);
    def.anchor_a_local = narrow(V{0.5, 0, 0});
    def.anchor_b_local = narrow(V{-0.5, 0, 0});
    const JointId joint = world.add_joint(def);
    world.apply_impulse(def.a, narrow(V{0, 10, 0}), narrow(V{-1, 0, 0}));
    for (int i = 0; i < 120; ++i) {
        world.step(nullptr);
        ASSERT_LE(double(world.joint_error(joint.index)), 0.02) << i;
    }
}

TEST_P(JointTypes, BreakWhenTheyBearTooMuch) {
    for (const double load : {0.9, 1.1}) {
        World world(GetParam(), settings_for(GetParam()));
        JointDef def;
        def.b = world.add_body(dynamic_body(ball(0.2), 3, V{0, -1, 0}));
        def.anchor_b_local = narrow(V{0, 1, 0});
        def.break_force = Real(3 * gravity / load);
        const JointId joint = world.add_joint(def);
        run(world, 120);
        EXPECT_EQ(world.state().joints[joint.index].broken, load > 1) << load;
        EXPECT_EQ(position_of(world, def.b).y<-2, load> 1);
    }
}

// A rope that gets taut early in a step bears most then, and nothing any more at the step's end.
TEST_P(JointTypes, BreakByTheirGreatestLoadWithinAStep) {
    StepSettings settings = weightless(settings_for(GetParam()));
    settings.substeps = 8;
    settings.max_substeps = 1;
    constexpr double speed = 3;
    for (const double strength : {0.0, 0.3}) {
        World world(GetParam(), settings);
        JointDef def;
        def.type = JointType::distance;
        BodyDef tied = dynamic_body(ball(0.1), 2, V{1 - speed * 0.3 / 60, 0, 0});
        tied.velocity = narrow(V{speed, 0, 0});
        def.b = world.add_body(tied);
        def.min_length = Real(0);
        def.max_length = Real(1);
        def.break_force = Real(strength * 2 * speed * 60 * 8);
        const JointId joint = world.add_joint(def);
        run(world, 1);
        EXPECT_EQ(world.state().joints[joint.index].broken, strength > 0);
        if (strength == 0) {
            EXPECT_LT(glm::length(wide(world.joint_load(joint.index).force)),
                      0.1 * 2 * speed * 60 * 8);
        }
    }
}

TEST_P(JointTypes, TellTheirLoad) {
    World world(GetParam(), settings_for(GetParam()));
    JointDef def;
    def.type = JointType::fixed;
    def.b = world.add_body(dynamic_body(block(V{0.5, 0.1, 0.1}), 2, V{0.5, 0, 0}));
    def.anchor_b_local = narrow(V{-0.5, 0, 0});
    const JointId joint = world.add_joint(def);
    run(world, 300);
    // A cantilever: the weight, and its moment at the wall.
    const World::JointLoad load = world.joint_load(joint.index);
    EXPECT_LE(glm::distance(wide(load.force), V{0, 2 * gravity, 0}), 0.02 * 2 * gravity);
    EXPECT_LE(glm::distance(wide(load.torque), V{0, 0, 0.5 * 2 * gravity}), 0.05 * gravity);
}

// A grab lifts what it can, and only lets go of loads it is too weak for.
TEST_P(JointTypes, AGrabHoldsWithItsForceAndNoMore) {
    for (const double strength : {0.9, 5.0}) {
        World world(GetParam(), settings_for(GetParam()));
        world.add_body(ground(0.5, 0));
        const BodyId id = world.add_body(dynamic_body(block(V{0.25}), 2, V{0, 0.25, 0}));
        world.grab(id, Vec3{Real(0)}, narrow(V{0, 2, 0}), Real(strength * 2 * gravity));
        run(world, 240);
        const double omega = 2 * pi * 5;
        const double sag = gravity / (omega * omega) + more_sag_of_springs(world, omega, 1);
        const double on_ground = GetParam() == "naive_impulses" ? 0.25 - 0.01 : 0.25; // its slop
        EXPECT_NEAR(position_of(world, id).y, strength > 1 ? 2 - sag : on_ground, 5e-3);
        world.release();
        run(world, 120);
        EXPECT_NEAR(position_of(world, id).y, on_ground, 5e-3);
    }
}

// A held body sags by g / w^2; without damping it first swings about that by as much.
TEST_P(JointTypes, AGrabPullsWithItsOwnSpring) {
    for (const double frequency : {1.0, 3.0}) {
        World world(GetParam(), settings_for(GetParam()));
        const BodyId id = world.add_body(dynamic_body(block(V{0.25}), 2, V{0}));
        world.grab(id, Vec3{Real(0)}, Vec3{Real(0)}, Real(1e4), {frequency, 0});
        const double sag = gravity / std::pow(2 * pi * frequency, 2);
        double lowest = 0;
        for (int i = 0; i < 60 / frequency; ++i) { // one period
            world.step(nullptr);
            lowest = std::min(lowest, position_of(world, id).y);
        }
        const double swings = position_of(world, id).y - lowest;
        EXPECT_LT(lowest, -1.3 * sag) << "it is not damped";
        EXPECT_GT(lowest, -2.2 * sag);
        EXPECT_GT(swings, 0.5 * sag) << "it comes up again";
        world.grab(id, Vec3{Real(0)}, Vec3{Real(0)}, Real(1e4), {frequency, 1});
        run(world, 240);
        EXPECT_NEAR(position_of(world, id).y,
                    -sag - more_sag_of_springs(world, 2 * pi * frequency, 1), 0.02 * sag + 1e-4);
    }
    World world(GetParam(), settings_for(GetParam()));
    const BodyId id = world.add_body(dynamic_body(block(V{0.25}), 2, V{0}));
    for (const GrabSpring spring : {GrabSpring{0, 1}, GrabSpring{-1, 1}, GrabSpring{5, -1}})
        EXPECT_THROW(world.grab(id, Vec3{Real(0)}, Vec3{Real(0)}, Real(1), spring), CheckFailure);
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
