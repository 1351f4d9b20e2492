#include "app/sandbox/panels/plot_draw.h"

#include "app/sandbox/panels/lab_draw.h"
#include "app/sandbox/panels/plot_axis.h"
#include "app/sandbox/panels/widgets.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <imgui/imgui.h>

namespace plumb {

namespace {

struct Span {
    double from = 0, to = 0; // s
};

Span shown_time(const Session &session, const std::optional<double> &seconds) {
    Span span{std::numeric_limits<double>::max(), session.simulation()->time()};
    for (const PlotCurve &curve : session.plots().curves())
        if (!curve.samples.empty())
            span.from = std::min(span.from, curve.samples.front().time);
    span.from = std::min(span.from, span.to);
    if (seconds)
        span.from = std::max(span.from, span.to - *seconds);
    return span;
}

// The first sample to draw: the one before the span, so that a line leads in.
std::size_t first_in(const PlotCurve &curve, const Span &span) {
    const auto first = std::ranges::lower_bound(curve.samples, span.from, {}, &PlotSample::time);
    const auto index = static_cast<std::size_t>(first - curve.samples.begin());
    return index > 0 ? index - 1 : 0;
}

// Curves of one unit, by index.
struct Group {
    std::string_view unit;
    std::vector<std::size_t> curves;
    PlotAxis axis;
    ImVec2 min, max;
};

std::vector<Group> groups_of(std::span<const PlotCurve> curves) {
    std::vector<Group> groups;
    for (std::size_t i = 0; i < curves.size(); ++i) {
        const std::string_view unit = curves[i].quantity->unit;
        auto group = std::ranges::find(groups, unit, &Group::unit);
        if (group == groups.end())
            group = groups.insert(groups.end(), {unit, {}, {}, {}, {}});
        group->curves.push_back(i);
    }
    return groups;
}

PlotAxis value_axis(const Group &group, std::span<const PlotCurve> curves, const Span &span,
                    int most) {
    double low = std::numeric_limits<double>::max();
    double high = std::numeric_limits<double>::lowest();
    for (const std::size_t i : group.curves)
        for (std::size_t k = first_in(curves[i], span); k < curves[i].samples.size(); ++k) {
            const double value = curves[i].samples[k].value;
            if (std::isfinite(value)) {
                low = std::min(low, value);
                high = std::max(high, value);
            }
        }
    return low <= high ? plot_axis(low, high, most) : plot_axis(0, 0, most);
}

float x_of(const Group &group, const PlotAxis &time, double seconds) {
    return group.min.x + static_cast<float>(time.fraction(seconds)) * (group.max.x - group.min.x);
}

float y_of(const Group &group, double value) {
    return group.max.y -
           static_cast<float>(group.axis.fraction(value)) * (group.max.y - group.min.y);
}

// Of the samples in one pixel column, only the first, least, greatest and last are drawn: that
// looks the same as drawing all.
void draw_curve(const Group &group, const PlotCurve &curve, const PlotAxis &time, const Span &span,
                const Colour &colour) {
    std::vector<ImVec2> line;
    const auto draw = [&] {
        ImDrawList &list = *ImGui::GetWindowDrawList();
        if (line.size() == 1)
            list.AddCircleFilled(line.front(), 2, packed(colour));
        else if (!line.empty())
            list.AddPolyline(line.data(), static_cast<int>(line.size()), packed(colour), 0, 1.5f);
        line.clear();
    };
    struct Column {
        ImVec2 first, low, high, last;
    };
    std::optional<Column> column;
    const auto close = [&] {
        if (!column)
            return;
        // In order of time, and each point once: a polyline that turns on the spot gets the wrong
        // thickness.
        const bool rises = column->low.x < column->high.x;
        for (const ImVec2 &point : {column->first, rises ? column->low : column->high,
                                    rises ? column->high : column->low, column->last})
            if (line.empty() || point.x != line.back().x || point.y != line.back().y)
                line.push_back(point);
        column.reset();
    };
    for (std::size_t k = first_in(curve, span); k < curve.samples.size(); ++k) {
        const PlotSample &sample = curve.samples[k];
        if (!std::isfinite(sample.value)) {
            close();
            draw();
            continue;
        }
        const ImVec2 at(x_of(group, time, sample.time), y_of(group, sample.value));
        if (column && at.x - column->first.x < 1) {
            if (at.y < column->low.y)
                column->low = at;
            if (at.y > column->high.y)
                column->high = at;
            column->last = at;
        } else {
            close();
            column = Column{at, at, at, at};
        }
    }
    close();
    draw();
}

void draw_grid(const PanelContext &context, const Group &group, const PlotAxis &time,
               bool labels_time) {
    ImDrawList &list = *ImGui::GetWindowDrawList();
    const float size = context.fonts.small->FontSize;
    list.AddRectFilled(group.min, group.max, packed(theme::field, 0.6f), 3);
    const ImU32 grid = packed(theme::line);
    for (const PlotTick &tick : group.axis.ticks) {
        const float y = std::round(y_of(group, tick.value));
        list.AddLine({group.min.x, y}, {group.max.x, y},
                     tick.value == 0 ? packed(theme::dim, 0.7f) : grid);
        small_at(context.fonts, group.min.x - 5 - small_width(context.fonts, tick.label),
                 label_begin(y, size, group.min.y, group.max.y), tick.label);
    }
    float free_from = std::numeric_limits<float>::lowest();
    for (const PlotTick &tick : time.ticks) {
        const float x = std::round(x_of(group, time, tick.value));
        list.AddLine({x, group.min.y}, {x, group.max.y}, grid);
        const std::string text = tick.label + " s";
        const float width = small_width(context.fonts, text);
        const float left = label_begin(x, width, group.min.x, group.max.x);
        if (!labels_time || left < free_from)
            continue;
        small_at(context.fonts, left, group.max.y + 3, text);
        free_from = left + width + size;
    }
}

// A line at the pointer, with each curve's value at that time.
void tell_at_pointer(const PanelContext &context, const std::vector<Group> &groups,
                     const PlotAxis &time) {
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const Group &first = groups.front();
    if (!ImGui::IsWindowHovered(ImGuiHoveredFlags_ChildWindows) || mouse.x < first.min.x ||
        mouse.x > first.max.x || mouse.y < first.min.y || mouse.y > groups.back().max.y)
        return;
    const double share = (mouse.x - first.min.x) / (first.max.x - first.min.x);
    const double seconds = time.low + share * (time.high - time.low);
    for (const Group &group : groups)
        ImGui::GetWindowDrawList()->AddLine({mouse.x, group.min.y}, {mouse.x, group.max.y},
                                            packed(theme::text, 0.5f));
    ImGui::BeginTooltip();
    std::optional<double> told;
    const auto curves = context.session.plots().curves();
    for (std::size_t i = 0; i < curves.size(); ++i) {
        const auto &samples = curves[i].samples;
        auto sample = std::ranges::lower_bound(samples, seconds, {}, &PlotSample::time);
        if (sample != samples.begin() &&
            (sample == samples.end() || seconds - std::prev(sample)->time < sample->time - seconds))
            --sample;
        if (sample == samples.end())
            continue;
        if (!told) {
            told = sample->time;
            ImGui::TextDisabled("%s, step %llu", number(*told, "s", 6).c_str(),
                                static_cast<unsigned long long>(sample->step));
        }
        ImGui::TextColored(curve_colour(i), "%s", title_of(curves[i].name).c_str());
        ImGui::SameLine();
        ImGui::TextUnformatted(number(sample->value, shown_unit(*curves[i].quantity), 6).c_str());
    }
    ImGui::EndTooltip();
}

} // namespace

std::size_t plot_count(const Plots &plots) {
    return groups_of(plots.curves()).size();
}

std::string_view shown_unit(const QuantityInfo &quantity) {
    return quantity.unit == "1" ? std::string_view() : quantity.unit;
}

void draw_plots(const PanelContext &context, ImVec2 size) {
    const auto curves = context.session.plots().curves();
    const float em = context.fonts.small->FontSize;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::Dummy(size);
    std::vector<Group> groups = groups_of(curves);
    const Span span = shown_time(context.session, context.view.plot_seconds);
    const float below = em + 5; // room for the time labels
    const float gap = std::round(0.6f * em);
    const auto count = static_cast<float>(groups.size());
    const float height = std::floor((size.y - below - gap * (count - 1)) / count);
    float widest = 0;
    for (Group &group : groups) {
        group.axis =
            value_axis(group, curves, span, std::clamp(static_cast<int>(height / (2 * em)), 2, 7));
        for (PlotTick &tick : group.axis.ticks) {
            if (group.unit != "1")
                tick.label.append(" ").append(group.unit);
            widest = std::max(widest, small_width(context.fonts, tick.label));
        }
    }
    float y = at.y;
    for (Group &group : groups) {
        group.min = {std::round(at.x + widest + 7), y};
        group.max = {at.x + size.x, y + height};
        y += height + gap;
    }
    const float width = groups.front().max.x - groups.front().min.x;
    const PlotAxis time =
        tight_axis(span.from, span.to, std::clamp(static_cast<int>(width / (6 * em)), 2, 11));
    ImDrawList &list = *ImGui::GetWindowDrawList();
    for (const Group &group : groups) {
        draw_grid(context, group, time, &group == &groups.back());
        list.PushClipRect(group.min, group.max, true);
        for (const std::size_t i : group.curves)
            draw_curve(group, curves[i], time, span, curve_colour(i));
        list.PopClipRect();
    }
    tell_at_pointer(context, groups, time);
}

} // namespace plumb
