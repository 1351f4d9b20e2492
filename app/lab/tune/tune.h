// Finds the cheapest settings with which a scene meets all its expectations.
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

// Everything that `base` does not give is searched.
struct TuneOptions {
    std::vector<std::string> methods; // empty: all that can run the scene
    RunOptions base;                  // its method is not read
    double tolerance = 0.8;           // the share of each tolerance that may be used, 0..1
    int starts = 3;                   // besides the scene as it stands; see starts.h
    std::optional<double> budget;     // s of CPU time per simulated second
    int repeats = 5;                  // timings of each candidate
    bool plainer = true;              // also try simpler models
    std::function<bool()> stop;       // called often; true ends early with the results so far
    Progress progress;
    MakeSimulation make; // empty: Simulation::create, on one thread
};

enum class TuneVerdict { met, missed, diverged, unfinished };

// One combination of settings and its result.
struct TunedRun {
    RunOptions options;
    ResolvedRun resolved;
    TuneVerdict verdict = TuneVerdict::unfinished;
    int starts = 0; // number run: none after the first that missed
    // The largest error over all starts, in units of its full tolerance, and whose it is. A lower
    // bound if the run was given up.
    double error = 0;
    std::string worst; // the name of an expectation; empty: all errors are 0
    double work = 0;   // passes over bodies and constraints per simulated second, as counted
    // CPU seconds per simulated second: the median of the timings, or without timings the least of
    // the runs, which only serves to rule out settings that are far too dear.
    double cost = 0;
    std::vector<double> timings;
};

// The scene with one more thing left out, on top of everything left out before.
struct PlainerModel {
    std::string what; // what is left out, worded to follow "without"
    TunedRun run;
    double times_as_dear = 0; // cost relative to the fuller model; 0 if not timed
    bool is_enough = false;   // accepted
};

struct Tuning {
    std::string scene;
    std::size_t expectations = 0;
    double tolerance = 1;
    int starts = 0; // per run, including the scene as it stands
    // In the order tried; the first uses the scene's own settings, except for those given.
    std::vector<TunedRun> runs;
    bool own_is_given = false; // a given setting differs from the scene's
    std::optional<std::size_t> chosen;
    std::optional<std::size_t> dearer; // the chosen one with twice the substeps
    std::vector<PlainerModel> plainer; // of the chosen run, in the order tried
    std::optional<double> budget;
    std::vector<std::string> left_out; // why each of these methods cannot run the scene
    bool interrupted = false;

    [[nodiscard]] const TunedRun &own() const { return runs.front(); }
    // The chosen run without everything that can be left out.
    [[nodiscard]] const TunedRun &plainest() const;
    // Chosen, and within the budget.
    [[nodiscard]] bool found() const { return chosen && !(budget && runs[*chosen].cost > *budget); }
};

// A run that is not dearer by this factor in every round counts as costing the same; then the
// counted work decides and, between two methods, the error. See choice.h.
inline constexpr double same_cost = 1.03;
// The most substeps tried.
inline constexpr int most_substeps = 1024;

// Finds the fewest substeps that meet the scene for every method, in float and double, at twice,
// once, half and a quarter of the scene's dt, with 1, 2, 4 and 8 iterations if it has any, and with
// either the same number of substeps for all islands or, if supported, as many as each island asks
// for. The search doubles the substeps and then bisects. Once some setting has met the scene, only
// less work (by the same method, no finer in precision and dt) is tried at all, starting with the
// most substeps, so most combinations are ruled out after one run or none. The candidates are timed
// against each other, interleaved. Simpler models of the chosen run are tried last; see plainer.h.
//
// Throws std::invalid_argument if the scene expects nothing of its motion, and for invalid options.
[[nodiscard]] Tuning tune_scene(const SceneText &text, const TuneOptions &options);

// Prints the choice and what the dearer one would buy; with `explain` also a table of all runs.
void print(std::ostream &out, const Tuning &tuning, bool explain);

// "1ms", "200us", "0.5 ms", "0.001s": of CPU time per frame of 1/60 s, returned as seconds per
// simulated second. Throws std::invalid_argument that says what would be right.
[[nodiscard]] double parse_budget(const std::string &text);

struct TuneCommand {
    std::filesystem::path scene;
    TuneOptions options; // stop and progress are set by the command
    bool write = false;  // write the chosen settings into the scene's file
    bool explain = false;
};

// Prints to `out`, and everything else to `err`. On Ctrl-C prints the best so far, and writes
// nothing.
[[nodiscard]] ExitCode tune_scene(const TuneCommand &command, std::ostream &out, std::ostream &err);

} // namespace plumb
