#include "app/lab/run/sweep.h"

#include <set>
#include <stdexcept>

#include <gtest/gtest.h>

namespace plumb {
namespace {

std::string sweep_complaint(const std::string &text) {
    try {
        (void)parse_sweep(text);
    } catch (const std::invalid_argument &error) {
        return error.what();
    }
    return "";
}

TEST(Sweep, RangesGoThroughPowersOfTwo) {
    EXPECT_EQ(parse_sweep("substeps=1..16").values, (std::vector<double>{1, 2, 4, 8, 16}));
    EXPECT_EQ(parse_sweep("substeps=3..20").values, (std::vector<double>{4, 8, 16}));
    EXPECT_EQ(parse_sweep("iterations=5..7").values, (std::vector<double>{5, 7}));
    EXPECT_EQ(parse_sweep("iterations=5..5").values, (std::vector<double>{5}));
    EXPECT_EQ(parse_sweep("iterations=8..8").values, (std::vector<double>{8}));
    EXPECT_EQ(setting_name(parse_sweep("iterations=4").setting), "iterations");
    EXPECT_EQ(parse_sweep("impact_sweeps=0..5").values, (std::vector<double>{0, 1, 2, 4}));
}

TEST(Sweep, DtDoublesFromItsLowerEnd) {
    const std::vector<double> values = parse_sweep("dt=1/240..1/30").values;
    ASSERT_EQ(values.size(), 4U);
    EXPECT_EQ(values[0], 1.0 / 240);
    EXPECT_EQ(values[3], 8.0 * (1.0 / 240));
    EXPECT_EQ(parse_sweep("dt=0.01..0.05").values, (std::vector<double>{0.01, 0.02, 0.04}));
}

TEST(Sweep, ListsAreSortedAndDistinct) {
    EXPECT_EQ(parse_sweep("substeps=5,1,3,1").values, (std::vector<double>{1, 3, 5}));
    EXPECT_EQ(parse_sweep("dt=1/50,1/100").values, (std::vector<double>{1.0 / 100, 1.0 / 50}));
}

TEST(Sweep, MistakesAreExplained) {
    EXPECT_NE(sweep_complaint("substeps").find("SETTING=VALUES"), std::string::npos);
    EXPECT_NE(sweep_complaint("substep=1..4").find("did you mean \"substeps\"?"),
              std::string::npos);
    EXPECT_NE(sweep_complaint("substeps=").find("no values"), std::string::npos);
    EXPECT_NE(sweep_complaint("substeps=1..x").find("\"x\" is not a number"), std::string::npos);
    EXPECT_NE(sweep_complaint("substeps=1..4..8").find("\"4..8\" is not a number"),
              std::string::npos);
    EXPECT_NE(sweep_complaint("substeps=1,,2").find("\"\" is not a number"), std::string::npos);
    EXPECT_NE(sweep_complaint("substeps=8..2").find("ascend"), std::string::npos);
    EXPECT_NE(sweep_complaint("substeps=0..4")
                  .find("substeps must be a whole number from 1 to 10000, got 0"),
              std::string::npos);
    EXPECT_NE(sweep_complaint("substeps=1.5").find("whole"), std::string::npos);
    EXPECT_NE(sweep_complaint("iterations=20000").find("1 to 10000"), std::string::npos);
    EXPECT_NE(sweep_complaint("dt=1/0").find("division by zero"), std::string::npos);
    EXPECT_NE(sweep_complaint("dt=0..1").find("a number from 1e-9 to 1 s, got 0"),
              std::string::npos);
    EXPECT_NE(sweep_complaint("gravity=1..2").find("gravity.y"), std::string::npos);
    EXPECT_NE(sweep_complaint("dt=nan").find("not a number"), std::string::npos);
}

TEST(Sweep, CombinationsAreAllThereOnceFirstAxisFastest) {
    const std::vector<SweepAxis> axes{parse_sweep("substeps=1..8"), parse_sweep("dt=0.01,0.02"),
                                      parse_sweep("iterations=1,3,5")};
    const std::vector<SweepPoint> points = sweep_points(axes);
    EXPECT_EQ(points.size(), 4U * 2 * 3);
    EXPECT_EQ(std::set<SweepPoint>(points.begin(), points.end()).size(), points.size());
    EXPECT_EQ(points[0], (SweepPoint{1, 0.01, 1}));
    EXPECT_EQ(points[1], (SweepPoint{2, 0.01, 1}));
    EXPECT_EQ(points[4], (SweepPoint{1, 0.02, 1}));
    EXPECT_EQ(points.back(), (SweepPoint{8, 0.02, 5}));
    StepSettings settings;
    given_by(axes, points.back()).apply_to(settings);
    EXPECT_EQ(settings.substeps, 8);
    EXPECT_EQ(settings.iterations, 5);
    EXPECT_EQ(settings.dt, 0.02);
    EXPECT_THROW((void)sweep_points({axes[0], axes[0]}), std::invalid_argument);
    EXPECT_EQ(sweep_points({}).size(), 1U);
}

TEST(Sweep, Labels) {
    const std::vector<SweepAxis> axes{parse_sweep("substeps=4"), parse_sweep("iterations=2"),
                                      parse_sweep("dt=1/120")};
    EXPECT_EQ(sweep_label(axes, {4, 2, 1.0 / 120}), "4×2, 1/120 s");
    EXPECT_EQ(sweep_label_meaning(axes), "substeps × iterations, dt");
    EXPECT_EQ(sweep_label({axes[2]}, {1.0 / 120}), "1/120 s");
    EXPECT_EQ(format_dt(0.0123), "0.0123 s");
}

// Without a lower end above 0 there is nothing to double.
TEST(Sweep, RangesThatDoNotBeginAboveZeroGoInFourSteps) {
    EXPECT_EQ(parse_sweep("baumgarte=0..0.4").values,
              (std::vector<double>{0, 0.4 / 4, 2 * 0.4 / 4, 3 * 0.4 / 4, 0.4}));
    EXPECT_EQ(parse_sweep("gravity.y=-20..0").values, (std::vector<double>{-20, -15, -10, -5, 0}));
}

TEST(Sweep, SettingsThatAMethodDoesNotReadMakeNoDifference) {
    for (const MethodInfo &method : method_infos())
        for (const SettingNumber number : setting_numbers()) {
            const StepSettings a = method.defaults;
            StepSettings b = a;
            const SettingRow &row = number.setting();
            set_setting(b, number, setting_value(a, number) < row.max ? row.max : row.min);
            EXPECT_EQ(same_work(method, a, b), !reads(method, number.setting()))
                << method.name << " " << setting_name(number);
            EXPECT_TRUE(same_work(method, a, a));
        }
}

TEST(Sweep, ASecondIsNoFraction) {
    EXPECT_EQ(format_dt(0.5), "1/2 s");
    EXPECT_EQ(format_dt(1), "1 s");
}

TEST(Sweep, ValuesThatAreTheSameAreSaidOnce) {
    EXPECT_EQ(values_by_name({{"a", "4"}, {"b", "4"}}), "4");
    EXPECT_EQ(values_by_name({{"a", "4"}, {"b", "1"}, {"c", "4"}}), "4 (a, c), 1 (b)");
}

} // namespace
} // namespace plumb
