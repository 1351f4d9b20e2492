// `plumb bench dynamics`: runs the same scenes in several engines, which take each step in turn, so
// that a machine that slows down slows down for all of them.
#include "tests/bench/benches.h"

#include "app/files/output_file.h"
#include "app/lab/clocks.h"
#include "app/lab/csv.h"
#include "app/lab/engines/pose_measures.h"
#include "app/lab/interrupt.h"
#include "app/lab/progress.h"
#include "app/lab/timing.h"
#include "tests/bench/bench_scenes.h"
#include "tests/bench/engines.h"
#include "tests/bench/heap.h"
#include "tests/bench/only.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>

namespace plumb {

namespace {

// Poses are measured once in this many steps.
constexpr int measured_every = 6;

struct Run {
    EngineKind kind;
    std::unique_ptr<Engine> engine; // null if it cannot run the scene or diverged
    bool diverged = false;
    // For each step (s): the thread's CPU time, and wall time, which counts with several threads.
    std::vector<double> cpu, wall;
    std::vector<double> collide; // share of the step
    std::vector<double> a_pass;  // s per contact or joint and pass
    double bytes_bodies = 0, bytes_contacts = 0;
    std::size_t most_contacts = 0;
    std::vector<BodyState> states;
    double deepest = 0, drift = 0; // worst of all measurements
    Depth depth;                   // at the end
    double kinetic = 0;

    const std::vector<double> &times() const { return kind.threads > 1 ? wall : cpu; }
    const char *clock() const { return kind.threads > 1 ? "wall" : "cpu"; }
};

double percentile(std::vector<double> values, double share) {
    if (values.empty())
        return 0;
    const auto rank =
        static_cast<std::ptrdiff_t>(std::ceil(share * static_cast<double>(values.size())) - 1);
    std::ranges::nth_element(values, values.begin() + rank);
    return values[static_cast<std::size_t>(rank)];
}

void take_step(Run &run) {
    const double heap = heap_in_use(), wall = wall_time(), cpu = thread_cpu_time();
    run.engine->step();
    run.cpu.push_back(thread_cpu_time() - cpu);
    run.wall.push_back(wall_time() - wall);
    run.bytes_contacts += heap_in_use() - heap;
    const StepWork work = run.engine->work();
    run.collide.push_back(work.collide);
    run.most_contacts = std::max(run.most_contacts, work.contacts);
    if (work.passes > 0)
        run.a_pass.push_back(run.times().back() / static_cast<double>(work.passes));
}

void measure(Run &run, const PoseMeasures &measures, const EngineScene &scene) {
    std::vector<BodyState> before = std::move(run.states);
    run.states = run.engine->states();
    if (!is_finite(run.states)) {
        run.diverged = true;
        run.engine = nullptr;
        return;
    }
    run.depth = measures.depth(run.states);
    run.deepest = std::max(run.deepest, run.depth.deepest);
    run.drift = std::max(run.drift, measures.joint_drift(run.states));
    if (before.size() == run.states.size())
        run.kinetic = measures.kinetic_energy(before, run.states, scene.dt());
}

struct Line {
    std::string scene;
    std::size_t bodies = 0, joints = 0, steps = 0;
};

void write_header(CsvWriter &csv) {
    for (const char *name : {"scene",
                             "bodies",
                             "joints",
                             "steps",
                             "engine",
                             "threads",
                             "clock",
                             "median_ms",
                             "p95_ms",
                             "times_ours",
                             "collide_share",
                             "ns_a_contact_and_pass",
                             "bytes_a_body",
                             "bytes_a_contact",
                             "most_contacts",
                             "deepest_m",
                             "deepest_at_end_m",
                             "mean_at_end_m",
                             "worst_drift_m",
                             "top_displacement_m",
                             "kinetic_J",
                             "diverged"})
        csv.cell(name);
    csv.end_row();
}

void report(const Line &line, bool stands, const std::vector<Run> &runs,
            const PoseMeasures &measures, CsvWriter &csv) {
    std::printf("\n%s: %zu bodies, %zu joints, %zu steps\n", line.scene.c_str(), line.bodies,
                line.joints, line.steps);
    std::printf("  %-14s %9s %9s %7s %8s %8s %7s %9s %9s %9s %8s %9s %9s %10s\n", "", "ms",
                "p95 ms", "ratio", "collide", "ns/pass", "B/body", "B/contact", "deepest", "at end",
                "mean", "drift", "top", "kinetic J");
    const Run &ours = runs.front();
    for (const Run &run : runs) {
        const std::string name =
            run.kind.name + (run.kind.threads > 1 ? " x" + std::to_string(run.kind.threads) : "") +
            ", " + run.clock();
        if (run.cpu.empty()) {
            std::printf("  %-14s cannot run it\n", name.c_str());
            continue;
        }
        // Threads are compared by wall time, engines by CPU time.
        const double ratio = run.kind.threads > 1 ? median_ratio(run.wall, ours.wall)
                                                  : median_ratio(run.cpu, ours.cpu);
        const double contacts = std::max(1.0, static_cast<double>(run.most_contacts));
        const double of_body = run.bytes_bodies / static_cast<double>(line.bodies);
        const double of_contact = run.most_contacts > 0 ? run.bytes_contacts / contacts : 0;
        const double top = run.engine ? measures.top_displacement(run.states) : 0;
        std::printf("  %-14s %9.3f %9.3f %7.2f %7.0f%% %8.0f %7.0f %9.0f", name.c_str(),
                    1e3 * median(run.times()), 1e3 * percentile(run.times(), 0.95), ratio,
                    100 * median(run.collide), 1e9 * median(run.a_pass), of_body, of_contact);
        if (run.diverged)
            std::printf("  diverged after %zu steps\n", run.cpu.size());
        else
            std::printf(" %9.2f %9.2f %8.3f %9.2f %9s %10.3g\n", 1e3 * run.deepest,
                        1e3 * run.depth.deepest, 1e3 * run.depth.mean, 1e3 * run.drift,
                        stands ? std::to_string(1e3 * top).substr(0, 8).c_str() : "", run.kinetic);
        csv.cell(line.scene)
            .cell(std::uint64_t{line.bodies})
            .cell(std::uint64_t{line.joints})
            .cell(std::uint64_t{line.steps})
            .cell(run.kind.name)
            .cell(run.kind.threads)
            .cell(run.clock())
            .cell(1e3 * median(run.times()))
            .cell(1e3 * percentile(run.times(), 0.95))
            .cell(ratio)
            .cell(median(run.collide))
            .cell(1e9 * median(run.a_pass))
            .cell(of_body)
            .cell(of_contact)
            .cell(std::uint64_t{run.most_contacts})
            .cell(run.deepest)
            .cell(run.depth.deepest)
            .cell(run.depth.mean)
            .cell(run.drift)
            .cell(top)
            .cell(run.kinetic)
            .cell(run.diverged);
        csv.end_row();
    }
    const auto threaded =
        std::ranges::find_if(runs, [](const Run &run) { return run.kind.threads > 1; });
    if (threaded != runs.end() && threaded->engine && ours.engine &&
        !std::ranges::equal(ours.states, threaded->states, [](const auto &a, const auto &b) {
            return a.position == b.position && a.orientation == b.orientation;
        }))
        std::printf("  Plumb's poses differ between 1 and %d threads\n", threaded->kind.threads);
    std::fflush(stdout);
}

// Returns the number of steps taken, fewer if interrupted.
std::size_t go(const EngineScene &scene, std::size_t steps, std::vector<Run> &runs,
               const PoseMeasures &measures, const std::function<void(double)> &progress) {
    for (Run &run : runs) {
        const double heap = heap_in_use();
        run.engine = run.kind.create(scene);
        run.bytes_bodies = heap_in_use() - heap;
    }
    for (std::size_t step = 1; step <= steps; ++step) {
        const bool at_end = step == steps;
        for (Run &run : runs) {
            if (!run.engine)
                continue;
            if (at_end) // to measure its motion in the last step
                run.states = run.engine->states();
            else
                run.states.clear();
            take_step(run);
            if (at_end || step % measured_every == 0)
                measure(run, measures, scene);
        }
        progress(static_cast<double>(step) / static_cast<double>(steps));
        if (InterruptGuard::requested())
            return step;
    }
    return steps;
}

} // namespace

ExitCode bench_dynamics(const EngineBenchOptions &options) {
    const std::vector<BenchScene> scenes = chosen(bench_scenes(), options.only);
    create_folder(options.out_dir);
    const InterruptGuard interrupt;
    ProgressLine line(std::cerr);
    OutputFile file(options.out_dir / "bench_dynamics.csv");
    CsvWriter csv(file.stream());
    write_header(csv);
    TaskPool tasks(options.threads);
    std::printf(
        "every engine at its defaults, 60 Hz, sleeping off\nms: median of a step, cpu: of the "
        "thread's own time; wall: by the clock on the "
        "wall, for several threads\nratio: to Plumb's; B: bytes of heap; deepest, mean, drift, "
        "top: mm, "
        "measured from poses by Plumb's geometry in double\n");
    for (std::size_t i = 0; i < scenes.size() && !InterruptGuard::requested(); ++i) {
        const BenchScene &one = scenes[i];
        const auto progress = [&](double part) {
            line.show((static_cast<double>(i) + part) / static_cast<double>(scenes.size()),
                      one.name);
        };
        progress(0);
        const EngineScene scene(one.make(options.size));
        const PoseMeasures measures(scene);
        std::vector<Run> runs;
        for (EngineKind &kind : engines(options.threads > 1 ? &tasks : nullptr))
            runs.emplace_back().kind = std::move(kind);
        const double seconds = std::min(one.seconds, options.seconds.value_or(one.seconds));
        const auto steps =
            static_cast<std::size_t>(std::max(2.0, std::round(seconds / scene.dt())));
        const std::size_t done = go(scene, steps, runs, measures, progress);
        line.clear();
        if (done < steps) {
            std::cerr << "interrupted within " << one.name
                      << "; of the scenes before: " << file.keep_partial().string() << '\n';
            return ExitCode::fine;
        }
        report({one.name, scene.desc.bodies.size(), scene.desc.joints.size(), steps}, one.stands,
               runs, measures, csv);
    }
    file.finish();
    std::cerr << "wrote " << file.path().string() << '\n';
    return ExitCode::fine;
}

} // namespace plumb
