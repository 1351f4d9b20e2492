#include "app/lab/chart.h"

#include "app/lab/cpu_clock.h"
#include "app/lab/pareto.h"
#include "app/lab/run_text.h"
#include "engine/core/check.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace plumb {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// A timing lasts at least this long, so that the clock's own cost (below a microsecond) is lost in
// it; a shorter segment is timed several times over.
constexpr double shortest_timing = 0.01; // s
constexpr int most_rounds = 1000;        // in one timing

void judge_error(const ErrorMeasure &measure, ChartRun &run) {
    run.worst = worst_of(run.run.outcomes);
    run.error = infinity;
    if (run.run.stopped) {
        run.status = ChartStatus::unfinished;
        return;
    }
    // A window that ended before a divergence has a result, but the method has failed.
    if (run.run.divergence) {
        run.status = ChartStatus::diverged;
        return;
    }
    run.error = error_of(measure, run.run);
    run.status = !std::isfinite(run.error) ? ChartStatus::no_result
                 : run.run.all_met()       ? ChartStatus::fine
                                           : ChartStatus::outside;
}

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const std::size_t half = values.size() / 2;
    return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

void set_cost(ChartRun &run) {
    if (run.timings.empty()) {
        const double simulated = static_cast<double>(run.run.steps) * run.resolved.settings.dt;
        run.cost = simulated > 0 ? run.run.step_cpu_time / simulated : 0;
        run.cost_low = run.cost_high = run.cost;
    } else {
        run.cost = median(run.timings);
        const auto [low, high] = std::minmax_element(run.timings.begin(), run.timings.end());
        run.cost_low = *low;
        run.cost_high = *high;
    }
}

void mark_front(SceneChart &chart) {
    std::vector<CostAndError> choices;
    // What fails the scene is no choice, however cheap.
    for (const ChartRun &run : chart.runs)
        choices.push_back(run.status == ChartStatus::fine ? CostAndError{run.cost, run.error}
                                                          : CostAndError{infinity, infinity});
    const std::vector<bool> front = pareto_front(choices);
    for (std::size_t i = 0; i < front.size(); ++i)
        chart.runs[i].pareto = front[i];
}

// What is needed to run the end of a run again and again.
struct Timer {
    std::unique_ptr<Simulation> simulation;
    std::unique_ptr<Simulation::Saved> saved;
    int steps = 0;  // in the timed segment
    int rounds = 1; // in one timing

    // CPU seconds per simulated second; nothing when a step failed.
    std::optional<double> time() const {
        double used = 0;
        try {
            simulation->restore(*saved);
            // Brings code and data back into the caches after the other simulations' turn.
            for (int i = 0; i < std::max(1, steps / 10); ++i)
                simulation->step();
            for (int round = 0; round < rounds; ++round) {
                simulation->restore(*saved);
                const double before = thread_cpu_time();
                for (int i = 0; i < steps; ++i)
                    simulation->step();
                used += thread_cpu_time() - before;
            }
        } catch (const CheckFailure &) {
            return std::nullopt;
        }
        return used / (rounds * steps * simulation->settings().dt);
    }
};

struct PlannedRun {
    RunOptions options;
    ResolvedRun resolved;
    SweepPoint point;
};

std::vector<PlannedRun> plan(const SceneDesc &scene, const ChartOptions &options,
                             SceneChart &chart) {
    std::vector<const MethodInfo *> methods;
    if (options.methods.empty()) {
        for (const MethodInfo &method : method_infos())
            methods.push_back(&method);
    } else {
        for (const std::string &name : options.methods) {
            RunOptions named = options.base;
            named.method = name;
            const MethodInfo *method = resolve_run(scene, named).method; // throws when unknown
            if (std::find(methods.begin(), methods.end(), method) == methods.end())
                methods.push_back(method);
        }
    }
    const std::vector<SweepPoint> points = sweep_points(chart.sweep);
    std::vector<PlannedRun> planned;
    for (const MethodInfo *method : methods) {
        if (std::string why = why_not(*method, scene); !why.empty()) {
            chart.left_out.push_back(std::move(why));
            continue;
        }
        const std::size_t first = planned.size();
        for (const SweepPoint &point : points) {
            PlannedRun run;
            run.options = options.base;
            run.options.method = std::string(method->name);
            run.point = point;
            run.options.settings.give(given_by(chart.sweep, point));
            run.resolved = resolve_run(scene, run.options);
            const bool repeated = std::any_of(planned.begin() + static_cast<std::ptrdiff_t>(first),
                                              planned.end(), [&](const PlannedRun &other) {
                                                  return same_work(*method, run.resolved.settings,
                                                                   other.resolved.settings);
                                              });
            if (!repeated)
                planned.push_back(std::move(run));
        }
    }
    return planned;
}

} // namespace

std::string_view status_name(ChartStatus status) {
    switch (status) {
    case ChartStatus::fine:
        return "fine";
    case ChartStatus::outside:
        return "outside";
    case ChartStatus::diverged:
        return "diverged";
    case ChartStatus::no_result:
        return "no result";
    case ChartStatus::unfinished:
        return "unfinished";
    }
    return "";
}

double SceneChart::median_spread() const {
    std::vector<double> spreads;
    for (const ChartRun &run : runs)
        if (run.timings.size() > 1)
            spreads.push_back((run.cost_high - run.cost_low) / run.cost);
    return spreads.empty() ? 0 : median(spreads);
}

SceneChart chart_scene(const SceneDesc &scene, const ChartOptions &options,
                       const std::function<void(const SceneChart &)> &changed) {
    SceneChart chart;
    chart.scene = scene;
    chart.sweep = options.sweep.empty() ? std::vector{default_sweep()} : options.sweep;
    if (options.repeats < 1)
        throw std::invalid_argument("repeats must be at least 1");
    if (!(options.timed > 0) || !(options.duration > 0))
        throw std::invalid_argument("durations must be above 0 s");
    chart.measure = choose_measure(scene, options.expect);
    const std::vector<PlannedRun> planned = plan(scene, options, chart);
    chart.planned = planned.size();
    chart.repeats = options.repeats;
    const double end = run_end(scene, options.duration);
    chart.timed = std::min(options.timed, end);
    const auto stopped = [&] { return options.stop && options.stop(); };
    const auto progress = [&](double fraction, const ChartRun &run) {
        if (options.progress)
            options.progress(fraction, scene.name + ": " + run_text(run.resolved));
    };
    const MakeSimulation make =
        options.make ? options.make : [](const SceneDesc &s, const RunOptions &o) {
            return Simulation::create(s, o, nullptr);
        };

    std::vector<Timer> timers;
    bool had_contacts = false;
    for (const PlannedRun &next : planned) {
        if (stopped())
            break;
        ChartRun run;
        run.resolved = next.resolved;
        run.point = next.point;
        Timer timer;
        timer.simulation = make(scene, next.options);
        JudgeOptions judging;
        judging.follow_errors = true;
        judging.duration = options.duration;
        judging.stop = options.stop;
        judging.at_time_seconds = end - chart.timed;
        judging.at_time = [&] { timer.saved = timer.simulation->save(); };
        judging.progress = [&](double fraction) {
            progress(0.5 * (static_cast<double>(timers.size()) + fraction) /
                         static_cast<double>(planned.size()),
                     run);
        };
        run.run = judge_run(*timer.simulation, scene, judging);
        judge_probes(scene, run.resolved.precision, run.run.outcomes);
        set_cost(run);
        if (run.run.stopped)
            timer.saved.reset();
        if (run.run.divergence || !timer.saved) {
            timer.simulation.reset();
            timer.saved.reset();
        } else {
            timer.steps =
                std::max(1, static_cast<int>(std::lround(chart.timed / run.resolved.settings.dt)));
            const double segment = run.cost * timer.steps * run.resolved.settings.dt;
            timer.rounds = segment > 0
                               ? static_cast<int>(std::clamp(std::ceil(shortest_timing / segment),
                                                             1.0, static_cast<double>(most_rounds)))
                               : most_rounds;
        }
        const double simulated = static_cast<double>(run.run.steps) * run.resolved.settings.dt;
        if (simulated > 0) {
            run.body_passes = static_cast<double>(run.run.body_passes) / simulated;
            run.constraint_passes = static_cast<double>(run.run.constraint_passes) / simulated;
        }
        had_contacts = had_contacts || run.run.had_contacts;
        if (everything_expected(scene).empty())
            chart.measure = followed_measure(scene, had_contacts);
        timers.push_back(std::move(timer));
        chart.runs.push_back(std::move(run));
        for (ChartRun &done : chart.runs)
            judge_error(chart.measure, done);
        mark_front(chart);
        if (changed)
            changed(chart);
    }

    for (int repeat = 0; repeat < options.repeats && !stopped(); ++repeat) {
        std::vector<std::optional<double>> round(timers.size());
        for (std::size_t i = 0; i < timers.size() && !stopped(); ++i) {
            if (!timers[i].simulation)
                continue;
            round[i] = timers[i].time();
            if (!round[i])
                timers[i].simulation.reset();
            progress(0.5 + 0.5 *
                               (repeat +
                                static_cast<double>(i + 1) / static_cast<double>(timers.size())) /
                               options.repeats,
                     chart.runs[i]);
        }
        // A round that was not finished would favour those that it reached.
        if (stopped())
            break;
        for (std::size_t i = 0; i < timers.size(); ++i) {
            if (!round[i])
                continue;
            chart.runs[i].timings.push_back(*round[i]);
            set_cost(chart.runs[i]);
        }
        mark_front(chart);
        if (changed)
            changed(chart);
    }
    chart.interrupted = stopped();
    return chart;
}

} // namespace plumb
