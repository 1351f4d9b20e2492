// Ctrl-C during charts and maps: finished results are kept.
#include "app/lab/chart/chart.h"
#include "app/lab/csv.h"
#include "app/lab/fingerprint.h"
#include "app/lab/map/stability_map.h"
#include "app/lab/partial_table.h"
#include "tests/lab/chart/falling.h"
#include "tests/temporary_folder.h"

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include <gtest/gtest.h>

namespace plumb {
namespace {

namespace fs = std::filesystem;

const char *const fall = R"(
[[body]]
name = "ball"
shape = "sphere"
radius = 0.5
[[expect]]
name = "x"
quantity = "position.x"
body = "ball"
to = 1
equals = 1
tolerance = 0.3
source = "as the fake has it"
)";

std::string text_of(const fs::path &path) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
}

// How many rows of a table belong to each method.
std::map<std::string, int> rows_by_method(const std::string &table) {
    std::istringstream in(table);
    CsvReader rows(in);
    std::map<std::string, int> count;
    while (rows.next())
        ++count[std::string(rows.cell("method"))];
    return count;
}
using Rows = std::map<std::string, int>;

class Interrupted : public testing::Test {
  protected:
    Interrupted() {
        for (const char *scene : {"a", "b"})
            std::ofstream(folder_ / (std::string(scene) + ".toml")) << fall;
    }

    TemporaryFolder temporary_;
    fs::path folder_ = temporary_.path();
    std::ostringstream out_, err_;
};

class InterruptedChart : public Interrupted {
  protected:
    // Makes `until` simulations, and is interrupted while making the next. Returns how many it
    // finished. By default one of two shards, as shards have no pictures.
    int chart(const std::vector<std::string> &scenes, const std::vector<std::string> &methods,
              int until = 1000) {
        int made = 0;
        ChartCommand command;
        for (const std::string &scene : scenes)
            command.scenes.push_back(folder_ / (scene + ".toml"));
        command.options = quick([&](const SceneDesc &scene, const RunOptions &options) {
            if (made++ == until)
                (void)std::raise(SIGINT);
            return fakes()(scene, options);
        });
        command.options.methods = methods;
        command.options.convergence = true; // nothing is timed
        command.options.base.precision = Precision::f64;
        command.options.sweep = {parse_sweep("dt=1/60,1/50,1/40,1/30")};
        command.options.shard = shard_;
        command.out_dir = folder_;
        command.shader_dir = PLUMB_SOURCE_DIR "/shaders";
        EXPECT_EQ(chart_scenes(command, out_, err_), ExitCode::fine) << err_.str();
        return std::min(made, until);
    }
    Shard shard_{1, 2};
    [[nodiscard]] fs::path table(const char *scene) const {
        return folder_ / (std::string(scene) + ".convergence.1-of-2.csv");
    }
    [[nodiscard]] fs::path partial(const char *scene) const {
        return table(scene).string() + ".partial";
    }
};

TEST_F(InterruptedChart, GoesOnWithEveryScene) {
    EXPECT_EQ(chart({"a", "b"}, {"soft_step"}, 3), 3);
    EXPECT_EQ(rows_by_method(text_of(table("a"))), (Rows{{"soft_step", 2}}));
    EXPECT_FALSE(fs::exists(table("b")));
    EXPECT_NE(err_.str().find("interrupted; rows so far: "), std::string::npos) << err_.str();
    // Neither the finished scene nor the first row of the other is run again.
    EXPECT_EQ(chart({"a", "b"}, {"soft_step"}), 1);
    EXPECT_EQ(rows_by_method(text_of(table("b"))), (Rows{{"soft_step", 2}}));
    EXPECT_FALSE(fs::exists(partial("a")));
    EXPECT_FALSE(fs::exists(partial("b")));
    EXPECT_EQ(chart({"a", "b"}, {"soft_step"}), 4); // from scratch
}

// Its accurate run is repeated, but no row is.
TEST_F(Interrupted, AChartOfSingleStepsGoesOn) {
    ChartCommand command;
    command.scenes = {folder_ / "a.toml"};
    command.options = quick({});
    command.options.one_step = true;
    command.options.methods = {"stormer_verlet", "rk4"};
    command.options.sweep = {parse_sweep("substeps=1,2")};
    command.options.repeats = 1;
    command.options.shard = {1, 2};
    command.out_dir = folder_;
    std::set<int> made; // substeps of Stormer-Verlet
    bool interrupts = true;
    command.options.make = [&](const SceneDesc &scene, const RunOptions &options) {
        if (interrupts && options.method == "rk4")
            (void)std::raise(SIGINT);
        if (options.method == "stormer_verlet" && scene.expects.empty())
            made.insert(resolve_run(scene, options).settings.substeps); // a single step
        return Simulation::create(scene, options, nullptr);
    };
    EXPECT_EQ(chart_scenes(command, out_, err_), ExitCode::fine) << err_.str();
    const fs::path table = folder_ / "a.one-step.1-of-2.csv";
    EXPECT_EQ(rows_by_method(text_of(table.string() + ".partial"))["stormer_verlet"], 1);
    EXPECT_EQ(made, std::set<int>{1});
    interrupts = false;
    made.clear();
    EXPECT_EQ(chart_scenes(command, out_, err_), ExitCode::fine) << err_.str();
    EXPECT_TRUE(made.empty());
    EXPECT_EQ(rows_by_method(text_of(table)), (Rows{{"stormer_verlet", 1}, {"rk4", 1}}));
    EXPECT_FALSE(fs::exists(table.string() + ".partial"));
}

TEST_F(InterruptedChart, KeepsWhatWasKnownWhenItIsInterruptedAtOnce) {
    EXPECT_EQ(chart({"a"}, {"soft_step", "rk4"}, 3), 3);
    EXPECT_EQ(chart({"a"}, {"soft_step", "rk4"}, 0), 0);
    EXPECT_EQ(chart({"b"}, {"soft_step"}, 0), 0);
    EXPECT_EQ(chart({"a"}, {"soft_step", "rk4"}), 1);
}

TEST_F(InterruptedChart, KeepsTheRowsOfOtherMethods) {
    EXPECT_EQ(chart({"a"}, {"soft_step", "rk4"}, 3), 3);
    EXPECT_EQ(chart({"a"}, {"tgs_soft"}, 1), 1);
    EXPECT_EQ(chart({"a"}, {"tgs_soft"}), 1);
    EXPECT_EQ(rows_by_method(text_of(table("a"))), (Rows{{"tgs_soft", 2}}));
    EXPECT_EQ(chart({"a"}, {"soft_step", "rk4"}), 1);
    EXPECT_EQ(rows_by_method(text_of(table("a"))), (Rows{{"soft_step", 2}, {"rk4", 2}}));
}

// Even while the table of what was interrupted is kept, for another command's rows.
TEST_F(InterruptedChart, LeavesNoPartialPictureBesideTheWholeOne) {
    shard_ = {1, 1};
    const fs::path stem = folder_ / "a.convergence";
    EXPECT_EQ(chart({"a"}, {"soft_step", "rk4"}, 6), 6);
    EXPECT_TRUE(fs::exists(stem.string() + ".partial.png")) << err_.str();
    EXPECT_EQ(chart({"a"}, {"soft_step"}), 4);
    EXPECT_TRUE(fs::exists(stem.string() + ".csv.partial"));
    EXPECT_TRUE(fs::exists(stem.string() + ".png"));
    EXPECT_FALSE(fs::exists(stem.string() + ".partial.png"));
}

TEST_F(InterruptedChart, FollowsLinks) {
    fs::create_directory(folder_ / "below");
    fs::create_symlink("below/t.csv", table("a"));
    EXPECT_EQ(chart({"a"}, {"soft_step"}, 1), 1);
    EXPECT_TRUE(fs::exists(folder_ / "below" / "t.csv.partial"));
    EXPECT_EQ(chart({"a"}, {"soft_step"}), 1);
    EXPECT_TRUE(fs::is_symlink(table("a")));
    EXPECT_EQ(rows_by_method(text_of(folder_ / "below" / "t.csv")), (Rows{{"soft_step", 2}}));
    EXPECT_FALSE(fs::exists(folder_ / "below" / "t.csv.partial"));
}

class InterruptedMap : public Interrupted {
  protected:
    // Interrupted after `until` cells that were not known yet.
    void map(const std::vector<std::string> &methods, std::size_t until = 1000) {
        MapCommand command;
        command.scene = folder_ / "a.toml";
        command.x = parse_map_axis("dt=0.1,0.2");
        command.y = parse_map_axis("substeps=1,2");
        command.options.methods = methods;
        std::size_t seen = 0;
        command.options.changed = [&](const StabilityMap &) {
            if (++seen == until)
                (void)std::raise(SIGINT);
        };
        command.csv = folder_ / "m.csv";
        EXPECT_EQ(map_scene(command, out_, err_), ExitCode::fine) << err_.str();
        run_ = seen;
    }
    [[nodiscard]] Rows rows(const char *file) const {
        return rows_by_method(text_of(folder_ / file));
    }

    std::size_t run_ = 0;
};

TEST_F(InterruptedMap, KeepsTheRowsOfOtherMethods) {
    map({"rk4", "stormer_verlet"}, 6);
    EXPECT_EQ(rows("m.csv.partial"), (Rows{{"rk4", 4}, {"stormer_verlet", 2}}));
    map({"velocity_verlet"}, 1);
    EXPECT_EQ(rows("m.csv.partial"),
              (Rows{{"rk4", 4}, {"stormer_verlet", 2}, {"velocity_verlet", 1}}));
    map({"velocity_verlet"});
    EXPECT_EQ(run_, 3U);
    EXPECT_EQ(rows("m.csv"), (Rows{{"velocity_verlet", 4}}));
    EXPECT_EQ(rows("m.csv.partial"), (Rows{{"rk4", 4}, {"stormer_verlet", 2}}));
    map({"rk4", "stormer_verlet"});
    EXPECT_EQ(run_, 2U);
    EXPECT_EQ(rows("m.csv"), (Rows{{"rk4", 4}, {"stormer_verlet", 4}}));
    EXPECT_FALSE(fs::exists(folder_ / "m.csv.partial"));
}

TEST(PartialTable, KeepsItsOwnProgramsRowsAlone) {
    const TemporaryFolder folder;
    const fs::path place = folder.path() / "partial";
    const std::string own = Fingerprint::of_program() + "-1", head = "key,\"a,b\",made_by\n";
    std::ofstream(place) << head << "1,\"x\"\"y\"," << own << "\n2,z," << own << "\n3,z,other-1\n";
    const PartialTable table(place);
    const std::vector<std::string> key{"key", "made_by"};
    EXPECT_EQ(table.rows_not_in(head + "2,new," + own + "\n", key, "made_by"),
              "1,\"x\"\"y\"," + own + "\n");
    EXPECT_EQ(table.rows_not_in("key,made_by\n", key, "made_by"), ""); // a different table
    table.keep_only("2,z," + own + "\n");
    EXPECT_EQ(text_of(place), head + "2,z," + own + "\n");
    table.keep_only("");
    EXPECT_FALSE(fs::exists(place));
    EXPECT_EQ(PartialTable(place).text(), "");
    PartialTable(place).keep_only("");
}

} // namespace
} // namespace plumb
