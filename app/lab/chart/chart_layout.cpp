#include "app/lab/chart/chart_layout.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace plumb {

namespace {

// Height of the strips for failed runs and for zero error: a mark with a label above or below it.
constexpr float strip = 54;

// Length of the part of a segment inside a box (Liang and Barsky 1984).
float length_inside(const std::pair<glm::vec2, glm::vec2> &segment, const PixelBox &box) {
    const glm::vec2 d = segment.second - segment.first;
    float enter = 0, leave = 1;
    for (int axis = 0; axis < 2; ++axis) {
        if (d[axis] == 0) {
            if (segment.first[axis] < box.min[axis] || segment.first[axis] > box.max[axis])
                return 0;
            continue;
        }
        const float a = (box.min[axis] - segment.first[axis]) / d[axis];
        const float b = (box.max[axis] - segment.first[axis]) / d[axis];
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
    }
    return leave > enter ? (leave - enter) * std::hypot(d.x, d.y) : 0;
}

} // namespace

std::vector<PlacedLabel> place_labels(const std::vector<glm::vec2> &points,
                                      const std::vector<glm::vec2> &sizes,
                                      const std::vector<float> &radii,
                                      const std::vector<std::size_t> &order, const PixelBox &bounds,
                                      const std::vector<PixelBox> &obstacles,
                                      const std::vector<std::pair<glm::vec2, glm::vec2>> &lines) {
    // Directions in order of preference: above, to the right, below, to the left, then the corners.
    constexpr std::array<glm::vec2, 8> directions{
        glm::vec2{0, -1}, glm::vec2{1, 0}, glm::vec2{0, 1},   glm::vec2{-1, 0},
        glm::vec2{1, -1}, glm::vec2{1, 1}, glm::vec2{-1, -1}, glm::vec2{-1, 1}};
    constexpr std::array<float, 3> gaps{2, 7, 13};

    std::vector<PlacedLabel> placed;
    for (const std::size_t index : order) {
        const glm::vec2 half = sizes[index] * 0.5f;
        if (half.x <= 0)
            continue;
        float best_score = std::numeric_limits<float>::infinity();
        PixelBox best;
        for (std::size_t g = 0; g < gaps.size(); ++g)
            for (std::size_t k = 0; k < directions.size(); ++k) {
                const glm::vec2 direction = directions[k];
                const bool corner = direction.x != 0 && direction.y != 0;
                const float reach = radii[index] + gaps[g];
                // Diagonal labels sit closer, as the mark is round.
                const glm::vec2 offset =
                    direction * (half + glm::vec2(corner ? 0.75f * reach : reach));
                const glm::vec2 centre = points[index] + offset;
                const PixelBox box{centre - half, centre + half};
                if (!bounds.contains(box))
                    continue;
                const auto hits = [&](const PixelBox &other) { return box.overlaps(other); };
                bool blocked = std::any_of(obstacles.begin(), obstacles.end(), hits) ||
                               std::any_of(placed.begin(), placed.end(),
                                           [&](const PlacedLabel &p) { return hits(p.box); });
                for (std::size_t i = 0; i < points.size() && !blocked; ++i) {
                    const float r = corner && i == index ? 0.7f * radii[i] : radii[i];
                    blocked = hits({points[i] - r, points[i] + r});
                }
                if (blocked)
                    continue;
                float score = 1.5f * static_cast<float>(k) + 9 * static_cast<float>(g);
                for (const auto &line : lines)
                    score += length_inside(line, box);
                if (score < best_score) {
                    best_score = score;
                    best = box;
                }
            }
        if (std::isfinite(best_score))
            placed.push_back({index, best});
    }
    return placed;
}

std::vector<std::string> fitting_lines(const std::vector<std::vector<std::string>> &texts,
                                       std::size_t rows) {
    std::size_t all = 0;
    for (const std::vector<std::string> &text : texts)
        all += text.size();
    std::vector<std::string> lines;
    std::size_t shown = 0;
    for (; shown < texts.size() && rows > 0; ++shown) {
        if (all > rows && lines.size() + texts[shown].size() + 1 > rows)
            break; // the last row says how many more there are
        lines.insert(lines.end(), texts[shown].begin(), texts[shown].end());
    }
    if (shown > 0 && shown < texts.size())
        lines.push_back("and " + std::to_string(texts.size() - shown) +
                        " more, named in the CSV file");
    return lines;
}

glm::vec2 chart_size(const ChartContent &content) {
    using chart_style::close_row;
    constexpr std::size_t long_name = 30; // characters; longer names may take two rows
    constexpr float fits = 17 * close_row;
    float names = 0;
    for (const ChartSeries &series : content.series)
        names += close_row + (series.name.size() > long_name ? chart_style::second_row : 0);
    return chart_style::size + glm::vec2(0, std::max(names - fits, 0.0f));
}

ChartLayout lay_out(const ChartContent &content, const TextSize &text_size) {
    using namespace chart_style;
    ChartLayout layout;
    layout.size = chart_size(content);
    layout.plot = {plot.min, plot.max + (layout.size - size)};
    layout.field = layout.plot;

    std::vector<double> costs, errors;
    bool any_failed = false, any_zero = false;
    for (const ChartMark &mark : content.marks) {
        costs.push_back(mark.cost);
        any_failed = any_failed || mark.failed;
        if (!mark.failed) {
            errors.push_back(mark.error);
            any_zero = any_zero || mark.error == 0;
        }
    }
    if (content.limit && *content.limit > 0)
        errors.push_back(*content.limit);
    // Lines within the next decade or so are worth the room.
    constexpr double reach = 20;
    const bool floor_shows =
        content.floor && *content.floor > 0 &&
        std::ranges::any_of(errors, [&](double error) { return error < reach * *content.floor; });
    if (floor_shows)
        errors.push_back(*content.floor);
    const bool has_budget = content.budget && !costs.empty();
    bool budget_shows = false, budget_is_above = false;
    if (has_budget) {
        const auto [least, greatest] = std::minmax_element(costs.begin(), costs.end());
        budget_is_above = *content.budget > *greatest;
        budget_shows = *content.budget <= reach * *greatest && *content.budget * reach >= *least;
        if (budget_shows)
            costs.push_back(*content.budget);
    }
    layout.cost_range = log_range(costs);
    layout.error_range = log_range(errors);
    if (any_failed) {
        layout.failed_line = layout.plot.min.y + strip / 2;
        layout.field.min.y += strip;
    }
    const bool zero_is_the_limit = content.limit && *content.limit == 0;
    const bool any_above =
        std::any_of(errors.begin(), errors.end(), [](double e) { return e > 0; });
    if (any_zero || zero_is_the_limit) {
        layout.field.max.y =
            any_above || any_failed ? layout.plot.max.y - strip : layout.field.min.y;
        layout.zero_line = 0.5f * (layout.field.max.y + layout.plot.max.y);
    }

    const PixelBox &field = layout.field;
    const auto x_of = [&](double cost) {
        return static_cast<float>(field.min.x + log_position(layout.cost_range, cost) *
                                                    (field.max.x - field.min.x));
    };
    const auto y_of = [&](double error) {
        return static_cast<float>(field.max.y - log_position(layout.error_range, error) *
                                                    (field.max.y - field.min.y));
    };
    for (const Tick &tick : log_ticks(layout.cost_range, content.cost_unit, 9))
        layout.cost_ticks.push_back({x_of(tick.value), tick.decade, tick.label});
    if (any_above)
        for (const Tick &tick : log_ticks(layout.error_range, content.error_unit, 10))
            layout.error_ticks.push_back({y_of(tick.value), tick.decade, tick.label});

    for (const ChartMark &mark : content.marks) {
        const float x = x_of(mark.cost);
        layout.marks.emplace_back(x, mark.failed       ? *layout.failed_line
                                     : mark.error == 0 ? *layout.zero_line
                                                       : y_of(mark.error));
    }

    std::vector<PixelBox> obstacles;
    // The place with the fewest marks in the way (the first if tied), clear of earlier texts.
    const auto best_place = [&](const std::vector<PixelBox> &places) {
        const auto score = [&](const PixelBox &box) {
            float sum = layout.plot.contains(box) ? 0.0f : 1000.0f;
            for (const glm::vec2 &mark : layout.marks)
                sum += box.overlaps({mark - mark_radius - 2.0f, mark + mark_radius + 2.0f}) ? 10.0f
                                                                                            : 0.0f;
            for (const PixelBox &obstacle : obstacles)
                sum += box.overlaps(obstacle) ? 1000.0f : 0.0f;
            if (budget_shows && box.min.x < x_of(*content.budget) &&
                box.max.x > x_of(*content.budget))
                sum += 100;
            return sum;
        };
        const PixelBox best = *std::ranges::min_element(places, {}, score);
        obstacles.push_back(best);
        return best;
    };
    const auto box_at = [](float x, float y, glm::vec2 text) {
        return PixelBox{{x, y}, {x + text.x, y + text.y}};
    };
    if (content.limit) {
        layout.limit_line = zero_is_the_limit ? field.max.y : y_of(*content.limit);
        const glm::vec2 text = text_size(content.limit_label, label_text);
        const float left = field.min.x + 10, right = field.max.x - 10 - text.x;
        const float above = *layout.limit_line - 4 - text.y, below = *layout.limit_line + 4;
        std::vector<PixelBox> places;
        constexpr int columns = 24;
        // Try both ends first.
        for (const int column : {columns, 0}) {
            const float x = left + (right - left) * static_cast<float>(column) / columns;
            places.insert(places.end(), {box_at(x, above, text), box_at(x, below, text)});
        }
        for (int column = columns - 1; column > 0; --column) {
            const float x = left + (right - left) * static_cast<float>(column) / columns;
            places.insert(places.end(), {box_at(x, above, text), box_at(x, below, text)});
        }
        layout.limit_text = best_place(places);
    }
    if (floor_shows) {
        layout.floor_line = y_of(*content.floor);
        const glm::vec2 text = text_size(content.floor_label, label_text);
        const float left = field.min.x + 10, right = field.max.x - 10 - text.x;
        const float below = *layout.floor_line + 4;
        layout.floor_text = best_place({box_at(right, below, text), box_at(left, below, text)});
    }
    if (has_budget) {
        const std::string cost =
            content.budget_label + ": " + short_quantity(*content.budget, content.cost_unit);
        layout.budget_label = budget_shows ? cost : budget_is_above ? cost + " »" : "« " + cost;
        const glm::vec2 text = text_size(layout.budget_label, label_text);
        const float top = field.min.y + 6, bottom = field.max.y - 6 - text.y;
        if (budget_shows) {
            layout.budget_line = x_of(*content.budget);
            const float left = *layout.budget_line - 6 - text.x, right = *layout.budget_line + 6;
            layout.budget_text =
                best_place({box_at(left, bottom, text), box_at(left, top, text),
                            box_at(right, bottom, text), box_at(right, top, text)});
        } else {
            const float x = budget_is_above ? field.max.x - 8 - text.x : field.min.x + 8;
            layout.budget_text = best_place({box_at(x, bottom, text), box_at(x, top, text),
                                             box_at(x, 0.5f * (top + bottom), text)});
        }
    }
    if (layout.limit_line && (layout.budget_line || !has_budget || budget_is_above))
        layout.corner = {{layout.plot.min.x, *layout.limit_line},
                         {layout.budget_line.value_or(layout.plot.max.x), layout.plot.max.y}};

    // The front, cheapest first.
    std::vector<std::size_t> front;
    for (std::size_t i = 0; i < content.marks.size(); ++i)
        if (content.marks[i].pareto)
            front.push_back(i);
    std::sort(front.begin(), front.end(), [&](std::size_t a, std::size_t b) {
        return std::pair(layout.marks[a].x, a) < std::pair(layout.marks[b].x, b);
    });
    if (!front.empty()) {
        layout.pareto_steps.emplace_back(layout.marks[front.front()].x, field.min.y);
        for (std::size_t k = 0; k < front.size(); ++k) {
            if (k > 0)
                layout.pareto_steps.emplace_back(layout.marks[front[k]].x,
                                                 layout.marks[front[k - 1]].y);
            layout.pareto_steps.push_back(layout.marks[front[k]]);
        }
        layout.pareto_steps.emplace_back(field.max.x, layout.marks[front.back()].y);
    }

    // Labels: the front first, then the ends of each line, then the rest.
    std::vector<int> rank(content.marks.size(), 2);
    std::vector<std::pair<glm::vec2, glm::vec2>> lines;
    for (const ChartSeries &series : content.series)
        for (const auto &line : series.lines) {
            if (line.empty())
                continue;
            rank[line.front()] = rank[line.back()] = 1;
            for (std::size_t k = 1; k < line.size(); ++k)
                lines.emplace_back(layout.marks[line[k - 1]], layout.marks[line[k]]);
        }
    if (layout.limit_line)
        lines.emplace_back(glm::vec2(field.min.x, *layout.limit_line),
                           glm::vec2(field.max.x, *layout.limit_line));
    if (layout.floor_line)
        lines.emplace_back(glm::vec2(field.min.x, *layout.floor_line),
                           glm::vec2(field.max.x, *layout.floor_line));
    if (layout.budget_line)
        lines.emplace_back(glm::vec2(*layout.budget_line, field.min.y),
                           glm::vec2(*layout.budget_line, layout.plot.max.y));
    std::vector<std::size_t> order(content.marks.size());
    std::vector<glm::vec2> sizes;
    std::vector<float> radii;
    for (std::size_t i = 0; i < content.marks.size(); ++i) {
        order[i] = i;
        if (content.marks[i].pareto)
            rank[i] = 0;
        radii.push_back(content.marks[i].pareto ? front_radius : mark_radius + 1);
        if (content.marks[i].cost_high > content.marks[i].cost_low && content.marks[i].cost_low > 0)
            lines.emplace_back(glm::vec2(x_of(content.marks[i].cost_low), layout.marks[i].y),
                               glm::vec2(x_of(content.marks[i].cost_high), layout.marks[i].y));
        sizes.push_back(content.marks[i].label.empty()
                            ? glm::vec2(0)
                            : text_size(content.marks[i].label, label_text) +
                                  glm::vec2(2 * label_margin, 0));
    }
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return rank[a] < rank[b]; });
    for (const std::optional<float> &border :
         {layout.failed_line ? std::optional(field.min.y) : std::nullopt,
          layout.zero_line ? std::optional(field.max.y) : std::nullopt})
        if (border)
            obstacles.push_back(
                {{layout.plot.min.x, *border - 1}, {layout.plot.max.x, *border + 1}});
    layout.labels = place_labels(layout.marks, sizes, radii, order, layout.plot, obstacles, lines);
    return layout;
}

} // namespace plumb
