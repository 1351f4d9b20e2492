#include "app/lab/map/map_picture.h"

#include "app/lab/chart/chart_pen.h"

#include <glm/common.hpp>

namespace plumb {

using namespace chart_colour;

namespace {

Face face_of(float size) {
    for (const Face face : {Face::title, Face::subtitle, Face::axis, Face::label})
        if (font_size(face) == size)
            return face;
    return Face::footer;
}

// Black or white, whichever reads better (by the luma of ITU-R BT.601).
ImU32 readable_on(unsigned rgb) {
    const unsigned luma =
        299 * ((rgb >> 16U) & 255U) + 587 * ((rgb >> 8U) & 255U) + 114 * (rgb & 255U);
    return luma > 140 * 1000 ? ink : paper;
}

void draw_text(ChartPen &pen, const MapText &text, Face face, ImU32 c) {
    pen.text(text.box.min, text.text, face, c);
}

void draw_limit(ChartPen &pen, glm::vec2 p) {
    pen.mark(p, 0, limit_radius, paper);
    pen.mark(p, 0, limit_radius - 1.5f, ink);
}

// The dash pattern continues across segments.
void draw_curve(ChartPen &pen, const std::vector<glm::vec2> &points) {
    constexpr float dash = 7, period = 11;
    float along = 0;
    for (std::size_t i = 1; i < points.size(); ++i) {
        const glm::vec2 d = points[i] - points[i - 1];
        const float length = std::hypot(d.x, d.y);
        if (std::fmod(along, period) < dash) {
            pen.line(points[i - 1], points[i], paper, 4);
            pen.line(points[i - 1], points[i], ink, 2);
        }
        along += length;
    }
}

// Whether a curve crosses the box or passes close by.
bool is_crossed(const PixelBox &box, const std::vector<std::vector<glm::vec2>> &curves) {
    constexpr float close = 4;
    const PixelBox around{box.min - close, box.max + close};
    for (const std::vector<glm::vec2> &curve : curves)
        for (std::size_t i = 1; i < curve.size(); ++i)
            if (around.overlaps(
                    {glm::min(curve[i - 1], curve[i]), glm::max(curve[i - 1], curve[i])}))
                return true;
    return false;
}

// With a halo in the cell's colour if a curve crosses it.
void draw_mark(ChartPen &pen, const MapCellBox &cell, bool crossed) {
    const unsigned rgb = info_of(cell.failing).colour;
    if (crossed)
        for (const glm::vec2 off :
             {glm::vec2(-1, -1), glm::vec2(0, -1.5f), glm::vec2(1, -1), glm::vec2(-1.5f, 0),
              glm::vec2(1.5f, 0), glm::vec2(-1, 1), glm::vec2(0, 1.5f), glm::vec2(1, 1)})
            pen.text(cell.mark->box.min + off, cell.mark->text, Face::footer, colour(rgb));
    draw_text(pen, *cell.mark, Face::footer, readable_on(rgb));
}

void draw_panel(ChartPen &pen, const MapPanel &panel) {
    pen.fill(panel.plot, paper);
    for (const MapCellBox &cell : panel.cells)
        pen.fill({cell.box.min + 0.5f, cell.box.max - 0.5f}, colour(info_of(cell.failing).colour));
    for (const std::vector<glm::vec2> &curve : panel.curves)
        draw_curve(pen, curve);
    for (const MapCellBox &cell : panel.cells)
        if (cell.mark)
            draw_mark(pen, cell, is_crossed(cell.mark->box, panel.curves));
    for (const glm::vec2 &limit : panel.limits)
        draw_limit(pen, limit);
    pen.outline(panel.plot, frame, 1);
    draw_text(pen, panel.title, Face::axis, ink);
    for (const std::vector<MapText> *labels : {&panel.x_labels, &panel.y_labels})
        for (const MapText &label : *labels)
            draw_text(pen, label, Face::footer, soft_ink);
}

void draw_entry(ChartPen &pen, const MapLegendEntry &entry) {
    const glm::vec2 center = 0.5f * (entry.sample.min + entry.sample.max);
    ImU32 letter_colour = ink;
    switch (entry.kind) {
    case MapLegendEntry::Kind::failing: {
        const unsigned rgb = info_of(entry.failing).colour;
        pen.fill(entry.sample, colour(rgb));
        letter_colour = readable_on(rgb);
        break;
    }
    case MapLegendEntry::Kind::limit:
        draw_limit(pen, center);
        break;
    case MapLegendEntry::Kind::theory:
        pen.dashed({entry.sample.min.x, center.y}, {entry.sample.max.x, center.y}, ink, 2, 7, 4);
        break;
    case MapLegendEntry::Kind::expectation:
        break;
    }
    pen.text(center, entry.letter, Face::footer, letter_colour, {0.5f, 0.5f});
    draw_text(pen, entry.text, Face::label, soft_ink);
}

} // namespace

void draw_map(ChartPen &pen, const MapPicture &picture) {
    const MapLayout layout = lay_out(picture.map, picture.theory, picture.footer,
                                     [&pen](std::string_view text, float font_size) -> glm::vec2 {
                                         return pen.text_size(text, face_of(font_size));
                                     });
    draw_text(pen, layout.title, Face::title, ink);
    draw_text(pen, layout.subtitle, Face::subtitle, soft_ink);
    draw_text(pen, layout.y_title, Face::axis, ink);
    draw_text(pen, layout.x_title, Face::axis, ink);
    for (const MapPanel &panel : layout.panels)
        draw_panel(pen, panel);
    for (const MapLegendEntry &entry : layout.legend)
        draw_entry(pen, entry);
    for (const MapText &line : layout.footer)
        draw_text(pen, line, Face::footer, faint_ink);
}

} // namespace plumb
