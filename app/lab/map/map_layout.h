// Layout of a stability map: values in, pixels out, nothing drawn.
#pragma once

#include "app/lab/chart/chart_layout.h"
#include "app/lab/map/stability_map.h"

#include <optional>
#include <string>
#include <vector>

namespace plumb {

// A theoretical limit of some methods.
struct TheoryCurve {
    std::string name; // "v dt = thickness + size"
    std::vector<const MethodInfo *> methods;
    std::vector<glm::dvec2> points; // joined; in the units of the axes
};

struct MapText {
    std::string text;
    PixelBox box;
};

struct MapCellBox {
    PixelBox box;
    Failing failing = Failing::none;
    std::optional<MapText> mark; // if there is room: the failing's letter, and the expectation's
};

inline constexpr float limit_radius = 4.7f; // radius of a dot, including its outline

struct MapPanel {
    MapText title;
    PixelBox plot;
    std::vector<MapCellBox> cells;
    std::vector<glm::vec2> limits;
    std::vector<std::vector<glm::vec2>> curves; // clipped to the plot
    std::vector<MapText> x_labels, y_labels;    // only as many as there is room for
};

struct MapLegendEntry {
    enum class Kind { failing, limit, theory, expectation };
    Kind kind = Kind::failing;
    Failing failing = Failing::none;
    PixelBox sample;
    std::string letter; // inside the sample
    MapText text;
};

struct MapLayout {
    glm::vec2 size{0};
    MapText title, subtitle, x_title, y_title;
    std::vector<MapPanel> panels;
    std::vector<MapLegendEntry> legend;
    std::vector<MapText> footer;
};

// No two texts overlap, and none leaves the picture: axis numbers and marks without room are
// dropped, titles are cut, and `footer` (small print) is wrapped.
[[nodiscard]] MapLayout lay_out(const StabilityMap &map, const std::vector<TheoryCurve> &theory,
                                const std::vector<std::string> &footer, const TextSize &text_size);

} // namespace plumb
