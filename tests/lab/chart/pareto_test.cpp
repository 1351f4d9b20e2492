#include "app/lab/chart/pareto.h"

#include "engine/core/random.h"

#include <cmath>

#include <gtest/gtest.h>

namespace plumb {
namespace {

// By definition: compares all pairs.
std::vector<bool> brute_force(const std::vector<CostAndError> &choices) {
    std::vector<bool> front;
    for (const CostAndError &a : choices) {
        bool beaten = !std::isfinite(a.cost) || !std::isfinite(a.error);
        for (const CostAndError &b : choices)
            beaten = beaten || (b.cost <= a.cost && b.error <= a.error &&
                                (b.cost < a.cost || b.error < a.error));
        front.push_back(!beaten);
    }
    return front;
}

TEST(Pareto, AgreesWithTheDefinition) {
    Random random(5);
    for (int trial = 0; trial < 2000; ++trial) {
        std::vector<CostAndError> choices;
        const int count = trial % 12;
        for (int i = 0; i < count; ++i) {
            // Few distinct values, so that ties are frequent; some failures.
            CostAndError choice{1.0 + random.next_index(5), 0.0 + random.next_index(5)};
            if (random.next_index(10) == 0)
                choice.error = INFINITY;
            choices.push_back(choice);
        }
        ASSERT_EQ(pareto_front(choices), brute_force(choices)) << "trial " << trial;
    }
}

TEST(Pareto, FailuresAreNeverOnIt) {
    const std::vector<CostAndError> choices{{1, INFINITY}, {2, NAN}, {NAN, 0}, {INFINITY, 1}};
    EXPECT_EQ(pareto_front(choices), std::vector<bool>(4, false));
}

} // namespace
} // namespace plumb
