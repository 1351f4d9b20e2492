// soft_step's joints must not change energy or angular momentum, and the world must stay finite.
#include "tests/dynamics/worlds.h"

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace trial;

World world_of(int substeps, bool has_gravity) {
    StepSettings settings = settings_for("soft_step");
    settings.substeps = substeps;
    return {"soft_step", has_gravity ? settings : weightless(settings)};
}

// A ball joint at a world point; a default id is the world.
void join(World &world, BodyId a, BodyId b, const V &at) {
    const auto local = [&](BodyId id) {
        if (id == BodyId{})
            return narrow(at);
        const Transform pose = world.pose_of(id.index);
        return glm::conjugate(pose.rotation) * (narrow(at) - pose.position);
    };
    JointDef joint;
    joint.a = a;
    joint.b = b;
    joint.anchor_a_local = local(a);
    joint.anchor_b_local = local(b);
    world.add_joint(joint);
}

// The largest of `measure` over some steps; infinite when the world is not finite.
template <typename Measure> double largest(World &world, double seconds, Measure &&measure) {
    double most = 0;
    for (int i = 0; i < int(seconds * 60); ++i) {
        world.step(nullptr);
        if (!world.report().finite)
            return std::numeric_limits<double>::infinity();
        most = std::max(most, std::abs(measure()));
    }
    return most;
}

// The heavy top: a plate whose axis lies level, turning about its end at the rate at which
// gravity's moment carries the spin's momentum round. With a level axis steady precession is
// exactly w = m g r / (I3 s).
TEST(SteadyPrecession, StaysLevel) {
    for (const double spin : {60.0, 100.0, 150.0})
        for (const int substeps : {4, 8}) {
            World world = world_of(substeps, true);
            const double arm = 0.3, half = 0.2, thin = 0.02;
            const double about_axis = (half * half + half * half) / 3;
            const double precession = gravity * arm / (about_axis * spin);
            BodyDef def =
                dynamic_body(block({half, thin, half}), 1, {arm, 0, 0}, {0, 0, -precession * arm});
            def.pose.rotation = narrow(glm::dquat(std::sqrt(0.5), 0, 0, -std::sqrt(0.5)));
            def.angular_velocity = narrow(V{spin, precession, 0});
            const BodyId plate = world.add_body(def);
            join(world, {}, plate, V{0});
            EXPECT_LT(largest(world, 5, [&] { return position_of(world, plate).y; }), 0.002)
                << spin << " rad/s, " << substeps << " substeps";
        }
}

TEST(FreeJoinedBodies, KeepEnergyAndAngularMomentum) {
    Random random(3);
    for (int trial = 0; trial < 6; ++trial) {
        World world = world_of(4, false);
        const V spin = any_vector(random, 4);
        const V at{0.5, 0.2, random.next_in(-0.2, 0.2)};
        // Both turn about the first one's centre, so the joint is not struck at the start.
        BodyDef first = dynamic_body(block({0.1, 0.4, 0.2}), 2, V{0});
        BodyDef second =
            dynamic_body(block({0.3, 0.1, 0.2}), 1, {1, 0, 0}, glm::cross(spin, V{1, 0, 0}));
        first.angular_velocity = second.angular_velocity = narrow(spin);
        const BodyId a = world.add_body(first);
        const BodyId b = world.add_body(second);
        join(world, a, b, at);
        const Measures before = world.measure();
        const double energy = before.energy();
        EXPECT_LT(largest(world, 20, [&] { return world.energy() / energy - 1; }), 2e-3) << trial;
        const double momentum = glm::length(before.angular_momentum);
        EXPECT_LT(glm::distance(world.measure().angular_momentum, before.angular_momentum),
                  5e-4 * momentum)
            << trial;
    }
}

// A body that turns about a pin outside it; the force that carries it round does no work.
double spinning_loss(const Shape &shape, double arm, double spin, int substeps, double seconds) {
    World world = world_of(substeps, false);
    BodyDef def = dynamic_body(shape, 1, {arm, 0, 0}, {0, 0, -arm * spin});
    def.angular_velocity = narrow(V{0, spin, 0});
    join(world, {}, world.add_body(def), V{0});
    const double before = world.energy();
    return largest(world, seconds, [&] { return world.energy() / before - 1; });
}

TEST(SpinningOnAJoint, KeepsItsEnergyWhereTheSubstepFollows) {
    const Shape rod = block({0.5, 0.05, 0.05});
    EXPECT_LT(spinning_loss(rod, 0.5, 10, 4, 5), 1e-4);
    EXPECT_LT(spinning_loss(rod, 0.5, 10, 8, 5), 1e-4);
    EXPECT_LT(spinning_loss(rod, 0.5, 50, 16, 5), 2e-2);
    EXPECT_LT(spinning_loss(ball(0.2), 0.5, 20, 4, 1), 2e-4);
    EXPECT_LT(spinning_loss(ball(0.2), 0.5, 50, 4, 1), 5e-3);
    EXPECT_LT(spinning_loss(ball(0.2), 0.5, 200, 16, 1), 1e-2);
}

// However fast it spins, it loses the energy the substep cannot follow, and gains none.
TEST(SpinningOnAJoint, NeverExplodes) {
    for (const double spin : {100.0, 200.0, 400.0, 1000.0})
        for (const int substeps : {1, 2, 4, 8})
            for (const double radius : {0.05, 0.2})
                EXPECT_LT(spinning_loss(ball(radius), 0.5, spin, substeps, 2), 5.0)
                    << spin << " rad/s, " << substeps << " substeps, radius " << radius;
}

TEST(DoublePendulum, KeepsItsEnergyForAMinute) {
    World world = world_of(8, true);
    const Shape rod = block({0.5, 0.05, 0.05});
    const BodyId upper = world.add_body(dynamic_body(rod, 1, {0.5, 0, 0}));
    const BodyId lower = world.add_body(dynamic_body(rod, 1, {1.5, 0, 0}));
    join(world, {}, upper, V{0});
    join(world, upper, lower, {1, 0, 0});
    const double depth = gravity * (0.5 + 1.5); // J, from level to hanging
    EXPECT_LT(largest(world, 60, [&] { return world.energy() / depth; }), 2e-3);
}

TEST(Pendulum, KeepsItsEnergyForAMinute) {
    for (const double degrees : {20.0, 60.0, 90.0, 150.0})
        for (const int substeps : {4, 8}) {
            World world = world_of(substeps, true);
            const double angle = degrees * pi / 180;
            BodyDef def = dynamic_body(ball(0.1), 1, {std::sin(angle), -std::cos(angle), 0});
            join(world, {}, world.add_body(def), V{0});
            const double before = world.energy();
            const double swing = gravity * (1 - std::cos(angle));
            EXPECT_LT(largest(world, 60, [&] { return (world.energy() - before) / swing; }), 3e-4)
                << degrees << " degrees, " << substeps << " substeps";
        }
}

// Balls on arms released level: the joints' forces turn them faster than any of these substeps can
// follow.
TEST(ChainsOfSmallBalls, StayFiniteAndGainNothing) {
    for (const int count : {2, 5, 20})
        for (const double radius : {0.02, 0.05, 0.1})
            for (const int substeps : {2, 4}) {
                World world = world_of(substeps, true);
                BodyId before{};
                for (int i = 0; i < count; ++i) {
                    BodyDef def = dynamic_body(ball(radius), 1, {0.5 * (i + 1), 0, 0});
                    def.colliders[0].filter = {0, 1};
                    const BodyId next = world.add_body(def);
                    join(world, before, next, {i == 0 ? 0.0 : 0.5 * i + 0.25, 0, 0});
                    before = next;
                }
                const double depth = gravity * 0.5 * count * (count + 1) / 2;
                const double gained =
                    largest(world, 5, [&] { return std::max(world.energy(), 0.0) / depth; });
                EXPECT_LT(gained, 0.05) << count << " balls of " << radius << ", " << substeps;
            }
}

TEST(Nets, HangFromTwoCornersAndStayFinite) {
    for (const int count : {10, 20}) {
        World world = world_of(4, true);
        std::vector<BodyId> balls;
        for (int i = 0; i < count * count; ++i) {
            BodyDef def = dynamic_body(ball(0.1), 1, {0.5 * (i % count), 0, 0.5 * (i / count)});
            def.colliders[0].filter = {0, 1};
            balls.push_back(world.add_body(def));
        }
        for (int i = 0; i < count * count; ++i) {
            const V at = position_of(world, balls[std::size_t(i)]);
            if (i % count + 1 < count)
                join(world, balls[std::size_t(i)], balls[std::size_t(i) + 1], at + V{0.25, 0, 0});
            if (i / count + 1 < count)
                join(world, balls[std::size_t(i)], balls[std::size_t(i + count)],
                     at + V{0, 0, 0.25});
        }
        join(world, {}, balls[0], V{0});
        join(world, {}, balls[std::size_t(count) - 1], {0.5 * (count - 1), 0, 0});
        EXPECT_LT(largest(world, 4, [&] { return world.measure().max_joint_drift; }), 0.25)
            << count;
    }
}

// A joint that cannot hold, as one end moves away, is stretched but does not explode.
TEST(AChainOutOfReach, StaysFinite) {
    for (const int links : {1, 2, 5})
        for (const double speed : {0.1, 0.5, 5.0})
            for (const int substeps : {1, 4}) {
                World world = world_of(substeps, true);
                BodyDef leaving = dynamic_body(block(V{0.1}), 1, {0.5 * links, 0, 0});
                leaving.kind = BodyKind::kinematic;
                leaving.mass.reset();
                leaving.velocity = narrow(V{speed, 0, 0});
                const BodyId end = world.add_body(leaving);
                BodyId before{};
                for (int i = 0; i < links; ++i) {
                    const BodyId next =
                        world.add_body(dynamic_body(block({0.2, 0.1, 0.1}), 2, {0.5 * i, 0, 0}));
                    join(world, before, next, {i == 0 ? -0.2 : 0.5 * i - 0.25, 0, 0});
                    before = next;
                }
                join(world, before, end, {0.5 * links - 0.25, 0, 0});
                const double fastest = largest(world, 5, [&] {
                    double most = 0;
                    for (const Motion &motion : world.motions())
                        most = std::max(most, glm::length(wide(motion.velocity)));
                    return most;
                });
                EXPECT_LT(fastest, 100) << links << " links, " << speed << " m/s, " << substeps;
            }
}

// Links of a hung chain, pulled as a hand pulls: up to a thousand times their weight.
TEST(AGrab, CannotBreakTheWorld) {
    Random random(11);
    for (int trial = 0; trial < 40; ++trial) {
        World world = world_of(4, true);
        const Shape link = trial % 2 == 0 ? Shape{upright_capsule(0.1, 0.05)} : Shape{ball(0.08)};
        std::vector<BodyId> links;
        BodyId before{};
        for (int i = 0; i < 8; ++i) {
            BodyDef def = dynamic_body(link, i == 7 ? 10 : 1, {0, 3 - 0.4 * i, 0});
            def.colliders[0].filter = {0, 1};
            links.push_back(world.add_body(def));
            join(world, before, links.back(), {0, 3.2 - 0.4 * i, 0});
            before = links.back();
        }
        const BodyId held = links[random.next_index(8)];
        const V aim = any_vector(random, 1);
        world.grab(held, Vec3{Real(0)}, motion_of(world, held).position, Real(10000));
        const double reach = trial < 20 ? 10 : 15;
        for (int step = 0; step < 120; ++step) {
            const double share = std::min(step / 30.0, 1.0);
            world.move_grab(narrow(V{0, 1.5, 0} + share * reach * aim / glm::length(aim)));
            world.step(nullptr);
            ASSERT_TRUE(world.report().finite) << "drag " << trial << ", step " << step;
        }
        world.release();
        run(world, 120);
        EXPECT_TRUE(world.report().finite) << trial;
        EXPECT_LT(world.measure().kinetic_energy, 1e5) << trial;
    }
}

// A row of balls on ball joints of 1 m; how high the last one rises first (degrees) when `raised`
// of them are let go at 30 degrees.
double first_rise(int count, int raised, double gap, int substeps) {
    World world = world_of(substeps, true);
    const double angle = pi / 6, pitch = 0.2 + gap;
    std::vector<BodyId> balls;
    for (int i = 0; i < count; ++i) {
        const double turn = i < raised ? angle : 0;
        const V hook{i * pitch, 1, 0};
        balls.push_back(world.add_body(with_material(
            dynamic_body(ball(0.1), 4, hook - V{std::sin(turn), std::cos(turn), 0}), 0, 1)));
        join(world, {}, balls.back(), hook);
    }
    double most = 0;
    for (int step = 0; step < 90; ++step) {
        world.step(nullptr);
        const V last = position_of(world, balls.back());
        most = std::max(most, std::atan2(last.x - (count - 1) * pitch, 1 - last.y) * 180 / pi);
    }
    return most;
}

// Impacts account for the joints of the bodies they hit: otherwise each would lose I / (m l^2) of
// its speed.
TEST(Cradles, HandOnTheirSpeedAtAnySubsteps) {
    for (const int count : {5, 9})
        for (const int raised : {1, 2, 3})
            for (const double gap : {0.0, 0.01})
                for (const int substeps : {4, 8, 16})
                    EXPECT_NEAR(first_rise(count, raised, gap, substeps), 30, 0.1)
                        << count << " balls, " << raised << " raised, gaps of " << gap << ", "
                        << substeps << " substeps";
}

// A beam of four parts welded to the world: it is one beam.
TEST(AWeldedBeam, HardlySags) {
    World world = world_of(4, true);
    BodyId before{};
    for (int i = 0; i < 4; ++i) {
        const BodyId next =
            world.add_body(dynamic_body(block({0.25, 0.05, 0.1}), 2, {0.25 + 0.5 * i, 2, 0}));
        JointDef joint;
        joint.type = JointType::fixed;
        joint.a = before;
        joint.b = next;
        joint.anchor_a_local = narrow(i == 0 ? V{0, 2, 0} : V{0.25, 0, 0});
        joint.anchor_b_local = narrow(V{-0.25, 0, 0});
        world.add_joint(joint);
        before = next;
    }
    EXPECT_LT(largest(world, 5, [&] { return position_of(world, before).y - 2; }), 5e-4);
}

TEST(FreeSpin, AboutTheMiddleAxisKeepsEnergyAndMomentumAtAnySubsteps) {
    for (const int substeps : {1, 4, 16, 32}) {
        World world = world_of(substeps, false);
        BodyDef def = dynamic_body(block({0.25, 0.15, 0.05}), 1, V{0});
        def.angular_velocity = narrow(V{0.01, 4, 0.01});
        world.add_body(def);
        const Measures before = world.measure();
        const double energy = before.energy();
        EXPECT_LT(largest(world, 60, [&] { return world.energy() / energy - 1; }), 1e-4)
            << substeps;
        EXPECT_LT(glm::distance(world.measure().angular_momentum, before.angular_momentum),
                  1e-4 * glm::length(before.angular_momentum))
            << substeps;
    }
}

// Which of a joint's two bodies is the world does not matter.
TEST(SoftStep, AJointMayNameTheWorldSecond) {
    const auto hung = [](bool world_first) {
        World world("soft_step", settings_for("soft_step"));
        const BodyId ball_id = world.add_body(dynamic_body(ball(0.1), 1, V{1, 0, 0}));
        JointDef joint;
        (world_first ? joint.b : joint.a) = ball_id;
        (world_first ? joint.anchor_b_local : joint.anchor_a_local) = narrow(V{-1, 0, 0});
        world.add_joint(joint);
        run(world, 60);
        return wide(world.motions()[ball_id.index].position);
    };
    EXPECT_LT(glm::length(hung(true) - hung(false)), 1e-5);
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
