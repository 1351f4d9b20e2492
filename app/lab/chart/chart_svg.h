// Charts and maps as scalable vector graphics: what their pixels show, as text. Needs no GL
// context.
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
