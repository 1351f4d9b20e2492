#include "app/lab/chart.h"

#include "app/lab/cpu_clock.h"
#include "app/lab/csv.h"
#include "app/lab/pareto.h"
#include "app/lab/run_text.h"
#include "engine/core/check.h"
#include "engine/scene/expect.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <stdexcept>

namespace plumb {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// A timing lasts at least this long, so that the clock's own cost (below a microsecond) is lost in
// it; a shorter segment is timed several times over.
constexpr double shortest_timing = 0.01; // s
constexpr int most_rounds = 1000;        // in one timing

std::string explain(const ExpectDesc &expect, const std::string &unit) {
    std::string text = expect.quantity + (expect.body.empty() ? "" : " of " + expect.body);
    if (expect.reduce == "last")
        text += " at " + with_unit(expect.to, "s");
    else
        text = expect.reduce + " of " + text + ", " + with_unit(expect.from, "s") + " to " +
               with_unit(expect.to, "s");
    switch (expect.relation) {
    case ExpectDesc::Relation::equals:
        text += "; truly " + with_unit(expect.value, unit);
        break;
    case ExpectDesc::Relation::at_most:
        text += "; should be at most " + with_unit(expect.value, unit);
        break;
    case ExpectDesc::Relation::at_least:
        text += "; should be at least " + with_unit(expect.value, unit);
        break;
    }
    if (!expect.source.empty())
        text += " (" + expect.source + ")";
    return text;
}

ErrorMeasure measure_of(const SceneDesc &scene, std::size_t index) {
    const ExpectDesc &expect = scene.expects[index];
    const ExpectOutcome outcome = judge(expect, 0);
    ErrorMeasure measure;
    measure.kind = ErrorMeasure::Kind::expectation;
    measure.expectation = index;
    measure.name = expect.name;
    measure.unit = outcome.unit;
    measure.explanation = expect.name + ": " + explain(expect, outcome.unit);
    measure.limit = outcome.limit;
    const std::string limit = short_quantity(outcome.limit, outcome.unit);
    switch (expect.relation) {
    case ExpectDesc::Relation::equals:
        measure.title = "Error: |measured − true|";
        measure.limit_label = "tolerance " + limit;
        break;
    case ExpectDesc::Relation::at_most:
        measure.title = expect.value > 0 ? "Measured: " + expect.quantity : "Excess over the bound";
        measure.limit_label = "bound " + limit;
        break;
    case ExpectDesc::Relation::at_least:
        measure.title = "Shortfall from the bound";
        measure.limit_label = "bound";
        break;
    }
    return measure;
}

// For scenes that expect nothing: the error that the scene can show.
ErrorMeasure followed_measure(const SceneDesc &scene, bool had_contacts) {
    ErrorMeasure measure;
    if (!scene.joints.empty()) {
        measure.kind = ErrorMeasure::Kind::joint_drift;
        measure.name = "max_joint_drift";
        measure.unit = "m";
        measure.title = "Largest joint drift";
        measure.explanation = "the largest joint drift of the run";
    } else if (had_contacts) {
        measure.kind = ErrorMeasure::Kind::penetration;
        measure.name = "max_penetration";
        measure.unit = "m";
        measure.title = "Deepest penetration";
        measure.explanation = "the deepest penetration of the run";
    } else {
        measure.kind = ErrorMeasure::Kind::energy;
        measure.name = "max_energy_error";
        measure.unit = "1";
        measure.title = "Largest energy error";
        measure.explanation = "the largest |E − E0| / (K0 + |U0|) of the run";
    }
    return measure;
}

void judge_error(const ErrorMeasure &measure, ChartRun &run) {
    if (run.run.stopped) {
        run.status = ChartStatus::unfinished;
        run.error = infinity;
        return;
    }
    bool judged = !run.run.divergence;
    switch (measure.kind) {
    case ErrorMeasure::Kind::expectation:
        // A window that ended before the divergence has a result, but the method has failed.
        run.error = run.run.outcomes[measure.expectation].error;
        break;
    case ErrorMeasure::Kind::penetration:
        run.error = run.run.max_penetration;
        break;
    case ErrorMeasure::Kind::joint_drift:
        run.error = run.run.max_joint_drift;
        break;
    case ErrorMeasure::Kind::energy:
        run.error = run.run.max_energy_error;
        break;
    }
    if (!judged) {
        run.status = ChartStatus::diverged;
        run.error = infinity;
    } else if (!std::isfinite(run.error)) {
        run.status = ChartStatus::no_result;
        run.error = infinity;
    } else {
        const bool outside = measure.kind == ErrorMeasure::Kind::expectation
                                 ? !run.run.outcomes[measure.expectation].passed
                                 : false;
        run.status = outside ? ChartStatus::outside : ChartStatus::fine;
    }
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
    for (const ChartRun &run : chart.runs)
        choices.push_back({run.cost, run.error});
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
            StepSettings swept;
            apply(chart.sweep, point, swept);
            for (const SweepAxis &axis : chart.sweep)
                switch (axis.setting) {
                case SweepSetting::substeps:
                    run.options.substeps = swept.substeps;
                    break;
                case SweepSetting::iterations:
                    run.options.iterations = swept.iterations;
                    break;
                case SweepSetting::dt:
                    run.options.dt = swept.dt;
                    break;
                }
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

double passes_per_second(int (*passes)(int, int), const StepSettings &settings) {
    return passes == nullptr ? 0 : passes(settings.substeps, settings.iterations) / settings.dt;
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
    std::size_t expectation = 0;
    if (!options.expect.empty()) {
        while (expectation < scene.expects.size() &&
               scene.expects[expectation].name != options.expect)
            ++expectation;
        if (expectation == scene.expects.size())
            throw std::invalid_argument("scene " + scene.name + " has no expectation \"" +
                                        options.expect + "\"");
    }
    chart.measure =
        scene.expects.empty() ? followed_measure(scene, false) : measure_of(scene, expectation);
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
        run.body_passes =
            passes_per_second(next.resolved.method->body_passes, next.resolved.settings);
        run.constraint_passes =
            passes_per_second(next.resolved.method->constraint_passes, next.resolved.settings);
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
        had_contacts = had_contacts || run.run.had_contacts;
        if (scene.expects.empty())
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

void write_chart_csv(std::ostream &out, const SceneChart &chart) {
    CsvWriter csv(out);
    for (const char *name : {"scene",
                             "method",
                             "precision",
                             "dt_s",
                             "substeps",
                             "iterations",
                             "gravity_x_m_s2",
                             "gravity_y_m_s2",
                             "gravity_z_m_s2",
                             "speculative_distance_m",
                             "penetration_slop_m",
                             "baumgarte",
                             "contact_frequency_ratio",
                             "contact_damping_ratio",
                             "joint_frequency_ratio",
                             "joint_damping_ratio",
                             "push_velocity_m_s",
                             "restitution_threshold_m_s",
                             "impact_sweeps",
                             "gyroscopic_iterations",
                             "status",
                             "pareto",
                             "cpu_s_per_s",
                             "cpu_s_per_s_least",
                             "cpu_s_per_s_greatest",
                             "timings",
                             "body_passes_per_s",
                             "constraint_passes_per_s",
                             "charted_error",
                             "error",
                             "end_s",
                             "steps",
                             "max_penetration_m",
                             "max_joint_drift_m",
                             "max_energy_change_J",
                             "max_energy_error",
                             "unresolved_impacts",
                             "diverged_at_s",
                             "diverged"})
        csv.cell(name);
    for (const ExpectDesc &expect : chart.scene.expects)
        for (const char *column : {".measured", ".error", ".limit", ".passed"})
            csv.cell(expect.name + column);
    csv.end_row();
    for (const ChartRun &run : chart.runs) {
        const StepSettings &s = run.resolved.settings;
        csv.cell(chart.scene.name)
            .cell(run.resolved.method->name)
            .cell(precision_name(run.resolved.precision))
            .cell(s.dt)
            .cell(s.substeps)
            .cell(s.iterations)
            .cell(s.gravity.x)
            .cell(s.gravity.y)
            .cell(s.gravity.z)
            .cell(s.speculative_distance)
            .cell(s.penetration_slop)
            .cell(s.baumgarte)
            .cell(s.contact_frequency_ratio)
            .cell(s.contact_damping_ratio)
            .cell(s.joint_frequency_ratio)
            .cell(s.joint_damping_ratio)
            .cell(s.push_velocity)
            .cell(s.restitution_threshold)
            .cell(s.impact_sweeps)
            .cell(s.gyroscopic_iterations)
            .cell(status_name(run.status))
            .cell(run.pareto)
            .cell(run.cost)
            .cell(run.cost_low)
            .cell(run.cost_high)
            .cell(static_cast<std::uint64_t>(run.timings.size()))
            .cell(run.body_passes)
            .cell(run.constraint_passes)
            .cell(chart.measure.name)
            .cell(run.error)
            .cell(run.run.time)
            .cell(run.run.steps)
            .cell(run.run.max_penetration)
            .cell(run.run.max_joint_drift)
            .cell(run.run.max_energy_change)
            .cell(run.run.max_energy_error)
            .cell(run.run.unresolved_impacts);
        if (run.run.divergence)
            csv.cell(run.run.divergence->time).cell(describe(*run.run.divergence));
        else
            csv.cell("").cell("");
        for (const ExpectOutcome &outcome : run.run.outcomes) {
            if (outcome.judged)
                csv.cell(outcome.measured).cell(outcome.error);
            else
                csv.cell("").cell("");
            csv.cell(outcome.limit);
            if (outcome.judged)
                csv.cell(outcome.passed);
            else
                csv.cell("");
        }
        csv.end_row();
    }
}

void print(std::ostream &out, const SceneChart &chart) {
    out << chart.scene.name << ": " << chart.measure.explanation;
    if (chart.measure.limit) {
        std::string label = chart.measure.limit_label;
        std::replace(label.begin(), label.end(), raised_from, '^');
        out << "; " << label;
    }
    out << '\n';
    char line[256];
    std::snprintf(line, sizeof line, "  %-22s %9s %9s %10s %14s %8s %14s  %s\n", "method",
                  "substeps", "iteration", "dt", "CPU ms/s", "spread", "error", "");
    out << line;
    for (const ChartRun &run : chart.runs) {
        char spread[24] = "-";
        if (run.timings.size() > 1)
            std::snprintf(spread, sizeof spread, "%.1f %%",
                          100 * (run.cost_high - run.cost_low) / run.cost);
        const std::string error =
            std::isfinite(run.error) ? with_unit(run.error, chart.measure.unit) : "-";
        std::snprintf(line, sizeof line, "  %-22.22s %9d %9d %10s %14.5g %8s %14s  %s%s\n",
                      std::string(run.resolved.method->name).c_str(),
                      run.resolved.settings.substeps, run.resolved.settings.iterations,
                      format_dt(run.resolved.settings.dt).c_str(), 1e3 * run.cost, spread,
                      error.c_str(), std::string(status_name(run.status)).c_str(),
                      run.pareto ? ", Pareto front" : "");
        out << line;
        if (run.run.divergence)
            out << "    " << describe(*run.run.divergence) << '\n';
    }
    for (const std::string &why : chart.left_out)
        out << "  left out: " << why << '\n';
    if (chart.interrupted)
        out << "  interrupted: " << chart.runs.size() << " of " << chart.planned
            << " runs were begun\n";
}

ChartContent chart_content(const SceneChart &chart, const std::string &command) {
    ChartContent content;
    content.title =
        (chart.scene.title.empty() ? chart.scene.name : chart.scene.title) + ": what truth costs";
    content.subtitle = chart.measure.explanation;
    if (chart.interrupted) {
        const auto finished =
            std::count_if(chart.runs.begin(), chart.runs.end(), [](const ChartRun &run) {
                return run.status != ChartStatus::unfinished;
            });
        content.subtitle = "INTERRUPTED: " + std::to_string(finished) + " of " +
                           std::to_string(chart.planned) + " runs. " + content.subtitle;
    }
    content.cost_title = "CPU time per simulated second";
    content.error_title = chart.measure.title;
    // Where the numbers at the ticks have no unit of their own.
    if (chart.measure.unit != "1" && !takes_prefix(chart.measure.unit))
        content.error_title += " (" + chart.measure.unit + ")";
    content.error_unit = chart.measure.unit;
    content.label_meaning = sweep_label_meaning(chart.sweep);
    content.limit = chart.measure.limit;
    content.limit_label = chart.measure.limit_label;
    content.left_out = chart.left_out;

    const MethodInfo *method = nullptr;
    SweepPoint others; // the point less its first axis: each has its own line
    for (const ChartRun &run : chart.runs) {
        if (run.status == ChartStatus::unfinished || !(run.cost > 0))
            continue;
        const SweepPoint rest(run.point.begin() + 1, run.point.end());
        if (run.resolved.method != method) {
            method = run.resolved.method;
            ChartSeries series;
            series.name = std::string(method->title);
            for (std::size_t i = 0; i < method_infos().size(); ++i)
                if (&method_infos()[i] == method)
                    series.style = i;
            content.series.push_back(std::move(series));
            content.series.back().lines.emplace_back();
            others = rest;
        } else if (rest != others) {
            content.series.back().lines.emplace_back();
            others = rest;
        }
        content.series.back().lines.back().push_back(content.marks.size());
        ChartMark mark;
        mark.cost = run.cost;
        mark.cost_low = run.cost_low;
        mark.cost_high = run.cost_high;
        mark.failed = !std::isfinite(run.error);
        mark.error = mark.failed ? 0 : run.error;
        mark.pareto = run.pareto;
        mark.label = sweep_label(chart.sweep, run.point);
        mark.series = content.series.size() - 1;
        content.marks.push_back(std::move(mark));
    }

    // What was not swept, where it is the same for all.
    std::string settings;
    const auto swept = [&](SweepSetting setting) {
        return std::any_of(chart.sweep.begin(), chart.sweep.end(),
                           [&](const SweepAxis &axis) { return axis.setting == setting; });
    };
    const auto same = [&](auto value_of) {
        return std::all_of(chart.runs.begin(), chart.runs.end(), [&](const ChartRun &run) {
            return value_of(run) == value_of(chart.runs.front());
        });
    };
    const auto add = [&](const std::string &text) {
        settings += (settings.empty() ? "" : "  ·  ") + text;
    };
    if (!chart.runs.empty()) {
        const ResolvedRun &first = chart.runs.front().resolved;
        if (!swept(SweepSetting::dt))
            add("dt " + format_dt(first.settings.dt));
        const auto count = [&](SweepSetting setting, auto value_of) {
            if (swept(setting))
                return;
            const std::string name(sweep_setting_name(setting));
            if (same(value_of)) {
                add(name + " " + std::to_string(value_of(chart.runs.front())));
                return;
            }
            // Each value once, with the methods that have it.
            std::vector<std::pair<int, std::string>> groups;
            const MethodInfo *last = nullptr;
            for (const ChartRun &run : chart.runs) {
                if (run.resolved.method == last)
                    continue;
                last = run.resolved.method;
                const int value = value_of(run);
                const auto group = std::find_if(groups.begin(), groups.end(),
                                                [&](const auto &g) { return g.first == value; });
                if (group == groups.end())
                    groups.emplace_back(value, last->title);
                else
                    group->second += ", " + std::string(last->title);
            }
            std::string each;
            for (const auto &[value, titles] : groups)
                each += (each.empty() ? "" : ", ") + std::to_string(value) + " (" + titles + ")";
            add(name + " " + each);
        };
        count(SweepSetting::substeps,
              [](const ChartRun &run) { return run.resolved.settings.substeps; });
        count(SweepSetting::iterations,
              [](const ChartRun &run) { return run.resolved.settings.iterations; });
        add(std::string(precision_name(first.precision)) + " precision");
        const bool timed = std::any_of(chart.runs.begin(), chart.runs.end(),
                                       [](const ChartRun &run) { return !run.timings.empty(); });
        if (timed) {
            char text[160];
            std::snprintf(text, sizeof text,
                          "one thread, median of %d interleaved timings of the last %.4g s "
                          "(spread %.0f %%)",
                          chart.repeats, chart.timed, 100 * chart.median_spread());
            add(text);
        } else {
            add("one thread, timed once");
        }
    }
    content.footer.push_back(settings);
    if (!command.empty())
        content.footer.push_back(command);
    return content;
}

} // namespace plumb
