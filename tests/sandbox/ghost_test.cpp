#include "app/sandbox/ghost.h"

#include "app/sandbox/sandbox.h"

#include <filesystem>

#include <gtest/gtest.h>

namespace plumb {
namespace {

// One ball, dropped; velocity Verlet is exact.
SceneDesc drop() {
    SceneDesc scene;
    scene.name = "drop";
    scene.world.method = "velocity_verlet";
    scene.world.precision = Precision::dual;
    BodyDesc &ball = scene.bodies.emplace_back();
    ball.name = "ball";
    ball.colliders.emplace_back().shape = SphereDesc{0.5};
    ball.position = {0, 100, 0};
    return scene;
}

GhostDistance distance(const Session &session) {
    return session.ghost()->farthest(*session.simulation(), session.present());
}

// Explicit Euler falls short by g h t / 2 of what is exact, h its substep.
double lag(const Session &session, double time) {
    const StepSettings &settings = session.ghost()->simulation().settings();
    return 0.5 * 9.81 * settings.dt / settings.substeps * time;
}

TEST(Ghost, IsAsFarAsTheTwoMethodsDiffer) {
    Session session;
    ASSERT_TRUE(session.open(drop()));
    ASSERT_TRUE(session.set_ghost("explicit_euler"));
    EXPECT_EQ(distance(session).metres, 0);
    for (int i = 0; i < 60; ++i)
        ASSERT_TRUE(session.step());
    EXPECT_NEAR(distance(session).metres, lag(session, 1), 1e-9);
    EXPECT_EQ(distance(session).name, "ball");
    for (int i = 0; i < 30; ++i)
        ASSERT_TRUE(session.step_back());
    EXPECT_NEAR(distance(session).metres, lag(session, 0.5), 1e-9);
    ASSERT_TRUE(session.step());
    EXPECT_NEAR(distance(session).metres, lag(session, 31.0 / 60), 1e-9);
    ASSERT_TRUE(session.restart());
    ASSERT_NE(session.ghost(), nullptr);
    EXPECT_EQ(distance(session).metres, 0);
    ASSERT_TRUE(session.set_ghost(""));
    EXPECT_EQ(session.ghost(), nullptr);
}

TEST(Ghost, BeginsWhereTheRunIsAndAnewBeforeThat) {
    Session session;
    ASSERT_TRUE(session.open(drop()));
    for (int i = 0; i < 30; ++i)
        ASSERT_TRUE(session.step());
    ASSERT_TRUE(session.set_ghost("explicit_euler"));
    EXPECT_NEAR(distance(session).metres, 0, 1e-12);
    for (int i = 0; i < 5; ++i)
        ASSERT_TRUE(session.step());
    EXPECT_GT(distance(session).metres, 0);
    for (int i = 0; i < 10; ++i)
        ASSERT_TRUE(session.step_back());
    EXPECT_NEAR(distance(session).metres, 0, 1e-12);
    EXPECT_EQ(session.ghost()->simulation().step_count(), session.simulation()->step_count());
}

TEST(Ghost, WhatIsDoneToTheOneIsDoneToTheOtherAndTheRunIsAsItWas) {
    const std::filesystem::path stack =
        std::filesystem::path(PLUMB_SOURCE_DIR) / "scenes/stacking/ten_box_stack.toml";
    const auto hash = [&](bool haunted) {
        Session session;
        EXPECT_TRUE(session.open(stack));
        EXPECT_TRUE(session.set_ghost(haunted ? "sequential_impulses" : ""));
        for (int i = 0; i < 10; ++i)
            EXPECT_TRUE(session.step());
        EXPECT_TRUE(session.shoot({-10, 3, 0}, {8, 0, 0}, 0.3));
        for (int i = 0; i < 30; ++i)
            EXPECT_TRUE(session.step());
        if (haunted) {
            EXPECT_TRUE(session.ghost()->simulation().find_body("ball"));
            EXPECT_EQ(session.ghost()->failure(), "");
            EXPECT_LT(distance(session).metres, 0.5);
        }
        return session.simulation()->hash();
    };
    EXPECT_EQ(hash(true), hash(false));
}

TEST(Ghost, OfAMethodThatCannotRunTheSceneThereIsNone) {
    Session session;
    ASSERT_TRUE(session.open(std::filesystem::path(PLUMB_SOURCE_DIR) /
                             "scenes/stacking/ten_box_stack.toml"));
    EXPECT_FALSE(session.set_ghost("rk4"));
    EXPECT_EQ(session.ghost(), nullptr);
    EXPECT_EQ(session.messages().all().size(), 1u);
    ASSERT_TRUE(session.step());
}

TEST(Ghost, IsDrawnTranslucentByItsKey) {
    Sandbox sandbox{Session()};
    ASSERT_TRUE(sandbox.open(drop()));
    const auto glass = [&] {
        return std::ranges::count(sandbox.draw_list().shapes, true, &DrawShape::glass);
    };
    EXPECT_EQ(glass(), 0);
    sandbox.handle(KeyEvent{{'g', false, false}, false});
    EXPECT_EQ(glass(), 1);
    sandbox.handle(KeyEvent{{'g', false, false}, false});
    EXPECT_EQ(glass(), 0);
}

} // namespace
} // namespace plumb
