#include "app/lab/chart/chart_layout.h"

#include "engine/core/random.h"

#include <cmath>

#include <glm/common.hpp>
#include <gtest/gtest.h>

namespace plumb {
namespace {

glm::vec2 text_size(std::string_view text, float font_size) {
    return {0.5f * font_size * static_cast<float>(text.size()), font_size};
}

ChartContent crowded(std::uint64_t seed, std::size_t count, bool clustered) {
    Random random(seed);
    ChartContent content;
    content.error_unit = "m";
    content.limit = 0.01;
    content.limit_label = "tolerance 10 mm";
    content.series.push_back({"one", 0, {{}}});
    for (std::size_t i = 0; i < count; ++i) {
        ChartMark mark;
        mark.cost = std::pow(10, clustered ? random.next_in(-3, -2.9) : random.next_in(-5, -1));
        mark.error = std::pow(10, clustered ? random.next_in(-2, -1.9) : random.next_in(-6, 0));
        mark.failed = random.next_index(8) == 0;
        if (random.next_index(8) == 0)
            mark.error = 0;
        mark.pareto = !mark.failed && random.next_index(4) == 0;
        mark.label = std::to_string(1 << random.next_index(11));
        content.series[0].lines[0].push_back(i);
        content.marks.push_back(mark);
    }
    return content;
}

TEST(ChartLayout, LabelsOverlapNothing) {
    using namespace chart_style;
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        const ChartContent content = crowded(seed, 10 + seed, seed % 3 == 0);
        const ChartLayout layout = lay_out(content, text_size);
        for (std::size_t i = 0; i < layout.labels.size(); ++i) {
            const PlacedLabel &label = layout.labels[i];
            ASSERT_TRUE(layout.plot.contains(label.box));
            ASSERT_FALSE(label.box.overlaps(layout.limit_text));
            for (std::size_t j = 0; j < i; ++j) {
                ASSERT_FALSE(label.box.overlaps(layout.labels[j].box)) << "seed " << seed;
                ASSERT_NE(label.mark, layout.labels[j].mark);
            }
            for (std::size_t m = 0; m < layout.marks.size(); ++m) {
                // The label's closest point to the mark's centre: outside the round mark.
                const glm::vec2 p = layout.marks[m];
                const glm::vec2 nearest = glm::max(label.box.min, glm::min(p, label.box.max));
                ASSERT_GE(std::hypot(nearest.x - p.x, nearest.y - p.y), mark_radius)
                    << "seed " << seed;
            }
        }
    }
}

TEST(ChartLayout, EveryMarkWithRoomHasItsLabel) {
    // On a diagonal, at least 40 pixels apart: nothing is in the way.
    ChartContent content;
    content.series.push_back({"one", 0, {{}}});
    for (int i = 0; i < 10; ++i) {
        ChartMark mark;
        mark.cost = std::pow(2, i);
        mark.error = std::pow(2, -i);
        mark.label = std::to_string(i);
        content.series[0].lines[0].push_back(content.marks.size());
        content.marks.push_back(mark);
    }
    const ChartLayout layout = lay_out(content, text_size);
    EXPECT_EQ(layout.labels.size(), 10U);
    for (const PlacedLabel &label : layout.labels) {
        // And close to it: within the mark's radius, the widest gap and half the text.
        const glm::vec2 centre = 0.5f * (label.box.min + label.box.max);
        const glm::vec2 p = layout.marks[label.mark];
        EXPECT_LT(std::hypot(centre.x - p.x, centre.y - p.y), 45);
    }
}

TEST(ChartLayout, PixelsFollowTheLogarithms) {
    ChartContent content;
    content.error_unit = "m";
    content.series.push_back({"one", 0, {{0, 1, 2}}});
    for (int i = 0; i < 3; ++i) {
        ChartMark mark;
        mark.cost = std::pow(10, i);
        mark.error = std::pow(100, i);
        content.marks.push_back(mark);
    }
    const ChartLayout layout = lay_out(content, text_size);
    EXPECT_FALSE(layout.failed_line);
    EXPECT_FALSE(layout.zero_line);
    EXPECT_FALSE(layout.limit_line);
    // Equal ratios are equal distances; costlier is to the right, worse is higher up. Pixels are
    // floats below 1200: round-off stays below 1e-3.
    EXPECT_NEAR(layout.marks[1].x - layout.marks[0].x, layout.marks[2].x - layout.marks[1].x, 1e-3);
    EXPECT_GT(layout.marks[1].x, layout.marks[0].x);
    EXPECT_NEAR(layout.marks[1].y - layout.marks[0].y, layout.marks[2].y - layout.marks[1].y, 1e-3);
    EXPECT_LT(layout.marks[1].y, layout.marks[0].y);
    for (const PlacedTick &tick : layout.cost_ticks) {
        EXPECT_GE(tick.pixel, layout.field.min.x);
        EXPECT_LE(tick.pixel, layout.field.max.x);
        if (tick.label == "1 s") {
            EXPECT_NEAR(tick.pixel, layout.marks[0].x, 1e-3);
        }
    }
}

TEST(ChartLayout, FailuresGoToTheTopAndZerosToTheBottom) {
    ChartContent content;
    content.limit = 0.1;
    content.limit_label = "tolerance";
    content.series.push_back({"one", 0, {{0, 1, 2}}});
    content.marks.resize(3);
    content.marks[0].cost = 1;
    content.marks[0].failed = true;
    content.marks[1].cost = 2;
    content.marks[1].error = 0;
    content.marks[1].pareto = true;
    content.marks[2].cost = 1.5;
    content.marks[2].error = 1;
    content.marks[2].pareto = true;
    const ChartLayout layout = lay_out(content, text_size);
    ASSERT_TRUE(layout.failed_line && layout.zero_line && layout.limit_line);
    EXPECT_EQ(layout.marks[0].y, *layout.failed_line);
    EXPECT_LT(layout.marks[0].y, layout.field.min.y);
    EXPECT_EQ(layout.marks[1].y, *layout.zero_line);
    EXPECT_GT(layout.marks[1].y, layout.field.max.y);
    EXPECT_GT(layout.marks[2].y, layout.field.min.y);
    EXPECT_LT(layout.marks[2].y, *layout.limit_line);
    EXPECT_LT(*layout.limit_line, layout.field.max.y);
    // The staircase only goes right and down.
    for (std::size_t i = 1; i < layout.pareto_steps.size(); ++i) {
        EXPECT_GE(layout.pareto_steps[i].x, layout.pareto_steps[i - 1].x);
        EXPECT_GE(layout.pareto_steps[i].y, layout.pareto_steps[i - 1].y);
    }
}

// A bound that every run keeps: all errors are exactly 0, and there is nothing else to show.
TEST(ChartLayout, NothingButZeros) {
    ChartContent content;
    content.limit = 0;
    content.limit_label = "at least 1 rad";
    content.series.push_back({"one", 0, {{0, 1}}});
    content.marks.resize(2);
    for (std::size_t i = 0; i < 2; ++i) {
        content.marks[i].cost = 1 + static_cast<double>(i);
        content.marks[i].label = "4";
    }
    const ChartLayout layout = lay_out(content, text_size);
    ASSERT_TRUE(layout.zero_line && layout.limit_line);
    EXPECT_EQ(*layout.zero_line, 0.5f * (layout.plot.min.y + layout.plot.max.y));
    EXPECT_TRUE(layout.error_ticks.empty()); // there is no scale
    EXPECT_FALSE(layout.cost_ticks.empty());
    EXPECT_EQ(layout.labels.size(), 2U);
    EXPECT_TRUE(layout.plot.contains(layout.limit_text));
    for (const glm::vec2 &mark : layout.marks) {
        EXPECT_EQ(mark.y, *layout.zero_line);
        EXPECT_GT(mark.y, *layout.limit_line); // inside the band of runs within tolerance
    }
    // One run with an error brings the scale back, and zeros go to the bottom.
    content.marks[0].error = 0.1;
    const ChartLayout scale = lay_out(content, text_size);
    EXPECT_FALSE(scale.error_ticks.empty());
    EXPECT_LT(scale.marks[0].y, *scale.limit_line);
    EXPECT_GT(scale.marks[1].y, *scale.limit_line);
    EXPECT_EQ(*scale.limit_line, scale.field.max.y);
}

TEST(ChartLayout, NothingButFailures) {
    ChartContent content;
    content.series.push_back({"one", 0, {{0}}});
    content.marks.resize(1);
    content.marks[0].cost = 1e-3;
    content.marks[0].failed = true;
    const ChartLayout layout = lay_out(content, text_size);
    EXPECT_TRUE(std::isfinite(layout.marks[0].x));
    EXPECT_TRUE(layout.pareto_steps.empty());
}

TEST(ChartLayout, ListsShowWholeTextsAndSayHowManyMoreThereAre) {
    using Lines = std::vector<std::string>;
    const std::vector<Lines> texts{{"a"}, {"b", "of b"}, {"c"}};
    EXPECT_EQ(fitting_lines(texts, 4), (Lines{"a", "b", "of b", "c"}));
    EXPECT_EQ(fitting_lines(texts, 9), (Lines{"a", "b", "of b", "c"}));
    EXPECT_EQ(fitting_lines(texts, 3), (Lines{"a", "and 2 more, named in the CSV file"}));
    EXPECT_EQ(fitting_lines(texts, 1), Lines{});
    EXPECT_EQ(fitting_lines(texts, 0), Lines{});
    EXPECT_EQ(fitting_lines({}, 3), Lines{});
}

} // namespace
} // namespace plumb
