// Cost of each method on a scene against its error.
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
    fine,    // every expectation is met, as in `check`, or the scene has none
    outside, // some expectation is missed, whether or not the chart shows it
    diverged,
    no_result, // it ran, but the quantity could not be measured: a period that never came, say
    unfinished // interrupted
};

[[nodiscard]] std::string_view status_name(ChartStatus status);

struct ChartRun {
    std::size_t index = 0; // among the planned runs
    ResolvedRun resolved;
    int threads = 1;
    SweepPoint point;
    JudgedRun run; // full, from the start: chaos makes other errors incomparable
    ChartStatus status = ChartStatus::unfinished;
    double error = 0;      // in the measure's unit; infinite without a result
    OneStepError one_step; // one-step charts only
    std::string failure;   // why there is no error; empty if there is one
    // The expectation with the largest error in units of its tolerance, as an index into
    // run.outcomes; none if all errors are 0.
    std::optional<std::size_t> worst;
    // Seconds per simulated second, in CPU time of one thread or wall-clock time
    // (SceneChart::wall_clock): every repeat, then the median, least and greatest. A run that
    // cannot be timed again (diverged, interrupted) has no repeats and costs what its full run
    // took.
    std::vector<double> timings;
    double cost = 0, cost_low = 0, cost_high = 0;
    // Work per simulated second, counted in the full run: see StepReport.
    double body_passes = 0, constraint_passes = 0;
    bool pareto = false;         // fine, and no cheaper fine run is more accurate
    std::string machine, commit; // see provenance.h; empty: this machine and commit
};

// Finished runs of an earlier, interrupted chart, by run_key.
using KnownRuns = std::map<std::string, ChartRun>;

// Planned runs number n, n + of, ..., counted from 1.
struct Shard {
    std::size_t n = 1, of = 1;
};

struct ChartOptions {
    std::vector<std::string> methods;         // empty: all that can run the scene
    std::vector<const OtherEngine *> engines; // besides the methods; see lab/engines/engine.h
    std::vector<SweepAxis> sweep;      // empty: default_sweep(), or default_convergence_sweep()
    std::vector<Precision> precisions; // one curve each; empty: base's or the scene's
    std::vector<int> threads;          // one curve each; empty: one thread
    RunOptions base;                   // settings that are not swept; its method is ignored
    std::string expect;                // chart only this one, in its own unit; empty: all
    // Error against dt instead of cost: nothing is timed, and there is one substep unless given
    // otherwise.
    bool convergence = false;
    // Error of single steps from states of one accurate run: see OneStepStates.
    bool one_step = false;
    double budget = 1;          // s of CPU time per simulated second; 1: a whole frame at 60 Hz
    double duration = 5;        // s, for scenes without expectations
    int repeats = 5;            // timings per run; the median counts
    double timed = 2;           // simulated s to time if all steps cost alike; see RunRecord
    std::uint64_t seed = 1;     // for the order of runs in each round of timings
    Shard shard;                // run only these
    KnownRuns known;            // not run again except to add missing timings
    std::function<bool()> stop; // polled often; true ends early with the results so far
    Progress progress;
    MakeSimulation make; // empty: Simulation::create, on the run's number of threads
};

// "precision=float,double", "threads=1,2,4", or anything parse_sweep takes; throws like it.
void add_sweep(ChartOptions &options, std::string_view text);

// The options' sweep, or the default if they have none.
[[nodiscard]] std::vector<SweepAxis> sweep_of(const ChartOptions &options);

// Identifies a run within a chart: method, threads, precision and settings.
[[nodiscard]] std::string run_key(const ResolvedRun &run, int threads);

// The states a one-step chart starts from.
struct StepsFrom {
    double frame = 0;         // s, length of a step
    std::size_t instants = 0; // states
    std::string accurate;     // description of the accurate run
    OneStepError own_error;   // the accurate run's
    // Errors below this are not resolved: only that they are below is known.
    [[nodiscard]] double floor() const { return 10 * own_error.rms; }
};

struct SceneChart {
    SceneDesc scene;
    std::vector<SweepAxis> sweep;
    ErrorMeasure measure;
    std::vector<ChartRun> runs; // grouped by method, first axis fastest; only runs that were begun
    bool convergence = false;
    std::optional<StepsFrom> steps_from; // one-step charts only
    bool wall_clock = false;             // times are wall-clock: charts of several threads
    double budget = 1;                   // s per simulated second
    std::uint64_t seed = 1;
    std::vector<std::string> left_out; // the reason for each method that cannot run the scene
    // The scene's expectations that no run is judged by, as the sweep changes their answer, by
    // name; see outdated_answers. The error is that of a scene without them.
    std::vector<std::string> outdated;
    std::size_t planned = 0;
    int repeats = 0;
    double timed = 0; // simulated s per timing
    bool interrupted = false;
    // Whether the accurate run is so much more accurate that the error is this run's own; always
    // true except in one-step charts.
    [[nodiscard]] bool told_apart(const ChartRun &run) const {
        return !steps_from || run.error >= steps_from->floor();
    }
    [[nodiscard]] std::size_t finished() const; // runs that were not interrupted
    [[nodiscard]] double median_spread() const; // of (greatest - least) / median over runs
};

// Which expectations do not count, and why: ""rests" cannot be measured for Bullet, ODE"; "stated
// for the file's own gravity.y: "height"".
[[nodiscard]] std::vector<std::string> not_judged(const SceneChart &chart);

// Runs everything once in full for the errors, then times all runs in rounds, so that a machine
// that slows down does so for all of them. `changed` is called whenever a run was added or a round
// of timings finished; it may be empty. Throws std::invalid_argument for options that make no
// sense.
[[nodiscard]] SceneChart chart_scene(const SceneDesc &scene, const ChartOptions &options,
                                     const std::function<void(const SceneChart &)> &changed = {});

// dt doubles from 1/960 s to 1/30 s.
[[nodiscard]] SweepAxis default_convergence_sweep();

// Judges all runs by the chart's measure and marks the Pareto front. Call after adding runs.
void finish_chart(SceneChart &chart);

// Whether the scene expects nothing that the chart can judge by.
[[nodiscard]] bool expects_nothing(const SceneChart &chart);

// One row per run: all settings, costs, work, every error and expectation, and its provenance.
// `fingerprint` is from chart_fingerprint, or empty.
void write_chart_csv(std::ostream &out, const SceneChart &chart,
                     const std::string &fingerprint = {});

// A human-readable table.
void print(std::ostream &out, const SceneChart &chart);

// What the picture shows, not yet drawn. `command` is the command line, for the footer.
[[nodiscard]] ChartContent chart_content(const SceneChart &chart, const std::string &command);

struct ChartCommand {
    std::vector<std::filesystem::path> scenes;
    ChartOptions options; // its stop, progress and known are set here
    std::filesystem::path out_dir;
    std::filesystem::path shader_dir;
    std::string command; // for the footer
};

// Writes out_dir/SCENE.csv, SCENE.png and SCENE.svg for each scene, prints tables to `out` and
// everything else to `err`. Convergence charts are named SCENE.convergence.csv and so on, one-step
// charts SCENE.one-step.csv; a shard writes only SCENE.2-of-4.csv. On Ctrl-C the rows so far stay
// in SCENE.csv.partial, from which the same command resumes, and are charted as SCENE.partial.png.
[[nodiscard]] ExitCode chart_scenes(const ChartCommand &command, std::ostream &out,
                                    std::ostream &err);

struct MergeCommand {
    std::vector<std::filesystem::path> tables; // of one chart's shards
    std::filesystem::path scene;               // scene file; empty: found by the name in the tables
    std::function<std::filesystem::path(const std::string &name)> find_scene;
    std::filesystem::path out_dir;
    std::filesystem::path shader_dir;
    std::string command; // for the footer
};

// Writes what chart_scenes would have written without shards.
[[nodiscard]] ExitCode merge_charts(const MergeCommand &command, std::ostream &out,
                                    std::ostream &err);

} // namespace plumb
