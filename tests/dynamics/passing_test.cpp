// Bodies that pass without touching are let through; obstacles are not tunnelled through.
#include "tests/dynamics/worlds.h"

namespace plumb::inline PLUMB_PRECISION {
namespace {

using namespace trial;

constexpr double drum_radius = 1.9; // m

std::vector<std::string> methods_that_look_ahead() {
    std::vector<std::string> names;
    for (const Method &method : methods())
        if (method.info.looks_ahead)
            names.emplace_back(method.info.name);
    return names;
}

class Passing : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Methods, Passing, testing::ValuesIn(methods_that_look_ahead()), name_of);

World weightless_world(const std::string &method) {
    return World(method, weightless(settings_for(method)));
}

// The speed of a body initially at rest after another has passed along x, `above` its centre.
double speed_after_passing(const std::string &method, const Shape &moving, const Shape &resting,
                           double speed, double above, double start) {
    World world = weightless_world(method);
    world.add_body(
        with_material(dynamic_body(moving, 1, V{start, above, 0}, V{speed, 0, 0}), 0, 0));
    const BodyId id = world.add_body(with_material(dynamic_body(resting, 1, V{0}), 0, 0));
    run(world, int(3 * 60 / speed) + 3);
    return glm::length(velocity_of(world, id));
}

// At every phase of the step, with gaps from a millimetre at 2 m/s to 20 cm at 50 m/s.
TEST_P(Passing, ABallThatPassesAnotherDoesNotTouchIt) {
    for (const double speed : {2.0, 5.0, 10.0, 20.0, 50.0})
        for (const double gap : {0.001, 0.005, 0.02, 0.05, 0.1, 0.2})
            for (int phase = 0; phase < 12; ++phase) {
                const double start = -1.5 - speed / 60 * phase / 12;
                EXPECT_EQ(
                    speed_after_passing(GetParam(), ball(0.2), ball(0.2), speed, 0.4 + gap, start),
                    0)
                    << speed << ' ' << gap << ' ' << phase;
                EXPECT_EQ(speed_after_passing(GetParam(), ball(0.2), block(V{0.2}), speed,
                                              0.4 + gap, start),
                          0)
                    << speed << ' ' << gap << ' ' << phase;
            }
}

TEST_P(Passing, ABallThatGrazesAnotherTouchesIt) {
    for (const double speed : {2.0, 10.0, 50.0})
        for (const double depth : {0.002, 0.02, 0.1})
            for (int phase = 0; phase < 12; ++phase)
                EXPECT_GT(speed_after_passing(GetParam(), ball(0.2), ball(0.2), speed, 0.4 - depth,
                                              -1.5 - speed / 60 * phase / 12),
                          0.01 * speed * std::sqrt(depth / 0.4))
                    << speed << ' ' << depth << ' ' << phase;
}

TEST_P(Passing, BoxesThatPassDoNotTouch) {
    Random random(3);
    for (int trial = 0; trial < 200; ++trial) {
        const double speed = random.next_in(2, 50);
        const V a = any_vector(random, 0.1) + V{0.2}, b = any_vector(random, 0.1) + V{0.2};
        const double above = a.y + b.y + random.next_in(0.005, 0.1);
        EXPECT_EQ(speed_after_passing(GetParam(), block(a), block(b), speed, above,
                                      -1.5 - random.next_in(0, speed / 60)),
                  0);
    }
}

// A ball at rest close to a wall, hit by one ten times as heavy.
TEST(SoftStepPassing, NothingIsStruckThroughAWall) {
    for (const double speed : {8.0, 20.0, 40.0, 100.0})
        for (const double gap : {0.02, 0.05, 0.1, 0.3})
            for (int phase = 0; phase < 10; ++phase) {
                World world = weightless_world("soft_step");
                world.add_body(with_material(static_body(block(V{0.005, 5, 5})), 0, 0));
                const double x = -0.105 - gap;
                const BodyId id =
                    world.add_body(with_material(dynamic_body(ball(0.1), 1, V{x, 0, 0}), 0, 0));
                world.add_body(with_material(
                    dynamic_body(ball(0.1), 10, V{x - 0.3 - speed / 60 * phase / 10, 0, 0},
                                 V{speed, 0, 0}),
                    0, 0));
                double farthest = x;
                for (int i = 0; i < 30; ++i) {
                    world.step(nullptr);
                    farthest = std::max(farthest, position_of(world, id).x);
                }
                EXPECT_LT(farthest, 0) << speed << ' ' << gap << ' ' << phase;
            }
}

// Small boxes against a wall thinner than they are, hitting with any corner, edge or face.
TEST(SoftStepPassing, ABoxDoesNotPassAThinWall) {
    Random random(5);
    for (const double speed : {10.0, 30.0})
        for (const double restitution : {0.0, 0.5})
            for (int trial = 0; trial < 100; ++trial) {
                World world = weightless_world("soft_step");
                world.add_body(
                    with_material(static_body(block(V{0.005, 50, 50})), 0.3, restitution));
                V way = any_vector(random, 1);
                way = glm::normalize(V{std::abs(way.x) + 0.3, way.y, way.z});
                BodyDef def = dynamic_body(block(V{0.05, 0.1, 0.02}), 1,
                                           -(3 + random.next_in(0, 1)) * way, speed * way);
                def.pose.rotation = glm::normalize(narrow(any_rotation(random)));
                const BodyId id = world.add_body(with_material(def, 0.3, restitution));
                double farthest = -1;
                for (int i = 0; i < int(9 * 60 / speed); ++i) {
                    world.step(nullptr);
                    farthest = std::max(farthest, position_of(world, id).x);
                }
                EXPECT_LT(farthest, 0) << speed << ' ' << restitution << ' ' << trial;
            }
}

// A drum of twelve planks, turning about z.
BodyDef drum(double spin, bool is_closed) {
    constexpr double half_angle = pi / 12, thick = 0.05;
    BodyDef def;
    def.kind = BodyKind::kinematic;
    for (int i = 0; i < 12; ++i) {
        const double angle = 2 * half_angle * i;
        Box plank = block(V{thick, 0.55, 1});
        plank.center = narrow((drum_radius + thick) * V{std::cos(angle), std::sin(angle), 0});
        plank.rotation = narrow(glm::angleAxis(angle, V{0, 0, 1}));
        def.colliders.emplace_back().shape = plank;
    }
    for (const double z : {-1.05, 1.05}) {
        Box lid = block(V{2, 2, thick});
        lid.center = narrow(V{0, 0, z});
        if (is_closed)
            def.colliders.emplace_back().shape = lid;
    }
    def.angular_velocity = narrow(V{0, 0, spin});
    return with_material(def, 0.5, 0);
}

// The drum turns by up to a quarter of a radian per step: a plank's plane is then elsewhere, and
// would push its riders through.
TEST(SoftStepPassing, WhatIsInATurningDrumStaysInIt) {
    for (const auto &[spin, rate] :
         {std::pair{10.0, 60.0}, std::pair{15.0, 60.0}, std::pair{20.0, 120.0}})
        for (const Shape &shape : {Shape{ball(0.1)}, Shape{ball(0.05)}, Shape{block(V{0.1})},
                                   Shape{upright_capsule(0.1, 0.1)}}) {
            StepSettings settings = settings_for("soft_step");
            settings.dt = 1 / rate;
            World world("soft_step", settings);
            world.add_body(drum(spin, true));
            std::vector<BodyId> inside;
            for (int i = 0; i < 8; ++i)
                inside.push_back(world.add_body(with_material(
                    dynamic_body(shape, 1, V{-0.7 + 0.45 * (i % 4), -0.8 + 0.45 * (i / 4), 0}), 0.5,
                    0)));
            run(world, int(1.5 * rate));
            for (const BodyId id : inside) {
                const V p = position_of(world, id);
                EXPECT_LT(std::hypot(p.x, p.y), drum_radius / std::cos(pi / 12))
                    << spin << ' ' << rate << ' ' << shape.index();
                EXPECT_LT(std::abs(p.z), 1);
            }
        }
}

// Far away, in each of 40 steps, a ball hits another standing before a wall. That cannot be
// foreseen, so the step is retried. The retry adds passes over everything with the same number of
// substeps, so the riders in the drum may differ by the little those change.
TEST(SoftStepPassing, WhatIsTriedAgainForOthersGoesItsOwnWay) {
    for (const double spin : {4.0, 6.5, 7.0, 9.0, 10.0})
        for (const Shape &shape : {Shape{ball(0.1)}, Shape{block(V{0.1})}}) {
            World alone("soft_step", settings_for("soft_step"));
            World with_others = alone;
            std::vector<BodyId> inside;
            for (World *world : {&alone, &with_others}) {
                world->add_body(drum(spin, false));
                inside.clear();
                for (int i = 0; i < 4; ++i)
                    inside.push_back(world->add_body(with_material(
                        dynamic_body(shape, 1, V{-0.7 + 0.45 * i, -0.8, 0}), 0.5, 0)));
            }
            with_others.add_body(
                with_material(static_body(block(V{0.005, 5, 5}), V{100, 0, 0}), 0, 0));
            for (int i = 0; i < 40; ++i) {
                const V at{99.9, -4 + 0.2 * i, 0};
                BodyDef struck = with_material(dynamic_body(ball(0.05), 1, at), 0, 0);
                BodyDef striker = with_material(
                    dynamic_body(ball(0.05), 10, at - V{20.0 / 60 * (30 + i), 0, 0}, V{20, 0, 0}),
                    0, 0);
                struck.gravity_scale = striker.gravity_scale = 0;
                with_others.add_body(struck);
                with_others.add_body(striker);
            }
            run(alone, 46);
            run(with_others, 46);
            for (const BodyId id : inside)
                EXPECT_LT(glm::distance(position_of(alone, id), position_of(with_others, id)), 0.05)
                    << spin << ' ' << shape.index();
        }
}

// On a fixed axle, from less than a twentieth of a turn per step to half a turn.
TEST(SoftStepPassing, ASpinningRodDoesNotPassAPost) {
    for (const double spin : {10.0, 30.0, 94.0, 180.0})
        for (int phase = 0; phase < 20; ++phase) {
            World world = weightless_world("soft_step");
            world.add_body(
                with_material(static_body(upright_capsule(1, 0.05), V{0.8, 0, 0}), 0, 0));
            BodyDef rod = dynamic_body(block(V{1, 0.03, 0.03}), 1, V{0});
            rod.pose.rotation =
                glm::normalize(narrow(glm::angleAxis(0.3 + 2.4 * phase / 20, V{0, 1, 0})));
            rod.angular_velocity = narrow(V{0, spin, 0});
            rod.locked = {true, true, true, true, false, true};
            const BodyId id = world.add_body(with_material(rod, 0, 0));
            run(world, 60);
            EXPECT_LT(std::abs(spin_of(world, id).y), 0.01 * spin) << spin << ' ' << phase;
        }
}

} // namespace
} // namespace plumb::inline PLUMB_PRECISION
