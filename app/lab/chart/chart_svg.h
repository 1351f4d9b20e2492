// Charts and maps as SVG, showing the same as their pixels. Needs no GL context.
#pragma once

#include "app/lab/chart/chart_layout.h"

#include <ostream>

namespace plumb {

struct MapPicture;
struct PanelChart;

void write_chart_svg(std::ostream &out, const ChartContent &content);
void write_chart_svg(std::ostream &out, const MapPicture &picture);
void write_chart_svg(std::ostream &out, const PanelChart &chart);

} // namespace plumb
