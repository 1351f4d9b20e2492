// Lays out and draws a chart.
#pragma once

#include "app/lab/chart/chart_layout.h"

namespace plumb {

class ChartPen;

void draw_chart(ChartPen &pen, const ChartContent &content);

} // namespace plumb
