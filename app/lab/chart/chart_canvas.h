// What a chart's pen draws on: pixels or SVG text. All coordinates are pixels of the finished
// picture.
#pragma once

#include "app/lab/chart/chart_layout.h"

#include <array>
#include <cstddef>
#include <span>
#include <string_view>

#include <glm/vec2.hpp>
#include <imgui/imgui.h>

namespace plumb {

// Text sizes, defined in chart_style.
enum class Face { title, subtitle, axis, label, footer };
inline constexpr std::array all_faces{Face::title, Face::subtitle, Face::axis, Face::label,
                                      Face::footer};

[[nodiscard]] constexpr float font_size(Face face) {
    constexpr std::array sizes{chart_style::title_text, chart_style::subtitle_text,
                               chart_style::axis_text, chart_style::label_text,
                               chart_style::footer_text};
    return sizes[static_cast<std::size_t>(face)];
}

// Drawn this many times larger, then averaged down, for smooth edges everywhere.
inline constexpr int supersampling = 2;

// One per face, at its size times supersampling.
using ChartFonts = std::array<ImFont *, all_faces.size()>;

// Adds the fonts to the atlas.
[[nodiscard]] ChartFonts load_chart_fonts(ImFontAtlas &atlas);

// Size of the text in that face, scaled by `scale`.
[[nodiscard]] glm::vec2 text_size(const ChartFonts &fonts, std::string_view text, Face face,
                                  float scale);

class ChartCanvas {
  public:
    ChartCanvas() = default;
    virtual ~ChartCanvas() = default;
    ChartCanvas(const ChartCanvas &) = delete;
    ChartCanvas &operator=(const ChartCanvas &) = delete;

    [[nodiscard]] virtual const ChartFonts &fonts() const = 0;
    virtual void box(const PixelBox &box, ImU32 c) = 0;
    virtual void polygon(std::span<const glm::vec2> convex, ImU32 c) = 0;
    virtual void stroke(std::span<const glm::vec2> points, ImU32 c, float width) = 0;
    // p: upper left corner.
    virtual void text(glm::vec2 p, std::string_view text, Face face, float scale, ImU32 c) = 0;
};

} // namespace plumb
