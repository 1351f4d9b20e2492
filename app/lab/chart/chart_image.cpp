#include "app/lab/chart/chart_image.h"

#include "app/lab/chart/chart_drawing.h"
#include "app/lab/chart/chart_pen.h"
#include "app/lab/chart/panel_chart.h"
#include "app/lab/map/map_picture.h"
#include "app/render/context.h"
#include "app/render/imgui_renderer.h"

#include <utility>
#include <vector>

#include <imgui/imgui.h>

namespace plumb {

namespace {

// Draws to an ImGui draw list.
class PixelCanvas final : public ChartCanvas {
  public:
    PixelCanvas(ImDrawList &list, const ChartFonts &fonts) : list_(list), fonts_(fonts) {}

    [[nodiscard]] const ChartFonts &fonts() const override { return fonts_; }
    void box(const PixelBox &box, ImU32 c) override {
        list_.AddRectFilled(at(box.min), at(box.max), c);
    }
    void polygon(std::span<const glm::vec2> convex, ImU32 c) override {
        for (const glm::vec2 &p : convex)
            list_.PathLineTo(at(p));
        list_.PathFillConvex(c);
    }
    void stroke(std::span<const glm::vec2> points, ImU32 c, float width) override {
        // Segment by segment with round joints: ImGui's mitres break at sharp turns.
        for (std::size_t i = 1; i < points.size(); ++i) {
            list_.AddLine(at(points[i - 1]), at(points[i]), c, width * supersampling);
            if (i + 1 < points.size())
                list_.AddCircleFilled(at(points[i]), 0.5f * width * supersampling, c);
        }
    }
    void text(glm::vec2 p, std::string_view text, Face face, float scale, ImU32 c) override {
        list_.AddText(fonts_[static_cast<std::size_t>(face)],
                      scale * font_size(face) * supersampling, at(p), c, text.data(),
                      text.data() + text.size());
    }

  private:
    static ImVec2 at(glm::vec2 p) { return {p.x * supersampling, p.y * supersampling}; }

    ImDrawList &list_;
    const ChartFonts &fonts_;
};

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

// Makes a context current and restores the previous one.
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
    ChartFonts fonts{};
    std::unique_ptr<ImguiRenderer> renderer;

    ~Parts() { gl->make_current(); } // for the renderer's destructor
};

ChartPainter::ChartPainter(const std::filesystem::path &shader_dir) {
    ContextRequest request;
    request.off_screen = true;
    auto gl = create_context(request).context;
    parts_ = std::make_unique<Parts>();
    parts_->gl = std::move(gl);
    const CurrentImGui current(parts_->imgui.context);
    parts_->fonts = load_chart_fonts(*ImGui::GetIO().Fonts);
    parts_->renderer = std::make_unique<ImguiRenderer>(shader_dir);
}

ChartPainter::~ChartPainter() = default;

Image ChartPainter::paint(const std::function<void(ChartPen &)> &draw, glm::vec2 extent) {
    parts_->gl->make_current();
    const CurrentImGui current(parts_->imgui.context);
    const glm::ivec2 size = glm::ivec2(extent) * supersampling;
    const Image large = paint_image(*parts_->renderer, size, glm::vec3(0.984f, 0.988f, 0.992f),
                                    [&](ImDrawList &list) {
                                        PixelCanvas canvas(list, parts_->fonts);
                                        ChartPen pen(canvas);
                                        draw(pen);
                                    });
    return reduced(large);
}

Image ChartPainter::paint(const ChartContent &content) {
    return paint([&](ChartPen &pen) { draw_chart(pen, content); }, chart_size(content));
}

Image ChartPainter::paint(const PanelChart &chart) {
    return paint([&](ChartPen &pen) { draw_panels(pen, chart); }, chart_style::size);
}

Image ChartPainter::paint(const MapPicture &picture) {
    return paint([&](ChartPen &pen) { draw_map(pen, picture); }, chart_style::size);
}

} // namespace plumb
