// How the error falls with dt.
#pragma once

#include "app/lab/chart/chart.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace plumb {

// Least-squares slope of log error over log dt.
struct FittedOrder {
    double slope = 0;     // 2: half the dt, a quarter of the error
    std::size_t from = 0; // number of points fitted
};

// "Velocity Verlet, double, 2 threads": tells a run's curve from the chart's others.
[[nodiscard]] std::string curve_name(const SceneChart &chart, const ChartRun &run);

// Fits the range where the error follows a power of dt: the longest run of neighbouring points
// whose slopes from one to the next agree, the greatest at most 1.3 times the least and none below
// 0.3; of equally long runs, the finest. This leaves out a dt too coarse for the method and the
// round-off floor; errors of 0 are left out too. Empty with fewer than three such points.
[[nodiscard]] std::optional<FittedOrder>
fitted_order(std::vector<std::pair<double, double>> errors_by_dt);

struct CurveOrder {
    std::string name; // curve_name
    std::optional<FittedOrder> fitted;
    std::string why_none; // why nothing was fitted
};

// One per curve of a convergence chart; empty for other charts.
[[nodiscard]] std::vector<CurveOrder> curve_orders(const SceneChart &chart);

[[nodiscard]] std::string order_text(const CurveOrder &order); // "order 1.98", "no order"

} // namespace plumb
