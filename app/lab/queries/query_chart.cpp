#include "app/lab/queries/query_chart.h"

#include "app/lab/csv.h"
#include "app/lab/provenance.h"
#include "app/lab/timing.h"

#include <algorithm>
#include <cstdio>
#include <numeric>

namespace plumb {

std::uint64_t QueryRun::asked() const {
    return std::accumulate(
        families.begin(), families.end(), std::uint64_t{0},
        [](std::uint64_t sum, const FamilyScore &score) { return sum + score.asked; });
}

std::uint64_t QueryRun::wrong() const {
    return std::accumulate(
        families.begin(), families.end(), std::uint64_t{0},
        [](std::uint64_t sum, const FamilyScore &score) { return sum + score.wrong; });
}

double QueryRun::wrong_rate() const {
    return asked() == 0 ? 0 : static_cast<double>(wrong()) / static_cast<double>(asked());
}

QueryChart chart_queries(const QueryChartOptions &options) {
    QueryChart chart;
    chart.options = options;
    const auto stopped = [&] { return options.stop && options.stop(); };
    const auto progress = [&](double fraction, const std::string &what) {
        if (options.progress)
            options.progress(fraction, what);
    };
    progress(0, "generating inputs");
    const std::vector<QueryCase> cases = query_cases(options.seed, options.adversarial);
    std::size_t methods = 0;
    for (const QueryCase &one : cases)
        methods += one.methods.size();
    for (const QueryCase &one : cases)
        for (const MethodOfQuery &method : one.methods) {
            if (stopped()) {
                chart.interrupted = true;
                return chart;
            }
            progress(0.3 * static_cast<double>(chart.runs.size()) / static_cast<double>(methods),
                     one.name);
            QueryRun run;
            run.query = one.name;
            run.method = method.method;
            run.families = method.judge();
            chart.runs.push_back(std::move(run));
        }

    std::vector<std::function<std::uint64_t()>> works;
    std::vector<double> batches;
    for (const QueryCase &one : cases)
        for (const MethodOfQuery &method : one.methods) {
            works.push_back(method.ask_all);
            batches.push_back(static_cast<double>(one.batch));
        }
    TimingOptions timing;
    timing.rounds = options.repeats;
    timing.least = options.timed;
    timing.stop = options.stop;
    timing.progress = [&](double fraction, std::size_t which) {
        progress(0.3 + 0.7 * fraction, chart.runs[which].query);
    };
    const std::vector<std::vector<double>> times = time_interleaved(works, timing);
    for (std::size_t i = 0; i < chart.runs.size(); ++i) {
        for (const double seconds : times[i])
            chart.runs[i].timings.push_back(seconds / batches[i]);
        chart.runs[i].cost = median(chart.runs[i].timings);
    }
    chart.interrupted = stopped();
    return chart;
}

void write_query_csv(std::ostream &out, const QueryChart &chart) {
    CsvWriter csv(out);
    for (const char *name : {"query", "method", "family", "asked", "wrong", "wrong_rate",
                             "cpu_ns_per_query", "cpu_ns_least", "cpu_ns_greatest", "timings"})
        csv.cell(name);
    csv.end_row();
    for (const QueryRun &run : chart.runs) {
        const auto row = [&](const std::string &family, std::uint64_t asked, std::uint64_t wrong) {
            csv.cell(run.query)
                .cell(query_method_name(run.method))
                .cell(family)
                .cell(asked)
                .cell(wrong)
                .cell(asked == 0 ? 0.0 : static_cast<double>(wrong) / static_cast<double>(asked));
            if (run.timings.empty()) {
                csv.cell("").cell("").cell("");
            } else {
                const auto [least, greatest] =
                    std::minmax_element(run.timings.begin(), run.timings.end());
                csv.cell(1e9 * run.cost).cell(1e9 * *least).cell(1e9 * *greatest);
            }
            csv.cell(static_cast<std::uint64_t>(run.timings.size()));
            csv.end_row();
        };
        row("all", run.asked(), run.wrong());
        for (const FamilyScore &score : run.families)
            row(score.family, score.asked, score.wrong);
    }
}

void print(std::ostream &out, const QueryChart &chart) {
    char line[160];
    std::snprintf(line, sizeof line, "%-24s %10s %10s %10s   %12s %12s %12s\n", "query", "book ns",
                  "plain ns", "plumb ns", "book wrong", "plain wrong", "plumb wrong");
    out << line;
    for (std::size_t i = 0; i + 2 < chart.runs.size(); i += 3) {
        const QueryRun *run = &chart.runs[i];
        std::snprintf(
            line, sizeof line, "%-24s %10.2f %10.2f %10.2f   %10.4f %% %10.4f %% %10.4f %%\n",
            run->query.c_str(), 1e9 * run[0].cost, 1e9 * run[1].cost, 1e9 * run[2].cost,
            100 * run[0].wrong_rate(), 100 * run[1].wrong_rate(), 100 * run[2].wrong_rate());
        out << line;
    }
    if (chart.interrupted)
        out << "interrupted\n";
}

PanelChart panel_chart(const QueryChart &chart, const std::string &command) {
    PanelChart result;
    result.title = "Geometric queries: what accuracy costs";
    result.subtitle = "Wrong answers on inputs made to be hard, against time per query on random "
                      "ones (lower and further left is better)";
    result.x_title = "CPU time per query";
    result.y_title = "wrong answers";
    result.zero_label = "none";
    result.series = {"the book's", "most engines'", "Plumb's"};
    for (const QueryRun &run : chart.runs) {
        if (run.timings.empty())
            continue;
        if (result.panels.empty() || result.panels.back().title != run.query)
            result.panels.push_back({run.query, {}});
        result.panels.back().marks.push_back(
            {run.cost, run.wrong_rate(), static_cast<std::size_t>(run.method)});
    }
    if (!chart.runs.empty()) {
        char text[200];
        std::snprintf(text, sizeof text,
                      "%zu hard inputs per query, seed %llu  ·  one thread, float, %s of batches "
                      "of 1024, cache-hot  ·  ",
                      chart.options.adversarial,
                      static_cast<unsigned long long>(chart.options.seed),
                      timings_text(chart.options.repeats).c_str());
        result.footer.push_back(text + machine() + "  ·  commit " + build_commit());
    }
    if (!command.empty())
        result.footer.push_back(command);
    return result;
}

} // namespace plumb
