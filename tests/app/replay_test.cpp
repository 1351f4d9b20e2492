// `plumb run --record` and `plumb replay`, by running the program itself.
#include "tests/app/program.h"

#include "engine/scene/recording.h"
#include "engine/scene/scene_file.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace plumb {
namespace {

namespace fs = std::filesystem;

constexpr const char *stack = R"([[body]]
name = "ground"
shape = "plane"
[[body]]
name = "crate"
shape = "box"
half_extents = [0.5, 0.5, 0.5]
position = [0, 0.6, 0]
repeat = { kind = "stack", count = 3 }
)";

constexpr const char *record =
    "run stack.toml --substeps 2 --gl osmesa --size 16x16 --frames 31 --record run.toml";

TEST(Replay, EndsWithTheHashThatWasRecorded) {
    const TemporaryFolder folder;
    folder.write("stack.toml", stack);
    const ProgramResult run = run_program(record, folder.path());
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const ProgramResult hash =
        run_program("hash stack.toml --substeps 2 --steps 30", folder.path());
    for (const char *threads : {"", " --threads 3"}) {
        const ProgramResult again =
            run_program(std::string("replay --no-window run.toml") + threads, folder.path());
        EXPECT_EQ(again.exit_code, 0) << again.err;
        EXPECT_EQ(again.out.substr(0, 16), hash.out.substr(0, 16)) << again.out;
        EXPECT_TRUE(has(again.out, "step 30")) << again.out;
    }
}

// A recording that starts mid-run, after bodies were removed, and one of a run resumed from the
// scene that was saved then.
TEST(Replay, OfTheMiddleOfARunAfterABodyWasRemoved) {
    const TemporaryFolder folder;
    const SceneFileResult read = parse_scene(stack, "stack.toml");
    ASSERT_TRUE(read.ok());
    const auto simulation = Simulation::create(read.scene, {}, nullptr);
    const auto step = [&](int count) {
        for (int i = 0; i < count; ++i)
            simulation->step();
    };
    step(10);
    simulation->apply(RemoveBody{"crate_1"});
    step(10);
    folder.write("later.toml", write_scene(simulation->describe()));
    Recorder recorder(*simulation);
    BodyDesc crate = read.scene.bodies.back();
    crate.name = "crate_9";
    crate.position = {0.1, 4, 0};
    simulation->apply(AddBody{crate});
    recorder.add(*simulation, AddBody{crate});
    for (int i = 0; i < 40; ++i) {
        recorder.before_step(*simulation);
        simulation->step();
    }
    folder.write("middle.toml", write_recording(recorder.recording(*simulation)));
    const ProgramResult middle = run_program("replay --no-window middle.toml", folder.path());
    EXPECT_EQ(middle.exit_code, 0) << middle.err;
    EXPECT_EQ(middle.out.substr(0, 16), hash_text(simulation->hash())) << middle.out;

    const ProgramResult run = run_program(
        "run later.toml --gl osmesa --size 16x16 --frames 11 --record run.toml", folder.path());
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const ProgramResult again = run_program("replay --no-window run.toml", folder.path());
    EXPECT_EQ(again.exit_code, 0) << again.err;
    EXPECT_TRUE(has(again.out, "step 30")) << again.out;
}

TEST(Replay, SaysAtWhichStepItFirstDiffers) {
    const TemporaryFolder folder;
    folder.write("stack.toml", stack);
    ASSERT_EQ(run_program(record, folder.path()).exit_code, 0);
    Recording recording = load_recording(folder.path() / "run.toml").recording;
    ASSERT_EQ(recording.hashes.size(), 31U);
    // Adds a push that was not in the recorded run.
    recording.commands.push_back({12, ApplyImpulse{"crate_1", {10, 0, 0}, {0, 1.6, 0}}, 0});
    folder.write("pushed.toml", write_recording(recording));
    const ProgramResult pushed = run_program("replay --no-window pushed.toml", folder.path());
    EXPECT_EQ(pushed.exit_code, 1) << pushed.out;
    EXPECT_TRUE(pushed.out.empty()) << pushed.out;
    EXPECT_TRUE(has(pushed.err, "first differs at step 12")) << pushed.err;
}

TEST(Replay, ABadRecordingIsExitCode2WithItsPlace) {
    const TemporaryFolder folder;
    folder.write("stack.toml", stack);
    ASSERT_EQ(run_program(record, folder.path()).exit_code, 0);
    const std::string good = text_of(folder.path() / "run.toml");
    const auto line = std::to_string(std::ranges::count(good, '\n') + 2);
    folder.write("word.toml", good + "\n[[command]]\nstep = 3\ndo = \"jump\"\n");
    const ProgramResult word = run_program("replay --no-window word.toml", folder.path());
    EXPECT_EQ(word.exit_code, 2) << word.out;
    EXPECT_TRUE(has(word.err, "word.toml:" + std::to_string(std::ranges::count(good, '\n') + 4) +
                                  ":6: error: "))
        << word.err;
    folder.write("body.toml", good + "\n[[command]]\nstep = 3\ndo = \"remove\"\nbody = \"x\"\n");
    const ProgramResult body = run_program("replay --no-window body.toml", folder.path());
    EXPECT_EQ(body.exit_code, 2) << body.out;
    EXPECT_TRUE(has(body.err, "body.toml:" + line + ": error: there is no body \"x\"")) << body.err;
    EXPECT_EQ(run_program("replay --no-window stack.toml", folder.path()).exit_code, 2);
    EXPECT_EQ(run_program("replay --no-window nothing.toml", folder.path()).exit_code, 2);
}

TEST(Record, WhatCannotBeRecordedIsSaid) {
    const TemporaryFolder folder;
    folder.write("stack.toml", stack);
    const ProgramResult nowhere = run_program(
        "run stack.toml --gl osmesa --size 16x16 --frames 2 --record no/run.toml", folder.path());
    EXPECT_EQ(nowhere.exit_code, 5) << nowhere.err;
    EXPECT_TRUE(has(nowhere.err, "no/run.toml")) << nowhere.err;
    const ProgramResult no_window = run_program("run stack.toml --record run.toml", folder.path());
    EXPECT_EQ(no_window.exit_code, 4) << no_window.err;
    EXPECT_TRUE(has(no_window.err, "--frames")) << no_window.err;
    const ProgramResult probes = run_program(
        "run raycasts --gl osmesa --size 16x16 --frames 1 --record run.toml", folder.path());
    EXPECT_EQ(probes.exit_code, 2) << probes.err;
    EXPECT_TRUE(has(probes.err, "only probes")) << probes.err;
    EXPECT_FALSE(fs::exists(folder.path() / "run.toml"));
}

} // namespace
} // namespace plumb
