#include "app/sandbox/studies/ghost.h"

#include "app/sandbox/sandbox.h"

#include <filesystem>

#include <unistd.h>

#include <gtest/gtest.h>

namespace plumb {
namespace {

// One ball, dropped; velocity Verlet is exact for it.
SceneDesc drop() {
    SceneDesc scene;
    scene.name = "drop";
    scene.world.method = "velocity_verlet";
    scene.world.precision = Precision::f64;
    BodyDesc &ball = scene.bodies.emplace_back();
    ball.name = "ball";
    ball.colliders.emplace_back().shape = SphereDesc{0.5};
    ball.position = {0, 100, 0};
    return scene;
}

GhostDistance distance(const Session &session) {
    return session.ghost()->farthest(*session.simulation(), session.present());
}

// Explicit Euler falls short of the exact result by g h t / 2, with h its substep.
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

// Beside explicit Euler, the reference follows the exact fall: its distance is the run's error.
TEST(Ghost, TheReferenceTellsHowFarTheRunIsFromTheTruth) {
    SceneDesc scene = drop();
    scene.world.method = "explicit_euler";
    Session session;
    ASSERT_TRUE(session.open(scene));
    ASSERT_TRUE(session.set_ghost(reference_ghost));
    ASSERT_TRUE(session.ghost()->is_reference());
    EXPECT_EQ(session.ghost()->simulation().method().name, "rk4");
    const StepSettings &settings = session.simulation()->settings();
    for (int i = 0; i < 60; ++i)
        ASSERT_TRUE(session.step());
    while (session.ghost()->lag(*session.simulation()) > 0)
        session.let_ghost_go_on();
    EXPECT_NEAR(session.ghost()->present().bodies[0].position.y, 100 - 9.81 / 2, 1e-9);
    EXPECT_NEAR(distance(session).metres, 0.5 * 9.81 * settings.dt / settings.substeps, 1e-9);
    ASSERT_TRUE(session.restart());
    ASSERT_NE(session.ghost(), nullptr);
    EXPECT_TRUE(session.ghost()->is_reference());
}

// Started mid-run, it begins where the run is and continues beside it.
TEST(Ghost, AReferenceBegunInMidRunIsOfTheSameTime) {
    Session session;
    ASSERT_TRUE(session.open(drop()));
    for (int i = 0; i < 60; ++i)
        ASSERT_TRUE(session.step());
    ASSERT_TRUE(session.set_ghost(reference_ghost));
    EXPECT_EQ(session.ghost()->lag(*session.simulation()), 0);
    for (int i = 0; i < 30; ++i)
        ASSERT_TRUE(session.step());
    while (session.ghost()->lag(*session.simulation()) > 0)
        session.let_ghost_go_on();
    EXPECT_NEAR(session.ghost()->simulation().time(), 1.5, 1e-9);
    EXPECT_NEAR(distance(session).metres, 0, 1e-9);
}

// After a change of step it continues with a quarter of the new one.
TEST(Ghost, AReferenceKeepsItsShareOfTheStep) {
    Session session;
    ASSERT_TRUE(session.open(drop()));
    ASSERT_TRUE(session.set_ghost(reference_ghost));
    StepSettings settings = session.simulation()->settings();
    for (const double dt : {1.0 / 30, 1.0 / 240}) {
        settings.dt = dt;
        ASSERT_TRUE(session.set_settings(settings));
        EXPECT_EQ(session.ghost()->simulation().settings().dt, dt / 4);
        ASSERT_TRUE(session.step());
        while (session.ghost()->lag(*session.simulation()) > 0)
            session.let_ghost_go_on();
        EXPECT_NEAR(session.ghost()->simulation().time(), session.simulation()->time(), 1e-12);
    }
    EXPECT_EQ(session.ghost()->failure(), "");
}

// Without time to compute it lags and reports by how much; a command given then ends it.
TEST(Ghost, AReferenceWithoutTimeLags) {
    SceneDesc scene = drop();
    scene.world.method = "soft_step";
    const auto run = Simulation::create(scene, {}, nullptr);
    Ghost ghost(*run, reference_ghost);
    ghost.allow(0);
    const auto step = [&](int count) {
        for (int i = 0; i < count; ++i) {
            ghost.begin_step();
            run->step();
            ghost.catch_up(*run);
        }
    };
    step(6);
    EXPECT_NEAR(ghost.lag(*run), 0.1, 1e-9);
    EXPECT_EQ(ghost.simulation().step_count(), 0u);
    ghost.allow(1e9);
    ghost.go_on(*run);
    EXPECT_EQ(ghost.lag(*run), 0);
    EXPECT_EQ(ghost.simulation().step_count(), 24u) << "a quarter of the step";
    EXPECT_LT(ghost.farthest(*run, run->read()).metres, 1e-9);
    ghost.apply(*run, ApplyImpulse{"ball", {1, 0, 0}, {0, 100, 0}});
    EXPECT_EQ(ghost.failure(), "");
    ghost.allow(0);
    step(1);
    ghost.apply(*run, ApplyImpulse{"ball", {1, 0, 0}, {0, 100, 0}});
    EXPECT_NE(ghost.failure(), "");
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

// Settings chosen since stay in force for both when both step back.
TEST(Ghost, IsTakenBackBeforeAnythingIsDoneToIt) {
    Session session;
    ASSERT_TRUE(session.open(drop()));
    ASSERT_TRUE(session.set_ghost("explicit_euler"));
    for (int i = 0; i < 3; ++i)
        ASSERT_TRUE(session.step());
    StepSettings lighter = session.simulation()->settings();
    lighter.gravity.y = -1;
    ASSERT_TRUE(session.set_settings(lighter));
    for (int i = 0; i < 2; ++i)
        ASSERT_TRUE(session.step());
    for (int i = 0; i < 4; ++i)
        ASSERT_TRUE(session.step_back());
    EXPECT_EQ(session.ghost()->simulation().settings().gravity.y, -1);
    EXPECT_EQ(session.ghost()->simulation().step_count(), 1U);
    for (int i = 0; i < 4; ++i)
        ASSERT_TRUE(session.step());
    EXPECT_EQ(session.ghost()->simulation().settings().gravity.y, -1);
}

TEST(Ghost, WhatEndedItsMotionIsGoneOnlyBeforeThat) {
    Session session;
    ASSERT_TRUE(session.open(drop()));
    ASSERT_TRUE(session.set_method("soft_step"));
    ASSERT_TRUE(session.set_ghost("rk4"));
    ASSERT_TRUE(session.step());
    ASSERT_TRUE(session.step());
    ASSERT_TRUE(session.shoot({-10, 3, 0}, {8, 0, 0}, 0.3));
    EXPECT_NE(session.ghost()->failure(), "");
    for (int i = 0; i < 3; ++i)
        ASSERT_TRUE(session.step());
    for (int i = 0; i < 3; ++i) {
        ASSERT_TRUE(session.step_back());
        EXPECT_NE(session.ghost()->failure(), "") << i;
    }
    ASSERT_TRUE(session.step_back());
    EXPECT_EQ(session.ghost()->failure(), "");
}

// A grab holds the ghost too, even one that began before the ghost existed.
TEST(Ghost, IsHeldToo) {
    SceneDesc scene = drop();
    scene.world.method = "soft_step";
    Session session;
    ASSERT_TRUE(session.open(scene));
    session.grab(GrabView{0, {0, 0, 0}, {3, 100, 0}, 1e5});
    ASSERT_TRUE(session.step());
    ASSERT_TRUE(session.set_ghost("sequential_impulses"));
    for (int i = 0; i < 120; ++i)
        ASSERT_TRUE(session.step());
    EXPECT_NEAR(session.present_bodies()[0].position.x, 3, 0.1);
    EXPECT_LT(distance(session).metres, 0.1);
    session.grab(std::nullopt);
    for (int i = 0; i < 60; ++i)
        ASSERT_TRUE(session.step());
    EXPECT_LT(session.ghost()->simulation().read().bodies[0].position.y, 97);
}

// Playing forth and back, each recorded command reaches the ghost once, as it did live.
TEST(Ghost, FollowsARecording) {
    const std::filesystem::path path = std::filesystem::temp_directory_path() /
                                       ("plumb-ghost-" + std::to_string(::getpid()) + ".toml");
    const std::filesystem::path stack =
        std::filesystem::path(PLUMB_SOURCE_DIR) / "scenes/stacking/ten_box_stack.toml";
    std::uint64_t live = 0;
    {
        Session session;
        session.record();
        ASSERT_TRUE(session.open(stack));
        ASSERT_TRUE(session.set_ghost("sequential_impulses"));
        ASSERT_TRUE(session.step());
        ASSERT_TRUE(session.shoot({-10, 3, 0}, {8, 0, 0}, 0.3));
        ASSERT_TRUE(session.step());
        GrabView grab{*session.simulation()->find_body("ball"), {0, 0, 0}, {0, 9, 0}, 1e3};
        session.grab(grab);
        ASSERT_TRUE(session.step());
        grab.target.x = 3;
        session.grab(grab);
        for (int i = 0; i < 3; ++i)
            ASSERT_TRUE(session.step());
        session.grab(std::nullopt);
        ASSERT_TRUE(session.step());
        live = session.ghost()->simulation().hash();
        OutputFile file(path);
        session.write_recording(file);
    }
    Session session;
    ASSERT_TRUE(session.open_recording(path));
    ASSERT_TRUE(session.set_ghost("sequential_impulses"));
    const auto play_to_the_end = [&] {
        while (session.step()) {
        }
        EXPECT_FALSE(session.step()); // no command is repeated at the end
        EXPECT_EQ(session.replay_outcome(), ExitCode::fine);
        EXPECT_EQ(session.ghost()->failure(), "");
        return session.ghost()->simulation().hash();
    };
    EXPECT_EQ(play_to_the_end(), live);
    for (const int back : {1, 3, 7}) {
        for (int i = 0; i < back; ++i)
            ASSERT_TRUE(session.step_back());
        EXPECT_EQ(play_to_the_end(), live) << back;
    }
    // A ghost that starts while the recording holds something.
    ASSERT_TRUE(session.set_ghost(""));
    for (int i = 0; i < 3; ++i)
        ASSERT_TRUE(session.step_back());
    ASSERT_TRUE(session.set_ghost("sequential_impulses"));
    play_to_the_end();
    EXPECT_LT(distance(session).metres, 0.05);
    std::filesystem::remove(path);
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
