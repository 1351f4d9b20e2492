// Each island takes as many substeps as its own loads need.
#include "tests/dynamics/worlds.h"

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace trial;

constexpr double cube_side = 1;

BodyId add_box(World &world, double mass, const V &position) {
    return world.add_body(
        with_material(dynamic_body(block(V{0.5 * cube_side}), mass, position), 0.6, 0));
}

BodyId add_stack(World &world, std::span<const double> masses, double x) {
    BodyId top;
    double height = 0.5 * cube_side;
    for (const double mass : masses) {
        top = add_box(world, mass, V{x, height, 0});
        height += cube_side;
    }
    return top;
}

World bare_floor() {
    World world("soft_step", settings_for("soft_step"));
    world.add_body(ground(0.6, 0));
    return world;
}

TEST(Islands, SubstepsAreRoundedToThreeBinaryDigits) {
    int last = 1;
    for (int n = 1; n < 5000; ++n) {
        const int up = round_substeps_up(n), down = round_substeps_down(n);
        ASSERT_LE(down, n);
        ASSERT_GE(up, n);
        ASSERT_LE(up, 1.25 * n + 1);
        ASSERT_EQ(round_substeps_up(up), up);
        if (up != last) {
            ASSERT_EQ(fewer_substeps(up), last) << up;
        }
        last = up;
    }
}

// A stack of 60 at four substeps falls within 5 s (Rest.ATallStackStandsOnKeptContacts); deep in
// the tolerance, it sinks by a part of a millimetre at each contact.
TEST(Islands, ATallStackTakesWhatItNeedsAndStands) {
    for (const std::size_t boxes : {10U, 30U, 60U}) {
        World world = bare_floor();
        const std::vector<double> masses(boxes, 1.0);
        const BodyId top = add_stack(world, masses, 0);
        run(world, 60 * 30);
        const double n = double(boxes);
        EXPECT_GT(double(world.motions()[top.index].position.y), (n - 0.5) * cube_side - 0.01)
            << boxes;
        const Measures m = world.measure();
        EXPECT_LT(m.kinetic_energy, 1e-6 * n * gravity * cube_side * n / 2) << boxes;
        EXPECT_LT(m.max_penetration, world.settings().substep_tolerance * cube_side) << boxes;
    }
}

TEST(Islands, ALightBoxBearsAHeavyOne) {
    for (const double ratio : {30.0, 100.0, 300.0, 1000.0, 3000.0}) {
        World world = bare_floor();
        const BodyId heavy = add_stack(world, std::array{1.0, ratio}, 0);
        run(world, 60 * 30);
        // Where even the maximum is too few, the depth grows with the load.
        const double depth =
            world.settings().substep_tolerance * cube_side * std::max(1.0, ratio / 400);
        EXPECT_LT(world.measure().max_penetration, depth) << ratio;
        EXPECT_NEAR(double(world.motions()[heavy.index].position.y), 1.5 * cube_side, 2 * depth);
    }
}

// Only islands that need substeps pay for them, and only while they need them.
TEST(Islands, TakeTheirOwnSubsteps) {
    World world = bare_floor();
    StepSettings settings = world.settings();
    settings.sleep_after = 0; // sleeping bodies keep their number
    world.set_settings(settings);
    const BodyId alone = add_box(world, 1, V{-5, 0.5, 0});
    const BodyId flying = add_box(world, 1, V{-10, 50, 0});
    const BodyId heavy = add_stack(world, std::array{1.0, 300.0}, 5);
    run(world, 120);
    const int least = world.settings().substeps;
    EXPECT_EQ(world.substeps_of(alone.index), least);
    EXPECT_EQ(world.substeps_of(flying.index), least);
    EXPECT_GT(world.substeps_of(heavy.index), 8 * least);
    EXPECT_EQ(world.substeps_of(heavy.index), world.substeps_of(heavy.index - 1));
    world.remove_body(heavy);
    run(world, 120);
    EXPECT_LE(world.substeps_of(heavy.index - 1), least + 1); // a falling count keeps some spare
}

// The budget bounds the total cost of all islands, but takes none below the minimum. The smaller
// island gets what it needs first.
TEST(Islands, KeepToTheBudget) {
    World alone = bare_floor();
    World world = bare_floor();
    StepSettings settings = world.settings();
    settings.sleep_after = 0; // sleeping bodies take no substeps
    const BodyId only = add_stack(alone, std::vector<double>(10, 1.0), 0);
    const BodyId top = add_stack(world, std::vector<double>(10, 1.0), 0);
    const BodyId heavy = add_stack(world, std::array{1.0, 1000.0}, 5);
    int last = 0;
    for (const int budget : {0, 30, 100, 200, 400, 8192}) {
        settings.substep_budget = budget;
        for (World *each : {&alone, &world}) {
            each->set_settings(settings);
            run(*each, 60);
        }
        EXPECT_EQ(alone.substeps_of(only.index),
                  std::clamp(round_substeps_down(budget / 10), 4, 16))
            << budget;
        const int of_top = world.substeps_of(top.index), of_heavy = world.substeps_of(heavy.index);
        EXPECT_LE((of_top > 4 ? 10 * of_top : 0) + (of_heavy > 4 ? 2 * of_heavy : 0), budget);
        EXPECT_GE(of_top, 4);
        EXPECT_GE(of_heavy, of_top);
        last = of_heavy;
    }
    EXPECT_GE(last, 48);
}

// A chain hanging at rest with a heavy end stays at rest: no step starts so coarsely that it
// stretches the joints first.
TEST(Islands, AHangingChainWithAHeavyEndStaysAtRest) {
    for (const double ratio : {1.0, 10.0, 100.0, 300.0, 1000.0}) {
        World world("soft_step", settings_for("soft_step"));
        BodyId last;
        for (int i = 0; i < 10; ++i) {
            JointDef joint;
            joint.a = last;
            joint.b = last = world.add_body(
                dynamic_body(ball(i == 9 ? 0.3 : 0.1), i == 9 ? ratio : 1, V{0, -0.5 - i, 0}));
            joint.anchor_a_local = narrow(V{0, i == 0 ? 0 : -0.5, 0});
            joint.anchor_b_local = narrow(V{0, 0.5, 0});
            world.add_joint(joint);
        }
        const double before = world.energy();
        double highest = before;
        for (int i = 0; i < 600; ++i) {
            run(world, 1);
            highest = std::max(highest, world.energy());
        }
        Real drift{0};
        for (std::uint32_t j = 0; j < 10; ++j)
            drift = std::max(drift, world.joint_error(j));
        EXPECT_LT(double(drift), 1e-4) << ratio;
        EXPECT_LT(highest - before, 1e-4 * ratio * gravity) << ratio;
        EXPECT_LT(world.measure().kinetic_energy, 1e-4 * ratio * gravity) << ratio;
    }
}

// Cubes of 0.2 m in a row along x, 8 kg each and `tip` times that at the end, joined to each other
// and to a wall. For hinges and sliders x is the free axis, turned by `frame`.
void expect_beam_holds(JointType type, const glm::dquat &frame, int count, double tip) {
    constexpr double half = 0.1;
    World world("soft_step", settings_for("soft_step"));
    BodyId last;
    JointDef joint;
    joint.type = type;
    joint.frame_a_local = joint.frame_b_local = narrow(frame);
    joint.anchor_b_local = narrow(V{-half, 0, 0});
    for (int i = 0; i < count; ++i) {
        joint.a = last;
        joint.b = last = world.add_body(dynamic_body(block(V{half}), i + 1 == count ? 8 * tip : 8,
                                                     V{half * (2 * i + 1), 0, 0}));
        world.add_joint(joint);
        joint.anchor_a_local = narrow(V{half, 0, 0});
    }
    const double length = 2 * half * count;
    // The joints are softer while the first steps find out their loads.
    constexpr double most_share = 4e-3;
    const auto sag = [&] { return glm::length(position_of(world, last) - V{length - half, 0, 0}); };
    for (int step = 0; step < 180; ++step) {
        run(world, 1);
        ASSERT_LT(sag(), most_share * length) << count << ' ' << tip << ", step " << step;
    }
    const double turn = world.settings().substep_tolerance;
    for (int i = 0; i < count; ++i)
        EXPECT_LT(double(world.joint_errors(std::uint32_t(i)).angular), turn) << count << ' ' << i;
    // The first joint carries most: with weight alone, angles fall with the square of the distance
    // from the tip.
    EXPECT_LT(sag(), (tip > 1 ? 0.5 : 0.25) * count * turn * length) << count << ' ' << tip;
}

const glm::dquat level{1, 0, 0, 0};

TEST(Islands, WeldedBeamsHoldTheirWeight) {
    for (const int count : {5, 14, 20})
        expect_beam_holds(JointType::fixed, level, count, 1);
    expect_beam_holds(JointType::fixed, level, 5, 50);
}

TEST(Islands, BeamsOfHingesAndSlidersHoldTheirWeight) {
    expect_beam_holds(JointType::hinge, glm::angleAxis(pi / 2, V{0, 0, 1}), 12, 1);
    expect_beam_holds(JointType::slider, glm::angleAxis(-pi / 2, V{0, 1, 0}), 12, 1);
}

// A body spinning fast about a joint with a long lever arm turns far in a substep, and with four of
// them loses its energy: more than nine tenths within 5 s at 200 rad/s.
TEST(Islands, WhatSpinsOnAJointKeepsItsEnergy) {
    for (const double spin : {20.0, 50.0, 100.0, 200.0})
        for (const double arm : {0.25, 0.5, 1.0}) {
            World world("soft_step", weightless(settings_for("soft_step")));
            BodyDef def = dynamic_body(ball(0.2), 1, V{arm, 0, 0}, V{0, 0, -spin * arm});
            def.angular_velocity = narrow(V{0, spin, 0});
            JointDef joint;
            joint.b = world.add_body(def);
            joint.anchor_b_local = narrow(V{-arm, 0, 0});
            world.add_joint(joint);
            const double before = world.energy();
            run(world, 300);
            EXPECT_NEAR(world.energy(), before, 2e-3 * before) << spin << ' ' << arm;
            EXPECT_LT(double(world.joint_error(0)), 2e-3 * arm) << spin << ' ' << arm;
        }
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
