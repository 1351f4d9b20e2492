// Draws a stability map.
#pragma once

#include "app/lab/map/map_layout.h"

namespace plumb {

class ChartPen;

// A map with its theory curves and footer.
struct MapPicture {
    StabilityMap map;
    std::vector<TheoryCurve> theory;
    std::vector<std::string> footer;
};

void draw_map(ChartPen &pen, const MapPicture &picture);

} // namespace plumb
