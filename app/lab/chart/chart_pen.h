// Drawing primitives for charts, in pixels of the finished picture.
#pragma once

#include "app/lab/chart/chart_canvas.h"
#include "app/lab/chart/curve_style.h"
#include "app/lab/chart/log_axis.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec2.hpp>
#include <imgui/imgui.h>

namespace plumb {

namespace chart_colour {

constexpr ImU32 colour(unsigned rgb, unsigned alpha = 255) {
    return IM_COL32((rgb >> 16) & 255, (rgb >> 8) & 255, rgb & 255, alpha);
}

inline constexpr ImU32 background = colour(0xfbfcfd);
inline constexpr ImU32 ink = colour(0x22262b);
inline constexpr ImU32 soft_ink = colour(0x5f666e);
inline constexpr ImU32 faint_ink = colour(0x8b929a);
inline constexpr ImU32 strong_grid = colour(0xd9dde1);
inline constexpr ImU32 weak_grid = colour(0xeff1f3);
inline constexpr ImU32 frame = colour(0xa4abb2);
inline constexpr ImU32 paper = colour(0xffffff);
inline constexpr ImU32 fine_tint = colour(0xf0f7f1);
inline constexpr ImU32 untold_tint = colour(0xf4f2f0);
inline constexpr ImU32 limit_ink = colour(0x2f7d4f);
inline constexpr ImU32 budget_ink = colour(0x9a5b13);
inline constexpr ImU32 front = colour(0xdcdfe3);

} // namespace chart_colour

class ChartPen {
  public:
    explicit ChartPen(ChartCanvas &canvas) : canvas_(canvas) {}

    void line(glm::vec2 a, glm::vec2 b, ImU32 c, float width) {
        canvas_.stroke(std::array{a, b}, c, width);
    }
    void dashed(glm::vec2 a, glm::vec2 b, ImU32 c, float width, float dash, float gap) {
        const glm::vec2 d = b - a;
        const float length = std::hypot(d.x, d.y);
        for (float t = 0; t < length; t += dash + gap)
            line(a + d * (t / length), a + d * (std::min(t + dash, length) / length), c, width);
    }
    void fill(const PixelBox &box, ImU32 c) { canvas_.box(box, c); }
    void outline(const PixelBox &box, ImU32 c, float width) {
        const glm::vec2 a = box.min, b = box.max;
        canvas_.stroke(std::array{a, glm::vec2(b.x, a.y), b, glm::vec2(a.x, b.y), a}, c, width);
    }
    void path(const std::vector<glm::vec2> &points, ImU32 c, float width) {
        canvas_.stroke(points, c, width);
    }
    void cross(glm::vec2 p, float r, ImU32 c, float width) {
        line(p + glm::vec2(-r, -r), p + glm::vec2(r, r), c, width);
        line(p + glm::vec2(-r, r), p + glm::vec2(r, -r), c, width);
    }
    // A style's line, and its mark, filled.
    void styled(std::size_t style, std::span<const glm::vec2> points, ImU32 c, float width) {
        for (const LinePiece &piece : line_pieces(style, points))
            canvas_.stroke(piece, c, width);
    }
    void mark(glm::vec2 p, std::size_t style, float r, ImU32 c) {
        canvas_.polygon(mark_outline(style, p, r), c);
    }

    [[nodiscard]] glm::vec2 text_size(std::string_view text, Face face) const {
        const std::string_view head = text.substr(0, text.find(raised_from));
        glm::vec2 size = plain_size(head, face, 1);
        if (head.size() < text.size())
            size.x += plain_size(text.substr(head.size() + 1), face, raised_scale).x;
        return size;
    }
    // p is where `anchor` goes (0..1 of the text's size).
    void text(glm::vec2 p, std::string_view text, Face face, ImU32 c, glm::vec2 anchor = {0, 0}) {
        const glm::vec2 start = p - anchor * text_size(text, face);
        const std::string_view head = text.substr(0, text.find(raised_from));
        canvas_.text(start, head, face, 1, c);
        if (head.size() < text.size())
            canvas_.text(start + glm::vec2(plain_size(head, face, 1).x, -0.12f * font_size(face)),
                         text.substr(head.size() + 1), face, raised_scale, c);
    }
    // The text cut to the width, with an ellipsis if anything was cut.
    [[nodiscard]] std::string fitted(const std::string &text, Face face, float width) const {
        if (text_size(text, face).x <= width)
            return text;
        std::string cut = text;
        while (!cut.empty() && text_size(cut + "…", face).x > width) {
            // Whole UTF-8 characters.
            while (!cut.empty() && (static_cast<unsigned char>(cut.back()) & 0xc0) == 0x80)
                cut.pop_back();
            if (!cut.empty())
                cut.pop_back();
        }
        return cut + "…";
    }
    // Breaks the text at spaces into lines of at most this width (longer for a long word).
    [[nodiscard]] std::vector<std::string> wrapped(const std::string &text, Face face,
                                                   float width) const {
        std::vector<std::string> lines{""};
        std::size_t begin = 0;
        while (begin < text.size()) {
            const std::size_t space = std::min(text.find(' ', begin), text.size());
            const std::string word = text.substr(begin, space - begin);
            const std::string longer = lines.back().empty() ? word : lines.back() + " " + word;
            if (lines.back().empty() || text_size(longer, face).x <= width)
                lines.back() = longer;
            else
                lines.push_back(word);
            begin = space + 1;
        }
        return lines;
    }

  private:
    static constexpr float raised_scale = 0.72f;

    [[nodiscard]] glm::vec2 plain_size(std::string_view text, Face face, float scale) const {
        return plumb::text_size(canvas_.fonts(), text, face, scale);
    }

    ChartCanvas &canvas_;
};

} // namespace plumb
