#include "app/sandbox/studies/plots.h"

#include "app/sandbox/panels/plot_axis.h"
#include "app/sandbox/session/session.h"
#include "engine/core/random.h"
#include "tests/sandbox/fake_simulation.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include <unistd.h>

#include <gtest/gtest.h>

namespace plumb {
namespace {

std::string csv_of(const Plots &plots) {
    std::ostringstream out;
    plots.write_csv(out);
    return out.str();
}

SceneDesc slow_balls() {
    SceneDesc scene = two_balls(); // 0.25 m/s upwards
    scene.world.settings.give(&StepSettings::dt, 0.5);
    return scene;
}

TEST(Plots, FollowTheRunForthAndBack) {
    Session session({}, nullptr, make_fake());
    ASSERT_TRUE(session.open(slow_balls()));
    ASSERT_TRUE(session.plot({"position.y", "right"}));
    for (int i = 0; i < 10; ++i)
        ASSERT_TRUE(session.step());
    const auto &samples = session.plots().curves()[0].samples;
    ASSERT_EQ(samples.size(), 11u);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        EXPECT_EQ(samples[i].step, i);
        EXPECT_EQ(samples[i].time, 0.5 * static_cast<double>(i));
        EXPECT_EQ(samples[i].value, 0.125 * static_cast<double>(i));
    }
    for (int i = 0; i < 4; ++i)
        ASSERT_TRUE(session.step_back());
    ASSERT_EQ(samples.size(), 7u);
    EXPECT_EQ(samples.back().step, 6u);
    ASSERT_TRUE(session.step());
    ASSERT_EQ(samples.size(), 8u);
    EXPECT_EQ(samples.back().value, 7 * 0.125);
    ASSERT_TRUE(session.restart());
    ASSERT_EQ(session.plots().curves().size(), 1u);
    EXPECT_EQ(samples.size(), 1u);
}

TEST(Plots, BeginWhereTheFirstWasChosen) {
    Session session({}, nullptr, make_fake());
    ASSERT_TRUE(session.open(slow_balls()));
    EXPECT_FALSE(session.plots().first_step());
    for (int i = 0; i < 3; ++i)
        ASSERT_TRUE(session.step());
    ASSERT_TRUE(session.plot({"position.y", "right"}));
    ASSERT_TRUE(session.step());
    ASSERT_TRUE(session.plot({"position.y", "left"}));
    EXPECT_EQ(session.plots().first_step(), 3U);
    EXPECT_EQ(csv_of(session.plots()).find("\n3,"), csv_of(session.plots()).find('\n'));
    session.unplot(0);
    EXPECT_EQ(session.plots().first_step(), 4U);
    ASSERT_TRUE(session.restart());
    EXPECT_EQ(session.plots().first_step(), 0U);
}

// Whenever it is added to the plot, a displacement is measured from the start of the run.
TEST(Plots, CountFromTheStartOfTheRun) {
    Session session({}, nullptr, make_fake());
    ASSERT_TRUE(session.open(slow_balls()));
    for (int i = 0; i < 4; ++i)
        ASSERT_TRUE(session.step());
    ASSERT_TRUE(session.plot({"displacement", "left"}));
    EXPECT_EQ(session.plots().curves()[0].samples.back().value, 0.5);
}

TEST(Plots, OfWhatIsNotThereAreGoneOrRefused) {
    Session session({}, nullptr, make_fake());
    ASSERT_TRUE(session.open(two_balls()));
    EXPECT_FALSE(session.plot({"position.y", "nobody"}));
    EXPECT_FALSE(session.plot({"colour", "left"}));
    EXPECT_EQ(session.messages().all().size(), 2u);
    EXPECT_TRUE(session.plots().curves().empty());
    ASSERT_TRUE(session.step());
    ASSERT_TRUE(session.shoot({0, 9, 0}, {1, 0, 0}, 0.1));
    ASSERT_TRUE(session.step());
    ASSERT_TRUE(session.plot({"speed", "ball"}));
    ASSERT_TRUE(session.plot({"energy", ""}));
    ASSERT_TRUE(session.plot({"energy", ""})); // already plotted
    ASSERT_TRUE(session.step());
    ASSERT_EQ(session.plots().curves().size(), 2u);
    EXPECT_EQ(session.plots().curves()[0].samples.back().value, 1);
    for (int i = 0; i < 3; ++i) // back to before the shot
        ASSERT_TRUE(session.step_back());
    ASSERT_EQ(session.plots().curves().size(), 1u);
    EXPECT_EQ(session.plots().curves()[0].name.quantity, "energy");
    ASSERT_TRUE(session.plot({"speed", "left"}));
    SceneDesc other = two_balls();
    other.bodies[0].name = "first";
    ASSERT_TRUE(session.open(other));
    ASSERT_EQ(session.plots().curves().size(), 1u);
    ASSERT_TRUE(session.step());
    session.unplot(0);
    ASSERT_TRUE(session.step());
    EXPECT_TRUE(session.plots().curves().empty());
}

TEST(Plots, AsATable) {
    Session session({}, nullptr, make_fake());
    ASSERT_TRUE(session.open(slow_balls()));
    ASSERT_TRUE(session.plot({"position.y", "left"}));
    ASSERT_TRUE(session.step());
    ASSERT_TRUE(session.plot({"energy_error", ""}));
    ASSERT_TRUE(session.step());
    const std::string table = "step,time (s),position.y of left (m),energy_error\n"
                              "0,0,0,\n"
                              "1,0.5,0.125,0\n"
                              "2,1,0.25,0\n";
    EXPECT_EQ(csv_of(session.plots()), table);

    const std::filesystem::path folder =
        std::filesystem::temp_directory_path() / ("plumb-plots-" + std::to_string(::getpid()));
    EXPECT_TRUE(session.save_plots(folder / "a" / "plots.csv"));
    std::ostringstream written;
    written << std::ifstream(folder / "a" / "plots.csv").rdbuf();
    EXPECT_EQ(written.str(), table);
    EXPECT_FALSE(session.save_plots(folder / "a")); // a folder
    EXPECT_EQ(session.messages().all().back().severity, Message::Severity::error);
    std::filesystem::remove_all(folder);
}

TEST(Plots, OfferWhatTheLabMeasures) {
    const SceneDesc scene = two_balls();
    const FakeSimulation fake(scene);
    EXPECT_EQ(plot_subjects(fake), (std::vector<std::string>{"left", "right"}));
    for (const QuantityInfo &info : quantities()) {
        const auto has = [&](const std::string &name) {
            const auto found = quantities_of(fake, name);
            return std::find(found.begin(), found.end(), &info) != found.end();
        };
        EXPECT_EQ(has(""), info.subject().empty()) << info.name;
        EXPECT_EQ(has("left"), info.needs_body()) << info.name;
        EXPECT_FALSE(has("nobody")) << info.name;
    }
}

TEST(PlotAxis, TicksAscendAndTellTheirValues) {
    Random random(5);
    for (int i = 0; i < 3000; ++i) {
        const double size = std::pow(10.0, random.next_in(-9, 9));
        const double low = random.next_in(-1, 1) * size;
        const double high = low + std::pow(10.0, random.next_in(-7, 1)) * size;
        const int most = 2 + i % 8;
        const PlotAxis axis = plot_axis(low, high, most);
        ASSERT_LT(axis.low, low);
        ASSERT_GT(axis.high, high);
        ASSERT_LE(axis.ticks.size(), static_cast<std::size_t>(most));
        std::set<std::string> labels;
        for (std::size_t k = 0; k < axis.ticks.size(); ++k) {
            const PlotTick &tick = axis.ticks[k];
            EXPECT_GE(axis.fraction(tick.value), -1e-9);
            EXPECT_LE(axis.fraction(tick.value), 1 + 1e-9);
            EXPECT_TRUE(labels.insert(tick.label).second) << tick.label;
            if (k == 0)
                continue;
            const double distance = tick.value - axis.ticks[k - 1].value;
            ASSERT_GT(distance, 0);
            EXPECT_NEAR(std::stod(tick.label), tick.value, 0.01 * distance) << tick.label;
        }
    }
    EXPECT_GE(plot_axis(0, 1, 6).ticks.size(), 3u);
}

// Centred on its tick, except at the ends of the axis, past which another axis's labels begin.
TEST(PlotAxis, LabelsStayWithinIt) {
    EXPECT_EQ(label_begin(50, 10, 0, 100), 45);
    EXPECT_EQ(label_begin(2, 10, 0, 100), 0);
    EXPECT_EQ(label_begin(99, 10, 0, 100), 90);
    EXPECT_EQ(label_begin(3, 10, 0, 6), 0); // no room for it
}

TEST(PlotAxis, WhatRoundingDoesIsFlat) {
    const PlotAxis axis = plot_axis(1000, 1000.0001, 5);
    EXPECT_NEAR(axis.fraction(1000.0001) - axis.fraction(1000), 0.01, 0.002);
    const PlotAxis none = plot_axis(0, 0, 5);
    EXPECT_EQ(none.fraction(0), 0.5);
    EXPECT_EQ(none.ticks.back().label, "1");
    EXPECT_LT(plot_axis(10, 10, 5).low, 9);
    EXPECT_EQ(tight_axis(2, 2, 5).high, 3);
    EXPECT_EQ(tight_axis(0, 2, 5).ticks.back().label, "2.0");
}

} // namespace
} // namespace plumb
