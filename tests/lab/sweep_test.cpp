#include "app/lab/sweep.h"

#include <set>
#include <stdexcept>

#include <gtest/gtest.h>

namespace plumb {
namespace {

std::string complaint(const std::string &text) {
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
    EXPECT_EQ(parse_sweep("iterations=4").setting, SweepSetting::iterations);
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
    EXPECT_NE(complaint("substeps").find("SETTING=VALUES"), std::string::npos);
    EXPECT_NE(complaint("substep=1..4").find("substeps, iterations and dt can"), std::string::npos);
    EXPECT_NE(complaint("substeps=").find("no values"), std::string::npos);
    EXPECT_NE(complaint("substeps=1..x").find("\"x\" is not a number"), std::string::npos);
    EXPECT_NE(complaint("substeps=1..4..8").find("\"4..8\" is not a number"), std::string::npos);
    EXPECT_NE(complaint("substeps=1,,2").find("\"\" is not a number"), std::string::npos);
    EXPECT_NE(complaint("substeps=8..2").find("ascend"), std::string::npos);
    EXPECT_NE(complaint("substeps=0..4").find("between 1 and 1024"), std::string::npos);
    EXPECT_NE(complaint("substeps=1.5").find("whole"), std::string::npos);
    EXPECT_NE(complaint("iterations=2000").find("1024"), std::string::npos);
    EXPECT_NE(complaint("dt=1/0").find("division by zero"), std::string::npos);
    EXPECT_NE(complaint("dt=0..1").find("between 1e-6 and 1 s"), std::string::npos);
    EXPECT_NE(complaint("dt=nan").find("not a number"), std::string::npos);
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
    apply(axes, points.back(), settings);
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

TEST(Sweep, SettingsThatAMethodDoesNotHaveMakeNoDifference) {
    MethodInfo method;
    method.body_passes = [](int substeps, int) { return 4 * substeps; };
    method.constraint_passes = [](int, int) { return 0; };
    StepSettings a, b;
    b.iterations = a.iterations + 1;
    EXPECT_TRUE(same_work(method, a, b));
    method.constraint_passes = [](int substeps, int iterations) { return substeps * iterations; };
    EXPECT_FALSE(same_work(method, a, b));
    // The same product, but not the same motion.
    a.substeps = b.iterations = 4;
    b.substeps = a.iterations = 2;
    EXPECT_FALSE(same_work(method, a, b));
}

} // namespace
} // namespace plumb
