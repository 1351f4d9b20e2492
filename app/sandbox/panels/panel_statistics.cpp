// The cost of a step by phase, the energy over time, and the amount of work.
#include "app/sandbox/panels/panel.h"
#include "app/sandbox/panels/widgets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <imgui/imgui.h>

namespace plumb {

namespace {

struct Phase {
    const char *title;
    const Graph SessionGraphs::*graph;
    double StepTimes::*time;
    Colour colour;
};

constexpr std::array phases{
    Phase{
        "Find pairs", &SessionGraphs::find_pairs, &StepTimes::find_pairs, {0.42f, 0.68f, 0.90f, 1}},
    Phase{"Collide", &SessionGraphs::collide, &StepTimes::collide, {0.90f, 0.64f, 0.42f, 1}},
    Phase{"Advance", &SessionGraphs::advance, &StepTimes::advance, {0.50f, 0.76f, 0.58f, 1}},
    Phase{"Finish", &SessionGraphs::finish, &StepTimes::finish, {0.72f, 0.62f, 0.86f, 1}},
};

struct Plot {
    ImVec2 min, max;
    [[nodiscard]] float x(std::size_t i, std::size_t count) const {
        // The newest value is at the right border, however few there are.
        const auto behind = static_cast<float>(count - 1 - i);
        return max.x - behind * (max.x - min.x) / static_cast<float>(Graph::capacity - 1);
    }
    [[nodiscard]] float y(double fraction) const {
        return max.y - static_cast<float>(std::clamp(fraction, 0.0, 1.0)) * (max.y - min.y);
    }
};

Plot begin_plot(float height) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const ImVec2 size(ImGui::GetContentRegionAvail().x, height);
    ImGui::Dummy(size);
    const Plot plot{at, {at.x + size.x, at.y + size.y}};
    ImGui::GetWindowDrawList()->AddRectFilled(plot.min, plot.max, packed(theme::field, 0.6f), 3);
    return plot;
}

// Rounds up to 1, 2 or 5 times a power of ten, so that the scale rarely jumps.
double round_up(double value) {
    if (!(value > 0) || !std::isfinite(value))
        return 1;
    const double power = std::pow(10.0, std::floor(std::log10(value)));
    for (const double step : {1.0, 2.0, 5.0})
        if (value <= step * power)
            return step * power;
    return 10 * power;
}

void label(const Fonts &fonts, const Plot &plot, const std::string &text) {
    const float size = fonts.small->FontSize;
    const ImVec2 at(plot.min.x + 4, plot.min.y + 1);
    const float width = fonts.small->CalcTextSizeA(size, 1e9f, 0, text.c_str()).x;
    // A background keeps it legible over the graph.
    ImGui::GetWindowDrawList()->AddRectFilled({at.x - 2, at.y}, {at.x + width + 2, at.y + size},
                                              packed(theme::panel, 0.75f), 2);
    ImGui::GetWindowDrawList()->AddText(fonts.small, size, at, packed(theme::dim), text.c_str());
}

// Stacked, the first phase at the bottom.
void time_graph(const PanelContext &context, float height) {
    const SessionGraphs &graphs = context.session.graphs();
    const Plot plot = begin_plot(height);
    const std::size_t count = context.frozen ? 0 : graphs.advance.size();
    std::vector<double> totals(count);
    for (std::size_t i = 0; i < count; ++i)
        for (const Phase &phase : phases)
            totals[i] += (graphs.*phase.graph).at(i);
    // Scale to the 90th percentile: a few steps delayed by the machine run off the top, and the
    // others stay visible.
    double usual = 0;
    if (count > 0) {
        const auto at = totals.begin() + static_cast<std::ptrdiff_t>(count * 9 / 10);
        std::nth_element(totals.begin(), at, totals.end());
        usual = *at;
    }
    const double scale = round_up(1.25 * usual);
    ImDrawList &list = *ImGui::GetWindowDrawList();
    list.PushClipRect(plot.min, plot.max, true);
    // The antialiased edge of a phase too short to see would hide those below it.
    const ImDrawListFlags flags = list.Flags;
    list.Flags &= ~ImDrawListFlags_AntiAliasedFill;
    for (std::size_t i = 0; i + 1 < count; ++i) {
        double below_a = 0;
        double below_b = 0;
        for (const Phase &phase : phases) {
            const double above_a = below_a + (graphs.*phase.graph).at(i);
            const double above_b = below_b + (graphs.*phase.graph).at(i + 1);
            const float xa = plot.x(i, count);
            const float xb = plot.x(i + 1, count);
            list.AddQuadFilled({xa, plot.y(above_a / scale)}, {xb, plot.y(above_b / scale)},
                               {xb, plot.y(below_b / scale)}, {xa, plot.y(below_a / scale)},
                               packed(phase.colour));
            below_a = above_a;
            below_b = above_b;
        }
    }
    list.Flags = flags;
    list.PopClipRect();
    label(context.fonts, plot, usual > 0 ? duration(scale) : "-");
}

// "4.903 to 4.905 J"
std::string range_text(double low, double high) {
    if (low > high)
        return "-";
    // Enough digits to tell them apart.
    const double span = high - low;
    const double size = std::max(std::abs(low), std::abs(high));
    const int digits =
        size < 1e6 * span
            ? std::max(2 + static_cast<int>(std::ceil(std::log10(size / span + 1))), 4)
            : 9;
    const std::string from = number(low, {}, digits), to = number(high, {}, digits);
    return (from == to ? to : from + " to " + to) + " J";
}

void energy_graph(const PanelContext &context, float height) {
    const Graph &energy = context.session.graphs().energy;
    const std::size_t count = energy.size();
    double low = std::numeric_limits<double>::max();
    double high = std::numeric_limits<double>::lowest();
    for (std::size_t i = 0; i < count; ++i) {
        if (std::isfinite(energy.at(i))) {
            low = std::min(low, energy.at(i));
            high = std::max(high, energy.at(i));
        }
    }
    const Plot plot = begin_plot(height);
    small_text(context.fonts, range_text(low, high)); // below, clear of the curve
    if (low > high)
        return;
    // Changes from rounding alone are drawn flat, in the middle.
    const double middle = (low + high) / 2;
    const double span = std::max((high - low) * 1.1, std::max(std::abs(middle) * 1e-5, 1e-9));
    ImDrawList &list = *ImGui::GetWindowDrawList();
    list.PushClipRect(plot.min, plot.max, true);
    for (std::size_t i = 0; i + 1 < count; ++i) {
        if (!std::isfinite(energy.at(i)) || !std::isfinite(energy.at(i + 1)))
            continue;
        list.AddLine({plot.x(i, count), plot.y((energy.at(i) - middle) / span + 0.5)},
                     {plot.x(i + 1, count), plot.y((energy.at(i + 1) - middle) / span + 0.5)},
                     packed(theme::accent), 1.5f);
    }
    list.PopClipRect();
}

void legend(const PanelContext &context, const std::optional<StepTimes> &times) {
    // Two columns, or one if a name and its time would not fit into half the width.
    constexpr float least_column = 9; // in heights of its text
    const float width = ImGui::GetContentRegionAvail().x;
    const std::size_t columns = width / 2 < least_column * context.fonts.small->FontSize ? 1 : 2;
    const float column = width / static_cast<float>(columns);
    const float left = ImGui::GetCursorPosX();
    ImGui::PushFont(context.fonts.small);
    for (std::size_t i = 0; i < phases.size(); ++i) {
        const Phase &phase = phases[i];
        const bool is_first = i % columns == 0;
        const bool is_last = (i + 1) % columns == 0;
        const float start = left + (is_first ? 0.0f : column);
        if (!is_first)
            ImGui::SameLine();
        ImGui::SetCursorPosX(start);
        const ImVec2 at = ImGui::GetCursorScreenPos();
        const float side = ImGui::GetFontSize() * 0.6f;
        const float down = ImGui::GetFontSize() * 0.22f;
        ImGui::GetWindowDrawList()->AddRectFilled(
            {at.x, at.y + down}, {at.x + side, at.y + down + side}, packed(phase.colour), 2);
        ImGui::SetCursorPosX(start + side + 5);
        ImGui::TextUnformatted(phase.title);
        const std::string time = context.frozen || !times ? "-" : duration((*times).*phase.time);
        ImGui::SameLine();
        ImGui::SetCursorPosX(start + column - ImGui::CalcTextSize(time.c_str()).x -
                             (is_last ? 0.0f : 10.0f));
        ImGui::TextDisabled("%s", time.c_str());
    }
    ImGui::PopFont();
}

} // namespace

void diagnostics_panel(PanelContext &context) {
    if (!title_bar(context, PanelId::diagnostics, "Step time",
                   shortcut(Action::toggle_diagnostics)))
        return;
    const StepReport &report = context.session.simulation()->report();
    const float height = ImGui::GetFontSize() * 3.0f;
    time_graph(context, height);
    legend(context, context.session.times());
    ImGui::Spacing();
    heading(context.fonts, "Energy");
    energy_graph(context, height);
    ImGui::Spacing();
    const auto row = [&](const char *what, const std::string &counted, bool warns = false) {
        const bool known = context.session.times().has_value();
        value_row(what, known ? counted : "-", warns ? theme::warning : theme::text);
    };
    const std::ptrdiff_t asleep =
        std::ranges::count(context.session.present_bodies(), true, &BodyState::asleep);
    row("Moving bodies", std::to_string(report.moving_bodies) +
                             (asleep > 0 ? ", " + std::to_string(asleep) + " asleep" : ""));
    // What sleeps is not looked at, though it touches.
    const bool all_asleep = report.moving_bodies == 0 && asleep > 0;
    row("Pairs", all_asleep ? "asleep" : std::to_string(report.pairs));
    row("Contacts, points", all_asleep ? "asleep"
                                       : std::to_string(report.contacts) + ", " +
                                             std::to_string(report.contact_points));
    row("Joints", std::to_string(report.joints));
    const SoftParts &soft = context.session.simulation()->soft_parts();
    if (!soft.particles.empty()) {
        value_row("Particles", std::to_string(soft.particles.size()));
        row("Particle contacts", std::to_string(report.particle_contacts));
    }
    if (!soft.springs.empty()) {
        const std::size_t torn = soft.springs.size() - report.springs;
        row("Springs", std::to_string(report.springs) +
                           (torn > 0 ? ", " + std::to_string(torn) + " torn" : ""));
    }
    row("Impacts, unresolved",
        std::to_string(report.impacts) + ", " + std::to_string(report.unresolved_impacts),
        report.unresolved_impacts > 0);
    measures_panel(context);
}

} // namespace plumb
