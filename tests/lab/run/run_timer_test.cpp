// Which parts of a run are timed.
#include "app/lab/run/run_timer.h"

#include "tests/lab/run/fake_simulation.h"

#include <functional>
#include <gtest/gtest.h>

namespace plumb {
namespace {

// The parts of a run in which a step takes cost(fraction of the run done).
std::vector<TimedPart> parts_of(double end, double timed,
                                const std::function<double(double)> &cost) {
    FakeSimulation fake(1.0 / 64);
    RunRecord record(end, timed);
    double used = 0;
    auto next = record.times().begin();
    for (; fake.time() < end; fake.step()) {
        for (; next != record.times().end() && fake.time() >= *next; ++next)
            record.note(fake, used);
        used += cost(fake.time() / end);
    }
    return record.take_parts(fake, used);
}

std::uint64_t first_step(const TimedPart &part) {
    return dynamic_cast<const FakeSimulation::State &>(*part.start).steps;
}

TEST(RunTimer, PartsAreSpreadEvenlyOverARunThatGoesOnAlike) {
    const std::vector<TimedPart> parts = parts_of(64, 2, [](double) { return 1e-3; });
    ASSERT_EQ(parts.size(), 8U);
    for (std::size_t i = 0; i < parts.size(); ++i) {
        EXPECT_DOUBLE_EQ(parts[i].share, 0.125);
        EXPECT_EQ(parts[i].steps, 16U); // 1/4 s
        EXPECT_EQ(first_step(parts[i]), 64 * 8 * i + 64 * 4);
    }
}

TEST(RunTimer, AShortRunIsTimedAsAWhole) {
    for (const double timed : {1.0, 2.0}) {
        const std::vector<TimedPart> parts = parts_of(1, timed, [](double) { return 1e-3; });
        ASSERT_EQ(parts.size(), 1U);
        EXPECT_EQ(first_step(parts[0]), 0U);
        EXPECT_EQ(parts[0].steps, 64U);
        EXPECT_EQ(parts[0].share, 1);
    }
}

// A scene that falls asleep takes a thousandth from then on; an impact takes a hundred times as
// much for a moment; a collapse takes less and less. If bursts as short as a part cost one to four
// times as much in turn, eight parts are only a sample: their mean is typically off by a sixth.
TEST(RunTimer, PartsStandForARunThatDoesNot) {
    const std::function<double(double)> courses[] = {
        [](double t) { return t < 0.04 ? 1 : 1e-3; },
        [](double t) { return t < 0.3 ? 1 : 1e-3; },
        [](double t) { return t > 0.703 && t < 0.713 ? 100 : 1; },
        [](double t) { return t > 0.999 ? 100 : 0.1; },
        [](double t) { return 1.05 - t; },
        [](double t) { return 1 + std::floor(std::fmod(23 * t, 4)); },
    };
    for (const auto &course : courses)
        for (const double end : {6.0, 20.0, 61.0}) {
            const std::vector<TimedPart> parts = parts_of(end, 2, course);
            double share = 0, found = 0, steps = 0;
            for (const TimedPart &part : parts) {
                double taken = 0;
                for (std::uint64_t i = 0; i < part.steps; ++i)
                    taken += course(static_cast<double>(first_step(part) + i) / 64 / end);
                found += part.share * taken / static_cast<double>(part.steps);
                share += part.share;
                steps += static_cast<double>(part.steps);
            }
            double all = 0;
            for (int i = 0; i < 64 * static_cast<int>(end); ++i)
                all += course(i / 64.0 / end) / (64 * end);
            const auto which = &course - courses;
            EXPECT_NEAR(share, 1, 1e-12) << which;
            EXPECT_NEAR(found / all, 1, which < 5 ? 0.02 : 0.1) << which << ' ' << end;
            EXPECT_LE(steps / 64, std::max(4.0, end)) << which;
        }
}

} // namespace
} // namespace plumb
