#include "app/lab/run/measure.h"

#include "tests/lab/csv_reader.h"
#include "tests/lab/run/fake_simulation.h"

#include <cmath>
#include <map>
#include <sstream>

#include <gtest/gtest.h>

namespace plumb {
namespace {

FakeSimulation cooling() {
    FakeSimulation fake(0.25);
    fake.measures_at = [](double t) {
        Measures measures;
        measures.kinetic_energy = 8 - t;
        measures.potential_energy = -2;
        measures.linear_momentum = {1, 2, t};
        measures.max_penetration = t == 0.5 ? 0.125 : 0;
        measures.max_joint_drift = 0.5 * t;
        return measures;
    };
    return fake;
}

TEST(Measure, OneRowAStepAndASummary) {
    FakeSimulation fake = cooling();
    MeasureOptions options;
    options.steps = 4;
    std::ostringstream csv;
    const MeasureSummary summary = measure_run(fake, options, csv);
    const auto rows = read_csv(csv.str());
    ASSERT_EQ(rows.size(), 1U + 5); // header, start, four steps
    std::map<std::string, std::size_t> column;
    for (std::size_t i = 0; i < rows[0].size(); ++i)
        column[rows[0][i]] = i;
    for (std::size_t k = 0; k < 5; ++k) {
        const auto &row = rows[k + 1];
        ASSERT_EQ(row.size(), rows[0].size());
        const double t = 0.25 * static_cast<double>(k);
        const auto number = [&](const char *name) { return std::stod(row.at(column.at(name))); };
        EXPECT_EQ(number("step"), static_cast<double>(k));
        EXPECT_EQ(number("time_s"), t);
        EXPECT_EQ(number("kinetic_energy_J"), 8 - t);
        EXPECT_EQ(number("energy_J"), 6 - t);
        EXPECT_EQ(number("energy_change_J"), -t);
        EXPECT_DOUBLE_EQ(number("energy_error"), -t / 10); // of 8 + |-2|
        EXPECT_EQ(number("momentum_z_kg_m_s"), t);
        EXPECT_EQ(number("max_penetration_m"), t == 0.5 ? 0.125 : 0);
        EXPECT_EQ(number("contacts"), k == 0 ? 0 : 1);
        EXPECT_EQ(number("finite"), 1);
    }
    EXPECT_EQ(summary.steps, 4U);
    EXPECT_EQ(summary.simulated, 1);
    EXPECT_EQ(summary.start_energy, 6);
    EXPECT_EQ(summary.end_energy, 5);
    EXPECT_EQ(summary.max_energy_change, 1);
    EXPECT_DOUBLE_EQ(summary.max_energy_error, 0.1);
    EXPECT_EQ(summary.max_penetration, 0.125);
    EXPECT_EQ(summary.max_penetration_time, 0.5);
    EXPECT_EQ(summary.max_joint_drift, 0.5);
    EXPECT_EQ(summary.max_joint_drift_time, 1);
    EXPECT_FALSE(summary.divergence);
    EXPECT_EQ(fake.measure_calls, 5);
}

TEST(Measure, EndsWithTheStepThatDiverged) {
    FakeSimulation fake = cooling();
    fake.nan_from_step = 3;
    std::ostringstream csv;
    const MeasureSummary summary = measure_run(fake, {}, csv);
    EXPECT_EQ(summary.steps, 3U);
    ASSERT_TRUE(summary.divergence);
    EXPECT_EQ(summary.divergence->step, 3U);
    EXPECT_EQ(summary.divergence->body, "ball");
    const auto rows = read_csv(csv.str());
    ASSERT_EQ(rows.size(), 1U + 4);
    EXPECT_EQ(rows.back().back(), "0"); // not finite
    std::ostringstream text;
    print(text, summary);
    EXPECT_NE(text.str().find("DIVERGED: not finite after step 3"), std::string::npos);
}

TEST(Measure, StopsWhenAsked) {
    FakeSimulation fake = cooling();
    MeasureOptions options;
    options.stop = [&] { return fake.step_count() == 2; };
    std::ostringstream csv;
    const MeasureSummary summary = measure_run(fake, options, csv);
    EXPECT_TRUE(summary.stopped);
    EXPECT_EQ(summary.steps, 2U);
    EXPECT_EQ(read_csv(csv.str()).size(), 1U + 3);
}

} // namespace
} // namespace plumb
