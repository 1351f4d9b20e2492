#include "engine/scene/expect.h"

#include <cmath>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace plumb {
namespace {

constexpr double pi = std::numbers::pi;

struct Samples {
    std::vector<double> times;
    std::vector<double> values;
};

// offset + amplitude sin(2 pi t / period + phase), `count` samples from 0 to `end`.
Samples sine(double offset, double amplitude, double period, double phase, double end, int count) {
    Samples s;
    for (int i = 0; i < count; ++i) {
        const double t = end * i / (count - 1);
        s.times.push_back(t);
        s.values.push_back(offset + amplitude * std::sin(2 * pi * t / period + phase));
    }
    return s;
}

double reduce(const Samples &s, Reduction reduction, std::optional<double> level = std::nullopt) {
    return plumb::reduce(s.times, s.values, reduction, level);
}

TEST(Reduce, TakesLastAndExtremes) {
    const Samples s{{0, 1, 2, 4}, {2, -7, 5, 1}};
    EXPECT_EQ(reduce(s, Reduction::last), 1);
    EXPECT_EQ(reduce(s, Reduction::min), -7);
    EXPECT_EQ(reduce(s, Reduction::max), 5);
    EXPECT_EQ(reduce(s, Reduction::max_abs), 7);
    EXPECT_EQ(reduce(s, Reduction::drift), 9);
}

TEST(Reduce, MeanWeighsByTime) {
    // Trapezoids of 2, 3 and 12 over 6 seconds.
    const Samples s{{0, 1, 2, 6}, {1, 3, 3, 3}};
    EXPECT_DOUBLE_EQ(reduce(s, Reduction::mean), (2.0 + 3.0 + 12.0) / 6.0);
    // A straight line's mean is its middle, however unevenly sampled.
    const Samples line{{0, 0.1, 0.7, 1}, {3, 3.2, 4.4, 5}};
    EXPECT_NEAR(reduce(line, Reduction::mean), 4, 1e-14);
    EXPECT_EQ(reduce(Samples{{3}, {8}}, Reduction::mean), 8);
}

TEST(Reduce, FindsThePeriodOfASine) {
    // Linear interpolation between samples h apart misplaces a crossing by a cubic remainder of
    // (2 pi h / period)^2 times the distance to the samples: below h (2 pi h / T)^2 / 6 each, here
    // 1e-3 * (6.3e-3 / 0.7)^2 / 6 = 1.4e-8 s.
    for (const double phase : {0.1, 1.0, 2.0, 4.0, 6.0}) {
        const Samples s = sine(0, 3, 0.7, phase, 5, 5001);
        EXPECT_NEAR(reduce(s, Reduction::period, 0.0), 0.7, 3e-8) << phase;
    }
}

TEST(Reduce, PeriodHasALevel) {
    // About 5 rather than 0: the default level, midway between the extremes, finds it. The sampled
    // extremes miss the true ones by up to a (pi h / T)^2 / 2 each, but every crossing moves alike.
    const Samples s = sine(5, 3, 0.7, 1, 5, 5001);
    EXPECT_NEAR(reduce(s, Reduction::period), 0.7, 3e-8);
    EXPECT_NEAR(reduce(s, Reduction::period, 6.0), 0.7, 3e-8);
    EXPECT_TRUE(std::isnan(reduce(s, Reduction::period, 9.0))); // never reaches 9
    // One upward crossing makes no period.
    EXPECT_TRUE(std::isnan(reduce(Samples{{0, 1, 2}, {-1, 1, -1}}, Reduction::period, 0.0)));
}

TEST(Reduce, PeriodIsExactForTriangles) {
    // Linear interpolation is exact for straight sides: upward through 0 at 0.25, 4.25, 8.25.
    const Samples s{{0, 1, 3, 4, 5, 7, 8, 9}, {-1, 3, -1, -1, 3, -1, -1, 3}};
    EXPECT_DOUBLE_EQ(reduce(s, Reduction::period, 0.0), 4);
    // A sample on the level is a crossing at that sample, counted once.
    const Samples touching{{0, 1, 2, 3, 4, 5}, {-1, 0, 1, -1, 0, 1}};
    EXPECT_DOUBLE_EQ(reduce(touching, Reduction::period, 0.0), 3);
}

TEST(Reduce, CountsCrossings) {
    // A sine of 5 s / 0.7 s = 7.14 turns from phase 0.1 is zero at phases pi, 2 pi, ...: the last
    // below 0.1 + 14.29 pi, so 14 times.
    EXPECT_EQ(reduce(sine(0, 3, 0.7, 0.1, 5, 5001), Reduction::crossings, 0.0), 14);
    // Touching the level from one side is no crossing; passing through samples on it is one.
    EXPECT_EQ(reduce(Samples{{0, 1, 2}, {1, 0, 1}}, Reduction::crossings, 0.0), 0);
    EXPECT_EQ(reduce(Samples{{0, 1, 2, 3}, {1, 0, 0, -1}}, Reduction::crossings, 0.0), 1);
    EXPECT_EQ(reduce(Samples{{0, 1}, {2, 2}}, Reduction::crossings), 0);
}

// Dropped from 5 m, it passes 2 m after sqrt(2 (5 - 2) / g): the chord is off by g dt^2 / 8, 1.2e-6
// m, at 7.7 m/s.
TEST(Reduce, FirstCrossingOfAFall) {
    Samples s;
    for (int i = 0; i <= 1000; ++i) {
        s.times.push_back(3 + 0.001 * i); // counts from the first sample
        s.values.push_back(5 - 0.5 * 9.81 * (0.001 * i) * (0.001 * i));
    }
    EXPECT_NEAR(reduce(s, Reduction::first_crossing, 2.0), std::sqrt(6 / 9.81), 2e-7);
    EXPECT_DOUBLE_EQ(reduce(s, Reduction::first_crossing, -10.0), 1); // not while sampled
    // Upward, and only the first; touching is no crossing.
    const Samples wave{{0, 1, 2, 3, 4, 5}, {-1, 0, -1, 3, -3, 3}};
    EXPECT_DOUBLE_EQ(reduce(wave, Reduction::first_crossing, 0.0), 2.25);
    // Through samples on the level: the first of them.
    EXPECT_DOUBLE_EQ(reduce(Samples{{0, 1, 2, 3}, {1, 0, 0, -1}}, Reduction::first_crossing, 0.0),
                     1);
}

TEST(Reduce, NothingGivesNan) {
    for (const ReductionInfo &info : reductions()) {
        EXPECT_TRUE(std::isnan(plumb::reduce({}, {}, info.reduction))) << info.name;
        EXPECT_TRUE(std::isnan(reduce(Samples{{0, 1, 2}, {0, NAN, 2}}, info.reduction)))
            << info.name;
    }
}

TEST(Reduce, RefusesUnequalLengths) {
    const std::vector<double> one{1};
    const std::vector<double> both{1, 2};
    EXPECT_ANY_THROW(plumb::reduce(one, both, Reduction::last));
}

// f at `count` points over [from, to].
std::vector<double> values_of(double (*f)(double), double from, double to, int count) {
    std::vector<double> values;
    for (int i = 0; i < count; ++i)
        values.push_back(f(from + (to - from) * i / (count - 1)));
    return values;
}

double cubic(double t) {
    return 2 - 3 * t + 0.5 * t * t - 0.25 * t * t * t;
}

double sine_of(double t) {
    return std::sin(t);
}

// A curve's largest error within its intervals [first, last].
double curve_error(double (*f)(double), double from, double to, int count, int first, int last) {
    const std::vector<double> values = values_of(f, from, to, count);
    const double h = (to - from) / (count - 1);
    double error = 0;
    for (int i = 64 * first; i <= 64 * (last + 1); ++i) {
        const double t = from + h * i / 64;
        error = std::max(error, std::abs(curve_at(values, from, to, t) - f(t)));
    }
    return error;
}

TEST(Curve, IsExactForCubicsAndAtItsValues) {
    // A dozen roundings of numbers up to 50.
    for (const int count : {4, 5, 9})
        EXPECT_LT(curve_error(cubic, -2, 5, count, 0, count - 2), 1e-13) << count;
    const std::vector<double> values{3, -1, 4, 1, -5};
    for (std::size_t i = 0; i < values.size(); ++i)
        EXPECT_DOUBLE_EQ(curve_at(values, 1, 3, 1 + 0.5 * static_cast<double>(i)), values[i]);
    // Clamped outside its window.
    EXPECT_DOUBLE_EQ(curve_at(values, 1, 3, 0.9), 3);
    EXPECT_DOUBLE_EQ(curve_at(values, 1, 3, 3.1), -5);
}

// Within the declared bounds, and above half of them: they are tight for a sine, whose fourth
// derivative is at most 1.
TEST(Curve, IsOffByTheFourthPowerOfItsInterval) {
    for (const int count : {33, 65, 129}) {
        const double h = 2 * pi / (count - 1);
        const double end = std::pow(h, 4) / 24, within = 3 * std::pow(h, 4) / 128;
        const double found = curve_error(sine_of, 0, 2 * pi, count, 1, count - 3);
        EXPECT_LE(found, within) << count;
        EXPECT_GT(found, 0.5 * within) << count;
        // Starting where the sine is largest, the ends are worst.
        const double at_ends =
            std::max(curve_error(sine_of, pi / 2, 2.5 * pi, count, 0, 0),
                     curve_error(sine_of, pi / 2, 2.5 * pi, count, count - 2, count - 2));
        EXPECT_LE(at_ends, end) << count;
        EXPECT_GT(at_ends, 0.5 * end) << count;
    }
}

TEST(Curve, RefusesWhatIsNone) {
    const std::vector<double> values{1, 2, 3};
    EXPECT_ANY_THROW(curve_at(values, 0, 1, 0.5));
    EXPECT_ANY_THROW(curve_at(std::vector<double>{1, 2, 3, 4}, 1, 1, 1));
}

TEST(RelativeChange, DividesByTheScaleAtTheStart) {
    EXPECT_DOUBLE_EQ(relative_change(-3, 4), -0.75);
    EXPECT_EQ(relative_change(-3, 0), -3);
}

TEST(Quantities, AreFoundByName) {
    std::set<std::string_view> names;
    for (const QuantityInfo &info : quantities()) {
        EXPECT_TRUE(names.insert(info.name).second) << info.name;
        EXPECT_EQ(find_quantity(info.name), &info);
        EXPECT_FALSE(info.unit.empty());
        EXPECT_FALSE(info.description.empty());
    }
    EXPECT_EQ(find_quantity("entropy"), nullptr);
    for (const ReductionInfo &info : reductions())
        EXPECT_EQ(find_reduction(info.name), &info);
    EXPECT_EQ(find_reduction(""), nullptr);
}

} // namespace
} // namespace plumb
