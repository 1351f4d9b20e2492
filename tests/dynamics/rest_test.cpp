// Standing bodies come to rest and stay at rest: for long, and at every SIMD width.
#include "tests/dynamics/particles.h"

#include <hwy/highway.h>
#include <hwy/targets.h>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace trial;

constexpr double box_side = 1;

World stack_of(int boxes, const StepSettings &settings) {
    World world("soft_step", settings);
    world.add_body(ground(0.6, 0));
    for (int i = 0; i < boxes; ++i)
        world.add_body(dynamic_body(block(V{box_side / 2}), 1, V{0, box_side * (i + 0.5), 0}));
    return world;
}

World pyramid_of(int base, const StepSettings &settings) {
    World world("soft_step", settings);
    world.add_body(ground(0.6, 0));
    for (int row = 0; row < base; ++row)
        for (int i = 0; i < base - row; ++i)
            world.add_body(dynamic_body(
                block(V{box_side / 2}), 1,
                V{1.05 * box_side * (i - 0.5 * (base - row - 1)), box_side * (row + 0.5), 0}));
    return world;
}

double height_of(const World &world, std::uint32_t body) {
    return double(world.motions()[body].position.y);
}

// The largest tilt of any body's up axis (rad), and the farthest any has moved (m).
struct Strayed {
    double tilt = 0;
    double way = 0;
};
Strayed strayed(const World &now, const World &before) {
    Strayed most;
    for (std::uint32_t i = 0; i < now.bodies().size(); ++i) {
        const V up = wide(now.pose_of(i).rotation) * V{0, 1, 0};
        most.tilt = std::max(most.tilt, std::hypot(up.x, up.z));
        most.way = std::max(most.way, glm::length(wide(now.pose_of(i).position) -
                                                  wide(before.pose_of(i).position)));
    }
    return most;
}

// With one solver pass all of these sway, and a cylinder of h / d = 10 falls within two minutes.
TEST(Rest, WhatIsTallAndThinStands) {
    for (const double sleep_after : {0.0, 0.5})
        for (const double slenderness : {3, 10, 20})
            for (const double radius : {0.02, 0.1, 0.4}) {
                StepSettings settings = settings_for("soft_step");
                settings.sleep_after = sleep_after;
                World world("soft_step", settings);
                world.add_body(ground(0.6, 0));
                const Real half = Real(slenderness * radius);
                const Cylinder shape{Vec3{0, -half, 0}, Vec3{0, half, 0}, Real(radius)};
                world.add_body(dynamic_body(shape, 1000 * pi * std::pow(radius, 3) * slenderness,
                                            V{0, double(half), 0}));
                const World before = world;
                run(world, 150 * 60);
                const Strayed most = strayed(world, before);
                EXPECT_LT(most.tilt, 1e-5) << slenderness << ' ' << radius << ' ' << sleep_after;
                EXPECT_LT(most.way, 1e-3 * radius) << slenderness << ' ' << radius;
                EXPECT_TRUE(sleep_after == 0 || slenderness > 10 || all_sleep(world))
                    << slenderness << ' ' << radius;
            }
}

// With one solver pass they creep by 2 cm in a minute.
TEST(Rest, TablesOnTablesStand) {
    for (const int tables : {2, 4, 8})
        for (const double size : {0.3, 1.0}) {
            World world("soft_step", settings_for("soft_step"));
            world.add_body(ground(0.6, 0));
            for (int i = 0; i < tables; ++i) {
                BodyDef table;
                table.mass = 10;
                table.pose.position = narrow(size * V{0, 0.45 + 0.9 * i, 0});
                const auto add = [&](const V &centre, const V &half) {
                    Box box = block(size * half);
                    box.center = narrow(size * centre);
                    table.colliders.emplace_back().shape = box;
                };
                add({0, 0.4, 0}, {0.5, 0.05, 0.5});
                for (const double x : {-0.4, 0.4})
                    for (const double z : {-0.4, 0.4})
                        add({x, -0.05, z}, {0.05, 0.4, 0.05});
                world.add_body(with_material(table, 0.6, 0));
            }
            const World before = world;
            run(world, 60 * 60);
            EXPECT_LT(strayed(world, before).way, 1e-4) << tables << ' ' << size;
        }
}

// If contacts are found again in each step, a column of soft contacts buckles under its own weight
// once it is taller than N^3 = 7.8 k / (m g): some 15 boxes at four substeps. With kept contacts it
// does not.
TEST(Rest, ATallStackStandsOnKeptContacts) {
    StepSettings settings = settings_for("soft_step");
    settings.substeps = 8;
    for (const int boxes : {20, 30}) {
        World world = stack_of(boxes, settings);
        run(world, 60 * 30);
        const auto top = static_cast<std::uint32_t>(boxes);
        const double sunk = box_side * (boxes - 0.5) - height_of(world, top);
        EXPECT_LT(sunk, 0.04) << boxes;
        EXPECT_LT(world.measure().kinetic_energy, 1e-6 * boxes * gravity * box_side * boxes / 2);
    }
    settings.substeps = 4;
    settings.max_substeps = 1;
    settings.kept_travel = 0;
    World fallen = stack_of(30, settings);
    run(fallen, 60 * 30);
    EXPECT_LT(height_of(fallen, 30), 10) << "found anew in each step it falls";
}

// A substep's soft pass restores half of a load's impulse, and rests where the spring makes up for
// it: m g h / 2 = m_eff h omega^2 depth. Between two boxes the effective mass is half of one's
// mass; against the ground omega is twice the omega h = pi / 4 between them.
TEST(Rest, AStackSinksAsItsSpringsSay) {
    StepSettings settings = settings_for("soft_step");
    settings.max_substeps = 1;
    settings.sleep_after = 0;
    const double h = settings.dt / settings.substeps;
    const double between = gravity * h * h * 16 / (pi * pi);
    const double on_ground = between / 2 / (2 * 2);
    for (const int boxes : {1, 2, 10}) {
        World world = stack_of(boxes, settings);
        run(world, 60 * 10);
        const auto top = static_cast<std::uint32_t>(boxes);
        const double sunk = box_side * (boxes - 0.5) - height_of(world, top);
        const double expected = boxes * on_ground + boxes * (boxes - 1) / 2.0 * between;
        EXPECT_NEAR(sunk, expected, 0.01 * expected) << boxes;
    }
}

// Like large heaps that exceed their substep budget. With contacts found again in each step, a lean
// doubles every second, and cubes alternately offset by a centimetre fall after 12 s.
TEST(Rest, WhatGetsTooFewSubstepsStandsOnContactsKeptLonger) {
    constexpr int count = 60;
    StepSettings settings = settings_for("soft_step");
    settings.substep_budget = 0;
    World world("soft_step", settings);
    world.add_body(ground(0.5, 0));
    for (int i = 0; i < count; ++i)
        world.add_body(dynamic_body(block(V{0.5}), 1000, V{i % 2 == 0 ? -0.01 : 0.01, i + 0.5, 0}));
    run(world, 60 * 30);
    EXPECT_GT(height_of(world, count), count - 0.5 - 0.6);
    EXPECT_LT(world.measure().kinetic_energy, 1e-6 * world.measure().potential_energy);
}

// A body carrying many times its own weight is pushed about by the order in which its corners are
// solved.
TEST(Rest, HeavyOnLightDoesNotWalk) {
    struct Pair {
        V light, heavy; // half extents
        double friction, aside;
    };
    const std::vector<Pair> pairs{{V{0.5}, V{0.5}, 0.5, 0},
                                  {V{0.5}, V{0.3}, 0.25, 0.1},
                                  {V{0.5, 0.2, 0.5}, V{0.5}, 0.8, 0},
                                  {V{0.4, 0.5, 0.6}, V{0.8}, 0.8, 0.1},
                                  {V{0.5, 0.2, 0.5}, V{0.8}, 0.25, 0.1}};
    for (const Pair &pair : pairs)
        for (const double ratio : {0.1, 2.0, 5.0, 8.0, 12.0, 20.0, 60.0, 300.0, 700.0}) {
            World world("soft_step", settings_for("soft_step"));
            world.add_body(ground(pair.friction, 0));
            BodyDef def = dynamic_body(block(pair.light), 1, V{0, pair.light.y, 0});
            world.add_body(with_material(def, pair.friction, 0));
            const V place{pair.aside, 2 * pair.light.y + pair.heavy.y, 0};
            def = dynamic_body(block(pair.heavy), ratio, place);
            const BodyId heavy = world.add_body(with_material(def, pair.friction, 0));
            run(world, 60 * 4);
            const V landed = position_of(world, heavy);
            EXPECT_LT(glm::distance(landed, place), 3e-3) << ratio;
            run(world, 60 * 26);
            EXPECT_LT(glm::distance(position_of(world, heavy), landed), 5e-5) << ratio;
            EXPECT_LT(world.measure().kinetic_energy, 1e-6) << ratio;
        }
}

TEST(Rest, APyramidComesToRest) {
    for (const int base : {10, 20}) {
        World world = pyramid_of(base, settings_for("soft_step"));
        run(world, 60 * 20);
        const Measures m = world.measure();
        EXPECT_LT(m.kinetic_energy, 1e-6 * m.potential_energy) << base;
        EXPECT_LT(m.max_penetration, 3e-3) << base;
    }
}

// Beyond base 40 the budget affords too few substeps for such loads. No part may sway ever more.
TEST(Rest, ALargePyramidCalmsDown) {
    World world = pyramid_of(60, settings_for("soft_step"));
    run(world, 60 * 20);
    const Measures m = world.measure();
    EXPECT_LT(m.kinetic_energy, 1e-7 * m.potential_energy);
}

// Balls in the corners of a tetrahedron, `layers` high, each of the radius 1; the last is the top.
World pile_of_balls(int layers, double friction) {
    World world("soft_step", settings_for("soft_step"));
    world.add_body(ground(friction, 0));
    for (int k = 0; k < layers; ++k)
        for (int i = 0; i < layers - k; ++i)
            for (int j = 0; j < layers - k - i; ++j)
                world.add_body(
                    with_material(dynamic_body(Sphere{{}, 1}, 1,
                                               V{2 * i + j + k, 1 + k * std::sqrt(8.0 / 3),
                                                 std::sqrt(3.0) * j + k / std::sqrt(3.0)}),
                                  friction, 0));
    return world;
}

// Four balls need a friction of tan(a / 2) = sqrt(3) - sqrt(2) = 0.318, where a is the angle
// between the vertical and the line from a lower ball to the top one (sin a = 1 / sqrt(3)). Begun
// with loads far too large, larger piles burst.
TEST(Rest, PilesOfBallsStand) {
    struct Pile {
        int layers;
        double friction;
        bool stands;
    };
    for (const Pile &pile : {Pile{2, 0.31, false}, Pile{2, 0.33, true}, Pile{3, 0.7, true},
                             Pile{4, 1.0, true}, Pile{5, 1.5, true}}) {
        World world = pile_of_balls(pile.layers, pile.friction);
        const auto top = static_cast<std::uint32_t>(world.bodies().size() - 1);
        const double before = height_of(world, top);
        run(world, 60 * 3);
        EXPECT_EQ(before - height_of(world, top) < 0.05, pile.stands)
            << pile.layers << " layers, friction " << pile.friction;
    }
}

// When some points of a contact slide before others hold, the latter must carry more than
// friction's first sweep knew.
TEST(Rest, WhatFrictionHoldsDoesNotCreepDownASlope) {
    for (const double ratio : {0.3, 0.5, 0.7, 0.9}) {
        const double angle = std::atan(0.5 * ratio);
        StepSettings settings = settings_for("soft_step");
        settings.gravity = gravity * V{std::sin(angle), -std::cos(angle), 0};
        World world("soft_step", settings);
        world.add_body(ground(0.5, 0));
        BodyDef box = dynamic_body(block(V{0.5}), 10, V{0, 0.5, 0});
        world.add_body(with_material(box, 0.5, 0));
        run(world, 300);
        // Known failing: the goal of 1e-5 is only met up to nearly half of what friction holds.
        EXPECT_LT(std::abs(double(world.motions()[1].position.x)), 2.1e-5 * ratio) << ratio;
    }
}

// With this many substeps each rotation is less than a quaternion's rounding.
TEST(Rest, AnArchDoesNotCreepHoweverFineItsSubsteps) {
    StepSettings settings = settings_for("soft_step");
    settings.substeps = 64;
    settings.max_substeps = 1;
    settings.sleep_after = 0;
    World world("soft_step", settings);
    add_arch(world);
    run(world, 60 * 20);
    const std::vector<Motion> before(world.motions().begin(), world.motions().end());
    run(world, 60 * 20);
    for (std::size_t i = 0; i < before.size(); ++i)
        EXPECT_LT(glm::distance(wide(before[i].position), wide(world.motions()[i].position)), 2e-5)
            << i;
}

// On a slope a little steeper than friction holds, a box accelerates immediately; nothing is lost
// to corners that have not yet shared out the load.
TEST(Rest, ASlopeJustTooSteepGivesTheClosedFormsWay) {
    for (const double ratio : {1.05, 1.1, 1.5}) {
        const double angle = std::atan(0.5 * ratio);
        StepSettings settings = settings_for("soft_step");
        settings.gravity = gravity * V{std::sin(angle), -std::cos(angle), 0};
        World world("soft_step", settings);
        world.add_body(ground(0.5, 0));
        BodyDef box = dynamic_body(block(V{0.5}), 10, V{0, 0.5, 0});
        world.add_body(with_material(box, 0.5, 0));
        run(world, 240);
        const double way = 0.5 * gravity * (std::sin(angle) - 0.5 * std::cos(angle)) * 16;
        EXPECT_NEAR(double(world.motions()[1].position.x), way, 0.01) << ratio;
    }
}

// The contacts of one colour share no body, nor do the joints of one level, and springs of one
// level share no particle: so neither their order nor the SIMD width matters.
TEST(Rest, EveryWidthOfVectorsGivesTheSameBits) {
    const auto hash_at = [](std::int64_t target) {
        hwy::SetSupportedTargetsForTest(target);
        hwy::GetChosenTarget().Update(hwy::SupportedTargets());
        Random random(11);
        World world("soft_step", settings_for("soft_step"));
        world.add_body(ground(0.6, 0));
        for (int i = 0; i < 150; ++i) {
            const V at{0.7 * (i % 5), 0.4 + 0.8 * (i / 25), 0.7 * (i / 5 % 5)};
            world.add_body(dynamic_body(any_shape(random), random.next_in(0.5, 5), at));
        }
        // One net that a substep can follow, and one too stiff for it.
        for (const double stiffness : {300.0, 3e5})
            add_net(world, {.n = 8,
                            .side = 3,
                            .middle = {1.4, stiffness > 1000 ? 4.0 : 3.0, 1.4},
                            .mass = 1,
                            .stiffness = stiffness,
                            .damping = 0.1});
        add_joined_net(world, 7, {0, 5, 0});
        run(world, 120);
        return world.hash();
    };
    const std::vector<std::int64_t> targets = hwy::SupportedAndGeneratedTargets();
    ASSERT_FALSE(targets.empty());
    const std::uint64_t first = hash_at(targets.front());
    for (const std::int64_t target : targets)
        EXPECT_EQ(hash_at(target), first) << hwy::TargetName(target);
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
