#include "app/sandbox/session/session.h"

#include "engine/dynamics/method_info.h"
#include "engine/scene/recording.h"
#include "engine/scene/scene_file.h"
#include "tests/sandbox/fake_simulation.h"

#include <algorithm>
#include <filesystem>
#include <fstream>

#include <unistd.h>

#include <gtest/gtest.h>

namespace plumb {
namespace {

// A stack that is pushed over: contacts, friction and warm starting all matter.
constexpr const char *stack_text = R"(
title = "stack"
[[body]]
name = "ground"
shape = "plane"
[[body]]
name = "crate"
shape = "box"
half_extents = [0.5, 0.5, 0.5]
position = [0, 0.5, 0]
repeat = { kind = "stack", count = 4 }
[[body]]
name = "ball"
shape = "sphere"
radius = 0.3
position = [-3, 1.5, 0]
velocity = [9, 1, 0]
)";

class SessionTest : public testing::Test {
  protected:
    SessionTest()
        : folder(std::filesystem::temp_directory_path() /
                 ("plumb-session-" + std::to_string(::getpid()) + "-" +
                  testing::UnitTest::GetInstance()->current_test_info()->name())) {
        std::filesystem::create_directories(folder);
        write("stack.toml", stack_text);
    }
    ~SessionTest() override { std::filesystem::remove_all(folder); }
    void write(const char *name, const std::string &text) const {
        std::ofstream(folder / name) << text;
    }
    std::filesystem::path folder;
};

std::vector<std::uint64_t> hashes_of_steps(Session &session, int steps) {
    std::vector<std::uint64_t> hashes{session.simulation()->hash()};
    for (int i = 0; i < steps; ++i) {
        EXPECT_TRUE(session.step());
        hashes.push_back(session.simulation()->hash());
    }
    return hashes;
}

TEST_F(SessionTest, SteppingBackGivesTheVeryStatesBefore) {
    Session session;
    ASSERT_TRUE(session.open(folder / "stack.toml"));
    const std::vector<std::uint64_t> hashes = hashes_of_steps(session, 60);
    for (std::size_t step = 60; step-- > 0;) {
        ASSERT_TRUE(session.step_back());
        ASSERT_EQ(session.simulation()->step_count(), step);
        ASSERT_EQ(session.simulation()->hash(), hashes[step]) << "step " << step;
    }
    EXPECT_FALSE(session.step_back());               // no states left to go back to
    EXPECT_EQ(hashes_of_steps(session, 60), hashes); // and forward again, the same way
}

TEST_F(SessionTest, SteppingBackUndoesAShot) {
    Session session;
    ASSERT_TRUE(session.open(folder / "stack.toml"));
    hashes_of_steps(session, 3);
    const std::uint64_t before = session.simulation()->hash();
    session.step();
    const std::size_t bodies = session.simulation()->body_count();
    ASSERT_TRUE(session.shoot({0, 3, 3}, {0, 0, -5}, 0.2));
    EXPECT_EQ(session.simulation()->body_count(), bodies + 1);
    session.step();
    ASSERT_TRUE(session.step_back());
    ASSERT_TRUE(session.step_back());
    EXPECT_EQ(session.simulation()->hash(), before);
    EXPECT_EQ(session.present_bodies().size(), session.simulation()->body_count());
}

TEST_F(SessionTest, RestartIsTheStart) {
    Session session;
    ASSERT_TRUE(session.open(folder / "stack.toml"));
    const std::vector<std::uint64_t> hashes = hashes_of_steps(session, 20);
    ASSERT_TRUE(session.restart());
    EXPECT_EQ(session.steps_remembered(), 0u);
    EXPECT_EQ(hashes_of_steps(session, 20), hashes);
}

TEST_F(SessionTest, RestartKeepsMethodAndSettingsAndAsWrittenDoesNot) {
    Session session;
    ASSERT_TRUE(session.open(folder / "stack.toml"));
    const std::string written(session.simulation()->method().name);
    ASSERT_TRUE(session.set_method("sequential_impulses"));
    StepSettings settings = session.simulation()->settings();
    settings.dt = 1.0 / 120;
    settings.iterations = 13;
    settings.gravity = {0, -3, 0};
    ASSERT_TRUE(session.set_settings(settings));
    session.step();
    ASSERT_TRUE(session.restart());
    EXPECT_EQ(session.simulation()->method().name, "sequential_impulses");
    EXPECT_EQ(session.simulation()->settings().dt, 1.0 / 120);
    EXPECT_EQ(session.simulation()->settings().iterations, 13);
    EXPECT_EQ(session.simulation()->settings().gravity, glm::dvec3(0, -3, 0));
    ASSERT_TRUE(session.restart_as_written());
    EXPECT_EQ(session.simulation()->method().name, written);
    EXPECT_EQ(session.simulation()->settings().dt, 1.0 / 60);
    EXPECT_EQ(session.simulation()->settings().gravity, glm::dvec3(0, -9.81, 0));
}

TEST_F(SessionTest, SteppingBackKeepsTheMethodChosen) {
    Session session;
    ASSERT_TRUE(session.open(folder / "stack.toml"));
    hashes_of_steps(session, 5);
    ASSERT_TRUE(session.set_method("sequential_impulses"));
    ASSERT_TRUE(session.step_back());
    EXPECT_EQ(session.simulation()->method().name, "sequential_impulses");
    EXPECT_EQ(session.simulation()->step_count(), 4u);
}

// Another method runs with the scene's settings for it, or else with its own defaults.
TEST_F(SessionTest, EachMethodBringsItsOwnSettings) {
    write("tuned.toml", std::string(stack_text) +
                            "[methods.sequential_impulses]\nsubsteps = 3\niterations = 17\n");
    Session session;
    ASSERT_TRUE(session.open(folder / "tuned.toml")) << session.messages().all()[0].text;
    ASSERT_TRUE(session.set_method("sequential_impulses"));
    EXPECT_EQ(session.simulation()->settings().substeps, 3);
    EXPECT_EQ(session.simulation()->settings().iterations, 17);
    ASSERT_TRUE(session.set_method("soft_step"));
    const MethodInfo &soft = *find_method_info("soft_step");
    EXPECT_EQ(session.simulation()->settings().substeps, soft.defaults.substeps);
    EXPECT_EQ(session.simulation()->settings().iterations, soft.defaults.iterations);
}

TEST_F(SessionTest, AMethodThatCannotRunTheSceneIsRefusedWithAReason) {
    Session session;
    ASSERT_TRUE(session.open(folder / "stack.toml"));
    const std::uint64_t before = session.simulation()->hash();
    EXPECT_FALSE(session.set_method("rk4")); // has no contacts
    EXPECT_FALSE(session.set_method("no such method"));
    EXPECT_EQ(session.simulation()->hash(), before);
    ASSERT_EQ(session.messages().all().size(), 2u);
    EXPECT_NE(session.messages().all()[0].text.find("rk4"), std::string::npos);
    StepSettings settings = session.simulation()->settings();
    settings.dt = -1;
    EXPECT_FALSE(session.set_settings(settings));
    EXPECT_EQ(session.messages().all().size(), 3u);
}

TEST_F(SessionTest, ASavedStateLoadsToTheSameHashAndGoesOnTheSameWay) {
    Session session;
    ASSERT_TRUE(session.open(folder / "stack.toml"));
    hashes_of_steps(session, 40);
    const std::filesystem::path saved = folder / "new folder" / "saved.toml";
    ASSERT_TRUE(session.save_scene(saved));
    // No half-written file is left beside it.
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(saved.parent_path()), {}), 1);
    Session again;
    ASSERT_TRUE(again.open(saved)) << again.messages().all()[0].text;
    EXPECT_EQ(hashes_of_steps(again, 40), hashes_of_steps(session, 40));
}

TEST_F(SessionTest, AFolderThatCannotBeMadeIsAMessage) {
    Session session;
    ASSERT_TRUE(session.open(folder / "stack.toml"));
    EXPECT_FALSE(session.save_scene(folder / "stack.toml" / "saved.toml")); // a file, not a folder
    ASSERT_EQ(session.messages().all().size(), 1u);
    EXPECT_EQ(session.messages().all()[0].severity, Message::Severity::error);
}

TEST_F(SessionTest, ReloadReadsTheFileAnewAndABrokenOneChangesNothing) {
    Session session;
    ASSERT_TRUE(session.open(folder / "stack.toml"));
    const std::size_t bodies = session.simulation()->body_count();
    write("stack.toml", std::string(stack_text) + "[[body]]\nname = \"more\"\nshape = \"sphere\"\n"
                                                  "radius = 1\nposition = [9, 9, 9]\n");
    ASSERT_TRUE(session.reload());
    EXPECT_EQ(session.simulation()->body_count(), bodies + 1);
    session.step();
    const std::uint64_t running = session.simulation()->hash();
    session.messages().clear();
    write("stack.toml", "[[body]]\nnaem = \"typo\"\n");
    EXPECT_FALSE(session.reload());
    EXPECT_EQ(session.simulation()->hash(), running);
    ASSERT_FALSE(session.messages().empty());
    // The mistake, and its file and line.
    EXPECT_TRUE(std::ranges::any_of(session.messages().all(), [](const Message &message) {
        return message.text.find("stack.toml:2:") != std::string::npos &&
               message.text.find("naem") != std::string::npos;
    }));
    std::filesystem::remove(folder / "stack.toml");
    EXPECT_FALSE(session.reload());
    EXPECT_TRUE(session.step());
}

TEST_F(SessionTest, WithoutASceneNothingHappens) {
    Session session;
    EXPECT_FALSE(session.open(folder / "absent.toml"));
    EXPECT_FALSE(session.messages().empty());
    EXPECT_FALSE(session.running());
    EXPECT_FALSE(session.step());
    EXPECT_FALSE(session.step_back());
    EXPECT_FALSE(session.restart());
    EXPECT_FALSE(session.reload());
    EXPECT_FALSE(session.set_method("soft_step"));
    EXPECT_FALSE(session.save_scene(folder / "x.toml"));
    EXPECT_FALSE(session.shoot({}, {}, 1).has_value());
}

TEST(SessionWithFake, ASceneThatCannotRunLeavesTheOldOneRunning) {
    Session session({}, nullptr, make_fake());
    ASSERT_TRUE(session.open(two_balls()));
    session.step();
    SceneDesc impossible = two_balls();
    impossible.name = "impossible";
    EXPECT_FALSE(session.open(impossible));
    EXPECT_EQ(session.scene().name, "two_balls");
    EXPECT_TRUE(session.step());
    ASSERT_EQ(session.messages().all().size(), 1u);
    EXPECT_NE(session.messages().all()[0].text.find("no method can run it"), std::string::npos);
}

TEST(SessionWithFake, AFailingStepStopsWithAMessageAndGoesBack) {
    Session session({}, nullptr, make_fake());
    ASSERT_TRUE(session.open(two_balls()));
    auto &fake = dynamic_cast<FakeSimulation &>(*session.simulation());
    fake.throws_at = 3;
    for (int i = 0; i < 3; ++i)
        EXPECT_TRUE(session.step());
    EXPECT_FALSE(session.step());
    EXPECT_TRUE(session.stopped());
    EXPECT_FALSE(session.step()); // stays stopped
    ASSERT_EQ(session.messages().all().size(), 1u);
    EXPECT_NE(session.messages().all()[0].text.find("as told"), std::string::npos);
    ASSERT_TRUE(session.step_back());
    EXPECT_FALSE(session.stopped());
}

TEST(SessionWithFake, AnExplosionSaysWhatWhereAndWhen) {
    Session session({}, nullptr, make_fake());
    ASSERT_TRUE(session.open(two_balls()));
    dynamic_cast<FakeSimulation &>(*session.simulation()).diverges_at = 2;
    session.step();
    session.step();
    EXPECT_FALSE(session.step());
    EXPECT_TRUE(session.stopped());
    ASSERT_EQ(session.messages().all().size(), 1u);
    const std::string &text = session.messages().all()[0].text;
    EXPECT_NE(text.find("\"right\""), std::string::npos) << text;
    EXPECT_NE(text.find("step 3"), std::string::npos) << text;
    ASSERT_TRUE(session.step_back());
    EXPECT_TRUE(std::isfinite(session.simulation()->read().bodies[1].position.y));
}

TEST(SessionWithFake, PosesBeforeAndAfterTheLastStep) {
    Session session({}, nullptr, make_fake());
    SceneDesc scene = two_balls();
    scene.world.settings.give(&StepSettings::dt, 0.5);
    ASSERT_TRUE(session.open(scene));
    EXPECT_EQ(session.previous_bodies()[0].position, session.present_bodies()[0].position);
    session.step();
    session.step();
    // 0.25 m/s, half a second per step.
    EXPECT_EQ(session.previous_bodies()[0].position.y, 0.125);
    EXPECT_EQ(session.present_bodies()[0].position.y, 0.25);
    session.step_back();
    EXPECT_EQ(session.previous_bodies()[0].position.y, 0.125);
    EXPECT_EQ(session.present_bodies()[0].position.y, 0.125);
}

TEST(SessionWithFake, GraphsFollowStepsBothWays) {
    Session session({}, nullptr, make_fake());
    ASSERT_TRUE(session.open(two_balls()));
    for (std::size_t i = 0; i < Graph::capacity + 10; ++i)
        session.step();
    const Graph &energy = session.graphs().energy;
    EXPECT_EQ(energy.size(), Graph::capacity);
    EXPECT_EQ(energy.at(Graph::capacity - 1), static_cast<double>(Graph::capacity + 10));
    EXPECT_EQ(energy.at(0), 11);
    session.step_back();
    EXPECT_EQ(energy.size(), Graph::capacity - 1);
    EXPECT_EQ(energy.at(energy.size() - 1), static_cast<double>(Graph::capacity + 9));
}

TEST(SessionWithFake, TimesAreOfTheStepThatLedHere) {
    Session session({}, nullptr, make_fake());
    ASSERT_TRUE(session.open(two_balls()));
    EXPECT_FALSE(session.times());
    dynamic_cast<FakeSimulation &>(*session.simulation()).advance_time = 1e-3;
    ASSERT_TRUE(session.step());
    ASSERT_TRUE(session.times());
    EXPECT_EQ(session.times()->advance, 1e-3);
    ASSERT_TRUE(session.step_back());
    EXPECT_FALSE(session.times());
    ASSERT_TRUE(session.step());
    EXPECT_TRUE(session.times());
    ASSERT_TRUE(session.restart());
    EXPECT_FALSE(session.times());
}

// Expectations about two_balls: "left" rises by 0.25 m/s.
SceneDesc expecting() {
    SceneDesc scene = two_balls();
    scene.world.settings.give(&StepSettings::dt, 0.125);
    const auto expect = [&](const char *name, const char *reduce, double to,
                            ExpectDesc::Relation relation, double value) {
        ExpectDesc desc;
        desc.name = name;
        desc.quantity = "position.y";
        desc.body = "left";
        desc.reduce = reduce;
        desc.to = to;
        desc.relation = relation;
        desc.value = value;
        desc.tolerance = relation == ExpectDesc::Relation::equals ? 0.01 : 0;
        scene.expects.push_back(desc);
    };
    expect("height", "last", 1, ExpectDesc::Relation::equals, 0.25);
    expect("never so high", "max", 2, ExpectDesc::Relation::at_most, 0.125);
    expect("low", "last", 0.5, ExpectDesc::Relation::at_most, 0.0625);
    return scene;
}

std::vector<Verdict> verdicts(const Session &session) {
    std::vector<Verdict> all;
    for (const ExpectOutcome &outcome : session.expectations())
        all.push_back(outcome.verdict);
    return all;
}

using enum Verdict;
using Verdicts = std::vector<Verdict>;

TEST(SessionWithFake, ExpectationsFollowTheRunBothWays) {
    Session session({}, nullptr, make_fake());
    ASSERT_TRUE(session.open(expecting()));
    const auto expected_after = [](int steps) {
        return Verdicts{steps < 8 ? pending : met, steps <= 4 ? pending : missed,
                        steps < 4 ? pending : missed};
    };
    EXPECT_EQ(verdicts(session), expected_after(0));
    for (int step = 1; step <= 20; ++step) {
        ASSERT_TRUE(session.step());
        ASSERT_EQ(verdicts(session), expected_after(step)) << step;
        ASSERT_EQ(session.expectations()[0].measured, 0.03125 * std::min(step, 8));
    }
    for (int step = 19; step >= 0; --step) {
        ASSERT_TRUE(session.step_back());
        ASSERT_EQ(verdicts(session), expected_after(step)) << step;
        ASSERT_EQ(session.expectations()[0].measured, 0.03125 * std::min(step, 8));
    }
    for (int step = 1; step <= 9; ++step)
        session.step();
    EXPECT_EQ(verdicts(session), expected_after(9));
    ASSERT_TRUE(session.restart());
    EXPECT_EQ(verdicts(session), expected_after(0));
    EXPECT_FALSE(session.disturbed());
}

TEST(SessionWithFake, AnotherStepIsJudgedByTimeNotByCount) {
    Session session({}, nullptr, make_fake());
    ASSERT_TRUE(session.open(expecting()));
    StepSettings settings = session.simulation()->settings();
    settings.dt = 0.25; // before the first step: the whole run uses it
    ASSERT_TRUE(session.set_settings(settings));
    EXPECT_FALSE(session.disturbed());
    for (int step = 1; step <= 4; ++step)
        ASSERT_TRUE(session.step());
    EXPECT_EQ(verdicts(session), (Verdicts{met, missed, missed}));
    ASSERT_TRUE(session.restart()); // with the newly chosen step
    EXPECT_EQ(verdicts(session), (Verdicts{pending, pending, pending}));
    for (int step = 1; step <= 4; ++step)
        ASSERT_TRUE(session.step());
    EXPECT_EQ(verdicts(session), (Verdicts{met, missed, missed}));
}

// The recording holds everything the window does to a run, undone steps included.
TEST_F(SessionTest, ARecordingIsTheWayToThePresentState) {
    Session session;
    session.record();
    ASSERT_TRUE(session.open(folder / "stack.toml"));
    const auto replayed_hash = [&] {
        const std::filesystem::path path = folder / "run.toml";
        OutputFile file(path);
        session.write_recording(file);
        const RecordingResult read = load_recording(path);
        EXPECT_TRUE(read.ok());
        const auto simulation = Simulation::create(read.recording.scene, {}, nullptr);
        Replay replay(read.recording);
        while (true) {
            EXPECT_TRUE(replay.obey(*simulation)) << "step " << simulation->step_count();
            if (replay.is_at_end(*simulation))
                break;
            simulation->step();
        }
        return simulation->hash();
    };
    EXPECT_EQ(replayed_hash(), session.simulation()->hash());
    hashes_of_steps(session, 3);
    const std::size_t crate = session.simulation()->find_body("crate_3").value();
    GrabView grab{crate, {0.5, 0.5, 0}, {1, 5, 0}, 1e5};
    session.grab(grab);
    hashes_of_steps(session, 2);
    grab.target.x = 2;
    session.grab(grab);
    hashes_of_steps(session, 4);
    EXPECT_EQ(replayed_hash(), session.simulation()->hash());
    session.shoot({-4, 1, 0}, {20, 0, 0}, 0.3);
    hashes_of_steps(session, 2);
    ASSERT_TRUE(session.step_back()); // lets go
    EXPECT_EQ(replayed_hash(), session.simulation()->hash());
    hashes_of_steps(session, 3);
    ASSERT_TRUE(session.set_method("sequential_impulses"));
    hashes_of_steps(session, 3);
    for (int i = 0; i < 8; ++i)
        ASSERT_TRUE(session.step_back()); // before the shot; the method stays
    EXPECT_EQ(replayed_hash(), session.simulation()->hash());
    session.shoot({-4, 1, 0}, {20, 0, 0}, 0.3);
    hashes_of_steps(session, 5);
    EXPECT_EQ(replayed_hash(), session.simulation()->hash());
    ASSERT_TRUE(session.restart());
    hashes_of_steps(session, 2);
    EXPECT_EQ(replayed_hash(), session.simulation()->hash());
}

// A recorded run plays back and forth until a new command is given.
TEST_F(SessionTest, ARecordingIsPlayedAgain) {
    const std::filesystem::path path = folder / "run.toml";
    std::vector<std::uint64_t> hashes;
    {
        Session session;
        session.record();
        ASSERT_TRUE(session.open(folder / "stack.toml"));
        hashes_of_steps(session, 3);
        GrabView grab{
            session.simulation()->find_body("crate_3").value(), {0.5, 0.5, 0}, {1, 5, 0}, 1e5};
        session.grab(grab);
        hashes_of_steps(session, 4);
        session.grab(std::nullopt);
        session.shoot({-4, 1, 0}, {20, 0, 0}, 0.3);
        hashes_of_steps(session, 5);
        ASSERT_TRUE(session.set_method("sequential_impulses"));
        hashes_of_steps(session, 3);
        hashes.push_back(session.simulation()->hash());
        OutputFile file(path);
        session.write_recording(file);
    }
    Session session;
    ASSERT_TRUE(session.open_recording(path));
    const auto play_to_the_end = [&] {
        while (session.step()) {
        }
        EXPECT_EQ(session.simulation()->step_count(), 15u);
        EXPECT_EQ(session.simulation()->hash(), hashes.back());
        EXPECT_EQ(session.present_bodies().size(), session.simulation()->body_count());
        EXPECT_EQ(session.replay_outcome(), ExitCode::fine);
        EXPECT_FALSE(session.stopped());
    };
    play_to_the_end();
    EXPECT_TRUE(session.disturbed());
    EXPECT_FALSE(session.step()) << "there is nothing beyond the end";
    for (int i = 0; i < 10; ++i)
        ASSERT_TRUE(session.step_back()); // before the shot and the change of method
    play_to_the_end();
    ASSERT_TRUE(session.restart());
    EXPECT_EQ(session.simulation()->step_count(), 0u);
    play_to_the_end();
    ASSERT_TRUE(session.shoot({-4, 1, 0}, {20, 0, 0}, 0.3));
    EXPECT_TRUE(session.step()) << "from here on it is another run";
    ASSERT_TRUE(session.reload());
    play_to_the_end();
}

// The saved scene's grab keeps holding, though no pointer does, until it is released.
TEST_F(SessionTest, WhatASavedSceneHoldsIsHeld) {
    Session first;
    ASSERT_TRUE(first.open(folder / "stack.toml"));
    const std::size_t crate = first.simulation()->find_body("crate_3").value();
    first.grab(GrabView{crate, {0.5, 0.5, 0}, {1, 5, 0}, 1e5});
    hashes_of_steps(first, 4);
    ASSERT_TRUE(first.save_scene(folder / "held.toml"));
    Session session;
    session.record();
    ASSERT_TRUE(session.open(folder / "held.toml"));
    EXPECT_FALSE(session.grabbed());
    ASSERT_TRUE(session.held());
    EXPECT_EQ(session.simulation()->body_info(session.held()->body).name, "crate_3");
    EXPECT_EQ(session.held()->target, glm::dvec3(1, 5, 0));
    EXPECT_EQ(session.held()->local_point, glm::dvec3(0.5, 0.5, 0));
    EXPECT_EQ(hashes_of_steps(session, 3), hashes_of_steps(first, 3));
    EXPECT_FALSE(session.disturbed());
    ASSERT_TRUE(session.step_back());
    EXPECT_TRUE(session.held());
    EXPECT_TRUE(session.let_go());
    EXPECT_FALSE(session.held());
    EXPECT_FALSE(session.let_go());
    hashes_of_steps(session, 2);
    EXPECT_TRUE(session.disturbed());
    {
        OutputFile file(folder / "run.toml");
        session.write_recording(file);
    }
    for (int i = 0; i < 3; ++i)
        ASSERT_TRUE(session.step_back());
    EXPECT_FALSE(session.held());
    ASSERT_TRUE(session.restart());
    EXPECT_TRUE(session.held());

    Session played;
    ASSERT_TRUE(played.open_recording(folder / "run.toml"));
    EXPECT_TRUE(played.held());
    EXPECT_FALSE(played.let_go()) << "the recording does";
    while (played.step()) {
    }
    EXPECT_FALSE(played.held());
    EXPECT_EQ(played.replay_outcome(), ExitCode::fine);
}

TEST_F(SessionTest, APlayedRecordingSaysWhereItDiffers) {
    const std::filesystem::path path = folder / "run.toml";
    Session recorded;
    recorded.record();
    ASSERT_TRUE(recorded.open(folder / "stack.toml"));
    hashes_of_steps(recorded, 9);
    {
        OutputFile file(path);
        recorded.write_recording(file);
    }
    Recording recording = load_recording(path).recording;
    recording.commands.push_back({4, ApplyImpulse{"crate_3", {10, 0, 0}, {0, 3, 0}}, 0});
    write("pushed.toml", write_recording(recording));
    Session session;
    ASSERT_TRUE(session.open_recording(folder / "pushed.toml"));
    while (session.step()) {
    }
    EXPECT_EQ(session.simulation()->step_count(), 4u);
    EXPECT_EQ(session.replay_outcome(), ExitCode::outside_tolerance);
    EXPECT_NE(session.messages().all().back().text.find("first differs at step 4"),
              std::string::npos);
    recording.commands.back() = {4, RemoveBody{"nobody"}, 0};
    write("removed.toml", write_recording(recording));
    ASSERT_TRUE(session.open_recording(folder / "removed.toml"));
    while (session.step()) {
    }
    EXPECT_EQ(session.simulation()->step_count(), 4u);
    EXPECT_EQ(session.replay_outcome(), ExitCode::bad_input);
}

TEST(SessionWithFake, ARunThatWasMeddledWithSaysSo) {
    Session session({}, nullptr, make_fake());
    ASSERT_TRUE(session.open(expecting()));
    session.step();
    session.step();
    EXPECT_FALSE(session.disturbed());
    session.shoot({0, 9, 0}, {0, 1, 0}, 0.1);
    EXPECT_TRUE(session.disturbed());
    session.step();
    session.step_back(); // the ball is still there
    EXPECT_TRUE(session.disturbed());
    session.step_back();
    EXPECT_FALSE(session.disturbed());
    session.grab(GrabView{0, {}, {0, 5, 0}});
    EXPECT_FALSE(session.disturbed());
    session.step();
    EXPECT_TRUE(session.disturbed());
    session.step_back();
    EXPECT_FALSE(session.disturbed());
    StepSettings settings = session.simulation()->settings();
    settings.gravity = {0, -1, 0};
    session.set_settings(settings);
    EXPECT_TRUE(session.disturbed());
    session.step_back(); // to the start: the whole run from here on uses the new settings
    EXPECT_FALSE(session.disturbed());
    session.step();
    session.set_settings(settings);
    EXPECT_TRUE(session.disturbed());
    ASSERT_TRUE(session.restart());
    EXPECT_FALSE(session.disturbed());
}

TEST(SessionWithFake, WhatDivergesIsNotJudgedFurther) {
    Session session({}, nullptr, make_fake());
    ASSERT_TRUE(session.open(expecting()));
    dynamic_cast<FakeSimulation &>(*session.simulation()).diverges_at = 2;
    while (session.step()) {
    }
    EXPECT_TRUE(session.stopped());
    EXPECT_EQ(verdicts(session), (Verdicts{pending, pending, pending}));
    ASSERT_TRUE(session.step_back());
    EXPECT_EQ(verdicts(session), (Verdicts{pending, pending, pending}));
}

TEST(Messages, NotesGoAndErrorsStay) {
    Messages messages;
    messages.note("saved");
    messages.error("broken");
    messages.grow_older(Messages::note_lifetime - 0.5);
    EXPECT_EQ(messages.all().size(), 2u);
    messages.note("saved"); // repeated: new again, and only once
    EXPECT_EQ(messages.all().size(), 2u);
    messages.grow_older(1);
    EXPECT_EQ(messages.all().size(), 2u);
    messages.grow_older(Messages::note_lifetime);
    ASSERT_EQ(messages.all().size(), 1u);
    EXPECT_EQ(messages.all()[0].text, "broken");
    for (int i = 0; i < 1000; ++i)
        messages.error(std::to_string(i));
    EXPECT_EQ(messages.all().size(), Messages::most);
}

} // namespace
} // namespace plumb
