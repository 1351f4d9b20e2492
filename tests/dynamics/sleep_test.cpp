// Resting bodies fall asleep and cost nothing; touching, moving or removing them wakes them; and
// nothing that still moves is put to sleep.
#include "tests/dynamics/worlds.h"

#include <functional>
#include <optional>
#include <variant>

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace trial;

World floor_world(const StepSettings &settings = settings_for("soft_step")) {
    World world("soft_step", settings);
    world.add_body(ground(0.6, 0));
    return world;
}

BodyId add_box(World &world, const V &position, double mass = 1) {
    return world.add_body(with_material(dynamic_body(block(V{0.5}), mass, position), 0.6, 0));
}

// A stack of boxes, lowest first.
std::vector<BodyId> add_stack(World &world, int boxes, double x) {
    std::vector<BodyId> ids;
    for (int i = 0; i < boxes; ++i)
        ids.push_back(add_box(world, V{x, 0.5 + i, 0}));
    return ids;
}

bool sleeps(const World &world, BodyId id) {
    return world.state().paces[id.index].is_asleep();
}

bool run_until_all_sleep(World &world, double seconds) {
    for (int i = 0; i < int(seconds / world.settings().dt) && !all_sleep(world); ++i)
        world.step(nullptr);
    return all_sleep(world);
}

TEST(Sleep, WhatRestsIsNotSteppedAnyMore) {
    World world = floor_world();
    const std::vector<BodyId> boxes = add_stack(world, 5, 0);
    const BodyId ball_id =
        world.add_body(with_material(dynamic_body(ball(0.3), 2, V{5, 0.3, 0}), 0.6, 0));
    ASSERT_TRUE(run_until_all_sleep(world, 10));
    const std::vector<Motion> before = world.state().motions;
    run(world, 600);
    EXPECT_EQ(world.report().moving_bodies, 0U);
    EXPECT_EQ(world.report().pairs, 0U);
    EXPECT_EQ(world.report().constraint_passes, 0U);
    EXPECT_EQ(world.report().body_passes, 0U);
    for (const BodyId id : {boxes.front(), boxes.back(), ball_id}) {
        EXPECT_EQ(position_of(world, id), wide(before[id.index].position));
        EXPECT_EQ(velocity_of(world, id), V{0});
    }
    // But everything can still be queried.
    EXPECT_EQ(world.contacts().size(), 6U);
    EXPECT_GT(world.measure().max_penetration, 0);
    EXPECT_LT(world.measure().max_penetration, world.settings().substep_tolerance);
    EXPECT_EQ(world.measure().kinetic_energy, 0);
}

// Tall ones too: contacts stop the swaying, although one pass does not balance all loads.
TEST(Sleep, TallStacksAndPyramidsComeToRest) {
    for (const int boxes : {5, 10, 15, 20, 25, 40, 60}) {
        World world = floor_world();
        add_stack(world, boxes, 0);
        EXPECT_TRUE(run_until_all_sleep(world, boxes > 40 ? 60 : 10)) << boxes;
        EXPECT_LT(world.measure().max_penetration, world.settings().substep_tolerance) << boxes;
    }
    for (const int base : {10, 20, 25, 30, 40}) {
        World world = floor_world();
        for (int row = 0; row < base; ++row)
            for (int i = 0; i < base - row; ++i)
                add_box(world, V{1.05 * (i - 0.5 * (base - row - 1)), 0.5 + row, 0});
        EXPECT_TRUE(run_until_all_sleep(world, base > 30 ? 20 : 6)) << base;
    }
}

// At any size, gravity and dt: the rounding left in velocities grows with positions and rates.
TEST(Sleep, StacksOfAnySizeComeToRestAtAnyDt) {
    for (const double side : {0.05, 1.0, 20.0})
        for (const double pull : {0.5, 9.81, 100.0})
            for (const double rate : {30.0, 240.0, 1000.0}) {
                StepSettings settings = settings_for("soft_step");
                settings.gravity = V{0, -pull, 0};
                settings.dt = 1 / rate;
                World world = floor_world(settings);
                for (int i = 0; i < 6; ++i)
                    world.add_body(with_material(
                        dynamic_body(block(V{0.5 * side}), 1, V{0, (i + 0.5) * side, 0}), 0.6, 0));
                EXPECT_TRUE(run_until_all_sleep(world, 4 + 5 * std::sqrt(side / pull)))
                    << side << ", " << pull << ", " << rate;
            }
}

// Sleeping moves nothing by more than 0.1 mm.
TEST(Sleep, ChangesNothingThatCanBeSeen) {
    StepSettings settings = settings_for("soft_step");
    World sleeping = floor_world(settings);
    settings.sleep_after = 0;
    World awake = floor_world(settings);
    for (World *world : {&sleeping, &awake}) {
        add_stack(*world, 10, 0);
        add_stack(*world, 3, 3);
        world->add_body(with_material(
            dynamic_body(Capsule{narrow(V{-0.5, 0, 0}), narrow(V{0.5, 0, 0}), Real(0.3)}, 1,
                         V{6, 0.4, 0}),
            0.6, 0));
        run(*world, 60 * 30);
    }
    EXPECT_TRUE(all_sleep(sleeping));
    EXPECT_FALSE(all_sleep(awake));
    for (std::size_t i = 0; i < awake.motions().size(); ++i)
        EXPECT_LT(glm::length(wide(sleeping.motions()[i].position - awake.motions()[i].position)),
                  1e-4)
            << i;
}

// Each of these wakes the stack it concerns, in the same step, and no other.
TEST(Sleep, WhatTouchesMovesOrLeavesAnIslandWakesIt) {
    struct Waking {
        const char *name;
        std::function<void(World &, std::span<const BodyId>)> act;
        double within; // s, until the stack is awake
    };
    const std::vector<Waking> all{
        {"a ball strikes it",
         [](World &world, std::span<const BodyId>) {
             world.add_body(dynamic_body(ball(0.3), 1, V{-3, 2.5, 0}, V{10, 0, 0}));
         },
         0.5},
        {"a ball strikes it fast",
         [](World &world, std::span<const BodyId>) {
             world.add_body(dynamic_body(ball(0.1), 1, V{-10, 2.5, 0}, V{300, 0, 0}));
         },
         0.1},
        {"an impulse",
         [](World &world, std::span<const BodyId> boxes) {
             world.apply_impulse(boxes[2], narrow(V{0.1, 0, 0}),
                                 world.motions()[boxes[2].index].position);
         },
         0.02},
        {"its lowest is removed",
         [](World &world, std::span<const BodyId> boxes) { world.remove_body(boxes[0]); }, 0.02},
        {"its middle is moved away",
         [](World &world, std::span<const BodyId> boxes) {
             world.set_motion(boxes[2], {narrow(V{3, 5, 3}), identity_rotation}, Vec3{Real(0)},
                              Vec3{Real(0)});
         },
         0.02},
        {"something fixed is put into it",
         [](World &world, std::span<const BodyId>) {
             world.add_body(static_body(block(V{0.5}), V{0.8, 2.5, 0}));
         },
         0.02},
        {"something driven comes",
         [](World &world, std::span<const BodyId>) {
             BodyDef pusher = static_body(block(V{0.5}), V{-1.5, 1.5, 0});
             pusher.kind = BodyKind::kinematic;
             pusher.velocity = narrow(V{1, 0, 0});
             world.add_body(pusher);
         },
         1},
        {"a joint",
         [](World &world, std::span<const BodyId> boxes) {
             JointDef joint;
             joint.type = JointType::ball;
             joint.a = boxes[4];
             joint.anchor_b_local = narrow(V{0, 6, 0});
             world.add_joint(joint);
         },
         0.02},
        {"a grab",
         [](World &world, std::span<const BodyId> boxes) {
             world.grab(boxes[4], Vec3{Real(0)}, narrow(V{0, 8, 0}), Real(100));
         },
         0.02},
    };
    for (const Waking &waking : all) {
        World world = floor_world();
        const std::vector<BodyId> boxes = add_stack(world, 5, 0);
        const std::vector<BodyId> others = add_stack(world, 5, 100);
        ASSERT_TRUE(run_until_all_sleep(world, 10));
        waking.act(world, boxes);
        bool woke = false;
        for (int i = 0; i < int(waking.within * 60) + 1 && !woke; ++i) {
            world.step(nullptr);
            woke = true;
            for (const BodyId id : boxes)
                woke = woke && (!world.is_alive(id) || !sleeps(world, id));
        }
        EXPECT_TRUE(woke) << waking.name;
        run(world, 5);
        const bool all_wake = std::string_view(waking.name) == "something fixed is put into it";
        if (!all_wake) {
            EXPECT_TRUE(sleeps(world, others.front())) << waking.name;
        }
    }
}

TEST(Sleep, OtherLawsWakeAll) {
    World world = floor_world();
    const std::vector<BodyId> boxes = add_stack(world, 3, 0);
    ASSERT_TRUE(run_until_all_sleep(world, 10));
    StepSettings settings = world.settings();
    settings.gravity = {5, 0, 0};
    world.set_settings(settings);
    run(world, 60);
    EXPECT_NEAR(velocity_of(world, boxes[1]).x, 5, 0.2);
}

// The same impact on a stack that slept and on one that never did.
TEST(Sleep, WhatWakesGoesOnAsIfItHadNotSlept) {
    StepSettings settings = settings_for("soft_step");
    for (const double speed : {2.0, 10.0, 40.0}) {
        std::vector<V> tops, momenta;
        for (const double sleep_after : {0.5, 0.0}) {
            settings.sleep_after = sleep_after;
            World world = floor_world(settings);
            const std::vector<BodyId> boxes = add_stack(world, 3, 0);
            run(world, 300);
            ASSERT_EQ(all_sleep(world), sleep_after > 0);
            world.add_body(with_material(
                dynamic_body(ball(0.3), 1, V{-1.5, 2.5, 0}, V{speed, 0, 0}), 0.6, 0.5));
            run(world, int(60 * 1.2 / speed) + 3);
            tops.push_back(velocity_of(world, boxes[2]));
            momenta.push_back(world.measure().linear_momentum);
        }
        EXPECT_GT(glm::length(tops[0]), 0.1);
        EXPECT_LT(glm::length(tops[0] - tops[1]), 0.02 * speed) << speed;
        EXPECT_LT(glm::length(momenta[0] - momenta[1]), 0.02 * speed) << speed;
    }
}

// All of these move, slowly; a coarser threshold would stop them.
TEST(Sleep, WhatMovesSlowlyStaysAwake) {
    { // Without gravity everything drifts on forever.
        World world("soft_step", weightless(settings_for("soft_step")));
        const BodyId id = world.add_body(dynamic_body(block(V{0.5}), 1, V{0}, V{1e-5, 0, 0}));
        run(world, 600);
        EXPECT_NEAR(position_of(world, id).x, 1e-4, 1e-8);
    }
    { // A slope 0.05 degrees steeper than the friction angle.
        const double angle = std::atan(0.5) + 0.05 * pi / 180;
        const double a = gravity * (std::sin(angle) - 0.5 * std::cos(angle));
        const V normal{-std::sin(angle), std::cos(angle), 0};
        StepSettings settings = settings_for("soft_step");
        for (const double rate : {60.0, 1000.0}) {
            settings.dt = 1 / rate;
            std::vector<V> ends;
            for (const double sleep_after : {0.5, 0.0}) {
                settings.sleep_after = sleep_after;
                World world("soft_step", settings);
                world.add_body(ground(0.5, 0, normal));
                BodyDef box = with_material(dynamic_body(block(V{0.5}), 1, 0.5 * normal), 0.5, 0);
                box.pose.rotation = narrow(glm::angleAxis(angle, V{0, 0, 1}));
                const BodyId id = world.add_body(box);
                run(world, static_cast<int>(10 * rate));
                ends.push_back(position_of(world, id));
            }
            EXPECT_EQ(ends[0], ends[1]) << rate;
            EXPECT_NEAR(glm::length(ends[0] - 0.5 * normal), 0.5 * a * 100, 0.1 * 0.5 * a * 100)
                << rate;
        }
    }
    { // A pendulum swinging by a hundredth of a degree.
        World world("soft_step", settings_for("soft_step"));
        const double swing = 0.01 * pi / 180;
        JointDef joint;
        joint.type = JointType::ball;
        joint.b = world.add_body(
            dynamic_body(ball(0.1), 1, V{10 * std::sin(swing), -10 * std::cos(swing), 0}));
        joint.anchor_b_local = narrow(V{-10 * std::sin(swing), 10 * std::cos(swing), 0});
        world.add_joint(joint);
        run(world, 60 * 30);
        double fastest = 0;
        for (int i = 0; i < 600; ++i) {
            run(world, 1);
            fastest = std::max(fastest, glm::length(velocity_of(world, joint.b)));
        }
        EXPECT_NEAR(fastest, swing * std::sqrt(gravity * 10), 0.05 * fastest);
    }
}

// A figure that stands with its feet at y = 0, turned about the x axis by `turn` and lifted:
// hinges at knees, elbows and waist, within limits.
struct Figure {
    World world = floor_world();
    std::vector<BodyId> parts;
    glm::dquat turn;
    V feet;

    std::size_t add(const Shape &shape, double mass, const V &at) {
        BodyDef def = with_material(dynamic_body(shape, mass, feet + turn * at), 0.6, 0);
        def.pose.rotation = narrow(turn);
        // A round head would spin forever between its neck and the floor: nothing brakes it.
        def.angular_damping = Real(is_round(shape) ? 5 : 0);
        parts.push_back(world.add_body(def));
        return parts.size() - 1;
    }
    static bool is_round(const Shape &shape) { return std::holds_alternative<Sphere>(shape); }
    void join(std::size_t a, std::size_t b, const V &anchor, std::optional<JointLimits> limits) {
        JointDef joint;
        joint.type = limits ? JointType::hinge : JointType::ball;
        joint.a = parts[a];
        joint.b = parts[b];
        joint.limits = limits;
        const auto local = [&](BodyId id) {
            return narrow(glm::conjugate(turn) * (feet + turn * anchor - position_of(world, id)));
        };
        joint.anchor_a_local = local(joint.a);
        joint.anchor_b_local = local(joint.b);
        world.add_joint(joint);
    }
    Figure(double about_x, double height)
        : turn(glm::angleAxis(about_x, V{1, 0, 0})), feet(V{0, height, 0}) {
        const std::size_t torso = add(block(V{0.15, 0.25, 0.1}), 30, V{0, 1.40, 0});
        const std::size_t pelvis = add(block(V{0.14, 0.1, 0.1}), 15, V{0, 1.03, 0});
        join(torso, pelvis, V{0, 1.14, 0}, JointLimits{Real(-0.5), Real(0.5)});
        join(torso, add(ball(0.1), 5, V{0, 1.77, 0}), V{0, 1.66, 0}, {});
        for (const double side : {-1.0, 1.0}) {
            const double arm = 0.22 * side;
            const double leg = 0.09 * side;
            const std::size_t upper = add(upright_capsule(0.12, 0.05), 3, V{arm, 1.5, 0});
            join(torso, upper, V{0.2 * side, 1.64, 0}, {});
            join(upper, add(upright_capsule(0.12, 0.04), 2, V{arm, 1.17, 0}), V{arm, 1.335, 0},
                 JointLimits{Real(-2.3), Real(0)});
            const std::size_t thigh = add(upright_capsule(0.17, 0.07), 8, V{leg, 0.69, 0});
            join(pelvis, thigh, V{leg, 0.93, 0}, {});
            join(thigh, add(upright_capsule(0.17, 0.06), 5, V{leg, 0.23, 0}), V{leg, 0.46, 0},
                 JointLimits{Real(0), Real(2.3)});
        }
    }
};

// A jointed figure on the ground, with light parts below heavy ones: joints and contacts do not
// undo each other's work.
TEST(Sleep, AFigureThatFallsStaysWholeAndSleeps) {
    for (const double turn : {-0.5 * pi, 0.5 * pi, 0.4 * pi}) {
        Figure figure(turn, 0.6);
        World &world = figure.world;
        double apart = 0;
        for (int step = 0; step < 600 && !all_sleep(world); ++step) {
            world.step(nullptr);
            for (std::uint32_t i = 0; i < world.joints().size(); ++i)
                apart = std::max(apart, double(world.joint_errors(i).linear));
        }
        EXPECT_TRUE(all_sleep(world)) << turn;
        EXPECT_LT(apart, 1e-4) << turn;
    }
}

// A ball's spin moves no surface that anything could touch, but must still be kept.
TEST(Sleep, ABallThatSpinsStaysAwake) {
    for (const double radius : {0.01, 0.5, 10.0})
        for (const double speed : {0.1, 20.0}) { // of its surface, in radii
            World world("soft_step", settings_for("soft_step"));
            world.add_body(ground(0, 0));
            const BodyId id = world.add_body(dynamic_body(ball(radius), 1, V{0, radius, 0}));
            world.set_motion(id, world.pose_of(id.index), Vec3{Real(0)}, narrow(V{0, speed, 0}));
            run(world, 180);
            EXPECT_NEAR(spin_of(world, id).y, speed, 1e-4 * speed) << radius << ", " << speed;
        }
}

// Sleep is part of the state: a world saved asleep, or rebuilt from its readable state, continues
// bit for bit.
TEST(Sleep, IsSaved) {
    World world = floor_world();
    const std::vector<BodyId> boxes = add_stack(world, 4, 0);
    const BodyId striker = world.add_body(
        with_material(dynamic_body(ball(0.3), 1, V{-60, 10, 0}, V{25, 8.65, 0}), 0.6, 0.3));
    std::vector<SavedWorld> saves;
    std::vector<std::uint64_t> hashes;
    bool slept = false, woke = false;
    for (int i = 0; i < 600; ++i) {
        if (i % 20 == 0)
            world.save(saves.emplace_back());
        world.step(nullptr);
        slept = slept || sleeps(world, boxes[0]);
        woke = woke || (slept && !sleeps(world, boxes[0]));
        hashes.push_back(world.hash());
    }
    ASSERT_TRUE(slept && woke) << "the ball at " << position_of(world, striker).x;
    for (std::size_t k = saves.size(); k-- > 0;) {
        world.restore(saves[k]);
        for (std::size_t i = 20 * k; i < std::min<std::size_t>(20 * k + 45, hashes.size()); ++i) {
            world.step(nullptr);
            if (i % 3 == 0)
                world.measure(); // reads sleeping bodies, and must have no side effects
            ASSERT_EQ(world.hash(), hashes[i]) << k << ' ' << i;
        }
    }
}

// What never moves does not sleep, whatever is said of it.
TEST(Sleep, IsForDynamicBodies) {
    World world = floor_world();
    const BodyId box = add_box(world, V{0, 0.5, 0});
    for (const BodyId id : {world.body_id(0), box}) {
        Pace pace;
        pace.rested = Pace::asleep;
        world.set_pace(id, pace);
        EXPECT_EQ(sleeps(world, id), id == box);
    }
}

// What hangs on a spring from a body that is removed falls.
TEST(Sleep, WhatHangsOnASpringWakesWhenItsHookIsRemoved) {
    for (const bool moves : {false, true}) {
        World world("soft_step", settings_for("soft_step"));
        BodyDef hook = static_body(ball(0.1), V{0, 3, 0});
        hook.kind = moves ? BodyKind::kinematic : BodyKind::static_body;
        SpringDef spring;
        spring.a = {SpringEnd::Kind::body, world.add_body(hook).index, {}};
        const BodyId hung = add_box(world, V{0, 2, 0});
        spring.b = {SpringEnd::Kind::body, hung.index, narrow(V{0, 0.5, 0})};
        spring.rest_length = Real(0.3);
        spring.stiffness = Real(100);
        spring.damping = Real(15);
        world.add_spring(spring);
        ASSERT_TRUE(run_until_all_sleep(world, 20));
        const double before = position_of(world, hung).y;
        world.remove_body(world.body_id(spring.a.index));
        run(world, 60);
        EXPECT_NEAR(position_of(world, hung).y, before - gravity / 2, 0.02);
    }
}

// A body that went elsewhere while it was alone, and slept there, is found there by what comes.
TEST(Sleep, WhatMovedWhileItWasAloneIsMetWhereItIs) {
    World world("soft_step", settings_for("soft_step"));
    JointDef rail;
    rail.type = JointType::slider;
    BodyDef def = dynamic_body(block(V{0.5}), 1, V{0});
    def.linear_damping = Real(3);
    rail.b = world.add_body(def);
    world.add_joint(rail);
    const BodyId other = world.add_body(dynamic_body(ball(0.1), 1, V{0, 0, 5})); // falls for ever
    run(world, 60);
    ASSERT_TRUE(sleeps(world, rail.b));
    world.remove_body(other);
    world.apply_impulse(rail.b, narrow(V{15, 0, 0}), Vec3{Real(0)});
    ASSERT_TRUE(run_until_all_sleep(world, 20));
    EXPECT_NEAR(position_of(world, rail.b).x, 5, 0.1);
    const BodyId fallen = world.add_body(dynamic_body(ball(0.2), 1, V{5, 1, 0}));
    run(world, 120);
    EXPECT_NEAR(position_of(world, fallen).y, 0.7, 1e-3);
}

// A body driven by a motor does not sleep, however slow it is.
TEST(Sleep, AMotorKeepsAwake) {
    World world("soft_step", settings_for("soft_step"));
    JointDef joint;
    joint.type = JointType::hinge;
    joint.b = world.add_body(dynamic_body(block(V{0.5}), 1000, V{0}));
    joint.motor = JointMotor{Real(1), Real(0.5)};
    world.add_joint(joint);
    run(world, 600);
    EXPECT_FALSE(sleeps(world, joint.b));
    EXPECT_NEAR(glm::length(spin_of(world, joint.b)), 0.5 * 10 / (1000.0 / 6), 1e-3);
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
