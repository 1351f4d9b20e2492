#include "app/lab/chart/chart_svg.h"

#include "app/lab/chart/chart_drawing.h"
#include "app/lab/chart/chart_pen.h"
#include "app/lab/chart/panel_chart.h"
#include "app/lab/map/map_picture.h"

#include <charconv>
#include <functional>
#include <string>

namespace plumb {

namespace {

// Rounded to hundredths of a pixel.
std::string number(float value) {
    std::array<char, 32> text{};
    auto *end =
        std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed, 2)
            .ptr;
    return {text.data(), end};
}

std::string colour_text(ImU32 c) {
    char text[8];
    std::snprintf(text, sizeof text, "#%02x%02x%02x", c & 255U, (c >> 8U) & 255U,
                  (c >> 16U) & 255U);
    return text;
}

std::string escaped(std::string_view text) {
    std::string all;
    for (const char c : text)
        if (c == '<')
            all += "&lt;";
        else if (c == '&')
            all += "&amp;";
        else
            all += c;
    return all;
}

std::string points_text(std::span<const glm::vec2> points) {
    std::string text;
    for (const glm::vec2 &p : points)
        text += (text.empty() ? "" : " ") + number(p.x) + "," + number(p.y);
    return text;
}

class SvgCanvas final : public ChartCanvas {
  public:
    SvgCanvas(std::ostream &out, const ChartFonts &fonts) : out_(out), fonts_(fonts) {}

    [[nodiscard]] const ChartFonts &fonts() const override { return fonts_; }
    void box(const PixelBox &box, ImU32 c) override {
        out_ << "<rect x=\"" << number(box.min.x) << "\" y=\"" << number(box.min.y) << "\" width=\""
             << number(box.max.x - box.min.x) << "\" height=\"" << number(box.max.y - box.min.y)
             << "\" fill=\"" << colour_text(c) << "\"/>\n";
    }
    void polygon(std::span<const glm::vec2> convex, ImU32 c) override {
        out_ << "<polygon points=\"" << points_text(convex) << "\" fill=\"" << colour_text(c)
             << "\"/>\n";
    }
    void stroke(std::span<const glm::vec2> points, ImU32 c, float width) override {
        out_ << "<polyline points=\"" << points_text(points) << "\" fill=\"none\" stroke=\""
             << colour_text(c) << "\" stroke-width=\"" << number(width) << "\"/>\n";
    }
    // textLength keeps the width as laid out, whatever typeface the viewer has.
    void text(glm::vec2 p, std::string_view text, Face face, float scale, ImU32 c) override {
        if (text.empty())
            return;
        const glm::vec2 size = text_size(fonts_, text, face, scale);
        constexpr float baseline = 0.79f; // Roboto's, from the top of the line
        out_ << "<text x=\"" << number(p.x) << "\" y=\"" << number(p.y + baseline * size.y)
             << "\" font-size=\"" << number(0.85f * scale * font_size(face)) << "\" textLength=\""
             << number(size.x) << "\" lengthAdjust=\"spacingAndGlyphs\" fill=\"" << colour_text(c)
             << "\">" << escaped(text) << "</text>\n";
    }

  private:
    std::ostream &out_;
    const ChartFonts &fonts_;
};

void write(std::ostream &out, glm::vec2 size, const std::function<void(ChartPen &)> &draw) {
    ImFontAtlas atlas;
    const ChartFonts fonts = load_chart_fonts(atlas);
    atlas.Build();
    out << "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" << number(size.x) << "\" height=\""
        << number(size.y) << "\" viewBox=\"0 0 " << number(size.x) << " " << number(size.y)
        << "\" font-family=\"Roboto, sans-serif\">\n";
    SvgCanvas canvas(out, fonts);
    canvas.box({{0, 0}, size}, chart_colour::background);
    ChartPen pen(canvas);
    draw(pen);
    out << "</svg>\n";
}

} // namespace

void write_chart_svg(std::ostream &out, const ChartContent &content) {
    write(out, chart_size(content), [&](ChartPen &pen) { draw_chart(pen, content); });
}

void write_chart_svg(std::ostream &out, const MapPicture &picture) {
    write(out, chart_style::size, [&](ChartPen &pen) { draw_map(pen, picture); });
}

void write_chart_svg(std::ostream &out, const PanelChart &chart) {
    write(out, chart_style::size, [&](ChartPen &pen) { draw_panels(pen, chart); });
}

} // namespace plumb
