#include "app/lab/chart/chart.h"

#include "app/lab/chart/pareto.h"
#include "app/lab/run/end_timer.h"
#include "app/lab/run/method_choice.h"
#include "app/lab/run/run_text.h"
#include "app/lab/timing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace plumb {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

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

struct PlannedRun {
    RunOptions options;
    ResolvedRun resolved;
    SweepPoint point;
};

std::vector<PlannedRun> plan(const SceneDesc &scene, const ChartOptions &options,
                             SceneChart &chart) {
    const std::vector<const MethodInfo *> methods =
        methods_for(scene, options.methods, chart.left_out);
    const std::vector<SweepPoint> points = sweep_points(chart.sweep);
    // The least that islands take says little of what they take: where substeps are swept, and
    // nothing is said of the most, just so many are charted, too.
    const auto is_swept = [&](SettingMember member) {
        return std::ranges::any_of(chart.sweep, [&](const SweepAxis &axis) {
            return axis.setting.setting().member == member;
        });
    };
    const bool both = is_swept(&StepSettings::substeps) && !is_swept(&StepSettings::max_substeps) &&
                      !options.base.settings.has(*find_setting("max_substeps"));
    std::vector<PlannedRun> planned;
    for (const MethodInfo *method : methods) {
        const std::size_t first = planned.size();
        std::vector<RunOptions> variants{options.base};
        variants.front().method = std::string(method->name);
        if (both && method->chooses_substeps()) {
            const int most = resolve_run(scene, variants.front()).settings.max_substeps;
            variants.push_back(variants.front());
            variants[0].settings.give(&StepSettings::max_substeps, 1);
            variants[1].settings.give(&StepSettings::max_substeps,
                                      std::max(most, method->defaults.max_substeps));
        }
        for (const RunOptions &variant : variants)
            for (const SweepPoint &point : points) {
                PlannedRun run;
                run.options = variant;
                run.point = point;
                run.options.settings.give(given_by(chart.sweep, point));
                run.resolved = resolve_run(scene, run.options);
                const bool repeated = std::any_of(
                    planned.begin() + static_cast<std::ptrdiff_t>(first), planned.end(),
                    [&](const PlannedRun &other) {
                        return same_work(*method, run.resolved.settings, other.resolved.settings);
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

    std::vector<std::optional<EndTimer>> timers;
    bool had_contacts = false;
    for (const PlannedRun &next : planned) {
        if (stopped())
            break;
        ChartRun run;
        run.resolved = next.resolved;
        run.point = next.point;
        std::unique_ptr<Simulation> simulation = make(scene, next.options);
        std::unique_ptr<Simulation::Saved> saved;
        JudgeOptions judging;
        judging.follow_errors = true;
        judging.duration = options.duration;
        judging.stop = options.stop;
        judging.at_time_seconds = end - chart.timed;
        judging.at_time = [&] { saved = simulation->save(); };
        judging.progress = [&](double fraction) {
            progress(0.5 * (static_cast<double>(timers.size()) + fraction) /
                         static_cast<double>(planned.size()),
                     run);
        };
        run.run = judge_run(*simulation, scene, judging);
        judge_probes(scene, run.resolved.precision, run.run.outcomes);
        set_cost(run);
        timers.emplace_back();
        if (saved && !run.run.divergence && !run.run.stopped)
            timers.back().emplace(std::move(simulation), std::move(saved), chart.timed, run.cost);
        const double simulated = static_cast<double>(run.run.steps) * run.resolved.settings.dt;
        if (simulated > 0) {
            run.body_passes = static_cast<double>(run.run.body_passes) / simulated;
            run.constraint_passes = static_cast<double>(run.run.constraint_passes) / simulated;
        }
        had_contacts = had_contacts || run.run.had_contacts;
        if (everything_expected(scene).empty())
            chart.measure = followed_measure(scene, had_contacts);
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
            if (!timers[i])
                continue;
            round[i] = timers[i]->time();
            if (!round[i])
                timers[i].reset();
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
