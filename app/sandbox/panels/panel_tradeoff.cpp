// Cost against error of the running scene, by method. Clicking a point applies it.
#include "app/lab/chart/curve_style.h"
#include "app/lab/run/run_text.h"
#include "app/sandbox/panels/lab_draw.h"
#include "app/sandbox/panels/panel.h"
#include "app/sandbox/panels/plot_axis.h"
#include "app/sandbox/panels/widgets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include <imgui/imgui.h>
#include <imgui/imgui_stdlib.h>

namespace plumb {

namespace {

constexpr float least_height = 9;   // chart height including titles, in text heights
constexpr float mark_radius = 4.5f; // pixels at a scale of 1
constexpr float pointer_reach = 12; // picking distance, pixels at a scale of 1

Colour series_colour(const ChartSeries &series) {
    return curve_colour(series.style);
}

std::string without_raised(std::string label) {
    std::ranges::replace(label, raised_from, '^');
    return label;
}

bool is_shown(const ChartRun &run) {
    return run.status != ChartStatus::unfinished && run.cost > 0;
}

bool is_of(const ChartRun &run, const Simulation &running) {
    return run.resolved.method == &running.method() &&
           same_work(running.method(), run.resolved.settings, running.settings());
}

// The lab's chart, mapped into this window.
struct Placed {
    ChartContent content;
    ChartLayout layout;
    ImVec2 min, max;
    std::vector<std::size_t> runs; // the run of each mark

    [[nodiscard]] float x(float pixel) const {
        const PixelBox &from = layout.plot;
        return min.x + (pixel - from.min.x) / (from.max.x - from.min.x) * (max.x - min.x);
    }
    [[nodiscard]] float y(float pixel) const {
        const PixelBox &from = layout.plot;
        return min.y + (pixel - from.min.y) / (from.max.y - from.min.y) * (max.y - min.y);
    }
    [[nodiscard]] ImVec2 at(const glm::vec2 &pixel) const { return {x(pixel.x), y(pixel.y)}; }
};

Placed place(const SceneChart &chart) {
    Placed placed;
    placed.content = chart_content(chart, "");
    for (ChartMark &mark : placed.content.marks)
        mark.label.clear(); // shown by hovering instead
    placed.layout = lay_out(placed.content, [](std::string_view, float) { return glm::vec2(0); });
    for (std::size_t i = 0; i < chart.runs.size(); ++i)
        if (is_shown(chart.runs[i]))
            placed.runs.push_back(i);
    return placed;
}

void draw_axes(const PanelContext &context, const Placed &placed) {
    ImDrawList &list = *ImGui::GetWindowDrawList();
    const float em = context.fonts.small->FontSize;
    list.AddRectFilled(placed.min, placed.max, packed(theme::field, 0.6f), 3);
    if (placed.layout.limit_line)
        list.AddRectFilled({placed.min.x, placed.y(*placed.layout.limit_line)}, placed.max,
                           packed(theme::good, 0.13f));
    float free_from = placed.min.x - em;
    for (const PlacedTick &tick : placed.layout.cost_ticks) {
        const float x = std::round(placed.x(tick.pixel));
        list.AddLine({x, placed.min.y}, {x, placed.max.y},
                     packed(theme::line, tick.decade ? 1 : 0.6f));
        const std::string label = without_raised(tick.label);
        const float width = small_width(context.fonts, label);
        const float left = label_begin(x, width, placed.min.x, placed.max.x);
        if (label.empty() || left < free_from)
            continue;
        small_at(context.fonts, left, placed.max.y + 3, label);
        free_from = left + width + em;
    }
    float free_above = placed.max.y + em;
    std::vector<PlacedTick> up = placed.layout.error_ticks;
    std::ranges::sort(up, std::ranges::greater{}, &PlacedTick::pixel);
    const auto beside = [&](float y, const std::string &label) {
        small_at(context.fonts, placed.min.x - 5 - small_width(context.fonts, label),
                 label_begin(y, em, placed.min.y, placed.max.y), label);
    };
    if (placed.layout.zero_line) {
        beside(placed.y(*placed.layout.zero_line), "exactly 0");
        free_above = placed.y(*placed.layout.zero_line) - em;
    }
    for (const PlacedTick &tick : up) {
        const float y = std::round(placed.y(tick.pixel));
        list.AddLine({placed.min.x, y}, {placed.max.x, y},
                     packed(theme::line, tick.decade ? 1 : 0.6f));
        const bool under_failed =
            placed.layout.failed_line && y - em < placed.y(*placed.layout.failed_line) + em / 2;
        if (tick.label.empty() || y > free_above || under_failed)
            continue;
        beside(y, without_raised(tick.label));
        free_above = y - 1.3f * em;
    }
    if (placed.layout.failed_line)
        beside(placed.y(*placed.layout.failed_line), "failed");
    if (placed.layout.budget_line) {
        const float x = placed.x(*placed.layout.budget_line);
        list.AddLine({x, placed.min.y}, {x, placed.max.y}, packed(theme::dim), 1.5f);
    }
    if (placed.layout.limit_line)
        list.AddLine({placed.min.x, placed.y(*placed.layout.limit_line)},
                     {placed.max.x, placed.y(*placed.layout.limit_line)}, packed(theme::good),
                     1.5f);
}

glm::vec2 pixel(const ImVec2 &at) {
    return {at.x, at.y};
}

void draw_line(const ChartSeries &series, std::span<const glm::vec2> points, float opacity,
               float scale) {
    for (const LinePiece &piece : line_pieces(series.style, points, scale))
        ImGui::GetWindowDrawList()->AddLine({piece[0].x, piece[0].y}, {piece[1].x, piece[1].y},
                                            packed(series_colour(series), opacity), 1.5f);
}

void draw_mark(const ChartSeries &series, const ImVec2 &at, float radius, ImU32 colour) {
    std::vector<ImVec2> corners;
    for (const glm::vec2 &corner : mark_outline(series.style, pixel(at), radius))
        corners.emplace_back(corner.x, corner.y);
    ImGui::GetWindowDrawList()->AddConvexPolyFilled(corners.data(),
                                                    static_cast<int>(corners.size()), colour);
}

void draw_marks(const Placed &placed, const SceneChart &chart, const Simulation &running,
                float radius) {
    ImDrawList &list = *ImGui::GetWindowDrawList();
    for (const ChartSeries &series : placed.content.series)
        for (const auto &line : series.lines) {
            std::vector<glm::vec2> points;
            for (const std::size_t mark : line)
                points.push_back(pixel(placed.at(placed.layout.marks[mark])));
            draw_line(series, points, 0.55f, radius / mark_radius);
        }
    for (std::size_t i = 0; i < placed.content.marks.size(); ++i) {
        const ChartMark &mark = placed.content.marks[i];
        const ImVec2 at = placed.at(placed.layout.marks[i]);
        const ChartSeries &series = placed.content.series[mark.series];
        const ImU32 colour = packed(series_colour(series));
        if (mark.failed) {
            list.AddLine({at.x - radius, at.y - radius}, {at.x + radius, at.y + radius}, colour, 2);
            list.AddLine({at.x - radius, at.y + radius}, {at.x + radius, at.y - radius}, colour, 2);
        } else if (mark.outside) {
            draw_mark(series, at, radius + 0.5f, colour);
            draw_mark(series, at, radius - 1.6f, packed(theme::panel));
        } else {
            draw_mark(series, at, radius, colour);
        }
        if (mark.pareto)
            list.AddCircle(at, radius + 3, packed(theme::text), 0, 1.2f);
        if (is_of(chart.runs[placed.runs[i]], running))
            list.AddCircle(at, radius + 6, packed(theme::warning), 0, 2);
    }
}

// Method names beside their lines and marks, as many to a line as fit.
void legend(const PanelContext &context, const ChartContent &content) {
    const float em = context.fonts.small->FontSize;
    const float right = ImGui::GetCursorScreenPos().x + ImGui::GetContentRegionAvail().x;
    ImGui::PushFont(context.fonts.small);
    const float sample = 2.2f * em;
    bool first = true;
    for (const ChartSeries &series : content.series) {
        const float width = sample + 0.25f * em + ImGui::CalcTextSize(series.name.c_str()).x;
        if (!first && ImGui::GetItemRectMax().x + em + width < right)
            ImGui::SameLine(0, em);
        first = false;
        const ImVec2 at = ImGui::GetCursorScreenPos();
        const float y = at.y + 0.5f * em;
        draw_line(series, std::array{glm::vec2(at.x, y), glm::vec2(at.x + sample, y)}, 0.8f,
                  em / 13);
        draw_mark(series, {at.x + 0.5f * sample, y}, 0.32f * em, packed(series_colour(series)));
        ImGui::Dummy({sample, em});
        ImGui::SameLine(0, 0.25f * em);
        ImGui::TextUnformatted(series.name.c_str());
    }
    ImGui::PopFont();
}

void tell(const SceneChart &chart, const ChartRun &run) {
    ImGui::BeginTooltip();
    ImGui::TextUnformatted(std::string(run.resolved.method->title).c_str());
    ImGui::TextDisabled("%s", run_text(run.resolved).c_str());
    ImGui::Text("%s CPU time per simulated second", duration(run.cost).c_str());
    const std::string unit = chart.measure.unit == "1" ? "" : chart.measure.unit;
    if (!run.failure.empty())
        ImGui::TextColored(theme::error, "%s", run.failure.c_str());
    else
        ImGui::TextColored(run.status == ChartStatus::fine ? theme::good : theme::warning, "%s: %s",
                           chart.measure.title.c_str(), number(run.error, unit).c_str());
    if (run.worst && !run.run.divergence)
        ImGui::TextDisabled("worst: %s", run.run.outcomes[*run.worst].desc.name.c_str());
    ImGui::TextDisabled("Click to apply");
    ImGui::EndTooltip();
}

std::optional<std::size_t> pointed_at(const Placed &placed, float scale) {
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    std::optional<std::size_t> nearest;
    float least = pointer_reach * scale;
    for (std::size_t i = 0; i < placed.layout.marks.size(); ++i) {
        const ImVec2 at = placed.at(placed.layout.marks[i]);
        const float distance = std::hypot(at.x - mouse.x, at.y - mouse.y);
        if (distance < least) {
            least = distance;
            nearest = i;
        }
    }
    return nearest;
}

void draw_chart(PanelContext &context, const SceneChart &chart) {
    const float em = context.fonts.small->FontSize;
    const float scale = em / 13;
    Placed placed = place(chart);
    legend(context, placed.content);
    const ImVec2 room = ImGui::GetContentRegionAvail();
    const float height = std::max(room.y, least_height * ImGui::GetFontSize());
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::InvisibleButton("##chart", {room.x, height});
    float left = small_width(context.fonts, "exactly 0");
    for (const PlacedTick &tick : placed.layout.error_ticks)
        left = std::max(left, small_width(context.fonts, without_raised(tick.label)));
    // The titles have lines of their own above and below, so that they hide no mark.
    placed.min = {at.x + left + 8, at.y + em + 4};
    placed.max = {at.x + room.x - 2, at.y + height - 2 * em - 7};
    draw_axes(context, placed);
    small_at(context.fonts, placed.min.x, at.y, placed.content.error_title);
    const std::string &cost = placed.content.cost_title;
    small_at(context.fonts, placed.max.x - small_width(context.fonts, cost), placed.max.y + em + 5,
             cost);
    draw_marks(placed, chart, *context.session.simulation(), mark_radius * scale);
    if (!ImGui::IsItemHovered())
        return;
    if (const auto mark = pointed_at(placed, scale)) {
        const ChartRun &run = chart.runs[placed.runs[*mark]];
        tell(chart, run);
        if (ImGui::IsMouseClicked(ImGuiMouseButton_Left))
            context.run = choice_of(run);
    }
}

} // namespace

void tradeoff_tab(PanelContext &context) {
    ViewState &view = context.view;
    ChartStudy &study = context.chart;
    const float em = ImGui::GetFontSize();
    ImGui::SetNextItemWidth(0.55f * ImGui::GetContentRegionAvail().x);
    ImGui::InputTextWithHint("##sweeps", "substeps=1..16", &view.sweeps);
    tooltip("The settings to sweep, as for `plumb chart --sweep`: "
            "substeps=1..16 dt=1/240..1/60. Empty: substeps=1..16.");
    ImGui::SameLine();
    const bool running = study.running();
    if (study_button("Chart", running, 5 * em)) {
        view.sweep_mistake.clear();
        if (running)
            study.stop();
        else
            try {
                start_chart(study, context.session, view.sweeps);
            } catch (const std::exception &mistake) {
                view.sweep_mistake = mistake.what();
            }
    }
    const std::shared_ptr<const SceneChart> chart = context.frozen ? nullptr : study.result();
    ImGui::SameLine();
    const std::string failure = view.sweep_mistake.empty() ? study.failure() : view.sweep_mistake;
    const bool any = chart && std::ranges::any_of(chart->runs, is_shown);
    const bool is_on_it = any && std::ranges::any_of(chart->runs, [&](const ChartRun &run) {
                              return is_shown(run) && is_of(run, *context.session.simulation());
                          });
    study_state(context, running, study.done(), failure,
                !any       ? "What each method costs, against its error."
                : is_on_it ? ""
                           : "The present settings are not on the chart.");
    if (any)
        draw_chart(context, *chart);
}

} // namespace plumb
