// Choices among made-up runs.
#include "app/lab/tune/choice.h"

#include "engine/core/random.h"

#include <algorithm>
#include <numeric>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace plumb {
namespace {

struct MadeUpRun {
    const char *method;
    double cost, error, work;
};

// Five rounds of timings of each, off by up to `noise` either way.
Tuning made_up(const std::vector<MadeUpRun> &runs, double noise, std::uint64_t seed) {
    Random random(seed);
    Tuning tuning;
    for (const MadeUpRun &each : runs) {
        TunedRun &run = tuning.runs.emplace_back();
        run.resolved.method = find_method_info(each.method);
        run.verdict = TuneVerdict::met;
        run.error = each.error;
        run.work = each.work;
        for (int round = 0; round < 5; ++round)
            run.timings.push_back(each.cost * (1 + noise * random.next_in(-1.0, 1.0)));
        std::vector<double> sorted = run.timings;
        std::ranges::sort(sorted);
        run.cost = sorted[2];
    }
    return tuning;
}

std::size_t chosen_of(const Tuning &tuning) {
    std::vector<std::size_t> choices(tuning.runs.size());
    std::iota(choices.begin(), choices.end(), std::size_t{0});
    return cheapest_choice(tuning, choices);
}

// Two methods within a few per cent, as measured on a chain with a heavy end: whichever looks
// cheaper on the day, the more accurate one is chosen.
TEST(TuneChoice, NoiseDoesNotDecideBetweenTwoMethods) {
    for (const double tgs : {0.553, 0.563, 0.573})
        for (std::uint64_t seed = 1; seed <= 200; ++seed)
            EXPECT_EQ(chosen_of(made_up(
                          {{"tgs_soft", tgs, 0.727, 16500}, {"soft_step", 0.563, 0.0586, 5280}},
                          0.04, seed)),
                      1U)
                << tgs << ' ' << seed;
}

TEST(TuneChoice, NoiseDoesNotDecideBetweenTwoRunsOfAMethod) {
    for (std::uint64_t seed = 1; seed <= 200; ++seed)
        EXPECT_EQ(chosen_of(made_up({{"soft_step", 0.565, 0.01, 5940},
                                     {"soft_step", 0.57, 0.0586, 5280},
                                     {"soft_step", 0.56, 0.02, 6000}},
                                    0.02, seed)),
                  1U)
            << seed;
}

TEST(TuneChoice, WhatIsPlainlyCheaperIsChosenHoweverInaccurate) {
    for (std::uint64_t seed = 1; seed <= 200; ++seed)
        EXPECT_EQ(chosen_of(made_up({{"soft_step", 0.65, 0.01, 5280},
                                     {"tgs_soft", 0.56, 0.79, 16500},
                                     {"tgs_soft", 0.7, 0.1, 12000}},
                                    0.03, seed)),
                  1U)
            << seed;
}

TEST(TuneChoice, OfEqualOnesTheFirstMethodAndTheTimedOneAreTaken) {
    Tuning equal = made_up({{"tgs_soft", 1, 0, 2}, {"soft_step", 1, 0, 2}}, 0, 1);
    EXPECT_EQ(equal.runs[chosen_of(equal)].resolved.method, &method_infos()[0]);
    equal.runs[1].timings.clear();
    equal.runs[1].cost = 0.1;
    EXPECT_EQ(chosen_of(equal), 0U);
}

} // namespace
} // namespace plumb
