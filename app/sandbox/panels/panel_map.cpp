// Where the running method is stable on the running scene, over two numbers. Clicking a cell
// applies it.
#include "app/lab/run/run_text.h"
#include "app/sandbox/panels/lab_draw.h"
#include "app/sandbox/panels/panel.h"
#include "app/sandbox/panels/plot_axis.h"
#include "app/sandbox/panels/widgets.h"

#include <algorithm>
#include <cmath>

#include <imgui/imgui.h>
#include <imgui/imgui_stdlib.h>

namespace plumb {

namespace {

constexpr float least_map_height = 7; // in text heights

Colour colour_of(Failing failing) {
    return colour_of_code(info_of(failing).colour);
}

struct Grid {
    const StabilityMap &map;
    ImVec2 min, max;

    [[nodiscard]] std::size_t columns() const { return map.x.values.size(); }
    [[nodiscard]] std::size_t rows() const { return map.y.values.size(); }
    // The lowest row is at the bottom.
    [[nodiscard]] ImVec2 corner(std::size_t column, std::size_t row) const {
        return {min.x +
                    (max.x - min.x) * static_cast<float>(column) / static_cast<float>(columns()),
                max.y - (max.y - min.y) * static_cast<float>(row) / static_cast<float>(rows())};
    }
    // Pixel position of a place given in cells, see cell_position.
    [[nodiscard]] ImVec2 at(double x, double y) const {
        const ImVec2 cell = corner(1, 1);
        return {min.x + (static_cast<float>(x) + 0.5f) * (cell.x - min.x),
                max.y + (static_cast<float>(y) + 0.5f) * (cell.y - max.y)};
    }
};

// Black or white, whichever reads better on `ground`.
ImU32 ink_on(const Colour &ground) {
    const float light = 0.3f * ground.red + 0.6f * ground.green + 0.1f * ground.blue;
    return light > 0.45f ? IM_COL32(20, 22, 26, 255) : IM_COL32(235, 238, 242, 255);
}

void draw_cells(const PanelContext &context, const Grid &grid) {
    ImDrawList &list = *ImGui::GetWindowDrawList();
    const float em = context.fonts.small->FontSize;
    const MethodMap &of_method = grid.map.methods.front();
    for (std::size_t row = 0; row < grid.rows(); ++row)
        for (std::size_t column = 0; column < grid.columns(); ++column) {
            const ImVec2 low = grid.corner(column, row), high = grid.corner(column + 1, row + 1);
            const ImVec2 top_left(low.x + 1, high.y + 1), bottom_right(high.x - 1, low.y - 1);
            const std::optional<MapRun> &cell = grid.map.cell(of_method, column, row);
            if (!cell) {
                list.AddRectFilled(top_left, bottom_right, packed(theme::field, 0.6f));
                continue;
            }
            const Failing failing = cell->failing.failing;
            const Colour ground = colour_of(failing);
            list.AddRectFilled(top_left, bottom_right, packed(ground));
            if (failing == Failing::none || high.x - low.x < 1.4f * em || low.y - high.y < em + 2)
                continue;
            const std::string letter(1, info_of(failing).letter);
            list.AddText(context.fonts.small, em,
                         {std::round((low.x + high.x - small_width(context.fonts, letter)) / 2),
                          std::round((low.y + high.y - em) / 2)},
                         ink_on(ground), letter.c_str());
        }
    for (const MapLimit &limit : of_method.limits) {
        const double x = between(grid.map.x, limit.low, limit.high);
        const ImVec2 at = grid.at(cell_position(grid.map.x, x), cell_position(grid.map.y, limit.y));
        list.AddCircleFilled(at, 0.34f * em, packed(theme::panel));
        list.AddCircleFilled(at, 0.24f * em, packed(theme::text));
    }
}

// Marks the current settings, if they lie within the map.
void draw_running(const Grid &grid, const Simulation &simulation) {
    const auto place = [&](const MapAxis &axis) -> std::optional<double> {
        if (!axis.setting)
            return {};
        const double value = setting_value(simulation.settings(), *axis.setting);
        if (axis.logarithmic && !(value > 0))
            return {};
        const double cell = cell_position(axis, value);
        const bool inside = cell >= -0.5 && cell <= static_cast<double>(axis.values.size()) - 0.5;
        return inside ? std::optional(cell) : std::nullopt;
    };
    const auto x = place(grid.map.x), y = place(grid.map.y);
    if (!x || !y || grid.map.methods.front().method != &simulation.method())
        return;
    const ImVec2 at = grid.at(*x, *y);
    ImGui::GetWindowDrawList()->AddCircle(at, 7, IM_COL32(20, 22, 26, 255), 0, 4);
    ImGui::GetWindowDrawList()->AddCircle(at, 7, packed(theme::warning), 0, 2);
}

void draw_numbers(const PanelContext &context, const Grid &grid) {
    const float em = context.fonts.small->FontSize;
    float free_from = grid.min.x - em;
    for (std::size_t i = 0; i < grid.columns(); ++i) {
        const std::string label = value_label(grid.map.x, grid.map.x.values[i]);
        const float width = small_width(context.fonts, label);
        const float left =
            label_begin(grid.at(static_cast<double>(i), 0).x, width, grid.min.x, grid.max.x);
        if (left < free_from)
            continue;
        small_at(context.fonts, left, grid.max.y + 3, label);
        free_from = left + width + 0.7f * em;
    }
    float free_above = grid.max.y + em;
    for (std::size_t i = 0; i < grid.rows(); ++i) {
        const std::string label = value_label(grid.map.y, grid.map.y.values[i]);
        const float y = grid.at(0, static_cast<double>(i)).y;
        if (y > free_above)
            continue;
        small_at(context.fonts, grid.min.x - 5 - small_width(context.fonts, label),
                 label_begin(y, em, grid.min.y, grid.max.y), label);
        free_above = y - 1.1f * em;
    }
}

// Lists only the outcomes that occur, and what was not judged.
void legend(const PanelContext &context, const StabilityMap &map) {
    const float em = context.fonts.small->FontSize;
    const float right = ImGui::GetCursorScreenPos().x + ImGui::GetContentRegionAvail().x;
    ImGui::PushFont(context.fonts.small);
    ImGui::TextDisabled("%s; x: %s; y: %s", std::string(map.methods.front().method->title).c_str(),
                        axis_title(map.x).c_str(), axis_title(map.y).c_str());
    for (const FailingInfo &info : failings()) {
        const bool is_there =
            std::ranges::any_of(map.methods.front().cells, [&](const std::optional<MapRun> &cell) {
                return cell && cell->failing.failing == info.failing;
            });
        if (!is_there)
            continue;
        const std::string name(info.name);
        if (ImGui::GetItemRectMax().x + 3 * em + ImGui::CalcTextSize(name.c_str()).x < right)
            ImGui::SameLine(0, em);
        const ImVec2 at = ImGui::GetCursorScreenPos();
        ImGui::GetWindowDrawList()->AddRectFilled({at.x, at.y + 0.15f * em},
                                                  {at.x + 0.7f * em, at.y + 0.85f * em},
                                                  packed(colour_of(info.failing)), 2);
        ImGui::Dummy({0.75f * em, em});
        ImGui::SameLine(0, 0.25f * em);
        ImGui::TextUnformatted(name.c_str());
    }
    for (const std::string &what : map.unjudged)
        ImGui::TextWrapped("%s", what.c_str());
    ImGui::PopFont();
}

void tell(const StabilityMap &map, double x, double y, const std::optional<MapRun> &cell) {
    ImGui::BeginTooltip();
    ImGui::Text("%s %s, %s %s", map.x.name.c_str(), value_label(map.x, x).c_str(),
                map.y.name.c_str(), value_label(map.y, y).c_str());
    if (!cell) {
        ImGui::TextDisabled("not run yet");
    } else {
        const FailingInfo &info = info_of(cell->failing.failing);
        const bool held = cell->failing.failing == Failing::none;
        ImGui::TextColored(held ? theme::good : theme::warning, "%s",
                           std::string(info.name).c_str());
        if (!cell->failing.what.empty()) {
            ImGui::SameLine();
            ImGui::TextDisabled("%s", cell->failing.what.c_str());
        }
        ImGui::TextDisabled("penetration %s, joint drift %s",
                            number(cell->max_penetration, "m").c_str(),
                            number(cell->max_joint_drift, "m").c_str());
    }
    ImGui::TextDisabled(map.x.setting && map.y.setting ? "Click to apply"
                                                       : "Click to restart with it");
    ImGui::EndTooltip();
}

void draw_map(PanelContext &context, const MethodStudy &study) {
    const StabilityMap &map = study.map;
    const float em = context.fonts.small->FontSize;
    legend(context, map);
    const ImVec2 room = ImGui::GetContentRegionAvail();
    const float height = std::max(room.y, least_map_height * ImGui::GetFontSize());
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::InvisibleButton("##map", {room.x, height});
    float left = 0;
    for (const double value : map.y.values)
        left = std::max(left, small_width(context.fonts, value_label(map.y, value)));
    const Grid grid{map, {at.x + left + 8, at.y}, {at.x + room.x, at.y + height - em - 5}};
    draw_cells(context, grid);
    draw_numbers(context, grid);
    draw_running(grid, *context.session.simulation());
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    if (!ImGui::IsItemHovered() || mouse.x < grid.min.x || mouse.x >= grid.max.x ||
        mouse.y < grid.min.y || mouse.y >= grid.max.y)
        return;
    const auto column = static_cast<std::size_t>(
        (mouse.x - grid.min.x) / (grid.max.x - grid.min.x) * static_cast<float>(grid.columns()));
    const auto row = static_cast<std::size_t>((grid.max.y - mouse.y) / (grid.max.y - grid.min.y) *
                                              static_cast<float>(grid.rows()));
    if (column >= grid.columns() || row >= grid.rows())
        return;
    const double x = map.x.values[column], y = map.y.values[row];
    tell(map, x, y, map.cell(map.methods.front(), column, row));
    if (!ImGui::IsMouseClicked(ImGuiMouseButton_Left))
        return;
    context.run = choice_of(study, x, y);
}

void axis_field(const char *id, const char *before, std::string &text, float width) {
    ImGui::AlignTextToFramePadding();
    ImGui::TextDisabled("%s", before);
    ImGui::SameLine();
    ImGui::SetNextItemWidth(width);
    ImGui::InputText(id, &text);
    tooltip("A setting, any number in the scene file or a name such as speed, and its values, as "
            "for `plumb map`: "
            "dt=1/240..1/15:8log, substeps=1,2,4, body.ball.velocity.x=1..20:6.");
    ImGui::SameLine();
}

} // namespace

void map_tab(PanelContext &context) {
    ViewState &view = context.view;
    MapStudy &study = context.map;
    const float em = ImGui::GetFontSize();
    const float field = std::max((ImGui::GetContentRegionAvail().x - 11.5f * em) / 2, 4.0f * em);
    axis_field("##x", "x", view.map_x, field);
    axis_field("##y", "y", view.map_y, field);
    const bool running = study.running();
    if (study_button("Map", running, 4 * em)) {
        view.map_mistake.clear();
        if (running)
            study.stop();
        else
            try {
                start_map(study, context.session, view.map_x, view.map_y);
            } catch (const std::exception &mistake) {
                view.map_mistake = mistake.what();
            }
    }
    const std::shared_ptr<const MethodStudy> map = context.frozen ? nullptr : study.result();
    const std::string failure = view.map_mistake.empty() ? study.failure() : view.map_mistake;
    if (running)
        ImGui::SameLine();
    if (running || !failure.empty() || !map)
        study_state(context, running, study.done(), failure,
                    "Where the method holds the scene and why it fails, over two parameters.");
    if (map)
        draw_map(context, *map);
}

} // namespace plumb
