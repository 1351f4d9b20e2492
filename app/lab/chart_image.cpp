#include "app/lab/chart_image.h"

#include "app/render/context.h"
#include "app/render/fonts.h"
#include "app/render/imgui_renderer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <imgui/imgui.h>

namespace plumb {

namespace {

// Drawn this many times larger, then averaged down, for smooth edges everywhere.
constexpr int supersampling = 2;

constexpr ImU32 colour(unsigned rgb, unsigned alpha = 255) {
    return IM_COL32((rgb >> 16) & 255, (rgb >> 8) & 255, rgb & 255, alpha);
}

constexpr ImU32 ink = colour(0x22262b);
constexpr ImU32 soft_ink = colour(0x5f666e);
constexpr ImU32 faint_ink = colour(0x8b929a);
constexpr ImU32 strong_grid = colour(0xd9dde1);
constexpr ImU32 weak_grid = colour(0xeff1f3);
constexpr ImU32 frame = colour(0xa4abb2);
constexpr ImU32 paper = colour(0xffffff);
constexpr ImU32 fine_tint = colour(0xf0f7f1);
constexpr ImU32 limit_ink = colour(0x2f7d4f);
constexpr ImU32 front = colour(0xdcdfe3);

// Colours that people with any of the usual kinds of colour blindness can tell apart (Okabe and Ito
// 2008), without the yellow, which is too light on white. The shape of the mark says it again.
constexpr std::array<unsigned, 7> series_colours{0x0072b2, 0xd55e00, 0x009e73, 0xcc79a7,
                                                 0xe69f00, 0x56b4e9, 0x4d4d4d};
constexpr std::size_t shape_count = 5; // coprime to the number of colours: 35 combinations

enum class Face { title, subtitle, axis, label, footer };

class Pen {
  public:
    Pen(ImDrawList &list, const std::array<ImFont *, 5> &fonts) : list_(list), fonts_(fonts) {}

    static ImVec2 at(glm::vec2 p) { return {p.x * supersampling, p.y * supersampling}; }

    void line(glm::vec2 a, glm::vec2 b, ImU32 c, float width) {
        list_.AddLine(at(a), at(b), c, width * supersampling);
    }
    void dashed(glm::vec2 a, glm::vec2 b, ImU32 c, float width, float dash, float gap) {
        const glm::vec2 d = b - a;
        const float length = std::hypot(d.x, d.y);
        for (float t = 0; t < length; t += dash + gap)
            line(a + d * (t / length), a + d * (std::min(t + dash, length) / length), c, width);
    }
    void fill(const Box &box, ImU32 c) { list_.AddRectFilled(at(box.min), at(box.max), c); }
    void outline(const Box &box, ImU32 c, float width) {
        list_.AddRect(at(box.min), at(box.max), c, 0, 0, width * supersampling);
    }
    void path(const std::vector<glm::vec2> &points, ImU32 c, float width) {
        for (const glm::vec2 &p : points)
            list_.PathLineTo(at(p));
        list_.PathStroke(c, 0, width * supersampling);
    }
    void ring(glm::vec2 p, float radius, ImU32 c, float width) {
        list_.AddCircle(at(p), radius * supersampling, c, 40, width * supersampling);
    }
    void cross(glm::vec2 p, float r, ImU32 c, float width) {
        line(p + glm::vec2(-r, -r), p + glm::vec2(r, r), c, width);
        line(p + glm::vec2(-r, r), p + glm::vec2(r, -r), c, width);
    }
    // A filled mark of equal weight to the eye in each of the shapes.
    void mark(glm::vec2 p, std::size_t shape, float r, ImU32 c) {
        switch (shape % shape_count) {
        case 0:
            list_.AddCircleFilled(at(p), r * supersampling, c, 40);
            break;
        case 1:
            list_.AddRectFilled(at(p - 0.86f * r), at(p + 0.86f * r), c);
            break;
        case 2:
            polygon(p, r * 1.15f, 3, -90, c);
            break;
        case 3:
            polygon(p, r * 1.18f, 4, 0, c);
            break;
        default:
            polygon(p, r * 1.15f, 3, 90, c);
            break;
        }
    }

    [[nodiscard]] glm::vec2 text_size(std::string_view text, Face face) const {
        const std::string_view head = text.substr(0, text.find(raised_from));
        glm::vec2 size = plain_size(head, face, 1);
        if (head.size() < text.size())
            size.x += plain_size(text.substr(head.size() + 1), face, raised_scale).x;
        return size;
    }
    // `anchor` (0..1 of the text's size) lies at p.
    void text(glm::vec2 p, std::string_view text, Face face, ImU32 c, glm::vec2 anchor = {0, 0}) {
        const glm::vec2 start = p - anchor * text_size(text, face);
        const std::string_view head = text.substr(0, text.find(raised_from));
        plain_text(start, head, face, 1, c);
        if (head.size() < text.size())
            plain_text(start + glm::vec2(plain_size(head, face, 1).x, -0.12f * font_size(face)),
                       text.substr(head.size() + 1), face, raised_scale, c);
    }
    // The text cut to the width, with an ellipsis where something is missing.
    [[nodiscard]] std::string fitted(const std::string &text, Face face, float width) const {
        if (text_size(text, face).x <= width)
            return text;
        std::string cut = text;
        while (!cut.empty() && text_size(cut + "…", face).x > width) {
            // Whole characters of UTF-8.
            while (!cut.empty() && (static_cast<unsigned char>(cut.back()) & 0xc0) == 0x80)
                cut.pop_back();
            if (!cut.empty())
                cut.pop_back();
        }
        return cut + "…";
    }
    // Broken at spaces into lines of at most this width.
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

    static float font_size(Face face) {
        using namespace chart_style;
        switch (face) {
        case Face::title:
            return title_text;
        case Face::subtitle:
            return subtitle_text;
        case Face::axis:
            return axis_text;
        case Face::label:
            return label_text;
        case Face::footer:
            return footer_text;
        }
        return axis_text;
    }

  private:
    static constexpr float raised_scale = 0.72f;

    [[nodiscard]] glm::vec2 plain_size(std::string_view text, Face face, float scale) const {
        const ImVec2 size = fonts_[static_cast<std::size_t>(face)]->CalcTextSizeA(
            scale * font_size(face) * supersampling, 1e9f, 0, text.data(),
            text.data() + text.size());
        return {size.x / supersampling, size.y / supersampling};
    }
    void plain_text(glm::vec2 p, std::string_view text, Face face, float scale, ImU32 c) {
        list_.AddText(fonts_[static_cast<std::size_t>(face)],
                      scale * font_size(face) * supersampling, at(p), c, text.data(),
                      text.data() + text.size());
    }
    void polygon(glm::vec2 p, float r, int corners, float degrees, ImU32 c) {
        for (int i = 0; i < corners; ++i) {
            const float angle = 0.01745329f * (degrees + 360.0f * static_cast<float>(i) /
                                                             static_cast<float>(corners));
            list_.PathLineTo(at(p + r * glm::vec2(std::cos(angle), std::sin(angle))));
        }
        list_.PathFillConvex(c);
    }

    ImDrawList &list_;
    const std::array<ImFont *, 5> &fonts_;
};

ImU32 series_colour(const ChartSeries &series) {
    return colour(series_colours[series.style % series_colours.size()]);
}

void draw_grid(Pen &pen, const ChartContent &content, const ChartLayout &layout) {
    const Box &plot = layout.plot;
    const Box &field = layout.field;
    pen.fill(plot, paper);
    if (layout.limit_line && *layout.limit_line < plot.max.y)
        pen.fill({{plot.min.x, *layout.limit_line}, plot.max}, fine_tint);
    for (const bool decade : {false, true}) {
        for (const PlacedTick &tick : layout.cost_ticks)
            if (tick.decade == decade)
                pen.line({tick.pixel, plot.min.y}, {tick.pixel, plot.max.y},
                         decade ? strong_grid : weak_grid, 1);
        for (const PlacedTick &tick : layout.error_ticks)
            if (tick.decade == decade)
                pen.line({plot.min.x, tick.pixel}, {plot.max.x, tick.pixel},
                         decade ? strong_grid : weak_grid, 1);
    }
    for (const PlacedTick &tick : layout.cost_ticks)
        pen.text({tick.pixel, plot.max.y + 8}, tick.label, Face::axis, soft_ink, {0.5f, 0});
    for (const PlacedTick &tick : layout.error_ticks)
        pen.text({plot.min.x - 10, tick.pixel}, tick.label, Face::axis, soft_ink, {1, 0.5f});
    if (layout.failed_line) {
        pen.line({plot.min.x, field.min.y}, {plot.max.x, field.min.y}, frame, 1);
        pen.text({plot.min.x - 10, *layout.failed_line}, "failed", Face::axis, soft_ink, {1, 0.5f});
    }
    if (layout.zero_line) {
        pen.line({plot.min.x, field.max.y}, {plot.max.x, field.max.y}, frame, 1);
        pen.text({plot.min.x - 10, *layout.zero_line}, "exactly 0", Face::axis, soft_ink,
                 {1, 0.5f});
    }
    pen.outline(plot, frame, 1);
    pen.text({plot.min.x, plot.min.y - 10}, content.error_title, Face::axis, ink, {0, 1});
    pen.text({plot.max.x, plot.max.y + 30}, content.cost_title, Face::axis, ink, {1, 0});
}

void draw_marks(Pen &pen, const ChartContent &content, const ChartLayout &layout) {
    using chart_style::mark_radius;
    const Box &field = layout.field;
    if (layout.pareto_steps.size() > 1)
        pen.path(layout.pareto_steps, front, 7);
    if (layout.limit_line) {
        pen.dashed({field.min.x, *layout.limit_line}, {field.max.x, *layout.limit_line}, limit_ink,
                   1.5f, 8, 5);
        pen.text(layout.limit_text.min, content.limit_label, Face::label, limit_ink);
    }
    for (const ChartSeries &series : content.series)
        for (const auto &line : series.lines)
            for (std::size_t k = 1; k < line.size(); ++k) {
                // A line to a failed run would say that there is an error to read off.
                if (content.marks[line[k - 1]].failed || content.marks[line[k]].failed)
                    continue;
                pen.line(layout.marks[line[k - 1]], layout.marks[line[k]], series_colour(series),
                         1.8f);
            }
    const auto x_of = [&](double cost) {
        return static_cast<float>(field.min.x + log_position(layout.cost_range, cost) *
                                                    (field.max.x - field.min.x));
    };
    for (std::size_t i = 0; i < content.marks.size(); ++i) {
        const ChartMark &mark = content.marks[i];
        const ImU32 c = series_colour(content.series[mark.series]);
        if (mark.cost_low > 0 && mark.cost_high > mark.cost_low) {
            const float y = layout.marks[i].y;
            const float left = std::max(x_of(mark.cost_low), field.min.x);
            const float right = std::min(x_of(mark.cost_high), field.max.x);
            pen.line({left, y}, {right, y}, c, 1);
        }
    }
    for (std::size_t i = 0; i < content.marks.size(); ++i) {
        const ChartMark &mark = content.marks[i];
        const ChartSeries &series = content.series[mark.series];
        const glm::vec2 p = layout.marks[i];
        if (mark.failed) {
            pen.cross(p, mark_radius, paper, 5);
            pen.cross(p, mark_radius, series_colour(series), 2.5f);
            continue;
        }
        if (mark.pareto) {
            pen.mark(p, series.style, mark_radius + 4.5f, ink);
            pen.mark(p, series.style, mark_radius + 2.6f, paper);
        } else {
            pen.mark(p, series.style, mark_radius + 1.3f, paper);
        }
        pen.mark(p, series.style, mark_radius, series_colour(series));
    }
    for (const PlacedLabel &label : layout.labels)
        pen.text(label.box.min + glm::vec2(chart_style::label_margin, 0),
                 content.marks[label.mark].label, Face::label, ink);
}

void draw_legend(Pen &pen, const ChartContent &content, const ChartLayout &layout) {
    using chart_style::mark_radius;
    const float left = layout.plot.max.x + 28;
    const float text_left = left + 34;
    const float width = layout.size.x - 20 - text_left;
    float y = layout.plot.min.y + 10;
    constexpr float row = 26;
    for (const ChartSeries &series : content.series) {
        pen.line({left, y}, {left + 24, y}, series_colour(series), 1.8f);
        pen.mark({left + 12, y}, series.style, mark_radius + 1.3f, paper);
        pen.mark({left + 12, y}, series.style, mark_radius, series_colour(series));
        pen.text({text_left, y}, pen.fitted(series.name, Face::axis, width), Face::axis, ink,
                 {0, 0.5f});
        y += row;
    }
    y += 12;
    const auto entry = [&](const std::string &text) {
        pen.text({text_left, y}, text, Face::label, soft_ink, {0, 0.5f});
        y += 23;
    };
    if (!layout.pareto_steps.empty()) {
        pen.line({left, y}, {left + 24, y}, front, 7);
        pen.mark({left + 12, y}, 0, mark_radius + 2.5f, ink);
        pen.mark({left + 12, y}, 0, mark_radius + 0.6f, paper);
        pen.mark({left + 12, y}, 0, mark_radius - 2, faint_ink);
        entry("nothing cheaper is truer");
    }
    if (layout.failed_line) {
        pen.cross({left + 12, y}, mark_radius - 1, soft_ink, 2.2f);
        entry("diverged, or no result");
    }
    if (layout.limit_line) {
        pen.fill({{left, y - 7}, {left + 24, y + 7}}, fine_tint);
        pen.dashed({left, y - 7}, {left + 24, y - 7}, limit_ink, 1.5f, 6, 3);
        entry("true enough");
    }
    if (!content.label_meaning.empty()) {
        // The first label as a sample, where it is not too long.
        if (!content.marks.empty() &&
            pen.text_size(content.marks.front().label, Face::label).x < 30)
            pen.text({left + 12, y}, content.marks.front().label, Face::label, ink, {0.5f, 0.5f});
        entry("label: " + content.label_meaning);
    }
    if (std::any_of(content.marks.begin(), content.marks.end(),
                    [](const ChartMark &mark) { return mark.cost_high > mark.cost_low; })) {
        pen.line({left, y}, {left + 24, y}, faint_ink, 1);
        entry("spread of the timings");
    }
    if (!content.left_out.empty()) {
        y += 12;
        pen.text({left, y}, "Not on this chart", Face::label, soft_ink, {0, 0.5f});
        y += 21;
        for (const std::string &text : content.left_out)
            for (const std::string &line :
                 pen.wrapped(text, Face::footer, layout.size.x - 20 - left)) {
                if (y > layout.plot.max.y - 4)
                    return;
                pen.text({left, y}, line, Face::footer, faint_ink, {0, 0.5f});
                y += 16;
            }
    }
}

void draw_chart(Pen &pen, const ChartContent &content) {
    const ChartLayout layout =
        lay_out(content, [&pen](std::string_view text, float size) -> glm::vec2 {
            // The layout asks for one of our own sizes.
            return pen.text_size(text, size == chart_style::label_text ? Face::label : Face::axis);
        });
    const float left = 40, right = layout.size.x - 40;
    pen.text({left, 30}, pen.fitted(content.title, Face::title, right - left), Face::title, ink);
    pen.text({left, 66}, pen.fitted(content.subtitle, Face::subtitle, right - left), Face::subtitle,
             soft_ink);
    draw_grid(pen, content, layout);
    draw_marks(pen, content, layout);
    draw_legend(pen, content, layout);
    float y = layout.plot.max.y + 66;
    for (const std::string &text : content.footer)
        for (const std::string &line : pen.wrapped(text, Face::footer, right - left)) {
            if (y > layout.size.y - 16)
                return;
            pen.text({left, y}, pen.fitted(line, Face::footer, right - left), Face::footer,
                     faint_ink);
            y += 16;
        }
}

Image reduced(const Image &large) {
    Image small(large.width / supersampling, large.height / supersampling);
    constexpr int count = supersampling * supersampling;
    const auto stride = static_cast<std::size_t>(large.width) * 3;
    std::size_t out = 0;
    for (int y = 0; y < small.height; ++y)
        for (int x = 0; x < small.width; ++x)
            for (std::size_t c = 0; c < 3; ++c) {
                int sum = count / 2;
                for (int j = 0; j < supersampling; ++j)
                    for (int i = 0; i < supersampling; ++i)
                        sum +=
                            large.pixels[static_cast<std::size_t>(y * supersampling + j) * stride +
                                         static_cast<std::size_t>(x * supersampling + i) * 3 + c];
                small.pixels[out++] = static_cast<std::uint8_t>(sum / count);
            }
    return small;
}

// Makes a context current, and puts back the one before.
class CurrentImGui {
  public:
    explicit CurrentImGui(ImGuiContext *context) : before_(ImGui::GetCurrentContext()) {
        ImGui::SetCurrentContext(context);
    }
    ~CurrentImGui() { ImGui::SetCurrentContext(before_); }
    CurrentImGui(const CurrentImGui &) = delete;
    CurrentImGui &operator=(const CurrentImGui &) = delete;

  private:
    ImGuiContext *before_;
};

struct OwnImGui {
    OwnImGui() : before(ImGui::GetCurrentContext()), context(ImGui::CreateContext()) {
        ImGui::SetCurrentContext(before);
        const CurrentImGui current(context);
        ImGui::GetIO().IniFilename = nullptr;
    }
    ~OwnImGui() { ImGui::DestroyContext(context); }
    OwnImGui(const OwnImGui &) = delete;
    OwnImGui &operator=(const OwnImGui &) = delete;
    ImGuiContext *before;
    ImGuiContext *context;
};

} // namespace

struct ChartPainter::Parts {
    std::unique_ptr<GlContext> gl;
    OwnImGui imgui;
    std::array<ImFont *, 5> fonts{};
    std::unique_ptr<ImguiRenderer> renderer;

    ~Parts() { gl->make_current(); } // for the renderer's end
};

ChartPainter::ChartPainter(const std::filesystem::path &shader_dir) {
    ContextRequest request;
    request.off_screen = true;
    auto gl = create_context(request).context;
    parts_ = std::make_unique<Parts>();
    parts_->gl = std::move(gl);
    const CurrentImGui current(parts_->imgui.context);
    for (const Face face : {Face::title, Face::subtitle, Face::axis, Face::label, Face::footer})
        parts_->fonts[static_cast<std::size_t>(face)] =
            load_font(*ImGui::GetIO().Fonts, Pen::font_size(face) * supersampling);
    parts_->renderer = std::make_unique<ImguiRenderer>(shader_dir);
}

ChartPainter::~ChartPainter() = default;

Image ChartPainter::paint(const ChartContent &content) {
    parts_->gl->make_current();
    const CurrentImGui current(parts_->imgui.context);
    const glm::ivec2 size = glm::ivec2(chart_style::size) * supersampling;
    const Image large = paint_image(*parts_->renderer, size, glm::vec3(0.984f, 0.988f, 0.992f),
                                    [&](ImDrawList &list) {
                                        Pen pen(list, parts_->fonts);
                                        draw_chart(pen, content);
                                    });
    return reduced(large);
}

} // namespace plumb
