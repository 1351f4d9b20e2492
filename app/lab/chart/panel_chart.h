// Many small charts on one sheet, with the same two logarithmic axes: one panel a query.
#pragma once

#include <string>
#include <vector>

namespace plumb {

class ChartPen;

struct PanelMark {
    double x = 0; // > 0
    double y = 0; // >= 0; zero lies in a strip of its own
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
    std::string zero_label = "0"; // of the strip for y == 0
    std::vector<std::string> series;
    std::vector<Panel> panels;
    std::vector<std::string> footer;
};

void draw_panels(ChartPen &pen, const PanelChart &chart);

} // namespace plumb
