// How the error falls with dt.
#pragma once

#include "app/lab/chart/chart.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace plumb {

// The slope of log error over log dt, by least squares.
struct FittedOrder {
    double slope = 0;     // 2: half the dt, a quarter of the error
    std::size_t from = 0; // so many points
};

// "Velocity Verlet, double, 2 threads": what tells a run's curve from the others of the chart.
[[nodiscard]] std::string curve_name(const SceneChart &chart, const ChartRun &run);

// Where the error falls by a power of dt: over the longest run of neighbouring points whose slopes
// from one to the next are alike, the greatest at most 1.3 times the least and none below 0.3; the
// finest of runs as long. A dt that is too coarse for the method and the floor that rounding makes
// so stay out of it, as do errors of 0. Nothing with fewer than three such points.
[[nodiscard]] std::optional<FittedOrder>
fitted_order(std::vector<std::pair<double, double>> errors_by_dt);

struct CurveOrder {
    std::string name; // of the curve, as curve_name has it
    std::optional<FittedOrder> fitted;
    std::string why_none; // where there is none
};

// Of each curve of a convergence chart; none of other charts.
[[nodiscard]] std::vector<CurveOrder> curve_orders(const SceneChart &chart);

[[nodiscard]] std::string order_text(const CurveOrder &order); // "order 1.98", "no order"

} // namespace plumb
