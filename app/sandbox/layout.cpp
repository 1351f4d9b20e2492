#include "app/sandbox/layout.h"

#include <algorithm>
#include <cmath>

namespace plumb {

namespace {

// At a scale of 1: the rows that each of these panels holds, which do not grow with the window.
constexpr float settings_height = 222;
constexpr float view_height = 190;
constexpr float transport_height = 92;
constexpr float transport_width = 520;
constexpr float margin = 8;

} // namespace

Layout lay_out(glm::vec2 window, float scale, const LayoutWishes &wishes) {
    const float gap = std::round(margin * scale);
    const float height = std::max(window.y - 2 * gap, 1.0f);
    const float left = std::round(std::clamp(0.22f * window.x, 240 * scale, 280 * scale));
    const float right = std::round(std::clamp(0.245f * window.x, 240 * scale, 320 * scale));

    Layout layout;
    const float view = std::round(std::min(view_height * scale, 0.32f * height));
    const float settings = std::round(std::min(settings_height * scale, 0.38f * height));
    const float scenes = std::max(height - view - settings - 2 * gap, 1.0f);
    layout.scenes = {{gap, gap}, {left, scenes}};
    layout.settings = {{gap, layout.scenes.max().y + gap}, {left, settings}};
    layout.view = {{gap, layout.settings.max().y + gap}, {left, view}};

    const float right_x = std::max(window.x - gap - right, left + 3 * gap);
    const float details =
        wishes.diagnostics ? std::round(std::max(0.4f * height, height - 470 * scale)) : height;
    layout.details = {{right_x, gap}, {right, details}};
    layout.diagnostics = {{right_x, layout.details.max().y + gap},
                          {right, std::max(height - details - gap, 0.0f)}};

    const float middle_x = left + 2 * gap;
    const float middle = std::max(right_x - gap - middle_x, 1.0f);
    const float bar = std::min(transport_width * scale, middle);
    const float bar_height = std::round(transport_height * scale);
    layout.transport = {{std::round(middle_x + (middle - bar) / 2), window.y - gap - bar_height},
                        {bar, bar_height}};
    const float free = std::max(layout.transport.min.y - 2 * gap, 1.0f);
    const float said = std::min(wishes.messages_height, 0.35f * free);
    layout.messages = {{middle_x, gap}, {middle, said}};
    const float help_y = said > 0 ? layout.messages.max().y + gap : gap;
    layout.help = {{middle_x, help_y},
                   {middle, std::max(layout.transport.min.y - gap - help_y, 1.0f)}};
    return layout;
}

} // namespace plumb
