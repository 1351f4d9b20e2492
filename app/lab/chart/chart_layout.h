// Where everything on an error-cost chart goes: values in, pixels out, nothing drawn.
#pragma once

#include "app/lab/chart/log_axis.h"

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec2.hpp>

namespace plumb {

// One run on the chart.
struct ChartMark {
    double cost = 0;                    // s of CPU time per simulated second, > 0
    double cost_low = 0, cost_high = 0; // spread over the repeats
    double error = 0;                   // >= 0; not read when failed
    bool failed = false;                // diverged, or nothing could be measured
    bool outside = false;               // it misses something that the scene expects
    bool pareto = false;
    std::string label; // its setting
    std::size_t series = 0;
};

// A style is a colour, by what is left of it when divided by this, and one of 5 shapes.
inline constexpr std::size_t series_colour_count = 7;

struct ChartSeries {
    std::string name;
    std::size_t style = 0;                       // colour and shape
    std::vector<std::vector<std::size_t>> lines; // indices of marks, joined in this order
};

struct ChartContent {
    std::string title;
    std::string subtitle; // what the error is
    std::string cost_title;
    std::string error_title;
    std::string cost_unit = "s";
    std::string error_unit = "1";
    std::string label_meaning;   // "substeps"
    std::optional<double> limit; // true enough at most; 0 where only an error of exactly zero is
    std::string limit_label;
    std::optional<double> floor; // errors below it are not resolved
    std::string floor_label;
    std::optional<double> budget; // what it may cost; true enough and within it is the corner
    std::string budget_label;
    std::vector<ChartSeries> series;
    std::vector<ChartMark> marks;
    std::vector<std::string> worst;    // the expectations that are the worst of some run
    std::vector<std::string> failures; // a line a series with failed runs: which and why
    std::vector<std::string> left_out; // methods that are not here, and why
    std::vector<std::string> footer;
};

struct PixelBox {
    glm::vec2 min{0}, max{0};
    [[nodiscard]] bool overlaps(const PixelBox &other) const {
        return min.x < other.max.x && other.min.x < max.x && min.y < other.max.y &&
               other.min.y < max.y;
    }
    [[nodiscard]] bool contains(const PixelBox &other) const {
        return min.x <= other.min.x && min.y <= other.min.y && max.x >= other.max.x &&
               max.y >= other.max.y;
    }
};

// The size of a text in pixels.
using TextSize = std::function<glm::vec2(std::string_view text, float font_size)>;

struct PlacedTick {
    float pixel = 0; // x or y
    bool decade = false;
    std::string label;
};

struct PlacedLabel {
    std::size_t mark = 0;
    PixelBox box;
};

struct ChartLayout {
    glm::vec2 size{0};
    PixelBox plot;                    // the frame, strips included
    PixelBox field;                   // where the logarithmic scales hold
    std::optional<float> failed_line; // y of the failed runs' strip, above the field
    // y of the strip for errors of exactly zero, below the field; where there are no others, it
    // takes the field's place, which then has no height.
    std::optional<float> zero_line;
    LogRange cost_range, error_range;
    std::vector<PlacedTick> cost_ticks, error_ticks;
    std::vector<glm::vec2> marks;    // in the order of the content's
    std::vector<PlacedLabel> labels; // never over each other, a mark or the frame; some marks may
                                     // go without where there is no room
    std::optional<float> limit_line; // y; for a limit of 0 the top of the strip for zero
    PixelBox limit_text;
    std::optional<float> floor_line; // y; none where all errors are far above it
    PixelBox floor_text;
    // x; none where there is no budget, or it lies so far from all runs that the scale leaves it
    // out: then the text says on which side.
    std::optional<float> budget_line;
    std::string budget_label;
    PixelBox budget_text;
    std::optional<PixelBox> corner;      // of what is true enough and within the budget
    std::vector<glm::vec2> pareto_steps; // a staircase through the front, in pixels
};

namespace chart_style {
inline constexpr glm::vec2 size{1200, 800};
inline constexpr float mark_radius = 6;
inline constexpr float front_radius = 11; // of a mark on the Pareto front, with its outline
inline constexpr float title_text = 26;
inline constexpr float subtitle_text = 15;
inline constexpr float axis_text = 14;
inline constexpr float label_text = 13;
inline constexpr float footer_text = 12;
inline constexpr float label_margin = 2; // on both sides of a label, within its box
inline constexpr float close_row = 20;   // of many names
inline constexpr float second_row = 16;  // of one name that takes two
inline constexpr PixelBox plot{{96, 132}, {932, 668}};
} // namespace chart_style

// As high as the names of many series need.
[[nodiscard]] glm::vec2 chart_size(const ChartContent &content);

[[nodiscard]] ChartLayout lay_out(const ChartContent &content, const TextSize &text_size);

// Places a box of each size beside its point, off all points (squares of their radii around
// them), off `obstacles`, inside `bounds` and off each other; lines are avoided where possible. (A
// label at a corner of its own point reaches a little into that square: marks are round there.) The
// earlier a point in `order`, the better its chances. Entries without room are left out.
[[nodiscard]] std::vector<PlacedLabel>
place_labels(const std::vector<glm::vec2> &points, const std::vector<glm::vec2> &sizes,
             const std::vector<float> &radii, const std::vector<std::size_t> &order,
             const PixelBox &bounds, const std::vector<PixelBox> &obstacles,
             const std::vector<std::pair<glm::vec2, glm::vec2>> &lines);

// A list under a title, in so many rows: all lines of all texts where there is room for them, else
// those of the first texts, whole, and how many more there are. Empty where not even the first
// finds room.
[[nodiscard]] std::vector<std::string>
fitting_lines(const std::vector<std::vector<std::string>> &texts, std::size_t rows);

} // namespace plumb
