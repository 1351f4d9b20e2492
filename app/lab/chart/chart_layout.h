// Layout of an error-cost chart: values in, pixels out, nothing drawn.
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
    bool outside = false;               // misses an expectation of the scene
    bool pareto = false;
    std::string label; // its setting
    std::size_t series = 0;
};

struct ChartSeries {
    std::string name;
    std::size_t style = 0;                       // see curve_style.h
    std::vector<std::vector<std::size_t>> lines; // mark indices, joined in this order
};

struct ChartContent {
    std::string title;
    std::string subtitle; // what the error is
    std::string cost_title;
    std::string error_title;
    std::string cost_unit = "s";
    std::string error_unit = "1";
    std::string label_meaning;   // "substeps"
    std::optional<double> limit; // largest acceptable error; 0: only an error of exactly zero
    std::string limit_label;
    std::optional<double> floor; // errors below it are not resolved
    std::string floor_label;
    std::optional<double> budget; // largest acceptable cost; with the limit it bounds the corner
    std::string budget_label;
    std::vector<ChartSeries> series;
    std::vector<ChartMark> marks;
    std::vector<std::string> worst;    // expectations that are the worst of some run
    std::vector<std::string> failures; // one line per series with failed runs: which and why
    std::vector<std::string> left_out; // methods left off the chart, and why
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

// Text size in pixels.
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
    PixelBox field;                   // the part with logarithmic scales
    std::optional<float> failed_line; // y of the strip for failed runs, above the field
    // y of the strip for errors of exactly zero, below the field; if there are no other errors, the
    // strip replaces the field, whose height is then 0.
    std::optional<float> zero_line;
    LogRange cost_range, error_range;
    std::vector<PlacedTick> cost_ticks, error_ticks;
    std::vector<glm::vec2> marks;    // same order as ChartContent::marks
    std::vector<PlacedLabel> labels; // clear of each other, marks and the frame; marks without
                                     // room have no label
    std::optional<float> limit_line; // y; for a limit of 0 the top of the zero strip
    PixelBox limit_text;
    std::optional<float> floor_line; // y; none if all errors are far above it
    PixelBox floor_text;
    // x; none without a budget, or if it is so far from all runs that it is off the scale: the
    // label then says on which side.
    std::optional<float> budget_line;
    std::string budget_label;
    PixelBox budget_text;
    std::optional<PixelBox> corner;      // acceptable error within the budget
    std::vector<glm::vec2> pareto_steps; // a staircase through the front, in pixels
};

namespace chart_style {
inline constexpr glm::vec2 size{1200, 800};
inline constexpr float mark_radius = 6;
inline constexpr float front_radius = 11; // mark on the Pareto front, with its outline
inline constexpr float title_text = 26;
inline constexpr float subtitle_text = 15;
inline constexpr float axis_text = 14;
inline constexpr float label_text = 13;
inline constexpr float footer_text = 12;
inline constexpr float label_margin = 2; // on either side of a label, inside its box
inline constexpr float close_row = 20;   // row height with many names
inline constexpr float second_row = 16;  // second row of a long name
inline constexpr PixelBox plot{{96, 132}, {932, 668}};
} // namespace chart_style

// Taller if there are many series names.
[[nodiscard]] glm::vec2 chart_size(const ChartContent &content);

[[nodiscard]] ChartLayout lay_out(const ChartContent &content, const TextSize &text_size);

// Places a box of each size next to its point, clear of all points (squares of their radii), of
// `obstacles` and of each other, and inside `bounds`; lines are avoided where possible. (A label
// diagonal to its own point reaches a little into that square, since marks are round.) Points are
// placed in `order`; those without room are left out.
[[nodiscard]] std::vector<PlacedLabel>
place_labels(const std::vector<glm::vec2> &points, const std::vector<glm::vec2> &sizes,
             const std::vector<float> &radii, const std::vector<std::size_t> &order,
             const PixelBox &bounds, const std::vector<PixelBox> &obstacles,
             const std::vector<std::pair<glm::vec2, glm::vec2>> &lines);

// Fits a list under a title into `rows` rows: every line if there is room, else the first texts,
// each in full, then how many more there are. Empty if not even the first text fits.
[[nodiscard]] std::vector<std::string>
fitting_lines(const std::vector<std::vector<std::string>> &texts, std::size_t rows);

} // namespace plumb
