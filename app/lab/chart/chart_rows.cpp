#include "app/lab/chart/chart_rows.h"

#include "app/lab/chart/chart_columns.h"
#include "app/lab/csv.h"
#include "app/lab/engines/other_engines.h"
#include "app/lab/fingerprint.h"
#include "app/lab/run/run_text.h"
#include "app/lab/timing.h"
#include "engine/scene/scene_file.h"

#include <algorithm>
#include <sstream>
#include <stdexcept>

namespace plumb {

namespace {

std::optional<ChartStatus> find_status(std::string_view name) {
    for (const ChartStatus status :
         {ChartStatus::fine, ChartStatus::outside, ChartStatus::diverged, ChartStatus::no_result})
        if (status_name(status) == name)
            return status;
    return std::nullopt;
}

ExpectOutcome read_outcome(const CsvReader &row, const ExpectDesc &expect) {
    const std::string_view passed = row.cell(expect.name + ".passed");
    ExpectOutcome outcome = judge(expect, row.number(expect.name + ".measured").value_or(NAN));
    if (passed.empty()) {
        const std::vector<std::string> unseen = parsed_reasons(row.cell("not_judged"));
        outcome.verdict = std::ranges::find(unseen, expect.name) != unseen.end() ? Verdict::unseen
                                                                                 : Verdict::pending;
    }
    return outcome;
}

// Empty for a row that is unfinished or cannot be read.
std::optional<ChartRun> read_run(const CsvReader &row, const SceneDesc &scene,
                                 const std::vector<SweepAxis> &sweep) {
    ChartRun run;
    const CostColumns times(row.cell("clock") == "wall");
    const auto status = find_status(row.cell("status"));
    run.resolved.method = find_charted(row.cell("method"));
    const auto index = row.number("run"), threads = row.number("threads"),
               cost = row.number(times.cost), end = row.number("end_s"),
               steps = row.number("steps");
    if (!status || run.resolved.method == nullptr || !index || !threads || !cost || !end || !steps)
        return std::nullopt;
    run.status = *status;
    run.index = static_cast<std::size_t>(*index);
    run.threads = static_cast<int>(*threads);
    run.resolved.precision =
        row.cell("precision") == precision_name(Precision::f64) ? Precision::f64 : Precision::f32;
    GivenSettings settings;
    for (const SettingNumber number : setting_numbers()) {
        const auto value = row.number(setting_column(number));
        if (!value)
            return std::nullopt;
        settings.give(number, *value);
    }
    settings.apply_to(run.resolved.settings);
    for (const SweepAxis &axis : sweep)
        run.point.push_back(setting_value(run.resolved.settings, axis.setting));

    run.timings = parsed_numbers(row.cell(times.timings));
    run.cost = *cost;
    run.cost_low = row.number(times.least).value_or(*cost);
    run.cost_high = row.number(times.greatest).value_or(*cost);
    run.body_passes = row.number("body_passes_per_s").value_or(0);
    run.constraint_passes = row.number("constraint_passes_per_s").value_or(0);
    run.run.time = *end;
    run.run.steps = static_cast<std::uint64_t>(*steps);
    run.run.step_time = *cost * *steps * run.resolved.settings.dt;
    run.run.worst_step_time = row.number(times.worst_step).value_or(0);
    run.run.had_contacts = row.cell("had_contacts") == "1";
    run.run.max_penetration = row.number("max_penetration_m").value_or(0);
    run.run.max_joint_drift = row.number("max_joint_drift_m").value_or(0);
    run.run.max_energy_change = row.number("max_energy_change_J").value_or(0);
    run.run.max_energy_error = row.number("max_energy_error").value_or(0);
    run.run.unresolved_impacts =
        static_cast<std::uint64_t>(row.number("unresolved_impacts").value_or(0));
    run.one_step = {row.number("one_step_rms_m").value_or(0),
                    row.number("one_step_worst_m").value_or(0),
                    std::string(row.cell("one_step_failure"))};
    if (const auto at = row.number("diverged_at_s")) {
        run.run.divergence.emplace().time = *at;
        run.failure = row.cell("diverged");
    }
    for (const ExpectDesc &expect : everything_expected(scene))
        run.run.outcomes.push_back(read_outcome(row, expect));
    run.machine = row.cell("machine");
    run.commit = row.cell("commit");
    return run;
}

bool knows_all_columns(const CsvReader &table, const SceneDesc &scene) {
    const std::vector<ExpectDesc> expects = everything_expected(scene);
    return table.has("run") && table.has("fingerprint") &&
           std::ranges::all_of(
               expects,
               [&](const ExpectDesc &expect) { return table.has(expect.name + ".measured"); }) &&
           std::ranges::count_if(table.names(), [](const std::string &name) {
               return name.ends_with(".measured");
           }) == static_cast<std::ptrdiff_t>(expects.size());
}

// The part that all rows of a chart share.
SceneChart read_head(const CsvReader &row, const SceneDesc &scene) {
    SceneChart chart;
    chart.scene = scene;
    chart.sweep = parsed_sweeps(row.cell("sweep"));
    chart.convergence = row.cell("against") == "dt";
    chart.wall_clock = row.cell("clock") == "wall";
    chart.budget = row.number("budget_s_per_s").value_or(1);
    chart.planned = static_cast<std::size_t>(row.number("planned").value_or(0));
    chart.repeats = static_cast<int>(row.number("repeats").value_or(0));
    chart.timed = row.number("timed_s").value_or(0);
    chart.seed = static_cast<std::uint64_t>(row.number("seed").value_or(0));
    chart.outdated = parsed_reasons(row.cell("outdated"));
    const std::string_view charted = row.cell("charted_error");
    if (const auto frame = row.number("frame_s"))
        chart.steps_from = {*frame,
                            static_cast<std::size_t>(row.number("instants").value_or(0)),
                            std::string(row.cell("accurate_run")),
                            {row.number("accurate_rms_m").value_or(0),
                             row.number("accurate_worst_m").value_or(0),
                             {}}};
    else if (expects_nothing(chart))
        chart.measure = followed_measure(scene, charted == "max_penetration");
    else
        chart.measure = choose_measure(scene, charted == "worst" ? std::string_view() : charted,
                                       chart.convergence, chart.outdated);
    return chart;
}

// The cells read_head reads, and the commit.
std::string head_text(const CsvReader &row) {
    std::string text;
    for (const char *column : {"scene", "sweep", "against", "clock", "budget_s_per_s", "planned",
                               "repeats", "timed_s", "seed", "charted_error", "outdated", "commit",
                               "frame_s", "instants", "accurate_run", "accurate_rms_m"})
        text.append(row.cell(column)).append("\n");
    return text;
}

} // namespace

std::string chart_fingerprint(const SceneDesc &scene, const ChartOptions &options) {
    Fingerprint print;
    print.add(write_scene(scene));
    print.add(sweep_text(options.sweep));
    for (const std::string &method : options.methods)
        print.add(method);
    for (const OtherEngine *engine : options.engines)
        print.add(engine->info.name);
    for (const Precision precision : options.precisions)
        print.add(precision_name(precision));
    for (const int threads : options.threads)
        print.add(static_cast<double>(threads));
    print.add(options.base);
    print.add(options.expect);
    print.add(options.convergence ? "dt" : options.one_step ? "one step" : "cost");
    for (const double number :
         {options.budget, options.duration, options.timed, static_cast<double>(options.repeats),
          static_cast<double>(options.seed)})
        print.add(number);
    return print.text();
}

std::vector<std::string> chart_key_columns() {
    std::vector<std::string> columns{"method", "precision", "threads", "fingerprint"};
    for (const SettingNumber number : setting_numbers())
        columns.push_back(setting_column(number));
    return columns;
}

KnownRuns read_known_runs(std::istream &in, const SceneDesc &scene,
                          const std::string &fingerprint) {
    KnownRuns known;
    CsvReader table(in);
    if (!knows_all_columns(table, scene))
        return known;
    while (table.next())
        if (table.cell("fingerprint") == fingerprint)
            if (auto run = read_run(table, scene, parsed_sweeps(table.cell("sweep"))))
                known.insert_or_assign(run_key(run->resolved, run->threads), std::move(*run));
    return known;
}

std::string scene_of_chart(const std::string &table) {
    std::istringstream in(table);
    CsvReader reader(in);
    return reader.has("run") && reader.next() ? std::string(reader.cell("scene")) : std::string();
}

SceneChart merged_chart(const SceneDesc &scene, const std::vector<NamedTable> &tables) {
    std::optional<SceneChart> chart;
    std::string head;
    std::map<std::size_t, ChartRun> runs;
    for (const NamedTable &each : tables) {
        std::istringstream in(each.text);
        CsvReader table(in);
        if (!knows_all_columns(table, scene))
            throw std::invalid_argument(each.name + " does not match the scene " + scene.name +
                                        " as it is now: its expectations differ");
        while (table.next()) {
            if (table.cell("scene") != scene.name)
                throw std::invalid_argument(each.name + " is from the scene " +
                                            std::string(table.cell("scene")) + ", not of " +
                                            scene.name);
            if (!chart) {
                chart = read_head(table, scene);
                head = head_text(table);
            }
            if (head_text(table) != head)
                throw std::invalid_argument(each.name + " belongs to another chart than " +
                                            tables.front().name +
                                            ": the settings or the commit differ");
            if (auto run = read_run(table, scene, chart->sweep))
                runs.insert_or_assign(run->index, std::move(*run));
            for (std::string &why : parsed_reasons(table.cell("left_out")))
                if (std::ranges::find(chart->left_out, why) == chart->left_out.end())
                    chart->left_out.push_back(std::move(why));
        }
    }
    if (!chart)
        throw std::invalid_argument("there is nothing to merge: the tables have no rows");
    for (auto &[index, run] : runs)
        chart->runs.push_back(std::move(run));
    finish_chart(*chart);
    chart->interrupted = chart->runs.size() < chart->planned;
    return *chart;
}

} // namespace plumb
