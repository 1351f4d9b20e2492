// The cheapest settings with which a scene meets all that it expects of itself.
#pragma once

#include "app/lab/chart/chart.h"
#include "app/lab/exit_code.h"
#include "app/lab/progress.h"
#include "app/lab/run/judged_run.h"
#include "app/lab/run/scene_text.h"
#include "engine/scene/simulation.h"

#include <filesystem>
#include <functional>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

namespace plumb {

// What is searched for is all but what `base` gives.
struct TuneOptions {
    std::vector<std::string> methods; // empty: all that can run the scene
    RunOptions base;                  // its method is not read
    double tolerance = 0.8;           // the share of each tolerance that may be used, 0..1
    int starts = 3;                   // beside the scene as it stands; see starts.h
    std::optional<double> budget;     // s of CPU time for a simulated second
    int repeats = 5;                  // timings of each that comes into question
    bool plainer = true;              // whether to try what the model can do without
    std::function<bool()> stop;       // asked often; true ends early with what there is
    Progress progress;
    MakeSimulation make; // empty: Simulation::create, on one thread
};

enum class TuneVerdict { met, missed, diverged, unfinished };

// One combination of settings, and what came of it.
struct TunedRun {
    RunOptions options;
    ResolvedRun resolved;
    TuneVerdict verdict = TuneVerdict::unfinished;
    int starts = 0; // that were run: those after one that was missed are not
    // The largest error of all starts in units of its tolerance, the full one, and whose it is.
    // At least so large where the run was given up on.
    double error = 0;
    std::string worst; // the name of an expectation; empty: all errors are 0
    double work = 0;   // passes over bodies and constraints per simulated second, as counted
    // CPU seconds per simulated second: the median of the timings, or without them the least of the
    // runs, by which only what is far too dear is left out.
    double cost = 0;
    std::vector<double> timings;
};

// The scene with one thing less, beside all that was left out before.
struct PlainerModel {
    std::string what; // that is left out, after "without"
    TunedRun run;
    double times_as_dear = 0; // as the fuller one; 0 where it was not timed
    bool is_enough = false;   // left out
};

struct Tuning {
    std::string scene;
    std::size_t expectations = 0;
    double tolerance = 1;
    int starts = 0; // of each run, the scene as it stands counted
    // As they were tried; the first is as the scene has it, but for what is given.
    std::vector<TunedRun> runs;
    bool own_is_given = false; // something is given that differs
    std::optional<std::size_t> chosen;
    std::optional<std::size_t> dearer; // the chosen one with twice the substeps
    std::vector<PlainerModel> plainer; // of the chosen one, as they were tried
    std::optional<double> budget;
    std::vector<std::string> left_out; // why, of each method that cannot run the scene
    bool interrupted = false;

    [[nodiscard]] const TunedRun &own() const { return runs.front(); }
    // The chosen one, less all that can be left out.
    [[nodiscard]] const TunedRun &plainest() const;
    // Chosen, and within the budget.
    [[nodiscard]] bool found() const { return chosen && !(budget && runs[*chosen].cost > *budget); }
};

// What is not dearer by so much in every turn may cost the same, and the counted work decides; of
// two methods what is not by the median, and then the error decides.
inline constexpr double same_cost = 1.03;
// The most substeps that are tried.
inline constexpr int most_substeps = 1024;

// Of every method, in float and in double, at double, the same, half and a quarter of the scene's
// dt, with 1, 2, 4 and 8 iterations, where it has any, and with as many substeps for all as well as
// with those that each island asks for, where it can: the fewest substeps that meet the scene.
// These are found by doubling and then halving the gap; where some setting has met the scene, only
// what is less work (by the same method, no finer in precision and in dt) is tried at all,
// beginning with the most substeps, so that most are left out after one run or none. Those that
// come into question are timed against each other in turns. Of what is chosen, plainer models are
// tried in the end; see plainer.h.
//
// Throws std::invalid_argument when the scene's motion is held to nothing, and for options that
// make no sense.
[[nodiscard]] Tuning tune_scene(const SceneText &text, const TuneOptions &options);

// What was chosen, and what the dearer choice would buy; with `explain` a table of all runs.
void print(std::ostream &out, const Tuning &tuning, bool explain);

// "1ms", "200us", "0.5 ms", "0.001s": of CPU time for a frame of 1/60 s, in seconds for a
// simulated second. Throws std::invalid_argument that says what would be right.
[[nodiscard]] double parse_budget(const std::string &text);

struct TuneCommand {
    std::filesystem::path scene;
    TuneOptions options; // its stop and progress are set here
    bool write = false;  // the chosen settings into the scene's file
    bool explain = false;
};

// Prints to `out`, and everything else to `err`. On Ctrl-C says the best so far, and writes
// nothing.
[[nodiscard]] ExitCode tune_scene(const TuneCommand &command, std::ostream &out, std::ostream &err);

} // namespace plumb
