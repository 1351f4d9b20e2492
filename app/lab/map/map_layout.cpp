#include "app/lab/map/map_layout.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace plumb {

namespace {

using namespace chart_style;

constexpr float left_edge = 40, right_edge = size.x - 28;
constexpr float line_height = 16; // of small print
constexpr float legend_row = 22;
constexpr glm::vec2 sample_size{22, 14};
constexpr glm::vec2 panel_gap{18, 58};

class Writer {
  public:
    explicit Writer(const TextSize &text_size) : text_size_(text_size) {}

    glm::vec2 measure(std::string_view text, float font) const { return text_size_(text, font); }

    // Puts `anchor` (0..1 of the text's size) at p.
    MapText place(std::string text, float font, glm::vec2 p, glm::vec2 anchor = {0, 0}) const {
        const glm::vec2 extent = measure(text, font);
        const glm::vec2 corner = p - anchor * extent;
        return {std::move(text), {corner, corner + extent}};
    }
    std::string cut(std::string text, float font, float width) const {
        if (measure(text, font).x <= width)
            return text;
        // Removes whole UTF-8 characters.
        while (!text.empty() && measure(text + "…", font).x > width)
            do
                text.pop_back();
            while (!text.empty() && (static_cast<unsigned char>(text.back()) & 0xc0U) == 0x80U);
        return text + "…";
    }
    // Wraps at spaces; cuts words that are too long.
    std::vector<std::string> broken(const std::string &text, float font, float width) const {
        std::vector<std::string> lines;
        for (std::size_t begin = 0; begin <= text.size();) {
            const std::size_t space = std::min(text.find(' ', begin), text.size());
            const std::string word = text.substr(begin, space - begin);
            if (!lines.empty() && measure(lines.back() + " " + word, font).x <= width)
                lines.back() += " " + word;
            else
                lines.push_back(cut(word, font, width));
            begin = space + 1;
        }
        return lines;
    }

  private:
    const TextSize &text_size_;
};

// The expectations that cells missed, in the scene's order: a, b, c, ...
std::vector<std::string> missed_expectations(const StabilityMap &map) {
    std::set<std::string> seen;
    for (const MethodMap &of_method : map.methods)
        for (const auto &run : of_method.cells)
            if (run)
                seen.insert(run->failing.what);
    std::vector<std::string> missed;
    for (const ExpectDesc &expect : map.scene.expects)
        if (seen.contains(expect.name))
            missed.push_back(expect.name);
    return missed;
}

std::string letter_of(const std::vector<std::string> &missed, const std::string &name) {
    constexpr std::size_t letters = 26;
    const auto found = std::ranges::find(missed, name);
    const auto index = static_cast<std::size_t>(found - missed.begin());
    return found == missed.end() || index >= letters
               ? ""
               : std::string(1, static_cast<char>('a' + index));
}

// Every n-th label from the first, with the least n that keeps them `air` apart along the axis.
std::vector<MapText> spread_out(const std::vector<MapText> &labels, int axis, float air) {
    for (std::size_t stride = 1;; ++stride) {
        std::vector<MapText> kept;
        bool fits = true;
        for (std::size_t i = 0; i < labels.size(); i += stride) {
            const PixelBox &box = labels[i].box;
            fits = fits && (kept.empty() || box.min[axis] >= kept.back().box.max[axis] + air ||
                            kept.back().box.min[axis] >= box.max[axis] + air);
            kept.push_back(labels[i]);
        }
        if (fits)
            return kept;
    }
}

struct Frame {
    PixelBox plot;
    glm::vec2 cell;

    Frame(const PixelBox &box, const StabilityMap &map)
        : plot(box),
          cell((box.max - box.min) / glm::vec2(static_cast<float>(map.x.values.size()),
                                               static_cast<float>(map.y.values.size()))) {}
    // From cell coordinates: (0, 0) is the centre of the first cell.
    glm::vec2 at(double column, double row) const {
        return {plot.min.x + static_cast<float>(column + 0.5) * cell.x,
                plot.max.y - static_cast<float>(row + 0.5) * cell.y};
    }
    PixelBox box(std::size_t column, std::size_t row) const {
        const glm::vec2 center = at(static_cast<double>(column), static_cast<double>(row));
        return {center - 0.5f * cell, center + 0.5f * cell};
    }
};

std::vector<std::vector<glm::vec2>> curves_within(const Frame &frame, const StabilityMap &map,
                                                  const TheoryCurve &curve) {
    std::vector<std::vector<glm::vec2>> parts;
    bool inside_before = false;
    for (const glm::dvec2 &point : curve.points) {
        const glm::vec2 p = frame.at(cell_position(map.x, point.x), cell_position(map.y, point.y));
        const bool inside = frame.plot.contains({p, p});
        if (inside && !inside_before)
            parts.emplace_back();
        if (inside)
            parts.back().push_back(p);
        inside_before = inside;
    }
    return parts;
}

MapPanel lay_out_panel(const Writer &write, const StabilityMap &map, const MethodMap &of_method,
                       const PixelBox &plot, bool has_y_labels,
                       const std::vector<TheoryCurve> &theory,
                       const std::vector<std::string> &missed) {
    MapPanel panel;
    const Frame frame(plot, map);
    panel.plot = plot;
    panel.title = write.place(
        write.cut(std::string(of_method.method->title), axis_text, plot.max.x - plot.min.x),
        axis_text, {plot.min.x, plot.min.y - 4}, {0, 1});
    for (std::size_t row = 0; row < map.y.values.size(); ++row)
        for (std::size_t column = 0; column < map.x.values.size(); ++column) {
            const auto &run = map.cell(of_method, column, row);
            if (!run)
                continue;
            MapCellBox cell{frame.box(column, row), run->failing.failing, std::nullopt};
            if (run->failing.failing != Failing::none) {
                // In a corner, clear of the limits, which are drawn halfway up.
                MapText mark = write.place(std::string(1, info_of(run->failing.failing).letter) +
                                               letter_of(missed, run->failing.what),
                                           footer_text, cell.box.min + glm::vec2(4, 2));
                const float middle = 0.5f * (cell.box.min.y + cell.box.max.y);
                if (cell.box.contains(mark.box) && mark.box.max.y < middle - limit_radius - 1)
                    cell.mark = std::move(mark);
            }
            panel.cells.push_back(std::move(cell));
        }
    for (const MapLimit &limit : of_method.limits)
        panel.limits.push_back(frame.at(cell_position(map.x, between(map.x, limit.low, limit.high)),
                                        cell_position(map.y, limit.y)));
    for (const TheoryCurve &curve : theory)
        if (std::ranges::find(curve.methods, of_method.method) != curve.methods.end())
            for (std::vector<glm::vec2> &part : curves_within(frame, map, curve))
                panel.curves.push_back(std::move(part));

    std::vector<MapText> labels;
    for (std::size_t i = 0; i < map.x.values.size(); ++i) {
        const std::string text = value_label(map.x, map.x.values[i]);
        // Keeps the outer labels clear of the next panel's.
        const float half = 0.5f * write.measure(text, footer_text).x, beside = 0.4f * panel_gap.x;
        const float low = plot.min.x - beside + half, high = plot.max.x + beside - half;
        const float middle = frame.at(static_cast<double>(i), 0).x;
        labels.push_back(write.place(text, footer_text,
                                     {std::clamp(middle, low, std::max(low, high)), plot.max.y + 5},
                                     {0.5f, 0}));
    }
    panel.x_labels = spread_out(labels, 0, 8);
    if (!has_y_labels)
        return panel;
    labels.clear();
    for (std::size_t i = 0; i < map.y.values.size(); ++i)
        labels.push_back(write.place(value_label(map.y, map.y.values[i]), footer_text,
                                     {plot.min.x - 7, frame.at(0, static_cast<double>(i)).y},
                                     {1, 0.5f}));
    panel.y_labels = spread_out(labels, 1, 2);
    return panel;
}

std::vector<MapLegendEntry> legend_entries(const StabilityMap &map,
                                           const std::vector<TheoryCurve> &theory,
                                           const std::vector<std::string> &missed) {
    using Kind = MapLegendEntry::Kind;
    std::set<Failing> seen;
    bool any_limit = false;
    for (const MethodMap &of_method : map.methods) {
        any_limit = any_limit || !of_method.limits.empty();
        for (const auto &run : of_method.cells)
            if (run)
                seen.insert(run->failing.failing);
    }
    std::vector<MapLegendEntry> entries;
    for (const FailingInfo &info : failings())
        if (seen.contains(info.failing))
            entries.push_back({Kind::failing,
                               info.failing,
                               {},
                               info.failing == Failing::none ? "" : std::string(1, info.letter),
                               {std::string(info.meaning), {}}});
    if (any_limit)
        entries.push_back({Kind::limit,
                           Failing::none,
                           {},
                           "",
                           {map.x.whole ? "limit between two cells, by bisection"
                                        : "limit, by bisection to within 0.25 %",
                            {}}});
    for (const TheoryCurve &curve : theory)
        entries.push_back({Kind::theory, Failing::none, {}, "", {curve.name, {}}});
    for (const std::string &name : missed)
        if (const std::string letter = letter_of(missed, name); !letter.empty())
            entries.push_back({Kind::expectation, Failing::none, {}, letter, {name, {}}});
    return entries;
}

// Lays the entries out in rows, left to right, from y = 0 down. Returns the height.
float flow(const Writer &write, std::vector<MapLegendEntry> &entries) {
    float x = left_edge, y = 0;
    for (MapLegendEntry &entry : entries) {
        const float text_left = sample_size.x + 8;
        entry.text.text =
            write.cut(entry.text.text, label_text, right_edge - left_edge - text_left);
        const float width = text_left + write.measure(entry.text.text, label_text).x;
        if (x > left_edge && x + width > right_edge) {
            x = left_edge;
            y += legend_row;
        }
        entry.sample = {{x, y}, glm::vec2(x, y) + sample_size};
        entry.text = write.place(entry.text.text, label_text,
                                 {x + text_left, y + 0.5f * sample_size.y}, {0, 0.5f});
        x += width + 26;
    }
    return entries.empty() ? 0 : y + legend_row;
}

void move_down(PixelBox &box, float by) {
    box.min.y += by;
    box.max.y += by;
}

} // namespace

MapLayout lay_out(const StabilityMap &map, const std::vector<TheoryCurve> &theory,
                  const std::vector<std::string> &footer, const TextSize &text_size) {
    const Writer write(text_size);
    const float width = right_edge - left_edge;
    MapLayout layout;
    layout.size = size;
    layout.title = write.place(
        write.cut(map.scene.title.empty() ? map.scene.name : map.scene.title, title_text, width),
        title_text, {left_edge, 22});
    layout.subtitle =
        write.place(write.cut(std::string(map.interrupted ? "INTERRUPTED. " : "") +
                                  "Where each method holds the scene, and why it fails",
                              subtitle_text, width),
                    subtitle_text, {left_edge, 56});
    layout.y_title = write.place(write.cut("y: " + axis_title(map.y), axis_text, width), axis_text,
                                 {left_edge, 84});

    // From the bottom up: small print, legend, the x axis.
    std::vector<std::string> lines;
    for (const std::string &text : footer)
        for (std::string &line : write.broken(text, footer_text, width))
            lines.push_back(std::move(line));
    float y = size.y - 16 - line_height * static_cast<float>(lines.size());
    for (std::size_t i = 0; i < lines.size(); ++i)
        layout.footer.push_back(write.place(lines[i], footer_text,
                                            {left_edge, y + line_height * static_cast<float>(i)}));
    const std::vector<std::string> missed = missed_expectations(map);
    layout.legend = legend_entries(map, theory, missed);
    const float legend_height = flow(write, layout.legend);
    y -= legend_height + 10;
    for (MapLegendEntry &entry : layout.legend) {
        move_down(entry.sample, y);
        move_down(entry.text.box, y);
    }
    y -= 26;
    layout.x_title = write.place(write.cut("x: " + axis_title(map.x), axis_text, width), axis_text,
                                 {right_edge, y}, {1, 0});

    float labels_width = 0;
    for (const double value : map.y.values)
        labels_width =
            std::max(labels_width, write.measure(value_label(map.y, value), footer_text).x);
    const std::size_t count = map.methods.size();
    const std::size_t columns = std::min<std::size_t>(count, count == 4 ? 2 : 3);
    const std::size_t rows = (count + columns - 1) / columns;
    const glm::vec2 counts(static_cast<float>(columns), static_cast<float>(rows));
    const PixelBox area{{left_edge + labels_width + 8, 128}, {right_edge, y - 24}};
    const glm::vec2 extent = (area.max - area.min - panel_gap * (counts - 1.0f)) / counts;
    for (std::size_t i = 0; i < count; ++i) {
        const glm::vec2 corner =
            area.min + glm::vec2(static_cast<float>(i % columns), static_cast<float>(i / columns)) *
                           (extent + panel_gap);
        layout.panels.push_back(lay_out_panel(write, map, map.methods[i], {corner, corner + extent},
                                              i % columns == 0, theory, missed));
    }
    return layout;
}

} // namespace plumb
