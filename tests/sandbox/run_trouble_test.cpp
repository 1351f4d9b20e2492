#include "app/sandbox/session/run_trouble.h"

#include "app/sandbox/session/session.h"
#include "engine/scene/scene_file.h"
#include "tests/sandbox/fake_simulation.h"

#include <filesystem>

#include <unistd.h>

#include <gtest/gtest.h>

namespace plumb {
namespace {

const std::filesystem::path scenes_folder = std::filesystem::path(PLUMB_SOURCE_DIR) / "scenes";

// A ball and a wall, without gravity.
constexpr const char *bullet_text = R"(
title = "bullet"
[world]
gravity = [0, 0, 0]
[[body]]
name = "wall"
kind = "static"
shape = "box"
half_extents = [0.005, 2, 2]
[[body]]
name = "ball"
shape = "sphere"
radius = 0.05
position = [-2.3, 0, 0]
velocity = [40, 0, 0]
)";

std::optional<Trouble> trouble_of(const SceneDesc &scene, const std::string &method, int steps) {
    RunOptions options;
    options.method = method;
    if (method == "explicit_euler")
        options.settings.give(&StepSettings::substeps, 1);
    Session session(options);
    EXPECT_TRUE(session.open(scene));
    for (int i = 0; i < steps && !session.trouble(); ++i)
        session.step();
    return session.trouble();
}

bool says(const Trouble &trouble, const std::string &part) {
    return trouble.text.find(part) != std::string::npos;
}

// Explicit Euler multiplies an undamped spring's amplitude by sqrt(1 + (omega dt)^2) per step.
TEST(Trouble, AMethodThatGainsEnergyIsToldWithPlaceAndTime) {
    const SceneDesc scene = load_scene(scenes_folder / "springs/mass_on_spring.toml").scene;
    const auto grown = trouble_of(scene, "explicit_euler", 600);
    ASSERT_TRUE(grown);
    EXPECT_EQ(grown->failing, Failing::energy_grew);
    EXPECT_TRUE(says(*grown, "step " + std::to_string(grown->step))) << grown->text;
    EXPECT_TRUE(says(*grown, "fastest is")) << grown->text;
    EXPECT_FALSE(trouble_of(scene, "velocity_verlet", 600));
}

TEST(Trouble, IsGoneWhenTheRunIsTakenBackToBeforeIt) {
    RunOptions options;
    options.method = "explicit_euler";
    options.settings.give(&StepSettings::substeps, 1);
    Session session(options);
    ASSERT_TRUE(session.open(scenes_folder / "springs/mass_on_spring.toml"));
    while (!session.trouble() && session.step()) {
    }
    ASSERT_TRUE(session.trouble());
    const std::uint64_t at = session.trouble()->step;
    ASSERT_TRUE(session.step_back());
    EXPECT_FALSE(session.trouble());
    ASSERT_TRUE(session.step());
    ASSERT_TRUE(session.trouble());
    EXPECT_EQ(session.trouble()->step, at);
    ASSERT_TRUE(session.restart());
    EXPECT_FALSE(session.trouble());
}

// Struck towards a wall of a centimetre in the middle of a step: README, "Where methods break".
TEST(Trouble, ABodyThatPassesThroughAWallIsNamed) {
    SceneDesc scene = load_scene(scenes_folder / "contact/struck_before_wall.toml").scene;
    for (BodyDesc &body : scene.bodies)
        if (body.name == "heavy")
            body.velocity.x = 40;
    scene.world.settings.give(&StepSettings::dt, 1.0 / 60);
    const auto passed = trouble_of(scene, "sequential_impulses", 60);
    ASSERT_TRUE(passed);
    EXPECT_EQ(passed->failing, Failing::passed_through);
    EXPECT_TRUE(says(*passed, " through wall")) << passed->text;
    EXPECT_FALSE(trouble_of(scene, "soft_step", 60));
}

// A body far too heavy for such soft contacts.
TEST(Trouble, WhatStaysDeepIsNamedAndStaysGoneBeforeIt) {
    const SceneDesc scene = parse_scene(R"(
[world]
method = "tgs_soft"
sleep_after = 0
[[body]]
name = "ground"
shape = "plane"
[[body]]
name = "light"
shape = "box"
half_extents = [0.5, 0.5, 0.5]
mass = 1
position = [0, 0.5, 0]
[[body]]
name = "heavy"
shape = "box"
half_extents = [0.5, 0.5, 0.5]
mass = 1000
position = [0, 1.5, 0]
)",
                                        "heap.toml")
                                .scene;
    Session session;
    ASSERT_TRUE(session.open(scene));
    for (int i = 0; i < 600 && !session.trouble(); ++i)
        ASSERT_TRUE(session.step());
    ASSERT_TRUE(session.trouble());
    const Trouble told = *session.trouble();
    EXPECT_EQ(told.failing, Failing::penetration);
    EXPECT_TRUE(says(told, "\"light\"")) << told.text;
    EXPECT_TRUE(says(told, "step " + std::to_string(told.step))) << told.text;
    for (int i = 0; i < 5; ++i)
        ASSERT_TRUE(session.step_back());
    EXPECT_FALSE(session.trouble());
    while (!session.trouble() && session.simulation()->step_count() < 700)
        ASSERT_TRUE(session.step());
    ASSERT_TRUE(session.trouble());
    EXPECT_EQ(session.trouble()->text, told.text);
}

TEST(Trouble, AJointThatStaysApartIsNamed) {
    SceneDesc scene = load_scene(scenes_folder / "joints/heavy_chain.toml").scene;
    scene.expects.clear(); // these say how far apart it may be
    for (BodyDesc &body : scene.bodies)
        if (body.name == "weight")
            body.mass = 1e6;
    const auto torn = trouble_of(scene, "tgs_soft", 600);
    ASSERT_TRUE(torn);
    EXPECT_EQ(torn->failing, Failing::drift) << torn->text;
    EXPECT_TRUE(says(*torn, "joint \"")) << torn->text;
}

// Energy that the user adds is no failing of the method.
TEST(Trouble, AShotAndAPullAreNone) {
    Session session;
    ASSERT_TRUE(session.open(parse_scene(bullet_text, "bullet.toml").scene));
    ASSERT_TRUE(session.shoot({0, 50, 0}, {0, 300, 0}, 0.5));
    ASSERT_TRUE(session.step());
    const auto ball = session.simulation()->find_body("ball");
    session.grab(GrabView{*ball, {0, 0, 0}, {-500, 0, 0}, 1e5});
    for (int i = 0; i < 30; ++i)
        ASSERT_TRUE(session.step());
    session.grab(std::nullopt);
    for (int i = 0; i < 10; ++i)
        ASSERT_TRUE(session.step());
    EXPECT_FALSE(session.trouble()) << session.trouble()->text;
}

// Nor is it in a recording, which is judged as the run was: only the method's own gain is reported.
TEST(Trouble, InAReplayTheLightsAreThoseOfTheRun) {
    const std::filesystem::path path = std::filesystem::temp_directory_path() /
                                       ("plumb-trouble-" + std::to_string(::getpid()) + ".toml");
    const auto record = [&](Session &session, const auto &act) {
        session.record();
        act();
        OutputFile file(path);
        session.write_recording(file);
        return session.trouble();
    };
    const auto replayed = [&] {
        Session session;
        EXPECT_TRUE(session.open_recording(path));
        while (session.step()) {
        }
        EXPECT_EQ(session.replay_outcome(), ExitCode::fine);
        return session.trouble();
    };
    Session pulled;
    EXPECT_FALSE(record(pulled, [&] {
        ASSERT_TRUE(pulled.open(parse_scene(bullet_text, "bullet.toml").scene));
        ASSERT_TRUE(pulled.shoot({0, 50, 0}, {0, 300, 0}, 0.5));
        ASSERT_TRUE(pulled.step());
        pulled.grab(
            GrabView{*pulled.simulation()->find_body("ball"), {0, 0, 0}, {-500, 0, 0}, 1e5});
        for (int i = 0; i < 30; ++i)
            ASSERT_TRUE(pulled.step());
        pulled.grab(std::nullopt);
        for (int i = 0; i < 10; ++i)
            ASSERT_TRUE(pulled.step());
    }));
    const auto none = replayed();
    EXPECT_FALSE(none) << none->text;

    RunOptions options;
    options.method = "explicit_euler";
    options.settings.give(&StepSettings::substeps, 1);
    Session grown(options);
    const auto told = record(grown, [&] {
        ASSERT_TRUE(grown.open(scenes_folder / "springs/mass_on_spring.toml"));
        for (int i = 0; i < 300; ++i)
            ASSERT_TRUE(grown.step());
    });
    ASSERT_TRUE(told);
    const auto again = replayed();
    ASSERT_TRUE(again);
    EXPECT_EQ(again->text, told->text);
    std::filesystem::remove(path);
}

TEST(Trouble, WhatIsNotFiniteComesFirst) {
    Session session({}, nullptr, make_fake()); // its energy grows by 1 J per step
    ASSERT_TRUE(session.open(two_balls()));
    dynamic_cast<FakeSimulation &>(*session.simulation()).diverges_at = 1;
    ASSERT_TRUE(session.step());
    ASSERT_TRUE(session.trouble());
    EXPECT_EQ(session.trouble()->failing, Failing::energy_grew);
    EXPECT_FALSE(session.step());
    EXPECT_EQ(session.trouble()->failing, Failing::not_finite);
    EXPECT_TRUE(says(*session.trouble(), "body \"right\", last at (5, 0.004167, 0)"))
        << session.trouble()->text;
    ASSERT_TRUE(session.step_back());
    EXPECT_EQ(session.trouble()->failing, Failing::energy_grew);
}

// A particle's last position is reported too.
TEST(Trouble, SaysWhereAParticleWasLast) {
    RunOptions options;
    options.method = "explicit_euler";
    options.settings.give(&StepSettings::dt, 1.0 / 15);
    options.settings.give(&StepSettings::substeps, 1);
    Session session(options);
    ASSERT_TRUE(session.open(scenes_folder / "springs/spring_limit.toml"));
    while (session.step())
        ASSERT_LT(session.simulation()->step_count(), 5000u);
    ASSERT_TRUE(session.trouble());
    EXPECT_EQ(session.trouble()->failing, Failing::not_finite);
    EXPECT_TRUE(says(*session.trouble(), "particle \"bob\", last at (0, "))
        << session.trouble()->text;
}

// A scene that keeps its expectations raises no alarm.
TEST(Trouble, IsNoneInScenesThatAreFine) {
    for (const char *name : {"stacking/ten_box_stack", "joints/pendulum", "joints/newtons_cradle",
                             "contact/bounce_elastic", "springs/two_masses", "free/free_fall"}) {
        const SceneDesc scene = load_scene(scenes_folder / (std::string(name) + ".toml")).scene;
        const auto trouble = trouble_of(scene, "", 200);
        EXPECT_FALSE(trouble) << name << ": " << trouble->text;
    }
}

TEST(Trouble, AMissIsDatedToTheStepInWhichItWasSealed) {
    SceneDesc scene = two_balls(); // "left" rises by 0.25 m/s
    scene.world.settings.give(&StepSettings::dt, 0.5);
    const auto expect = [&](const char *name, const char *reduce, double at_most) {
        ExpectDesc &added = scene.expects.emplace_back();
        added.name = name;
        added.quantity = "position.y";
        added.body = "left";
        added.reduce = reduce;
        added.relation = ExpectDesc::Relation::at_most;
        added.value = at_most;
        added.to = 10;
    };
    expect("low", "max", 0.6);        // 0.625 m after 2.5 s
    expect("low at last", "last", 1); // 2.5 m at the end
    expect("high", "max", 3);
    Session session({}, nullptr, make_fake());
    ASSERT_TRUE(session.open(scene));
    for (int i = 0; i < 5; ++i) {
        EXPECT_FALSE(session.missed_since(0)) << i;
        ASSERT_TRUE(session.step());
    }
    EXPECT_EQ(session.missed_since(0), 2.5);
    for (int i = 5; i < 20; ++i) {
        EXPECT_FALSE(session.missed_since(1)) << i;
        ASSERT_TRUE(session.step());
    }
    EXPECT_EQ(session.missed_since(0), 2.5);
    EXPECT_EQ(session.missed_since(1), 10);
    EXPECT_FALSE(session.missed_since(2));
    ASSERT_TRUE(session.step_back());
    EXPECT_FALSE(session.missed_since(1));
}

} // namespace
} // namespace plumb
