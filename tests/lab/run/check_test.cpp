// The check command on real scene files.
#include "app/lab/run/check.h"

#include "app/lab/chart/chart.h"
#include "app/lab/run/measure.h"
#include "tests/lab/csv_reader.h"
#include "tests/temporary_folder.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

namespace plumb {
namespace {

namespace fs = std::filesystem;

// Free fall over 1 s from 10 m: true height 10 - 9.81 / 2 = 5.095 m.
const std::string fall = R"(
[world]
precision = "double"
[[body]]
name = "ball"
shape = "sphere"
radius = 0.5
position = [0, 10, 0]
[[expect]]
name = "height"
quantity = "position.y"
body = "ball"
to = 1
source = "10 - g t^2 / 2"
equals = 5.095
tolerance = )";

class LabCommands : public testing::Test {
  protected:
    fs::path file(const std::string &name, const std::string &text) {
        std::ofstream(folder_ / name) << text;
        return folder_ / name;
    }

    TemporaryFolder temporary_;
    fs::path folder_ = temporary_.path();
    std::ostringstream out_, err_;
};

TEST_F(LabCommands, CheckFineScene) {
    CheckCommand command;
    command.scenes = {file("fall.toml", fall + "0.1\n")};
    EXPECT_EQ(check_scenes(command, out_, err_), ExitCode::fine) << out_.str() << err_.str();
    EXPECT_NE(out_.str().find("ok    fall/height: 5.0"), std::string::npos) << out_.str();
    EXPECT_NE(out_.str().find("expected 5.095 m ± 0.1 m"), std::string::npos) << out_.str();
    EXPECT_NE(out_.str().find("soft_step substeps="), std::string::npos) << out_.str();
    EXPECT_NE(out_.str().find("dt=1/60 s double]"), std::string::npos) << out_.str();
    EXPECT_EQ(err_.str(), "");
}

TEST_F(LabCommands, CheckMissedToleranceInAFolder) {
    file("a.toml", fall + "0.1\n");
    // Semi-implicit Euler falls g dt t / 2 too far, 0.082 m here: outside 0.01 m.
    file("b.toml", fall + "0.01\n");
    CheckCommand command;
    command.scenes = {folder_};
    command.methods = {"semi_implicit_euler"};
    EXPECT_EQ(check_scenes(command, out_, err_), ExitCode::outside_tolerance) << out_.str();
    EXPECT_NE(out_.str().find("ok    a/height"), std::string::npos) << out_.str();
    EXPECT_NE(out_.str().find("MISSED b/height"), std::string::npos) << out_.str();
    EXPECT_NE(out_.str().find("1 not within tolerance"), std::string::npos) << out_.str();
}

TEST_F(LabCommands, BadInput) {
    CheckCommand command;
    command.scenes = {file("bad.toml", "[[body]]\nname = 3\n"), file("fall.toml", fall + "0.1\n")};
    EXPECT_EQ(check_scenes(command, out_, err_), ExitCode::bad_input);
    EXPECT_NE(err_.str().find("bad.toml:"), std::string::npos) << err_.str();
    EXPECT_NE(out_.str().find("ok    fall/height"), std::string::npos) << "goes on: " << out_.str();

    command.scenes = {folder_ / "fall.toml"};
    command.run.method = "no_such_method";
    EXPECT_EQ(check_scenes(command, out_, err_), ExitCode::bad_input);
    command.scenes = {folder_ / "none.toml"};
    EXPECT_EQ(check_scenes(command, out_, err_), ExitCode::bad_input);
    EXPECT_NE(err_.str().find("none.toml"), std::string::npos) << err_.str();

    MeasureCommand measure;
    measure.scene = folder_ / "bad.toml";
    EXPECT_EQ(measure_scene(measure, out_, err_), ExitCode::bad_input);
    measure.scene = folder_ / "fall.toml";
    measure.out = folder_ / "no_such_folder" / "x.csv";
    EXPECT_THROW((void)measure_scene(measure, out_, err_), std::system_error);
}

// No expectation, so none was met.
TEST_F(LabCommands, CheckCountsScenesThatExpectNothingApart) {
    const std::string ball = fall.substr(0, fall.find("[[expect]]"));
    CheckCommand command;
    command.scenes = {file("ball.toml", ball)};
    EXPECT_EQ(check_scenes(command, out_, err_), ExitCode::fine) << err_.str();
    EXPECT_NE(out_.str().find("ball: expects nothing"), std::string::npos) << out_.str();
    EXPECT_EQ(out_.str().find("within tolerance"), std::string::npos) << out_.str();
    EXPECT_NE(out_.str().find("1 run: 1 with nothing to judge"), std::string::npos) << out_.str();
    out_.str("");
    command.scenes.push_back(file("fall.toml", fall + "0.1\n"));
    command.scenes.push_back(file("far.toml", fall + "0.01\n")); // off by 0.082 m, as above
    command.run.method = "semi_implicit_euler";
    EXPECT_EQ(check_scenes(command, out_, err_), ExitCode::outside_tolerance) << err_.str();
    EXPECT_NE(out_.str().find(
                  "3 runs: 1 within tolerance, 1 not within tolerance, 1 with nothing to judge"),
              std::string::npos)
        << out_.str();
}

// Scenes that the method cannot run do not count as runs.
TEST_F(LabCommands, CheckSkipsWhatTheMethodCannotRun) {
    const fs::path pendulum = PLUMB_SOURCE_DIR "/scenes/joints/pendulum.toml";
    CheckCommand command;
    command.scenes = {pendulum};
    command.run.method = "rk4";
    EXPECT_EQ(check_scenes(command, out_, err_), ExitCode::bad_input) << err_.str();
    EXPECT_NE(out_.str().find("-     pendulum: skipped: rk4 "), std::string::npos) << out_.str();
    EXPECT_NE(out_.str().find("nothing was checked; 1 skipped\n"), std::string::npos) << out_.str();
    out_.str("");
    command.run.method.clear();
    command.scenes.push_back(file("fall.toml", fall + "0.1\n"));
    command.methods = {"rk4"};
    EXPECT_EQ(check_scenes(command, out_, err_), ExitCode::fine) << err_.str();
    EXPECT_NE(out_.str().find("1 run: 1 within tolerance; 1 skipped\n"), std::string::npos)
        << out_.str();
}

TEST_F(LabCommands, CheckDoesNotJudgeWhatASavedStateHasBehindIt) {
    std::string saved = fall + "0.1\n[[expect]]\nname = \"way\"\nquantity = \"displacement\"\n"
                               "body = \"ball\"\nto = 3\nat_most = 1e3\nsource = \"test\"\n";
    saved += "[state]\nstep = 120\n"; // 2 s: the height was expected after 1 s
    CheckCommand command;
    command.scenes = {file("saved.toml", saved)};
    EXPECT_EQ(check_scenes(command, out_, err_), ExitCode::fine) << err_.str() << out_.str();
    EXPECT_NE(out_.str().find("-     saved/height: not judged"), std::string::npos) << out_.str();
    EXPECT_NE(out_.str().find("-     saved/way: not judged"), std::string::npos) << out_.str();
    EXPECT_NE(out_.str().find("1 run: 1 with nothing to judge"), std::string::npos) << out_.str();
}

TEST_F(LabCommands, CheckRefusesAnEmptyFile) {
    CheckCommand command;
    for (const char *text : {"", "# nothing yet\n", "title = \"empty\"\n[world]\ndt = 0.01\n"}) {
        out_.str("");
        err_.str("");
        command.scenes = {file("empty.toml", text)};
        EXPECT_EQ(check_scenes(command, out_, err_), ExitCode::bad_input) << text;
        EXPECT_NE(err_.str().find("empty.toml:1:1: error: the scene is empty"), std::string::npos)
            << err_.str();
        EXPECT_EQ(std::ranges::count(err_.str(), '\n'), 1) << err_.str();
    }
}

TEST(ExitCodes, OfOutcomes) {
    CheckOutcome outcome;
    EXPECT_EQ(exit_code(outcome), ExitCode::fine);
    outcome.run.outcomes.emplace_back(); // not judged
    EXPECT_EQ(exit_code(outcome), ExitCode::outside_tolerance);
    outcome.run.divergence.emplace();
    EXPECT_EQ(exit_code(outcome), ExitCode::diverged);
    outcome.why_not = "it cannot";
    EXPECT_EQ(exit_code(outcome), ExitCode::bad_input);
    EXPECT_EQ(worse(ExitCode::fine, ExitCode::outside_tolerance), ExitCode::outside_tolerance);
    EXPECT_EQ(worse(ExitCode::diverged, ExitCode::outside_tolerance), ExitCode::diverged);
    EXPECT_EQ(worse(ExitCode::bad_input, ExitCode::no_gl_context), ExitCode::bad_input);
}

TEST_F(LabCommands, MeasureWritesItsTableWhole) {
    MeasureCommand command;
    command.scene = file("fall.toml", fall + "0.1\n");
    command.steps = 30;
    command.out = folder_ / "fall.csv";
    EXPECT_EQ(measure_scene(command, out_, err_), ExitCode::fine) << err_.str();
    std::stringstream text;
    text << std::ifstream(command.out).rdbuf();
    EXPECT_EQ(read_csv(text.str()).size(), 1U + 31);
    EXPECT_FALSE(fs::exists(folder_ / "fall.csv.partial"));
    EXPECT_NE(out_.str().find("30 steps, 0.5 s simulated"), std::string::npos) << out_.str();
    command.out.clear();
    std::ostringstream table;
    EXPECT_EQ(measure_scene(command, table, err_), ExitCode::fine);
    EXPECT_EQ(read_csv(table.str()).size(), 1U + 31); // and only the table
}

TEST_F(LabCommands, ChartWritesTableAndPicture) {
    ChartCommand command;
    command.scenes = {file("fall.toml", fall + "0.1\n")};
    command.options.sweep = {parse_sweep("substeps=1,2")};
    command.options.repeats = 1;
    command.out_dir = folder_ / "charts" / "deep";
    command.shader_dir = PLUMB_SOURCE_DIR "/shaders";
    EXPECT_EQ(chart_scenes(command, out_, err_), ExitCode::fine) << err_.str();
    EXPECT_TRUE(fs::exists(command.out_dir / "fall.csv"));
    EXPECT_FALSE(fs::exists(command.out_dir / "fall.csv.partial"));
    EXPECT_GT(fs::file_size(command.out_dir / "fall.png"), 1000U);

    fs::create_directories(folder_ / "other");
    command.scenes.push_back(file("other/fall.toml", fall + "0.1\n"));
    EXPECT_EQ(chart_scenes(command, out_, err_), ExitCode::bad_input); // the same file name twice
}

} // namespace
} // namespace plumb
