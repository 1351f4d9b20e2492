// Charts that are interrupted, sharded and merged again.
#include "app/lab/chart/chart_rows.h"

#include "app/lab/provenance.h"
#include "tests/lab/chart/falling.h"
#include "tests/lab/csv_reader.h"

#include <regex>
#include <sstream>

#include <gtest/gtest.h>

namespace plumb {
namespace {

std::string table(const SceneChart &chart, const std::string &fingerprint = "f") {
    std::ostringstream out;
    write_chart_csv(out, chart, fingerprint);
    return out.str();
}

KnownRuns known(const std::string &text, const std::string &fingerprint = "f") {
    std::istringstream in(text);
    return read_known_runs(in, falling_scene(), fingerprint);
}

// Counts how many simulations are made.
MakeSimulation counting(int &made, int broken) {
    return [&made, inner = fakes(broken)](const SceneDesc &scene, const RunOptions &options) {
        ++made;
        return inner(scene, options);
    };
}

TEST(ChartRows, WhatIsKnownIsNotRunAgain) {
    int made = 0;
    ChartOptions options = quick(counting(made, 2));
    const std::string whole = table(chart_scene(falling_scene(), options));
    EXPECT_EQ(made, 4);
    options.known = known(whole);
    EXPECT_EQ(options.known.size(), 4U);
    made = 0;
    EXPECT_EQ(table(chart_scene(falling_scene(), options)), whole);
    EXPECT_EQ(made, 0);
    EXPECT_TRUE(known(whole, "another").empty());
    // What a killed program leaves: its last row is cut off.
    EXPECT_EQ(known(whole.substr(0, whole.size() - 5)).size(), 3U);
    // Rows of another scene are not accepted.
    SceneDesc other = falling_scene();
    other.expects[0].name = "z";
    std::istringstream in(whole);
    EXPECT_TRUE(read_known_runs(in, other, "f").empty());
}

TEST(ChartRows, AnInterruptedChartGoesOn) {
    int made = 0;
    std::size_t seen = 0;
    ChartOptions options = quick(counting(made, 0));
    options.stop = [&] { return seen >= 2; };
    const SceneChart part = chart_scene(falling_scene(), options,
                                        [&](const SceneChart &now) { seen = now.runs.size(); });
    ASSERT_TRUE(part.interrupted);
    options.stop = {};
    options.known = known(table(part));
    EXPECT_EQ(options.known.size(), 2U);
    // A tampered result stays as it is: known runs are not judged again.
    for (auto &[key, run] : options.known)
        run.run.outcomes[0] = judge(run.run.outcomes[0].desc, 1.25);
    const SceneChart chart = chart_scene(falling_scene(), options);
    ASSERT_EQ(chart.runs.size(), 4U);
    EXPECT_FALSE(chart.interrupted);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(chart.runs[i].index, i);
        EXPECT_EQ(chart.runs[i].timings.size(), 3U); // which were missing
        EXPECT_NEAR(chart.runs[i].error, i < 2 ? 0.25 : 1.0 / (1 << i), 1e-12);
    }
}

TEST(ChartRows, ShardsMakeTheWholeChart) {
    ChartOptions options = quick(fakes(2));
    SceneDesc scene = falling_scene(); // too much for methods without contacts
    scene.bodies.push_back(scene.bodies.front());
    scene.bodies.back().name = "other";
    options.methods = {"soft_step", "rk4", "velocity_verlet"};
    const SceneChart whole = chart_scene(scene, options);
    std::vector<NamedTable> tables;
    for (const std::size_t n : {3U, 1U, 2U}) {
        options.shard = {n, 3};
        const SceneChart shard = chart_scene(scene, options);
        EXPECT_EQ(shard.runs.size(), n == 1 ? 2U : 1U);
        tables.push_back({std::to_string(n), table(shard)});
    }
    const SceneChart merged = merged_chart(scene, tables);
    ASSERT_EQ(merged.runs.size(), whole.runs.size());
    EXPECT_FALSE(merged.interrupted);
    EXPECT_EQ(merged.measure.name, whole.measure.name);
    EXPECT_EQ(merged.left_out, whole.left_out);
    EXPECT_EQ(merged.left_out.size(), 2U);
    for (std::size_t i = 0; i < whole.runs.size(); ++i) {
        const ChartRun &a = whole.runs[i], &b = merged.runs[i];
        EXPECT_EQ(run_key(a.resolved, a.threads), run_key(b.resolved, b.threads));
        EXPECT_EQ(a.error, b.error);
        EXPECT_EQ(a.status, b.status);
        EXPECT_EQ(a.failure, b.failure);
        EXPECT_EQ(a.point, b.point);
        EXPECT_EQ(b.timings.size(), a.timings.size());
    }
    SceneDesc other = scene; // has the same expectations
    other.name = "another";
    EXPECT_THROW((void)merged_chart(other, tables), std::invalid_argument);
    tables.pop_back();
    EXPECT_TRUE(merged_chart(scene, tables).interrupted);
    options.timed = 0.5;
    tables.push_back({"other", table(chart_scene(scene, options))});
    try {
        (void)merged_chart(scene, tables);
        FAIL() << "merged what does not belong together";
    } catch (const std::invalid_argument &refusal) {
        EXPECT_NE(std::string(refusal.what()).find("other belongs to another chart"),
                  std::string::npos);
    }
    options.shard = {4, 3};
    EXPECT_THROW((void)chart_scene(scene, options), std::invalid_argument);
}

TEST(ChartRows, EachSaysWhatMadeIt) {
    const auto rows = read_csv(table(chart_scene(falling_scene(), quick(fakes()))));
    const auto cell = [&](const std::string &column) {
        const auto found = std::find(rows[0].begin(), rows[0].end(), column);
        EXPECT_NE(found, rows[0].end()) << column;
        return rows[1].at(static_cast<std::size_t>(found - rows[0].begin()));
    };
    EXPECT_EQ(cell("commit"), build_commit());
    EXPECT_TRUE(std::regex_match(build_commit(), std::regex("[0-9a-f]{12}(-changed)?|unknown")))
        << build_commit();
    EXPECT_EQ(cell("machine"), machine());
    EXPECT_TRUE(machine().ends_with("threads"));
    EXPECT_EQ(cell("seed"), "1");
    EXPECT_EQ(cell("sweep"), "substeps=1,2,4,8");
    EXPECT_EQ(cell("threads"), "1");
}

} // namespace
} // namespace plumb
