// Every command and exit code, by running the program itself.
#include "tests/app/program.h"

#include "app/render/image.h"
#include "app/render/png.h"

#include <algorithm>
#include <fstream>
#include <set>
#include <vector>

#include <gtest/gtest.h>

namespace plumb {
namespace {

namespace fs = std::filesystem;

std::set<std::string> names_in(const fs::path &folder) {
    std::set<std::string> names;
    for (const fs::directory_entry &file : fs::directory_iterator(folder))
        names.insert(file.path().filename().string());
    return names;
}

// A freely falling ball that should be at `height` after one second.
std::string falling_ball(const std::string &height) {
    return R"([[body]]
name = "ball"
shape = "sphere"
radius = 1
position = [0, 10, 0]

[[expect]]
name = "height"
quantity = "position.y"
body = "ball"
reduce = "last"
to = 1
equals = )" +
           height + R"(
tolerance = 0.2
source = "closed form: h - g t^2 / 2"
)";
}

// Spins too fast for the finest step: not finite after one.
constexpr const char *diverging = R"([world]
dt = 1
method = "rk4"

[[body]]
name = "top"
shape = "box"
half_extents = [1, 2, 3]
angular_velocity = [1e9, 1e9, 1e9]
)";

constexpr const char *with_errors = R"(title = 3
[world]
dt = "0"
[[body]]
name = "a"
shape = "sphere"
radus = 1
)";

TEST(CommandLine, HelpOfEveryCommandNamesEveryOption) {
    const std::vector<std::string> run{"--set",        "--dt",        "--substeps",
                                       "--iterations", "--precision", "--threads"};
    struct Command {
        const char *name;
        std::vector<std::string> options;
        bool runs;
    };
    const Command commands[]{
        {"run",
         {"SCENE", "--method", "--gl", "--out", "--size", "--frames", "--screenshot", "--record"},
         true},
        {"replay", {"FILE", "--no-window", "--out", "--threads"}, false},
        {"snapshot",
         {"SCENE", "--method", "--at", "--every", "--steps", "--size", "--out", "--ui", "--samples",
          "--gl"},
         true},
        {"check", {"SCENE", "--method", "--all-methods"}, true},
        {"hash", {"SCENE", "--method", "--steps"}, true},
        {"list", {"--json", "--keys", "--methods", "--settings"}, false},
        {"measure", {"SCENE", "--method", "--steps", "--csv"}, true},
        {"chart",
         {"SCENE", "--methods", "--sweep", "--expect", "--repeats", "--out", "--set", "--dt",
          "--substeps", "--iterations", "--precision", "--convergence", "--one-step"},
         false}, // timed on one thread: it has no --threads
        {"map",
         {"SCENE", "--x", "--y", "NAME=FROM..TO[:N][log]", "--methods", "--image", "--csv",
          "--seconds"},
         true},
        {"tune",
         {"SCENE", "--methods", "--tolerance", "--starts", "--budget", "--repeats", "--explain",
          "--write", "--set", "--dt", "--substeps", "--iterations", "--precision"},
         false}, // timed on one thread
        {"reference", {"SCENE", "--write"}, false},
        {"compare", {"A", "B", "--tolerance", "--difference"}, false},
    };
    const ProgramResult all = run_program("--help");
    EXPECT_EQ(all.exit_code, 0);
    for (const Command &command : commands) {
        EXPECT_TRUE(has(all.out, std::string("  ") + command.name)) << command.name;
        const ProgramResult help = run_program(command.name + std::string(" --help"));
        EXPECT_EQ(help.exit_code, 0) << command.name;
        EXPECT_TRUE(help.err.empty()) << help.err;
        for (const std::string &option : command.options)
            EXPECT_TRUE(has(help.out, option)) << command.name << " " << option;
        for (const std::string &option : command.runs ? run : std::vector<std::string>{})
            EXPECT_TRUE(has(help.out, option)) << command.name << " " << option;
        EXPECT_TRUE(has(help.out, "Exit codes:")) << command.name;
    }
}

TEST(CommandLine, WrongArgumentsAreExitCode2) {
    for (const char *arguments : {"nonsense",
                                  "list --nonsense",
                                  "check",
                                  "hash pendulum",
                                  "snapshot pendulum --every 5",
                                  "snapshot pendulum --at 3 --every 5 --steps 9",
                                  "check pendulum --threads 0",
                                  "check pendulum --substeps 0",
                                  "check pendulum --dt -1",
                                  "check pendulum --precision half",
                                  "snapshot pendulum --gl vulkan",
                                  "snapshot pendulum --size 10",
                                  "map pendulum --x dt=1/60..1/30 --y substeps=1,2 --image m.jpg",
                                  "snapshot pendulum --size 640x400x2",
                                  "snapshot pendulum --size 15x400",
                                  "snapshot pendulum --at -1",
                                  "hash pendulum --steps -1",
                                  "measure pendulum --steps -1",
                                  "snapshot pendulum --every 3 --steps -9",
                                  "compare a.png",
                                  "chart pendulum --sweep dt",
                                  "chart geometry --methods rk4",
                                  "chart geometry --one-step",
                                  "chart free_fall --one-step --convergence",
                                  "chart free_fall --one-step --expect height",
                                  "map pendulum --x dt=1/120..1/30",
                                  "map pendulum --x dt=1/30..1/120 --y substeps=1,2",
                                  "map pendulum --x dtt=1..2 --y substeps=1,2",
                                  "map pendulum --x body.bbo.mass=1..2 --y substeps=1,2",
                                  "map pendulum --x dt=1/60,1/30 --y substeps=1,2 --seconds 1",
                                  "map points --x dt=1/60,1/30 --y substeps=1,2",
                                  "tune points",
                                  "reference",
                                  "reference pendulum rope",
                                  "reference pendulum --write",
                                  "tune pendulum --tolerance 0",
                                  "tune pendulum --budget 1",
                                  "tune pendulum --methods soft_stop",
                                  "tune free_fall pendulum"}) {
        const ProgramResult result = run_program(arguments);
        EXPECT_EQ(result.exit_code, 2) << arguments << '\n' << result.out << result.err;
        EXPECT_FALSE(result.err.empty()) << arguments;
    }
}

// Otherwise its value would be taken for a second scene.
TEST(CommandLine, AnOptionOfAnotherCommandIsAnsweredWithItsOwn) {
    const ProgramResult result = run_program("measure pendulum --methods rk4");
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(result.err, "plumb: plumb measure has no option --methods; did you mean --method?\n");
    EXPECT_EQ(run_program("list --nonsense").err,
              "plumb: plumb list has no option --nonsense; see plumb list --help\n");
}

// There is no number to report, and nothing diverged.
TEST(CommandLine, APeriodThatNothingHasIsMissed) {
    const TemporaryFolder folder;
    folder.write("still.toml", R"(
[world]
gravity = [0, 0, 0]
[[body]]
name = "ball"
shape = "sphere"
radius = 1
[[expect]]
name = "swings"
source = "it hangs on nothing"
quantity = "position.x"
body = "ball"
reduce = "period"
level = 1
to = 1
equals = 1
tolerance = 0.1
)");
    const ProgramResult check = run_program("check still.toml", folder.path());
    EXPECT_EQ(check.exit_code, 1);
    EXPECT_TRUE(has(check.out, "still/swings: none, expected 1 s ± 0.1 s  [")) << check.out;
    const ProgramResult chart = run_program(
        "chart still.toml --methods rk4 --sweep substeps=1 --repeats 1 --out .", folder.path());
    EXPECT_EQ(chart.exit_code, 1) << chart.err;
    EXPECT_TRUE(has(chart.out, "no result: swings")) << chart.out;
    const ProgramResult tune = run_program("tune still.toml --methods rk4", folder.path());
    EXPECT_EQ(tune.exit_code, 1);
    EXPECT_TRUE(has(tune.out, "there was nothing to judge swings by")) << tune.out;
}

TEST(CommandLine, AChartThatNoMethodCanRunLeavesTheEarlierOne) {
    const TemporaryFolder folder;
    folder.write("pendulum.csv", "earlier\n");
    EXPECT_EQ(run_program("chart pendulum --methods naive_spin --out " + folder.path().string())
                  .exit_code,
              2);
    EXPECT_EQ(names_in(folder.path()), std::set<std::string>{"pendulum.csv"});
    EXPECT_EQ(text_of(folder.path() / "pendulum.csv"), "earlier\n");
}

TEST(CommandLine, ShardsOfSeveralScenesMergeIntoAChartEach) {
    const TemporaryFolder folder;
    const std::string at = folder.path().string();
    for (const std::string n : {"1", "2"}) {
        const ProgramResult part = run_program("chart free_fall mass_on_spring --methods rk4 "
                                               "--sweep substeps=1,2 --repeats 1 --shard " +
                                               n + "/2 --out " + at);
        EXPECT_EQ(part.exit_code, 0) << part.err;
    }
    std::string tables;
    for (const std::string &name : names_in(folder.path()))
        tables += " " + at + "/" + name;
    const ProgramResult merged = run_program("merge" + tables + " --out " + at + "/whole");
    EXPECT_EQ(merged.exit_code, 0) << merged.err;
    const std::set<std::string> files = names_in(folder.path() / "whole");
    EXPECT_TRUE(files.contains("free_fall.csv"));
    EXPECT_TRUE(files.contains("mass_on_spring.csv"));
    const ProgramResult refused = run_program("merge" + tables + " --scene free_fall.toml");
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_TRUE(has(refused.err, "--scene is of one scene")) << refused.err;
}

TEST(CommandLine, AnUnknownMethodIsAnsweredWithThoseThereAre) {
    for (const char *command : {"hash --steps 1", "check", "measure", "snapshot"}) {
        const ProgramResult result =
            run_program(std::string(command) + " pendulum --method soft_stop");
        EXPECT_EQ(result.exit_code, 2) << command;
        EXPECT_TRUE(has(result.err, "soft_stop")) << command << ": " << result.err;
        EXPECT_TRUE(has(result.err, "soft_step")) << command << ": " << result.err;
    }
}

TEST(CommandLine, AWrongValueIsAnsweredWithWhatWouldBeRight) {
    for (const auto &[arguments, right] :
         {std::pair{"tune pendulum --budget 1", "as in 1ms"},
          std::pair{"chart pendulum --shard 3/2", "I from 1 to N"},
          std::pair{"chart pendulum --substeps 4", "substeps is given as 4 and also swept"},
          std::pair{"chart pendulum --sweep precision=float,double --precision double",
                    "precision is both given and swept"},
          std::pair{"map pendulum --x substeps=1,2 --y gravity.y=-9,-1 --set gravity=0,-3,0",
                    "gravity.y is given as -3 and also swept"},
          std::pair{"map pendulum --x precision=float,double --y dt=1/60,1/30",
                    "`plumb chart SCENE --sweep precision=float,double`"},
          std::pair{"chart bvh", "bvh: only probes, no motion to chart"}}) {
        const ProgramResult result = run_program(arguments);
        EXPECT_EQ(result.exit_code, 2) << arguments;
        EXPECT_TRUE(has(result.err, right)) << result.err;
    }
    const ProgramResult bounds = run_program("reference slope_holds");
    EXPECT_EQ(bounds.exit_code, 0) << bounds.err;
    EXPECT_TRUE(has(bounds.out, "slope_holds: has no expectation with `equals`")) << bounds.out;
}

TEST(CommandLine, AnUnknownSceneIsAnsweredWithTheNearest) {
    const ProgramResult result = run_program("check pendulm");
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_TRUE(has(result.err, "did you mean \"pendulum\"?")) << result.err;
}

// As `plumb list` shows them; a scene of that name would come first.
TEST(CommandLine, AGroupStandsForItsScenes) {
    const ProgramResult group = run_program("hash cloth --steps 0");
    const ProgramResult folder = run_program("hash " PLUMB_SOURCE_DIR "/scenes/cloth --steps 0");
    EXPECT_EQ(group.exit_code, 0) << group.err;
    EXPECT_TRUE(has(group.out, "\n")) << group.out;
    EXPECT_EQ(group.out, folder.out);
    const ProgramResult typo = run_program("hash cloht --steps 0");
    EXPECT_TRUE(has(typo.err, "\"cloth\"")) << typo.err;
    const ProgramResult one = run_program("measure cloth");
    EXPECT_EQ(one.exit_code, 2);
    EXPECT_TRUE(has(one.err, "give one scene")) << one.err;
}

TEST(CommandLine, ListNamesScenesMethodsAndKeys) {
    const ProgramResult scenes = run_program("list");
    EXPECT_EQ(scenes.exit_code, 0);
    EXPECT_TRUE(has(scenes.out, "wrecking_ball")) << scenes.out;
    const ProgramResult methods = run_program("list --methods");
    EXPECT_EQ(methods.exit_code, 0);
    EXPECT_TRUE(has(methods.out, "soft_step")) << methods.out;
    for (const char *line :
         {"soft_step             Soft step             contacts, joints, springs  ",
          "naive_impulses        Naive impulses        contacts, joints           Szauer",
          "rk4                   Runge-Kutta 4         free bodies, springs       "})
        EXPECT_TRUE(has(methods.out, line)) << line << '\n' << methods.out;
    const ProgramResult keys = run_program("list --keys");
    EXPECT_EQ(keys.exit_code, 0);
    EXPECT_TRUE(has(keys.out, "Ctrl+Q")) << keys.out;
}

TEST(CommandLine, ListJsonHoldsEveryScene) {
    const ProgramResult list = run_program("list --json");
    ASSERT_EQ(list.exit_code, 0);
    const TemporaryFolder folder;
    const fs::path json = folder.write("list.json", list.out);
    const fs::path checker = folder.write("check.py", R"(import json, os, sys
listed = json.load(open(sys.argv[1]))
found = sorted(os.path.join(d, f) for d, _, fs in os.walk(sys.argv[2]) for f in fs if f.endswith(".toml"))
assert sorted(s["path"] for s in listed) == found, (listed, found)
for s in listed:
    assert os.path.basename(s["path"]) == s["name"] + ".toml" and s["title"] and s["subject"], s
)");
    EXPECT_EQ(std::system(("python3 '" + checker.string() + "' '" + json.string() +
                           "' '" PLUMB_SOURCE_DIR "/scenes'")
                              .c_str()),
              0)
        << list.out;
}

TEST(CommandLine, CheckSaysWhetherASceneMeetsItsExpectations) {
    const TemporaryFolder folder;
    folder.write("right.toml", falling_ball("5.095"));
    folder.write("wrong.toml", falling_ball("7"));
    const ProgramResult right = run_program("check right.toml", folder.path());
    EXPECT_EQ(right.exit_code, 0) << right.out << right.err;
    EXPECT_TRUE(has(right.out, "ok    right/height")) << right.out;
    const ProgramResult wrong = run_program("check wrong.toml right.toml", folder.path());
    EXPECT_EQ(wrong.exit_code, 1) << wrong.out << wrong.err;
    EXPECT_TRUE(has(wrong.out, "MISSED wrong/height")) << wrong.out;
    EXPECT_TRUE(has(wrong.out, "ok    right/height")) << wrong.out;
}

TEST(CommandLine, ABadSceneIsExitCode2WithAllItsErrors) {
    const TemporaryFolder folder;
    folder.write("bad.toml", with_errors);
    for (const char *command :
         {"check", "hash --steps 1", "measure", "snapshot", "run --gl osmesa", "run", "chart"}) {
        const ProgramResult result = run_program(std::string(command) + " bad.toml", folder.path());
        EXPECT_EQ(result.exit_code, 2) << command << result.out << result.err;
        for (const char *place : {"bad.toml:1:9: error: ", "bad.toml:3:6: error: ",
                                  "bad.toml:4:1: error: ", "bad.toml:7:1: error: "})
            EXPECT_TRUE(has(result.err, place)) << command << ": " << place << '\n' << result.err;
    }
}

TEST(CommandLine, AMapIsPrintedAndWritten) {
    const TemporaryFolder folder;
    folder.write("fall.toml", falling_ball("5.095"));
    // Only large steps miss free fall by more than the tolerance, and RK4 never does.
    const ProgramResult map = run_program("map fall.toml --x dt=1/960..1/15:4log --y substeps=1,2 "
                                          "--methods semi_implicit_euler,rk4 --csv map.csv "
                                          "--image map.png --threads 2",
                                          folder.path());
    EXPECT_EQ(map.exit_code, 0) << map.err;
    EXPECT_TRUE(has(map.out, "semi_implicit_euler")) << map.out;
    EXPECT_TRUE(has(map.out, "missed: height")) << map.out;
    EXPECT_TRUE(has(map.out, "  ....\n")) << map.out;
    EXPECT_TRUE(has(text_of(folder.path() / "map.csv"), "kind,method,dt,substeps,low,high,why"));
    EXPECT_TRUE(fs::exists(folder.path() / "map.png"));
}

TEST(CommandLine, WhatIsTunedIsWrittenAndNothingElse) {
    const TemporaryFolder folder;
    const std::string world = "# as it falls\n[world]\nmethod = \"semi_implicit_euler\"\n"
                              "substeps = 64 # far too many\ndt = \"1/60\"\n\n";
    const fs::path file = folder.write("fall.toml", world + falling_ball("5.095"));
    // It falls g h t / 2 too far: 0.082 m with one substep; 0.8 of 0.2 m is allowed.
    const std::string tune = "tune fall.toml --methods semi_implicit_euler --dt 1/60 ";
    const ProgramResult looked = run_program(tune + "--explain", folder.path());
    EXPECT_EQ(looked.exit_code, 0) << looked.err;
    EXPECT_TRUE(has(looked.out, "semi_implicit_euler with 1 substep ")) << looked.out;
    EXPECT_TRUE(has(looked.out, "the scene's own settings cost ")) << looked.out;
    EXPECT_TRUE(has(looked.out, "Twice the substeps would cost ")) << looked.out;
    EXPECT_TRUE(has(looked.out, "; CHOSEN")) << looked.out;
    EXPECT_EQ(text_of(file), world + falling_ball("5.095")) << "only --write writes";

    const ProgramResult wrote = run_program(tune + "--write --precision float", folder.path());
    EXPECT_EQ(wrote.exit_code, 0) << wrote.err;
    EXPECT_TRUE(has(wrote.err, "wrote ")) << wrote.err;
    EXPECT_EQ(text_of(file), "# as it falls\n[world]\nmethod = \"semi_implicit_euler\"\n"
                             "substeps = 1 # far too many\ndt = \"1/60\"\n\n" +
                                 falling_ball("5.095"));
    const ProgramResult again = run_program(tune + "--write --precision float", folder.path());
    EXPECT_EQ(again.exit_code, 0) << again.err;
    EXPECT_TRUE(has(again.out, "Nothing to write")) << again.out;
    EXPECT_EQ(run_program("check fall.toml", folder.path()).exit_code, 0);

    // Settings given on the command line that meet the scene are written too.
    const ProgramResult other =
        run_program("tune fall.toml --methods semi_implicit_euler --dt 1/120 --substeps 2 --write "
                    "--precision float",
                    folder.path());
    EXPECT_EQ(other.exit_code, 0) << other.err;
    EXPECT_TRUE(has(other.out, "the scene's own settings, with the given options")) << other.out;
    EXPECT_TRUE(has(other.err, "dt holds for every method")) << other.err;
    EXPECT_TRUE(has(text_of(file), "substeps = 2 # far too many\ndt = \"1/120\"")) << text_of(file);
    const ProgramResult moon =
        run_program("tune fall.toml --set gravity=0,-9.81,0 --write", folder.path());
    EXPECT_EQ(moon.exit_code, 2);
    EXPECT_TRUE(has(moon.err, "--write keeps the scene's gravity")) << moon.err;
}

TEST(CommandLine, WhatCannotBeTunedIsExitCode1AndIsNotWritten) {
    const TemporaryFolder folder;
    const fs::path file = folder.write("fall.toml", falling_ball("7")); // not its actual height
    const ProgramResult result =
        run_program("tune fall.toml --methods rk4 --substeps 1 --write", folder.path());
    EXPECT_EQ(result.exit_code, 1) << result.err;
    EXPECT_TRUE(has(result.out, "nothing tried meets its expectation")) << result.out;
    EXPECT_EQ(text_of(file), falling_ball("7"));
    const ProgramResult dear = run_program(
        "tune fall.toml --methods rk4 --substeps 1 --write --budget 0.000001us", folder.path());
    EXPECT_EQ(dear.exit_code, 1) << dear.err;
    EXPECT_EQ(text_of(file), falling_ball("7"));
}

TEST(CommandLine, ADivergingWorldIsExitCode3) {
    const TemporaryFolder folder;
    folder.write("top.toml", diverging);
    for (const char *command :
         {"check top.toml", "hash --steps 9 top.toml", "measure top.toml --steps 9 --csv top.csv",
          "snapshot top.toml --at 0,9 --size 64x64"}) {
        const ProgramResult result = run_program(command, folder.path());
        EXPECT_EQ(result.exit_code, 3) << command << '\n' << result.out << result.err;
        std::string said = result.out + result.err;
        std::ranges::transform(said, said.begin(),
                               [](char c) { return c >= 'A' && c <= 'Z' ? char(c + 32) : c; });
        EXPECT_TRUE(has(said, "diverged")) << command << '\n' << said;
    }
    // The pictures up to there.
    EXPECT_TRUE(fs::exists(folder.path() / "out" / "top-00000.png"));
    EXPECT_TRUE(fs::exists(folder.path() / "out" / "top-00001.png"));
    EXPECT_FALSE(fs::exists(folder.path() / "out" / "top-00009.png"));
}

TEST(CommandLine, WithoutADisplayAWindowIsExitCode4WithTheReason) {
    const TemporaryFolder folder;
    for (const char *command :
         {"run pendulum --gl window", "snapshot pendulum --gl window --size 64x64"}) {
        const ProgramResult result = run_program(command, folder.path());
        EXPECT_EQ(result.exit_code, 4) << command << '\n' << result.err;
        EXPECT_TRUE(has(result.err, "window: ")) << result.err;
        EXPECT_TRUE(has(result.err, "DISPLAY")) << result.err;
        EXPECT_FALSE(has(result.err, "osmesa: ")) << result.err;
    }
}

TEST(CommandLine, WithoutADisplayRunDrawsAPictureAndSaysWhy) {
    const TemporaryFolder folder;
    const ProgramResult result = run_program("run pendulum --size 200x100", folder.path());
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(has(result.err, "no window: ")) << result.err;
    EXPECT_TRUE(has(result.err, "DISPLAY")) << result.err;
    const fs::path picture = folder.path() / "out" / "pendulum.png";
    ASSERT_TRUE(fs::exists(picture));
    EXPECT_TRUE(has(result.out, "out/pendulum.png")) << result.out;
    const Image image = read_png(picture);
    EXPECT_EQ(image.width, 200);
    EXPECT_EQ(image.height, 100);
}

TEST(CommandLine, SnapshotsAreNumberedByStep) {
    const TemporaryFolder folder;
    const auto shoot = [&](const std::string &how, const std::string &to) {
        const ProgramResult result = run_program(
            "snapshot pendulum --size 64x48 --samples 1 --out " + to + " " + how, folder.path());
        EXPECT_EQ(result.exit_code, 0) << how << '\n' << result.err;
        return names_in(folder.path() / to);
    };
    using Names = std::set<std::string>;
    EXPECT_EQ(shoot("", "start"), (Names{"pendulum-00000.png"}));
    EXPECT_EQ(shoot("--at 7,3,7", "at"), (Names{"pendulum-00003.png", "pendulum-00007.png"}));
    EXPECT_EQ(shoot("--steps 12", "steps"), (Names{"pendulum-00012.png"}));
    EXPECT_EQ(shoot("--every 5 --steps 12", "every"),
              (Names{"pendulum-00000.png", "pendulum-00005.png", "pendulum-00010.png"}));
    EXPECT_EQ(shoot("--ui --at 1", "ui"), (Names{"pendulum-00001.png"}));
    const Image image = read_png(folder.path() / "at" / "pendulum-00003.png");
    EXPECT_EQ(image.width, 64);
    EXPECT_EQ(image.height, 48);
}

TEST(CommandLine, TheSameSnapshotTwiceIsTheSameFile) {
    const TemporaryFolder folder;
    for (const char *to : {"a", "b"})
        ASSERT_EQ(
            run_program(std::string("snapshot pyramid --at 4 --size 160x100 --ui --out ") + to,
                        folder.path())
                .exit_code,
            0);
    const ProgramResult same =
        run_program("compare a/pyramid-00004.png b/pyramid-00004.png", folder.path());
    EXPECT_EQ(same.exit_code, 0) << same.out << same.err;
}

TEST(CommandLine, CompareTellsPicturesApart) {
    const TemporaryFolder folder;
    const Image grey(32, 24, {100, 100, 100});
    Image near = grey;
    near.set(3, 4, {105, 100, 100});
    write_png(folder.path() / "grey.png", grey);
    write_png(folder.path() / "near.png", near);
    write_png(folder.path() / "small.png", Image(16, 24, {100, 100, 100}));
    const auto compare = [&](const std::string &arguments) {
        return run_program("compare " + arguments, folder.path());
    };
    EXPECT_EQ(compare("grey.png grey.png").exit_code, 0);
    EXPECT_EQ(compare("grey.png near.png").exit_code, 1);
    EXPECT_EQ(compare("grey.png near.png --tolerance 4").exit_code, 1);
    EXPECT_EQ(compare("grey.png near.png --tolerance 5 --difference d.png").exit_code, 0);
    EXPECT_EQ(read_png(folder.path() / "d.png").width, 32);
    const ProgramResult sizes = compare("grey.png small.png --tolerance 255");
    EXPECT_EQ(sizes.exit_code, 1);
    EXPECT_TRUE(has(sizes.out, "32x24")) << sizes.out;
    const ProgramResult missing = compare("grey.png none.png");
    EXPECT_EQ(missing.exit_code, 2);
    EXPECT_TRUE(has(missing.err, "cannot read none.png: No such file or directory")) << missing.err;
}

TEST(CommandLine, ScenesAreFoundFromAnyFolder) {
    const TemporaryFolder folder;
    for (const fs::path &from : {fs::path("/"), folder.path(), fs::path(PLUMB_SOURCE_DIR)})
        for (const char *name : {"pendulum", "joints/pendulum"}) {
            const ProgramResult result = run_program(std::string("hash --steps 2 ") + name, from);
            EXPECT_EQ(result.exit_code, 0) << from << ' ' << name << result.err;
        }
}

TEST(CommandLine, WhatCannotBeWrittenIsOneMessageAndExitCode5) {
    const TemporaryFolder folder;
    folder.write("file", "");
    for (const char *command : {"snapshot pendulum --size 64x64 --out file/below",
                                "run pendulum --size 64x64 --out file/below",
                                "measure pendulum --steps 2 --csv file/x"}) {
        const ProgramResult result = run_program(command, folder.path());
        EXPECT_EQ(result.exit_code, 5) << command << '\n' << result.out << result.err;
        EXPECT_TRUE(has(result.err, "file/")) << command << '\n' << result.err;
    }
    EXPECT_EQ(names_in(folder.path()), (std::set<std::string>{"file"}));
}

TEST(CommandLine, NothingIsLeftBesideWhatIsWritten) {
    const TemporaryFolder folder;
    ASSERT_EQ(run_program("measure pendulum --steps 3 --csv table.csv", folder.path()).exit_code,
              0);
    ASSERT_EQ(run_program("snapshot pendulum --size 64x64 --out .", folder.path()).exit_code, 0);
    EXPECT_EQ(names_in(folder.path()), (std::set<std::string>{"table.csv", "pendulum-00000.png"}));
}

TEST(CommandLine, MeasureWritesARowForEachStep) {
    const ProgramResult result = run_program("measure pendulum --steps 3");
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(std::ranges::count(result.out, '\n'), 5) << result.out; // header, start, three steps
}

TEST(CommandLine, TheHashIsTheSameForAnyNumberOfThreadsAndEachRun) {
    const ProgramResult once = run_program("hash wrecking_ball pyramid --steps 60");
    ASSERT_EQ(once.exit_code, 0) << once.err;
    EXPECT_EQ(run_program("hash wrecking_ball pyramid --steps 60").out, once.out);
    EXPECT_EQ(run_program("hash wrecking_ball pyramid --steps 60 --threads 2").out, once.out);
    EXPECT_NE(run_program("hash wrecking_ball pyramid --steps 61").out, once.out);
}

} // namespace
} // namespace plumb
