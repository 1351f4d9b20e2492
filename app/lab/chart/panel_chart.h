// Many small charts on one sheet sharing two logarithmic axes: one panel per query.
#pragma once

#include <string>
#include <vector>

namespace plumb {

class ChartPen;

struct PanelMark {
    double x = 0; // > 0
    double y = 0; // >= 0; 0 is drawn in its own strip
    std::size_t series = 0;
};

struct Panel {
    std::string title;
    std::vector<PanelMark> marks; // joined in this order
};

struct PanelChart {
    std::string title;
    std::string subtitle;
    std::string x_title, y_title;
    std::string x_unit = "s";
    std::string zero_label = "0"; // label of the strip for y == 0
    std::vector<std::string> series;
    std::vector<Panel> panels;
    std::vector<std::string> footer;
};

void draw_panels(ChartPen &pen, const PanelChart &chart);

} // namespace plumb
