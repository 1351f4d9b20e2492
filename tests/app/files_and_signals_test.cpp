// What the program writes and reads, and how it stops on request, by running the program itself.
#include "tests/app/program.h"

#include "app/render/png.h"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include <fcntl.h>
#include <sys/stat.h>

namespace plumb {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

std::vector<std::string> files_in(const fs::path &folder) {
    std::vector<std::string> names;
    for (const fs::directory_entry &file : fs::directory_iterator(folder))
        names.push_back(file.path().filename().string());
    std::ranges::sort(names);
    return names;
}

// Waits for up to a minute.
template <typename Condition> bool comes(const Condition &condition) {
    for (int i = 0; i < 600 && !condition(); ++i)
        std::this_thread::sleep_for(100ms);
    return condition();
}

// Whether the program running in that folder reports its progress.
bool shows_progress(const fs::path &folder) {
    return comes([&] { return has(text_of(folder / "err"), " %"); });
}

// Sanitizers count reserved memory along with used memory.
#if defined(__SANITIZE_ADDRESS__)
constexpr bool memory_can_be_limited = false;
#elif defined(__has_feature)
constexpr bool memory_can_be_limited = !__has_feature(address_sanitizer);
#else
constexpr bool memory_can_be_limited = true;
#endif

const char *with_memory(const char *limit) {
    return memory_can_be_limited ? limit : "";
}

// Many spheres in one place.
std::string heap(int count) {
    return R"([[body]]
name = "ball"
shape = "sphere"
radius = 1
repeat = { kind = "line", count = )" +
           std::to_string(count) + ", step = [1e-4, 0, 0] }\n";
}

TEST(Output, AFullDiskIsExitCode5WithTheReasonInEveryCommand) {
    const TemporaryFolder folder;
    write_png(folder.path() / "a.png", Image(16, 16));
    for (const char *command :
         {"--help", "--version", "check --help", "list", "list --json", "list --keys",
          "list --methods", "hash pendulum --steps 1", "check free_fall", "check raycasts",
          "measure pendulum --steps 2", "measure raycasts", "snapshot pendulum --size 16x16",
          "chart free_fall --sweep substeps=1 --repeats 1", "compare a.png a.png",
          "run pendulum --size 16x16", "measure pendulum --steps 2 --csv t.csv"}) {
        const ProgramResult result =
            run_program(std::string(command) + " >/dev/full", folder.path());
        EXPECT_EQ(result.exit_code, 5) << command << '\n' << result.err;
        EXPECT_TRUE(has(result.err, "standard output: cannot be written: No space left on device"))
            << command << '\n'
            << result.err;
    }
    for (const char *command :
         {"measure pendulum --steps 2 --csv /dev/full", "measure raycasts --csv /dev/full",
          "compare a.png a.png --difference /dev/full"}) {
        const ProgramResult result = run_program(command, folder.path());
        EXPECT_EQ(result.exit_code, 5) << command << '\n' << result.err;
        EXPECT_TRUE(has(result.err, "/dev/full: cannot be written: No space left on device"))
            << command << '\n'
            << result.err;
    }
    EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

// It does not run to the end first.
TEST(Output, AFullDiskStopsALongCommand) {
    const ProgramResult result = run_program("measure pendulum --steps 1000000000 >/dev/full");
    EXPECT_EQ(result.exit_code, 5) << result.err;
}

TEST(Output, GoesThroughPipesLinksAndStandardOutput) {
    const TemporaryFolder folder;
    fs::create_symlink("real.csv", folder.path() / "link.csv");
    ASSERT_EQ(run_program("measure pendulum --steps 2 --csv link.csv", folder.path()).exit_code, 0);
    EXPECT_TRUE(fs::is_symlink(folder.path() / "link.csv"));
    // Times differ from run to run.
    const auto lines = [](const std::string &text) { return std::ranges::count(text, '\n'); };
    EXPECT_EQ(lines(text_of(folder.path() / "real.csv")), 4);

    ASSERT_EQ(mkfifo((folder.path() / "pipe").c_str(), 0600), 0);
    std::string read;
    std::thread reader([&] { read = text_of(folder.path() / "pipe"); });
    EXPECT_EQ(run_program("measure pendulum --steps 2 --csv pipe", folder.path()).exit_code, 0);
    reader.join();
    EXPECT_EQ(lines(read), 4);
    EXPECT_TRUE(fs::is_fifo(folder.path() / "pipe"));

    const ProgramResult printed = run_program("measure pendulum --steps 2 --csv /dev/stdout");
    EXPECT_EQ(printed.exit_code, 0);
    EXPECT_TRUE(printed.out.starts_with("step,time_s,")) << printed.out;
    EXPECT_TRUE(has(printed.out, "\n2,")) << printed.out;
    EXPECT_TRUE(has(printed.out, "2 steps, ")) << printed.out; // followed by the summary
}

TEST(Output, TwoRunsMayWriteTheSameFile) {
    const TemporaryFolder folder;
    const TemporaryFolder first_prints;
    const TemporaryFolder second_prints;
    const std::string command =
        "measure pendulum --steps 20000 --csv '" + (folder.path() / "t.csv").string() + "'";
    RunningProgram first(command, first_prints.path());
    RunningProgram second(command, second_prints.path());
    for (RunningProgram *program : {&first, &second}) {
        const ProgramResult result = program->wait();
        EXPECT_EQ(result.exit_code, 0) << result.err;
    }
    EXPECT_EQ(std::ranges::count(text_of(folder.path() / "t.csv"), '\n'), 20002);
    EXPECT_EQ(files_in(folder.path()), std::vector<std::string>{"t.csv"});
}

TEST(Input, WhatNeverEndsIsReadNoFurtherThanASceneMayBeLong) {
    for (const char *command : {"check", "hash --steps 1", "measure", "snapshot", "chart"}) {
        const ProgramResult result = run_program(std::string(command) + " /dev/zero", ".",
                                                 with_memory("prlimit --as=2000000000"));
        EXPECT_EQ(result.exit_code, 2) << command << '\n' << result.err;
        EXPECT_TRUE(has(result.err, "/dev/zero: error: the file is too large; a scene file has at "
                                    "most 64 MiB"))
            << command << '\n'
            << result.err;
    }
}

TEST(Input, ASceneMayComeThroughAPipe) {
    const TemporaryFolder folder;
    folder.write("ball.toml", heap(1));
    ASSERT_EQ(mkfifo((folder.path() / "pipe").c_str(), 0600), 0);
    std::thread writer(
        [&] { std::ofstream(folder.path() / "pipe") << text_of(folder.path() / "ball.toml"); });
    EXPECT_EQ(run_program("hash ./pipe --steps 1", folder.path()).exit_code, 0);
    writer.join();
}

TEST(Input, ASceneToMapMayComeThroughAPipe) {
    const TemporaryFolder folder;
    folder.write("ball.toml", heap(1));
    ASSERT_EQ(mkfifo((folder.path() / "pipe").c_str(), 0600), 0);
    std::thread writer(
        [&] { std::ofstream(folder.path() / "pipe") << text_of(folder.path() / "ball.toml"); });
    const ProgramResult map =
        run_program("map ./pipe --x dt=1/60,1/30 --y substeps=1,2 --seconds 0.1", folder.path());
    EXPECT_EQ(map.exit_code, 0) << map.err;
    writer.join();
}

TEST(Signals, CtrlCStopsPicturesAtOnceAndKeepsThoseThatAreThere) {
    for (const auto &[signal, code] : {std::pair{SIGINT, 130}, std::pair{SIGTERM, 143}}) {
        const TemporaryFolder folder;
        RunningProgram program("snapshot pyramid --every 1 --steps 100000 --size 160x100 "
                               "--gl osmesa --out frames",
                               folder.path());
        ASSERT_TRUE(
            comes([&] { return fs::exists(folder.path() / "frames" / "pyramid-00002.png"); }));
        const auto count = [&] { return files_in(folder.path() / "frames").size(); };
        const std::size_t before = count();
        program.send(signal);
        const ProgramResult result = program.wait();
        EXPECT_EQ(result.exit_code, code) << result.err;
        EXPECT_TRUE(has(result.err, "interrupted")) << result.err;
        EXPECT_LE(count(), before + 2);
        for (const std::string &name : files_in(folder.path() / "frames")) {
            EXPECT_TRUE(name.ends_with(".png")) << name;
            EXPECT_EQ(read_png(folder.path() / "frames" / name).width, 160) << name;
        }
        EXPECT_EQ(static_cast<std::size_t>(std::ranges::count(result.out, '\n')), count());
    }
}

TEST(Signals, CtrlCStopsEveryLongCommandAndKeepsWhatWasDone) {
    struct Command {
        const char *arguments;
        std::vector<std::string> kept;
    };
    for (const auto &[arguments, kept] :
         {Command{"measure pyramid --steps 100000 --csv t.csv", {"t.csv.partial"}},
          Command{"measure pyramid --steps 100000", {}},
          Command{"hash pyramid --set sleep_after=0 --steps 100000", {}},
          Command{"run pyramid --frames 100000 --size 64x64 --gl osmesa", {}},
          Command{"check pyramid --substeps 1000 --set sleep_after=0", {}},
          Command{"tune pyramid --methods soft_step --substeps 200 --set max_substeps=1 --dt 1/60 "
                  "--starts 0 --precision float --iterations 1",
                  {}},
          Command{"chart pyramid --sweep substeps=256 --out .", {"pyramid.csv.partial"}},
          Command{"map pyramid --x dt=1/6000,1/3000 --y substeps=100,200 --methods soft_step --csv "
                  "m.csv",
                  {"m.csv.partial"}},
          Command{"chart geometry --repeats 1000 --out .", {"geometry.csv.partial"}}}) {
        const TemporaryFolder folder;
        RunningProgram program(arguments, folder.path());
        EXPECT_TRUE(shows_progress(folder.path())) << arguments;
        program.send(SIGINT);
        const ProgramResult result = program.wait();
        EXPECT_EQ(result.exit_code, 130) << arguments << '\n' << result.err;
        if (std::string_view(arguments).starts_with("check")) {
            EXPECT_NE(result.err.find("0 of 1 runs are done"), std::string::npos) << result.err;
        }
        std::vector<std::string> expected = kept;
        expected.insert(expected.end(), {"err", "out"});
        std::vector<std::string> there = files_in(folder.path());
        std::erase(there, "pyramid.partial.png");
        std::ranges::sort(expected);
        EXPECT_EQ(there, expected) << arguments;
    }
}

TEST(Signals, AKillLeavesNothingBehind) {
    const TemporaryFolder folder;
    const int nameless = open(folder.path().c_str(), O_TMPFILE | O_WRONLY, 0600);
    if (nameless < 0)
        GTEST_SKIP() << "this file system knows no files without a name";
    close(nameless);
    RunningProgram program("measure pyramid --steps 100000 --csv t.csv", folder.path());
    EXPECT_TRUE(shows_progress(folder.path()));
    program.send(SIGKILL);
    EXPECT_EQ(program.wait().exit_code, 137);
    EXPECT_EQ(files_in(folder.path()), (std::vector<std::string>{"err", "out"}));
}

TEST(Arguments, ListsWithGapsAreRefused) {
    for (const char *arguments :
         {"snapshot pendulum --at 1,2,,3", "snapshot pendulum --at 1,", "snapshot pendulum --at ,1",
          "snapshot pendulum --at 1,x", "snapshot pendulum --at 1.5",
          "snapshot pendulum --at 1000000001", "chart pendulum --methods soft_step,,rk4",
          "chart pendulum --sweep substeps=1,,2", "list --keys --methods"}) {
        const TemporaryFolder folder;
        const ProgramResult result = run_program(arguments, folder.path());
        EXPECT_EQ(result.exit_code, 2) << arguments << '\n' << result.out << result.err;
        EXPECT_FALSE(result.err.empty()) << arguments;
        EXPECT_TRUE(files_in(folder.path()).empty()) << arguments;
    }
}

TEST(Arguments, ListJsonIsJsonOfWhateverIsListed) {
    const TemporaryFolder folder;
    const fs::path checker = folder.write("check.py", R"(import json, sys
methods, keys = (json.load(open(name)) for name in sys.argv[1:])
assert {m["name"] for m in methods} >= {"soft_step", "rk4"}, methods
runs = {m["name"]: (m["contacts"], m["joints"], m["springs"]) for m in methods}
assert runs["soft_step"] == (True, True, True) and runs["rk4"] == (False, False, True), runs
assert runs["naive_impulses"] == (True, True, False), runs
assert all(type(m["contacts"]) is bool and m["title"] and m["source"] for m in methods), methods
assert any("Ctrl+Q" in k.get("keys", []) for k in keys), keys
assert any(k.get("gesture") == "Wheel" for k in keys), keys
)");
    const ProgramResult methods = run_program("list --methods --json");
    const ProgramResult keys = run_program("list --keys --json");
    EXPECT_EQ(methods.exit_code, 0);
    EXPECT_EQ(keys.exit_code, 0);
    EXPECT_EQ(std::system(("python3 '" + checker.string() + "' '" +
                           folder.write("methods.json", methods.out).string() + "' '" +
                           folder.write("keys.json", keys.out).string() + "'")
                              .c_str()),
              0)
        << methods.out << keys.out;
}

TEST(Messages, SayTheSceneOnce) {
    const ProgramResult result = run_program("snapshot pyramid --method rk4 --size 16x16");
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_TRUE(has(result.err, "pyramid cannot run: ")) << result.err;
    EXPECT_FALSE(has(result.err, "pyramid: pyramid")) << result.err;
}

TEST(Messages, OfManyMistakesTheFirst50AreListed) {
    const TemporaryFolder folder;
    std::string scene;
    for (int i = 0; i < 600; ++i)
        scene += "mistake_" + std::to_string(i) + " = 1\n";
    folder.write("bad.toml", scene);
    for (const char *command : {"check", "run --gl osmesa", "snapshot"}) {
        const ProgramResult result = run_program(std::string(command) + " bad.toml", folder.path());
        EXPECT_EQ(result.exit_code, 2) << command;
        EXPECT_EQ(std::ranges::count(result.err, '\n') - (command[0] == 'r' ? 2 : 0), 51)
            << command << '\n'
            << result.err;
        EXPECT_TRUE(has(result.err, "bad.toml:1:1: error: ")) << command << result.err;
        EXPECT_TRUE(has(result.err, "bad.toml:50:1: error: ")) << command << result.err;
        EXPECT_TRUE(has(result.err, "bad.toml: error: ... and 550 more")) << command << result.err;
    }
}

TEST(Memory, WhatWouldTakeTooMuchIsRefusedAtItsLine) {
    const TemporaryFolder folder;
    folder.write("heap.toml", heap(8000));
    folder.write("hills.toml", R"([[probe]]
name = "hills"
ask = "closest"
points = [[0, 1, 0]]
shapes = [{ shape = "height_field", half_extents = [1, 1, 200000] }]
)");
    for (const char *command : {"check", "hash --steps 1", "measure", "snapshot"}) {
        // Less than either used before.
        const char *little = with_memory("prlimit --as=2000000000");
        const ProgramResult crowd =
            run_program(std::string(command) + " heap.toml", folder.path(), little);
        EXPECT_EQ(crowd.exit_code, 2) << command << '\n' << crowd.err;
        EXPECT_TRUE(has(crowd.err, "heap.toml:1:1: error: with \"ball_2449\" more than 3000000 "
                                   "pairs of bodies touch or overlap at the start"))
            << crowd.err;
        const ProgramResult hills =
            run_program(std::string(command) + " hills.toml", folder.path(), little);
        EXPECT_EQ(hills.exit_code, 2) << command << '\n' << hills.err;
        EXPECT_TRUE(has(hills.err, "hills.toml:5:")) << hills.err;
        EXPECT_TRUE(has(hills.err, "heights; at most 1000000")) << hills.err;
    }
}

TEST(Memory, ThatRanOutIsExitCode5) {
    if (!memory_can_be_limited)
        GTEST_SKIP() << "a sanitizer reserves more than any limit";
    const TemporaryFolder folder;
    folder.write("heap.toml", heap(1500)); // a million pairs: some 600 MB
    for (const char *command : {"check", "hash --steps 1", "measure --steps 1"}) {
        const ProgramResult result = run_program(std::string(command) + " heap.toml", folder.path(),
                                                 "prlimit --as=400000000");
        EXPECT_EQ(result.exit_code, 5) << command << '\n' << result.out << result.err;
        EXPECT_TRUE(has(result.err, "out of memory")) << command << '\n' << result.err;
        EXPECT_FALSE(has(result.err, "bad_alloc")) << command << '\n' << result.err;
    }
}

} // namespace
} // namespace plumb
