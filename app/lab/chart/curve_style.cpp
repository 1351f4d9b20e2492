#include "app/lab/chart/curve_style.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace plumb {

namespace {

// On, off, on, off, in pixels; no length on: solid.
using Dashes = std::array<float, 4>;
constexpr std::array<Dashes, dash_count> all_dashes{
    {{0, 0, 0, 0}, {7, 4, 7, 4}, {1.8f, 3.2f, 1.8f, 3.2f}, {9, 3.2f, 1.8f, 3.2f}, {15, 4, 15, 4}}};

std::vector<glm::vec2> polygon(glm::vec2 p, float radius, int corners, float first_degrees) {
    std::vector<glm::vec2> points;
    for (int i = 0; i < corners; ++i) {
        const float turned = 360.0f * static_cast<float>(i) / static_cast<float>(corners);
        const float angle = (first_degrees + turned) * std::numbers::pi_v<float> / 180;
        points.push_back(p + radius * glm::vec2(std::cos(angle), std::sin(angle)));
    }
    return points;
}

} // namespace

std::vector<glm::vec2> mark_outline(std::size_t style, glm::vec2 p, float radius) {
    switch (style % shape_count) {
    case 0:
        return polygon(p, radius, 40, 0);
    case 1:
        return polygon(p, 1.216f * radius, 4, 45); // a square, 0.86 of the radius to each side
    case 2:
        return polygon(p, 1.15f * radius, 3, -90);
    case 3:
        return polygon(p, 1.18f * radius, 4, 0);
    default:
        return polygon(p, 1.15f * radius, 3, 90);
    }
}

std::vector<LinePiece> line_pieces(std::size_t style, std::span<const glm::vec2> points,
                                   float scale) {
    const Dashes &dashes = all_dashes.at(style / series_colour_count % dash_count);
    std::vector<LinePiece> pieces;
    std::size_t part = 0;
    float left = dashes[0] * scale; // of this part
    for (std::size_t i = 1; i < points.size(); ++i) {
        const glm::vec2 from = points[i - 1], way = points[i] - from;
        const float length = std::hypot(way.x, way.y);
        if (dashes[0] == 0) {
            pieces.push_back({from, points[i]});
            continue;
        }
        for (float at = 0; at < length;) {
            const float end = std::min(at + left, length);
            if (part % 2 == 0)
                pieces.push_back({from + way * (at / length), from + way * (end / length)});
            left -= end - at;
            const bool is_used_up = left <= 0 || end == at; // at may be too coarse for the rest
            at = end;
            if (is_used_up) {
                part = (part + 1) % dashes.size();
                left = dashes.at(part) * scale;
            }
        }
    }
    return pieces;
}

} // namespace plumb
