// A chart's numbers, as CSV and as a human-readable table.
#include "app/lab/chart/chart.h"
#include "app/lab/chart/chart_columns.h"
#include "app/lab/chart/convergence.h"
#include "app/lab/chart/log_axis.h"
#include "app/lab/csv.h"
#include "app/lab/provenance.h"
#include "app/lab/run/method_choice.h"
#include "app/lab/run/run_text.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>

namespace plumb {

namespace {

std::string error_unit(const ErrorMeasure &measure) {
    return measure.kind == ErrorMeasure::Kind::worst ? "tolerance" : measure.unit;
}

std::vector<std::string> unseen_in(const JudgedRun &run) {
    std::vector<std::string> names;
    for (const ExpectOutcome &outcome : run.outcomes)
        if (outcome.verdict == Verdict::unseen)
            names.push_back(outcome.desc.name);
    return names;
}

// Of what is swept, or differs, besides the table's usual columns.
struct SweptColumn {
    std::string title;
    std::function<std::string(const ChartRun &)> value;
};

std::vector<SweptColumn> swept_columns(const SceneChart &chart) {
    std::vector<SweptColumn> columns;
    const auto add = [&](const std::string &title, auto value) {
        std::vector<std::string> values;
        for (const ChartRun &run : chart.runs)
            values.push_back(value(run));
        if (std::ranges::adjacent_find(values, std::ranges::not_equal_to{}) != values.end())
            columns.push_back({title, value});
    };
    for (const SweepAxis &axis : chart.sweep) {
        const std::string_view name = axis.setting.setting().name;
        if (name != "substeps" && name != "max_substeps" && name != "iterations" && name != "dt")
            add(setting_name(axis.setting), [number = axis.setting](const ChartRun &run) {
                return number_or_fraction(setting_value(run.resolved.settings, number));
            });
    }
    add("precision",
        [](const ChartRun &run) { return std::string(precision_name(run.resolved.precision)); });
    add("threads", [](const ChartRun &run) { return std::to_string(run.threads); });
    return columns;
}

} // namespace

void write_chart_csv(std::ostream &out, const SceneChart &chart, const std::string &fingerprint) {
    const std::string here = machine(), commit = build_commit();
    CsvWriter csv(out);
    for (const char *name : {"scene", "run", "method", "precision", "threads"})
        csv.cell(name);
    for (const SettingNumber number : setting_numbers())
        csv.cell(setting_column(number));
    const CostColumns times(chart.wall_clock);
    csv.cell("status").cell("pareto");
    for (const std::string &name :
         {times.cost, times.least, times.greatest, times.timings, times.worst_step})
        csv.cell(name);
    for (const char *name : {"body_passes_per_s",
                             "constraint_passes_per_s",
                             "charted_error",
                             "error",
                             "error_unit",
                             "worst",
                             "not_judged",
                             "outdated",
                             "end_s",
                             "steps",
                             "max_penetration_m",
                             "max_joint_drift_m",
                             "max_energy_change_J",
                             "max_energy_error",
                             "unresolved_impacts",
                             "had_contacts",
                             "diverged_at_s",
                             "diverged",
                             "against",
                             "clock",
                             "budget_s_per_s",
                             "sweep",
                             "left_out",
                             "planned",
                             "repeats",
                             "timed_s",
                             "seed",
                             "machine",
                             "commit",
                             "fingerprint"})
        csv.cell(name);
    if (chart.steps_from)
        for (const char *name :
             {"one_step_rms_m", "one_step_worst_m", "one_step_failure", "told_apart", "frame_s",
              "instants", "accurate_run", "accurate_rms_m", "accurate_worst_m"})
            csv.cell(name);
    for (const ExpectDesc &expect : everything_expected(chart.scene))
        for (const char *column : {".measured", ".error", ".limit", ".scaled_error", ".passed"})
            csv.cell(expect.name + column);
    csv.end_row();
    for (const ChartRun &run : chart.runs) {
        csv.cell(chart.scene.name)
            .cell(static_cast<std::uint64_t>(run.index))
            .cell(run.resolved.method->name)
            .cell(precision_name(run.resolved.precision))
            .cell(run.threads);
        for (const SettingNumber number : setting_numbers())
            csv.cell(setting_value(run.resolved.settings, number));
        csv.cell(status_name(run.status))
            .cell(run.pareto)
            .cell(run.cost)
            .cell(run.cost_low)
            .cell(run.cost_high)
            .cell(numbers_text(run.timings))
            .cell(run.run.worst_step_time)
            .cell(run.body_passes)
            .cell(run.constraint_passes)
            .cell(chart.measure.name)
            .cell(run.error)
            .cell(error_unit(chart.measure))
            .cell(run.worst ? run.run.outcomes[*run.worst].desc.name : "")
            .cell(reasons_text(unseen_in(run.run)))
            .cell(reasons_text(chart.outdated))
            .cell(run.run.time)
            .cell(run.run.steps)
            .cell(run.run.max_penetration)
            .cell(run.run.max_joint_drift)
            .cell(run.run.max_energy_change)
            .cell(run.run.max_energy_error)
            .cell(run.run.unresolved_impacts)
            .cell(run.run.had_contacts);
        if (run.run.divergence)
            csv.cell(run.run.divergence->time).cell(run.failure);
        else
            csv.cell("").cell("");
        csv.cell(chart.convergence ? "dt" : "cost")
            .cell(chart.wall_clock ? "wall" : "cpu")
            .cell(chart.budget)
            .cell(sweep_text(chart.sweep))
            .cell(reasons_text(chart.left_out))
            .cell(static_cast<std::uint64_t>(chart.planned))
            .cell(chart.repeats)
            .cell(chart.timed)
            .cell(chart.seed)
            .cell(run.machine.empty() ? here : run.machine)
            .cell(run.commit.empty() ? commit : run.commit)
            .cell(fingerprint);
        if (chart.steps_from)
            csv.cell(run.one_step.rms)
                .cell(run.one_step.worst)
                .cell(run.one_step.failure)
                .cell(chart.told_apart(run))
                .cell(chart.steps_from->frame)
                .cell(static_cast<std::uint64_t>(chart.steps_from->instants))
                .cell(chart.steps_from->accurate)
                .cell(chart.steps_from->own_error.rms)
                .cell(chart.steps_from->own_error.worst);
        for (const ExpectOutcome &outcome : run.run.outcomes)
            if (outcome.judged())
                csv.cell(outcome.measured)
                    .cell(outcome.error)
                    .cell(outcome.limit)
                    .cell(outcome.scaled_error)
                    .cell(outcome.verdict == Verdict::met);
            else
                csv.cell("").cell("").cell(outcome.limit).cell("").cell("");
        csv.end_row();
    }
}

void print(std::ostream &out, const SceneChart &chart) {
    out << chart.scene.name << ": " << chart.measure.explanation;
    // In units of tolerances it is 1 and needs no mention.
    if (chart.measure.limit && chart.measure.kind != ErrorMeasure::Kind::worst) {
        std::string label = chart.measure.limit_label;
        std::replace(label.begin(), label.end(), raised_from, '^');
        out << "; " << label;
    }
    out << '\n';
    if (chart.steps_from)
        out << "  states of " << chart.steps_from->accurate << ", whose own error is "
            << with_unit(chart.steps_from->own_error.rms, "m")
            << "; ~: below ten times that, not resolved\n";
    char line[256];
    const std::vector<SweptColumn> swept = swept_columns(chart);
    const auto aligned = [](const std::string &text, const std::string &title) {
        const std::size_t width = std::max<std::size_t>(title.size(), 8) + 1;
        return std::string(width - std::min(width, text.size()), ' ') + text;
    };
    std::snprintf(line, sizeof line, "  %-22s %9s %10s %10s", "method", "substeps", "iterations",
                  "dt");
    out << line;
    for (const SweptColumn &column : swept)
        out << aligned(column.title, column.title);
    std::snprintf(line, sizeof line, " %12s %8s %14s %14s\n",
                  chart.wall_clock ? "wall ms/s" : "CPU ms/s", "spread",
                  chart.wall_clock ? "worst wall ms" : "worst CPU ms", "error");
    out << line;
    for (const ChartRun &run : chart.runs) {
        char spread[24] = "-";
        if (run.timings.size() > 1)
            std::snprintf(spread, sizeof spread, "%.1f %%",
                          100 * (run.cost_high - run.cost_low) / run.cost);
        const std::string error =
            std::isfinite(run.error)
                ? (chart.told_apart(run) ? "" : "~") + with_unit(run.error, chart.measure.unit)
                : "-";
        std::snprintf(line, sizeof line, "  %-22.22s %9s %10d %10s",
                      std::string(run.resolved.method->name).c_str(),
                      substeps_text(run.resolved).c_str(), run.resolved.settings.iterations,
                      format_dt(run.resolved.settings.dt).c_str());
        out << line;
        for (const SweptColumn &column : swept)
            out << aligned(column.value(run), column.title);
        std::snprintf(line, sizeof line, " %12.5g %8s %14.4g %14s  %s%s", 1e3 * run.cost, spread,
                      1e3 * run.run.worst_step_time, error.c_str(),
                      std::string(status_name(run.status)).c_str(),
                      run.pareto ? ", Pareto front" : "");
        out << line;
        if (chart.steps_from && std::isfinite(run.error))
            out << "; farthest " << with_unit(run.one_step.worst, "m");
        else if (run.worst && !run.run.divergence && everything_expected(chart.scene).size() > 1)
            out << "; worst: " << run.run.outcomes[*run.worst].desc.name;
        out << '\n';
        if (!run.failure.empty())
            out << "    " << run.failure << '\n';
    }
    for (const CurveOrder &order : curve_orders(chart))
        out << "  " << order.name << ": " << order_text(order) << (order.fitted ? "" : ": ")
            << order.why_none << '\n';
    if (!chart.runs.empty())
        out << "  worst: the slowest step in each one's first run\n";
    for (const std::string &which : not_judged(chart))
        out << "  not judged: " << which << '\n';
    for (const std::string &why : grouped_reasons(chart.left_out))
        out << "  left out: " << why << '\n';
    if (chart.interrupted)
        out << "  interrupted: " << chart.finished() << " of " << chart.planned
            << " runs are done\n";
}

} // namespace plumb
