#include "app/sandbox/panels/layout.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace plumb {

namespace {

// Pixels at a scale of 1.
constexpr float margin = 8;
constexpr float transport_width = 520;
constexpr float least_transport_width = 380;
constexpr glm::vec2 roomy{860, 600};
// Of the height above the bar; more where it ends the columns.
constexpr float lab_share = 0.5f;
constexpr float spanning_lab_share = 0.65f;

// Below this share of the window's height a picture is useless.
constexpr float least_picture = 0.2f;

// Stacks panels one below the other. If they do not fit, the tallest are cut to a common height.
void stack(PerPanel<Rect> &rects, const PerPanel<float> &wished, PanelSpot side, const Rect &column,
           float gap) {
    std::vector<PanelId> panels;
    std::vector<float> heights;
    for (const PanelRow &row : panel_rows) {
        if (row.spot != side || !(wished[row.id] > 0))
            continue;
        panels.push_back(row.id);
        heights.push_back(std::ceil(wished[row.id]));
    }
    if (heights.empty())
        return;
    std::ranges::sort(heights);
    float room = column.size.y - gap * static_cast<float>(heights.size() - 1);
    float most = heights.back();
    for (std::size_t i = 0; i < heights.size(); ++i) {
        const float share = std::floor(room / static_cast<float>(heights.size() - i));
        if (heights[i] > share) {
            most = std::max(share, 1.0f);
            break;
        }
        room -= heights[i];
    }
    float y = column.min.y;
    for (const PanelId panel : panels) {
        const float height = std::min(std::ceil(wished[panel]), most);
        rects[panel] = {{column.min.x, y}, {column.size.x, height}};
        y += height + gap;
    }
}

} // namespace

float scale_that_fits(float wished, glm::vec2 window) {
    const float most = std::min(window.x / smallest_window.x, window.y / smallest_window.y);
    return std::min(wished, std::max(std::floor(10 * most) / 10, 1.0f));
}

bool is_roomy(glm::vec2 window, float scale) {
    return window.x >= roomy.x * scale && window.y >= roomy.y * scale;
}

PerPanel<Rect> lay_out(glm::vec2 window, float scale, const PerPanel<float> &wished) {
    const float gap = std::round(margin * scale);
    const float height = std::max(window.y - 2 * gap, 1.0f);
    const float left = std::round(std::clamp(0.2f * window.x, 190 * scale, 280 * scale));
    const float right = std::round(std::clamp(0.23f * window.x, 210 * scale, 320 * scale));
    const float right_x = std::max(window.x - gap - right, left + 3 * gap);
    const float middle_x = left + 2 * gap;
    const float middle = std::max(right_x - gap - middle_x, 1.0f);

    PerPanel<Rect> rects{};
    // If bar and lab do not fit between the columns, they span the window, and the columns end
    // above them.
    const float bar_height = std::min(std::ceil(wished[PanelId::transport]), 0.4f * height);
    const float bar_y = window.y - gap - bar_height;
    const bool fits = middle >= least_transport_width * scale;
    const float bar =
        std::min(transport_width * scale, fits ? middle : std::max(window.x - 2 * gap, 1.0f));
    const float bar_x = fits ? middle_x + (middle - bar) / 2 : (window.x - bar) / 2;
    if (bar_height > 0)
        rects[PanelId::transport] = {{std::round(bar_x), bar_y}, {bar, bar_height}};
    const float above = bar_height > 0 ? std::max(bar_y - 2 * gap, 1.0f) : height;
    const float lab =
        wished[PanelId::lab] > 0 ? std::floor((fits ? lab_share : spanning_lab_share) * above) : 0;
    if (lab > 0)
        rects[PanelId::lab] = {{fits ? middle_x : gap, gap + above - lab},
                               {fits ? middle : std::max(window.x - 2 * gap, 1.0f), lab}};
    const float above_lab = lab > 0 ? std::max(above - lab - gap, 1.0f) : above;
    const float column = fits ? height : above_lab;

    stack(rects, wished, PanelSpot::left, {{gap, gap}, {left, column}}, gap);
    stack(rects, wished, PanelSpot::right, {{right_x, gap}, {right, column}}, gap);

    const bool alone = !is_roomy(window, scale) && wished[PanelId::help] > 0;
    const float over_x = alone ? gap : middle_x;
    const float over = alone ? std::max(window.x - 2 * gap, 1.0f) : middle;
    const float said = std::min(std::ceil(wished[PanelId::messages]), 0.35f * above);
    if (said > 0)
        rects[PanelId::messages] = {{over_x, gap}, {over, said}};
    const float below_said = said > 0 ? 2 * gap + said : gap;
    if (wished[PanelId::help] > 0) {
        const float room = (alone ? height : above_lab) - (below_said - gap);
        rects[PanelId::help] = {
            {over_x, below_said},
            {over, std::min(std::ceil(wished[PanelId::help]), std::max(room, 1.0f))}};
    }
    return rects;
}

Rect free_part(glm::vec2 window, std::span<const Rect> taken, float aspect) {
    // The best rectangle's sides lie on sides of the window or of `taken`.
    std::vector<float> xs{0, window.x};
    std::vector<float> ys{0, window.y};
    for (const Rect &rect : taken) {
        xs.insert(xs.end(), {rect.min.x, rect.max().x});
        ys.insert(ys.end(), {rect.min.y, rect.max().y});
    }
    std::ranges::sort(xs);
    std::ranges::sort(ys);
    const auto is_free = [&](const Rect &rect) {
        return std::ranges::none_of(taken, [&](const Rect &other) {
            return rect.min.x < other.max().x && other.min.x < rect.max().x &&
                   rect.min.y < other.max().y && other.min.y < rect.max().y;
        });
    };
    Rect best{{0, 0}, window};
    std::pair<float, float> most{least_picture * window.y, 0}; // height of the picture, area
    for (const float left : xs)
        for (const float right : xs)
            for (const float top : ys)
                for (const float bottom : ys) {
                    if (!(left < right && top < bottom))
                        continue;
                    const Rect rect{{left, top}, {right - left, bottom - top}};
                    const std::pair<float, float> size{std::min(rect.size.y, rect.size.x / aspect),
                                                       rect.size.x * rect.size.y};
                    if (size > most && is_free(rect)) {
                        best = rect;
                        most = size;
                    }
                }
    return best;
}

} // namespace plumb
