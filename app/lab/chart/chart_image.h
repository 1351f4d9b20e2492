// Draws a chart off screen.
#pragma once

#include "app/lab/chart/chart_layout.h"
#include "app/render/image.h"

#include <filesystem>
#include <functional>
#include <memory>

namespace plumb {

class ChartPen;
struct MapPicture;
struct PanelChart;

// Holds a GL context and a typeface for any number of charts. Restores ImGui's current context but
// not the thread's GL context: a caller that has one must make it current again.
class ChartPainter {
  public:
    // Throws ContextError without a GL context, std::runtime_error if a shader is missing.
    explicit ChartPainter(const std::filesystem::path &shader_dir);
    ~ChartPainter();
    ChartPainter(const ChartPainter &) = delete;
    ChartPainter &operator=(const ChartPainter &) = delete;

    // 1200 x 800 pixels; taller with many series.
    [[nodiscard]] Image paint(const ChartContent &content);
    [[nodiscard]] Image paint(const PanelChart &chart);
    [[nodiscard]] Image paint(const MapPicture &picture);

  private:
    [[nodiscard]] Image paint(const std::function<void(ChartPen &)> &draw, glm::vec2 extent);

    struct Parts;
    std::unique_ptr<Parts> parts_;
};

} // namespace plumb
