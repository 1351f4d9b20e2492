#include "app/lab/chart/chart_drawing.h"

#include "app/lab/chart/chart_pen.h"

#include <algorithm>
#include <array>

namespace plumb {

using namespace chart_colour;

namespace {

constexpr float hollow_radius = chart_style::mark_radius - 2.4f;
constexpr float line_width = 1.8f;

ImU32 series_colour(const ChartSeries &series) {
    return colour(series_colours[series.style % series_colours.size()]);
}

void draw_grid(ChartPen &pen, const ChartContent &content, const ChartLayout &layout) {
    const PixelBox &plot = layout.plot;
    const PixelBox &field = layout.field;
    pen.fill(plot, paper);
    if (layout.corner && layout.corner->min.y < layout.corner->max.y)
        pen.fill(*layout.corner, fine_tint);
    if (layout.floor_line)
        pen.fill({{plot.min.x, *layout.floor_line}, {plot.max.x, plot.max.y}}, untold_tint);
    for (const bool decade : {false, true}) {
        for (const PlacedTick &tick : layout.cost_ticks)
            if (tick.decade == decade)
                pen.line({tick.pixel, plot.min.y}, {tick.pixel, plot.max.y},
                         decade ? strong_grid : weak_grid, 1);
        for (const PlacedTick &tick : layout.error_ticks)
            if (tick.decade == decade)
                pen.line({plot.min.x, tick.pixel}, {plot.max.x, tick.pixel},
                         decade ? strong_grid : weak_grid, 1);
    }
    for (const PlacedTick &tick : layout.cost_ticks)
        pen.text({tick.pixel, plot.max.y + 8}, tick.label, Face::axis, soft_ink, {0.5f, 0});
    for (const PlacedTick &tick : layout.error_ticks)
        pen.text({plot.min.x - 10, tick.pixel}, tick.label, Face::axis, soft_ink, {1, 0.5f});
    if (layout.failed_line) {
        pen.line({plot.min.x, field.min.y}, {plot.max.x, field.min.y}, frame, 1);
        pen.text({plot.min.x - 10, *layout.failed_line}, "failed", Face::axis, soft_ink, {1, 0.5f});
    }
    if (layout.zero_line) {
        pen.line({plot.min.x, field.max.y}, {plot.max.x, field.max.y}, frame, 1);
        pen.text({plot.min.x - 10, *layout.zero_line}, "exactly 0", Face::axis, soft_ink,
                 {1, 0.5f});
    }
    pen.outline(plot, frame, 1);
    pen.text({plot.min.x, plot.min.y - 10}, content.error_title, Face::axis, ink, {0, 1});
    pen.text({plot.max.x, plot.max.y + 30}, content.cost_title, Face::axis, ink, {1, 0});
}

// A cross with the series' mark inside, since there are fewer colours than methods.
void draw_failed(ChartPen &pen, glm::vec2 p, std::size_t style, ImU32 c) {
    constexpr float arm = chart_style::mark_radius + 1, small = 0.62f * chart_style::mark_radius;
    pen.cross(p, arm, paper, 5);
    pen.cross(p, arm, c, 2.2f);
    pen.mark(p, style, small + 1.2f, paper);
    pen.mark(p, style, small, c);
}

void draw_marks(ChartPen &pen, const ChartContent &content, const ChartLayout &layout) {
    using chart_style::mark_radius;
    const PixelBox &field = layout.field;
    if (layout.pareto_steps.size() > 1)
        pen.path(layout.pareto_steps, front, 7);
    if (layout.limit_line) {
        pen.dashed({field.min.x, *layout.limit_line}, {field.max.x, *layout.limit_line}, limit_ink,
                   1.5f, 8, 5);
        pen.text(layout.limit_text.min, content.limit_label, Face::label, limit_ink);
    }
    if (layout.floor_line) {
        pen.dashed({field.min.x, *layout.floor_line}, {field.max.x, *layout.floor_line}, soft_ink,
                   1.5f, 8, 5);
        pen.text(layout.floor_text.min, content.floor_label, Face::label, soft_ink);
    }
    if (layout.budget_line)
        pen.dashed({*layout.budget_line, layout.plot.min.y},
                   {*layout.budget_line, layout.plot.max.y}, budget_ink, 1.5f, 8, 5);
    if (!layout.budget_label.empty())
        pen.text(layout.budget_text.min, layout.budget_label, Face::label, budget_ink);
    for (const ChartSeries &series : content.series)
        for (const auto &line : series.lines) {
            std::vector<glm::vec2> points;
            const auto draw = [&] {
                pen.styled(series.style, points, series_colour(series), line_width);
                points.clear();
            };
            for (const std::size_t mark : line)
                // A line to a failed run would suggest an error that can be read off.
                if (content.marks[mark].failed)
                    draw();
                else
                    points.push_back(layout.marks[mark]);
            draw();
        }
    const auto x_of = [&](double cost) {
        return static_cast<float>(field.min.x + log_position(layout.cost_range, cost) *
                                                    (field.max.x - field.min.x));
    };
    for (std::size_t i = 0; i < content.marks.size(); ++i) {
        const ChartMark &mark = content.marks[i];
        const ImU32 c = series_colour(content.series[mark.series]);
        if (mark.cost_low > 0 && mark.cost_high > mark.cost_low) {
            const float y = layout.marks[i].y;
            const float left = std::max(x_of(mark.cost_low), field.min.x);
            const float right = std::min(x_of(mark.cost_high), field.max.x);
            pen.line({left, y}, {right, y}, c, 1);
        }
    }
    for (std::size_t i = 0; i < content.marks.size(); ++i) {
        const ChartMark &mark = content.marks[i];
        const ChartSeries &series = content.series[mark.series];
        const glm::vec2 p = layout.marks[i];
        if (mark.failed) {
            draw_failed(pen, p, series.style, series_colour(series));
            continue;
        }
        if (mark.pareto) {
            pen.mark(p, series.style, mark_radius + 4.5f, ink);
            pen.mark(p, series.style, mark_radius + 2.6f, paper);
        } else {
            pen.mark(p, series.style, mark_radius + 1.3f, paper);
        }
        pen.mark(p, series.style, mark_radius, series_colour(series));
        if (mark.outside)
            pen.mark(p, series.style, hollow_radius, paper);
    }
    for (const PlacedLabel &label : layout.labels)
        pen.text(label.box.min + glm::vec2(chart_style::label_margin, 0),
                 content.marks[label.mark].label, Face::label, ink);
}

// Splits a name too long for one row into two, after a comma.
std::vector<std::string> rows_of(const ChartPen &pen, const std::string &name, float width) {
    const auto fits = [&](std::size_t length) {
        return pen.text_size(name.substr(0, length), Face::axis).x <= width;
    };
    std::size_t split = std::string::npos;
    for (std::size_t comma = name.find(", "); comma != std::string::npos && fits(comma + 1);
         comma = name.find(", ", comma + 1))
        split = comma;
    if (fits(name.size()) || split == std::string::npos)
        return {pen.fitted(name, Face::axis, width)};
    return {name.substr(0, split + 1), pen.fitted(name.substr(split + 2), Face::axis, width)};
}

void draw_legend(ChartPen &pen, const ChartContent &content, const ChartLayout &layout) {
    using chart_style::mark_radius;
    constexpr float sample = 38; // a line long enough to show its dashes beside the mark
    const float left = layout.plot.max.x + 24, middle = left + 0.5f * sample;
    const float text_left = left + sample + 10;
    const float width = layout.size.x - 20 - text_left;
    float y = layout.plot.min.y + 10;
    // Down to the footer; many series are set closer to leave room for the rest.
    const float bottom = layout.plot.max.y + 54;
    const bool many = content.series.size() > 9;
    const float row = many ? chart_style::close_row : 26, entry_row = many ? 19 : 23;
    for (const ChartSeries &series : content.series) {
        const std::array line{glm::vec2(left, y), glm::vec2(left + sample, y)};
        pen.styled(series.style, line, series_colour(series), line_width);
        pen.mark({middle, y}, series.style, mark_radius + 1.3f, paper);
        pen.mark({middle, y}, series.style, mark_radius, series_colour(series));
        const std::vector<std::string> rows = rows_of(pen, series.name, width);
        for (const std::string &text : rows) {
            pen.text({text_left, y}, text, Face::axis, ink, {0, 0.5f});
            y += &text == &rows.back() ? row : chart_style::second_row;
        }
    }
    y += 12;
    const auto any = [&](auto is_such) {
        return std::any_of(content.marks.begin(), content.marks.end(), is_such);
    };
    const auto entry = [&](const std::string &text) {
        pen.text({text_left, y}, text, Face::label, soft_ink, {0, 0.5f});
        y += entry_row;
    };
    if (!layout.pareto_steps.empty()) {
        pen.line({left, y}, {left + sample, y}, front, 7);
        pen.mark({middle, y}, 0, mark_radius + 2.5f, ink);
        pen.mark({middle, y}, 0, mark_radius + 0.6f, paper);
        pen.mark({middle, y}, 0, mark_radius - 2, faint_ink);
        entry("Pareto front");
    }
    if (layout.failed_line) {
        draw_failed(pen, {middle, y}, 0, soft_ink);
        entry("diverged, or no result");
    }
    if (any([](const ChartMark &mark) { return mark.outside && !mark.failed; })) {
        pen.mark({middle, y}, 0, mark_radius, soft_ink);
        pen.mark({middle, y}, 0, hollow_radius, paper);
        entry("misses an expectation");
    }
    if (layout.corner) {
        pen.fill({{left, y - 7}, {left + sample, y + 7}}, fine_tint);
        pen.dashed({left, y - 7}, {left + sample, y - 7}, limit_ink, 1.5f, 6, 3);
        entry(content.budget ? "accurate enough, in budget" : "accurate enough");
    }
    if (!content.label_meaning.empty()) {
        // A sample label, from a run that has an error, if it is not too long.
        const auto mark = std::find_if(content.marks.begin(), content.marks.end(),
                                       [](const ChartMark &m) { return !m.failed; });
        if (mark != content.marks.end() && pen.text_size(mark->label, Face::label).x < 30)
            pen.text({middle, y}, mark->label, Face::label, ink, {0.5f, 0.5f});
        entry("label: " + content.label_meaning);
    }
    if (any([](const ChartMark &mark) { return mark.cost_high > mark.cost_low; })) {
        pen.line({left, y}, {left + sample, y}, faint_ink, 1);
        entry("spread of the timings");
    }
    struct List {
        std::string title;
        const std::vector<std::string> &texts;
    };
    // Lists that may be long come last.
    const std::array<List, 3> lists{{{"Worst expectation", content.worst},
                                     {"Failed", content.failures},
                                     {"Not on this chart", content.left_out}}};
    constexpr float gap = 12, title_row = 21, line_row = 16;
    // Every list gets at least its title, with a count if nothing is listed.
    float room = bottom + 0.5f * line_row - y;
    for (const List &list : lists)
        if (!list.texts.empty())
            room -= gap + title_row;
    for (const List &list : lists) {
        if (list.texts.empty())
            continue;
        std::vector<std::vector<std::string>> wrapped;
        for (const std::string &text : list.texts)
            wrapped.push_back(pen.wrapped(text, Face::footer, layout.size.x - 20 - left));
        const std::vector<std::string> lines =
            fitting_lines(wrapped, static_cast<std::size_t>(std::max(room, 0.0f) / line_row));
        y += gap;
        pen.text({left, y},
                 lines.empty() ? list.title + (": " + std::to_string(list.texts.size())) +
                                     ", named in the CSV file"
                               : list.title,
                 Face::label, soft_ink, {0, 0.5f});
        y += title_row;
        for (const std::string &line : lines) {
            pen.text({left, y}, line, Face::footer, faint_ink, {0, 0.5f});
            y += line_row;
        }
        room -= line_row * static_cast<float>(lines.size());
    }
}

} // namespace

void draw_chart(ChartPen &pen, const ChartContent &content) {
    const ChartLayout layout =
        lay_out(content, [&pen](std::string_view text, float size) -> glm::vec2 {
            // The layout only asks for our own sizes.
            return pen.text_size(text, size == chart_style::label_text ? Face::label : Face::axis);
        });
    const float left = 40, right = layout.size.x - 40;
    pen.text({left, 30}, pen.fitted(content.title, Face::title, right - left), Face::title, ink);
    pen.text({left, 66}, pen.fitted(content.subtitle, Face::subtitle, right - left), Face::subtitle,
             soft_ink);
    draw_grid(pen, content, layout);
    draw_marks(pen, content, layout);
    draw_legend(pen, content, layout);
    float y = layout.plot.max.y + 66;
    for (const std::string &text : content.footer)
        for (const std::string &line : pen.wrapped(text, Face::footer, right - left)) {
            if (y > layout.size.y - 16)
                return;
            pen.text({left, y}, pen.fitted(line, Face::footer, right - left), Face::footer,
                     faint_ink);
            y += 16;
        }
}

} // namespace plumb
