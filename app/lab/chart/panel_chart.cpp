#include "app/lab/chart/panel_chart.h"

#include "app/lab/chart/chart_pen.h"

#include <algorithm>
#include <cmath>

namespace plumb {

using namespace chart_colour;

namespace {

struct Sheet {
    int columns = 1;
    int rows = 1;
    PixelBox area;
    glm::vec2 gap{14, 30};
    LogRange x_range, y_range;
    float zero_strip = 22; // its height, below the logarithmic scale

    [[nodiscard]] PixelBox panel(std::size_t index) const {
        const auto across = static_cast<std::size_t>(columns);
        const std::size_t column = index % across, row = index / across;
        const glm::vec2 count(static_cast<float>(columns), static_cast<float>(rows));
        const glm::vec2 size = (area.max - area.min - gap * (count - 1.0f)) / count;
        const glm::vec2 corner =
            area.min +
            glm::vec2(static_cast<float>(column), static_cast<float>(row)) * (size + gap);
        return {corner, corner + size};
    }
    [[nodiscard]] float x(const PixelBox &box, double value) const {
        return box.min.x +
               static_cast<float>(log_position(x_range, value)) * (box.max.x - box.min.x);
    }
    [[nodiscard]] float y(const PixelBox &box, double value) const {
        const float bottom = box.max.y - zero_strip;
        if (!(value > 0))
            return box.max.y - 0.5f * zero_strip;
        return bottom - static_cast<float>(log_position(y_range, value)) * (bottom - box.min.y);
    }
};

Sheet lay_out(const PanelChart &chart) {
    Sheet sheet;
    sheet.columns = static_cast<int>(
        std::clamp(std::ceil(std::sqrt(1.6 * static_cast<double>(chart.panels.size()))), 1.0, 5.0));
    sheet.rows =
        std::max(1, (static_cast<int>(chart.panels.size()) + sheet.columns - 1) / sheet.columns);
    sheet.area = {{86, 150}, {chart_style::size.x - 28, chart_style::size.y - 96}};
    std::vector<double> xs, ys{1};
    for (const Panel &panel : chart.panels)
        for (const PanelMark &mark : panel.marks) {
            xs.push_back(mark.x);
            ys.push_back(mark.y);
        }
    sheet.x_range = log_range(xs);
    sheet.y_range = log_range(ys);
    return sheet;
}

void draw_panel(ChartPen &pen, const PanelChart &chart, const Sheet &sheet, std::size_t index) {
    const Panel &panel = chart.panels[index];
    const PixelBox box = sheet.panel(index);
    const bool is_left = index % static_cast<std::size_t>(sheet.columns) == 0;
    const bool is_bottom = index + static_cast<std::size_t>(sheet.columns) >= chart.panels.size();
    const float strip = box.max.y - sheet.zero_strip;
    pen.fill(box, paper);
    pen.fill({{box.min.x, strip}, box.max}, fine_tint);
    for (const Tick &tick : log_ticks(sheet.x_range, chart.x_unit, 4)) {
        const float x = sheet.x(box, tick.value);
        if (tick.decade)
            pen.line({x, box.min.y}, {x, box.max.y}, strong_grid, 1);
        if (is_bottom && tick.decade)
            pen.text({x, box.max.y + 5}, tick.label, Face::footer, soft_ink, {0.5f, 0});
    }
    for (const Tick &tick : log_ticks(sheet.y_range, "1", 6)) {
        const float y = sheet.y(box, tick.value);
        if (tick.decade)
            pen.line({box.min.x, y}, {box.max.x, y}, strong_grid, 1);
        if (is_left && tick.decade)
            pen.text({box.min.x - 7, y}, tick.label, Face::footer, soft_ink, {1, 0.5f});
    }
    pen.line({box.min.x, strip}, {box.max.x, strip}, frame, 1);
    if (is_left)
        pen.text({box.min.x - 7, 0.5f * (strip + box.max.y)}, chart.zero_label, Face::footer,
                 soft_ink, {1, 0.5f});
    pen.outline(box, frame, 1);
    pen.text({box.min.x, box.min.y - 4},
             pen.fitted(panel.title, Face::label, box.max.x - box.min.x), Face::label, ink, {0, 1});

    std::vector<glm::vec2> points;
    for (const PanelMark &mark : panel.marks)
        points.emplace_back(sheet.x(box, mark.x), sheet.y(box, mark.y));
    pen.path(points, front, 2);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const std::size_t series = panel.marks[i].series;
        pen.mark(points[i], series, chart_style::mark_radius + 1.3f, paper);
        pen.mark(points[i], series, chart_style::mark_radius,
                 colour(series_colours[series % series_colours.size()]));
    }
}

} // namespace

void draw_panels(ChartPen &pen, const PanelChart &chart) {
    const float left = 40, right = chart_style::size.x - 28;
    pen.text({left, 26}, pen.fitted(chart.title, Face::title, right - left), Face::title, ink);
    pen.text({left, 62}, pen.fitted(chart.subtitle, Face::subtitle, right - left), Face::subtitle,
             soft_ink);
    float x = left;
    for (std::size_t i = 0; i < chart.series.size(); ++i) {
        pen.mark({x + 6, 100}, i, chart_style::mark_radius,
                 colour(series_colours[i % series_colours.size()]));
        pen.text({x + 20, 100}, chart.series[i], Face::axis, ink, {0, 0.5f});
        x += pen.text_size(chart.series[i], Face::axis).x + 52;
    }
    const Sheet sheet = lay_out(chart);
    for (std::size_t i = 0; i < chart.panels.size(); ++i)
        draw_panel(pen, chart, sheet, i);
    pen.text({left, sheet.area.min.y - 22}, chart.y_title, Face::label, soft_ink, {0, 1});
    pen.text({sheet.area.max.x, sheet.area.max.y + 22}, chart.x_title, Face::label, soft_ink,
             {1, 0});
    float y = sheet.area.max.y + 46;
    for (const std::string &text : chart.footer)
        for (const std::string &line : pen.wrapped(text, Face::footer, right - left)) {
            pen.text({left, y}, line, Face::footer, faint_ink);
            y += 16;
        }
}

} // namespace plumb
