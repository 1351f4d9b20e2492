// What each method costs on a scene, against how wrong it is.
#pragma once

#include "app/lab/chart/chart_layout.h"
#include "app/lab/chart/error_measure.h"
#include "app/lab/chart/one_step.h"
#include "app/lab/exit_code.h"
#include "app/lab/progress.h"
#include "app/lab/run/judged_run.h"
#include "app/lab/run/sweep.h"
#include "engine/scene/simulation.h"

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

namespace plumb {

struct OtherEngine;

using MakeSimulation =
    std::function<std::unique_ptr<Simulation>(const SceneDesc &, const RunOptions &)>;

enum class ChartStatus {
    fine,    // all that the scene expects is met, as `check` says; or it expects nothing
    outside, // something is missed, whether or not the chart shows it
    diverged,
    no_result, // it ran, but the quantity could not be measured: a period that never came, say
    unfinished // interrupted
};

[[nodiscard]] std::string_view status_name(ChartStatus status);

struct ChartRun {
    std::size_t index = 0; // of those that were planned
    ResolvedRun resolved;
    int threads = 1;
    SweepPoint point;
    JudgedRun run; // a full one from the start: chaos keeps errors of any other from comparing
    ChartStatus status = ChartStatus::unfinished;
    double error = 0;      // in the measure's unit; infinite without a result
    OneStepError one_step; // of charts of single steps
    std::string failure;   // why there is no error; empty when there is
    // The expectation with the largest error in units of its tolerance, as an index into
    // run.outcomes; none when all errors are 0.
    std::optional<std::size_t> worst;
    // Seconds per simulated second, CPU time of one thread or SceneChart::wall_clock: of each
    // repeat, and their median, least and greatest. A run that could not be timed again
    // (diverged, interrupted) has no repeats: its cost is what its full run took.
    std::vector<double> timings;
    double cost = 0, cost_low = 0, cost_high = 0;
    // Work per simulated second, as it was counted in the full run: see StepReport.
    double body_passes = 0, constraint_passes = 0;
    bool pareto = false;         // fine, and nothing cheaper that is fine is truer
    std::string machine, commit; // see provenance.h; empty: these
};

// What an earlier, interrupted chart came to, by run_key.
using KnownRuns = std::map<std::string, ChartRun>;

// The runs number n, n + of, ... of those that are planned; the first is 1.
struct Shard {
    std::size_t n = 1, of = 1;
};

struct ChartOptions {
    std::vector<std::string> methods;         // empty: all that can run the scene
    std::vector<const OtherEngine *> engines; // beside the methods; see lab/engines/engine.h
    std::vector<SweepAxis> sweep;      // empty: default_sweep(), or default_convergence_sweep()
    std::vector<Precision> precisions; // each a curve of its own; empty: base's or the scene's
    std::vector<int> threads;          // each a curve of its own; empty: one
    RunOptions base;                   // what is not swept; its method is not read
    std::string expect;                // to chart this one alone, in its own unit; empty: all
    // Error against dt instead of cost: nothing is timed, and of substeps there is one unless
    // something else is given.
    bool convergence = false;
    // The error of single steps, from states of one accurate run: see OneStepStates.
    bool one_step = false;
    double budget = 1;          // s of CPU time per simulated second: at 60 Hz all of a frame
    double duration = 5;        // s, of scenes that expect nothing
    int repeats = 5;            // timings of each run; their median counts
    double timed = 2;           // s, simulated: of a run that goes on alike, as RunRecord chooses
    std::uint64_t seed = 1;     // of the order in which each round of timings goes
    Shard shard;                // only these
    KnownRuns known;            // not run again; timed where timings are missing
    std::function<bool()> stop; // asked often; true ends early with what there is
    Progress progress;
    MakeSimulation make; // empty: Simulation::create, on as many threads as the run has
};

// "precision=float,double", "threads=1,2,4", or what parse_sweep takes; throws as that does.
void add_sweep(ChartOptions &options, std::string_view text);

// What it goes through: the options' sweep, or else the default.
[[nodiscard]] std::vector<SweepAxis> sweep_of(const ChartOptions &options);

// Of all that makes it another run of the chart: method, threads, precision, settings.
[[nodiscard]] std::string run_key(const ResolvedRun &run, int threads);

// Of a chart of single steps: what they were taken from.
struct StepsFrom {
    double frame = 0;         // s, how long each is
    std::size_t instants = 0; // states
    std::string accurate;     // the run that they are of, in words
    OneStepError own_error;   // that run's
    // Errors below it say no more of a run than that they are.
    [[nodiscard]] double floor() const { return 10 * own_error.rms; }
};

struct SceneChart {
    SceneDesc scene;
    std::vector<SweepAxis> sweep;
    ErrorMeasure measure;
    std::vector<ChartRun> runs; // method by method, the first axis fastest; those that were begun
    bool convergence = false;
    std::optional<StepsFrom> steps_from; // of a chart of single steps
    bool wall_clock = false; // all times are by the clock on the wall: of charts of several threads
    double budget = 1;       // s per simulated second
    std::uint64_t seed = 1;
    std::vector<std::string> left_out; // why, of each method that cannot run the scene
    std::size_t planned = 0;
    int repeats = 0;
    double timed = 0; // s, simulated, in each timing
    bool interrupted = false;
    // Of a chart of single steps, whether the accurate run is so much truer that the error is the
    // run's own; true of others.
    [[nodiscard]] bool told_apart(const ChartRun &run) const {
        return !steps_from || run.error >= steps_from->floor();
    }
    [[nodiscard]] std::size_t finished() const; // runs that were not interrupted
    [[nodiscard]] double median_spread() const; // of (greatest - least) / median over the runs
};

// First each run in full, for its error; then the timings, round after round over all runs, so that
// a machine that slows down does so for all. `changed` is called whenever a run was added or a
// round of timings finished; it may be empty. Throws std::invalid_argument for options that make no
// sense.
[[nodiscard]] SceneChart chart_scene(const SceneDesc &scene, const ChartOptions &options,
                                     const std::function<void(const SceneChart &)> &changed = {});

// Doubles from 1/960 s to 1/30 s.
[[nodiscard]] SweepAxis default_convergence_sweep();

// Judges all runs by the chart's measure, and marks the Pareto front: after runs were added.
void finish_chart(SceneChart &chart);

// One row a run: all settings, costs, work, every error and every expectation, and what made it.
// `fingerprint` is chart_fingerprint's, or empty.
void write_chart_csv(std::ostream &out, const SceneChart &chart,
                     const std::string &fingerprint = {});

// A table for people.
void print(std::ostream &out, const SceneChart &chart);

// The picture, less its pixels. `command` is what made it, for the footer.
[[nodiscard]] ChartContent chart_content(const SceneChart &chart, const std::string &command);

struct ChartCommand {
    std::vector<std::filesystem::path> scenes;
    ChartOptions options; // its stop, progress and known are set here
    std::filesystem::path out_dir;
    std::filesystem::path shader_dir;
    std::string command; // for the footer
};

// Writes out_dir/SCENE.csv, SCENE.png and SCENE.svg for each scene, prints tables to `out` and
// everything else to `err`. Of convergence SCENE.convergence.csv and so on, of single
// steps SCENE.one-step.csv, of a shard SCENE.2-of-4.csv alone. On Ctrl-C the rows so far stay in
// SCENE.csv.partial, from which the same command goes on, and are charted as SCENE.partial.png.
[[nodiscard]] ExitCode chart_scenes(const ChartCommand &command, std::ostream &out,
                                    std::ostream &err);

struct MergeCommand {
    std::vector<std::filesystem::path> tables; // of one chart's shards
    std::filesystem::path scene;               // its file; empty: of the name in the tables
    std::function<std::filesystem::path(const std::string &name)> find_scene;
    std::filesystem::path out_dir;
    std::filesystem::path shader_dir;
    std::string command; // for the footer
};

// Writes what chart_scenes would have without shards.
[[nodiscard]] ExitCode merge_charts(const MergeCommand &command, std::ostream &out,
                                    std::ostream &err);

} // namespace plumb
