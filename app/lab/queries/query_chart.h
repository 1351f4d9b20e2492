// Cost of each implementation of a geometric query against how often it is wrong.
#pragma once

#include "app/lab/chart/panel_chart.h"
#include "app/lab/exit_code.h"
#include "app/lab/progress.h"
#include "app/lab/queries/query_set.h"

#include <filesystem>
#include <functional>
#include <ostream>
#include <string>
#include <vector>

namespace plumb {

struct QueryChartOptions {
    std::size_t adversarial = 200'000; // inputs per query
    std::uint64_t seed = 1;
    int repeats = 5;            // interleaved timings per method; the median counts
    double timed = 0.02;        // minimum s per timing
    std::function<bool()> stop; // polled often; true ends early with the results so far
    Progress progress;
};

// One method of one query.
struct QueryRun {
    std::string query;
    QueryMethod method = QueryMethod::ours;
    std::vector<FamilyScore> families;
    std::vector<double> timings; // s per query
    double cost = 0;             // their median

    [[nodiscard]] std::uint64_t asked() const;
    [[nodiscard]] std::uint64_t wrong() const;
    [[nodiscard]] double wrong_rate() const; // 0..1
};

struct QueryChart {
    std::vector<QueryRun> runs; // grouped by query, in the order of QueryMethod
    QueryChartOptions options;
    bool interrupted = false;
};

// Judges each method, then times all of them in rounds, with Google Benchmark.
[[nodiscard]] QueryChart chart_queries(const QueryChartOptions &options);

// One row per query, method and input family.
void write_query_csv(std::ostream &out, const QueryChart &chart);
void print(std::ostream &out, const QueryChart &chart); // a human-readable table
[[nodiscard]] PanelChart panel_chart(const QueryChart &chart, const std::string &command);

struct QueryChartCommand {
    QueryChartOptions options; // its stop and progress are set here
    std::filesystem::path out_dir;
    std::filesystem::path shader_dir;
    std::string command; // for the footer
};

// Writes out_dir/geometry.csv, geometry.svg and geometry.png, the table to `out` and everything
// else to `err`. On Ctrl-C no complete file is replaced; the rows so far stay in
// geometry.csv.partial.
[[nodiscard]] ExitCode chart_geometry(const QueryChartCommand &command, std::ostream &out,
                                      std::ostream &err);

} // namespace plumb
