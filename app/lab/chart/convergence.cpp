#include "app/lab/chart/convergence.h"

#include "app/lab/run/run_text.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace plumb {

std::string curve_name(const SceneChart &chart, const ChartRun &run) {
    const MethodInfo &method = *run.resolved.method;
    // Whether islands may choose their own substeps in this run.
    const auto chooses = [](const ChartRun &each) {
        return each.resolved.method->chooses_substeps() && each.resolved.settings.max_substeps > 1;
    };
    const auto any_differs = [&](const auto &value) {
        return std::ranges::any_of(
            chart.runs, [&](const ChartRun &other) { return value(other) != value(run); });
    };
    std::string name(method.title);
    const bool both = std::ranges::any_of(chart.runs, [&](const ChartRun &other) {
        return other.resolved.method == &method && chooses(other) != chooses(run);
    });
    const bool swept = std::ranges::any_of(chart.sweep, [](const SweepAxis &axis) {
        return axis.setting.setting().name == "max_substeps";
    });
    if (both && !swept)
        name += chooses(run) ? ", adaptive substeps" : ", fixed substeps";
    if (any_differs([](const ChartRun &each) { return each.resolved.precision; }))
        name += ", " + std::string(precision_name(run.resolved.precision));
    if (any_differs([](const ChartRun &each) { return each.threads; }))
        name += ", " + std::to_string(run.threads) + (run.threads == 1 ? " thread" : " threads");
    return name;
}

std::optional<FittedOrder> fitted_order(std::vector<std::pair<double, double>> errors_by_dt) {
    constexpr double alike = 1.3, least_slope = 0.3;
    std::erase_if(errors_by_dt, [](const auto &point) {
        return !(point.second > 0) || !std::isfinite(point.second);
    });
    std::sort(errors_by_dt.begin(), errors_by_dt.end());
    std::vector<double> x, y;
    for (const auto &[dt, error] : errors_by_dt) {
        x.push_back(std::log(dt));
        y.push_back(std::log(error));
    }
    std::size_t begin = 0, count = 2; // points; a run has at least three
    for (std::size_t first = 0; first + 2 < x.size(); ++first) {
        double low = INFINITY, high = 0;
        for (std::size_t last = first + 1; last < x.size(); ++last) {
            const double slope = (y[last] - y[last - 1]) / (x[last] - x[last - 1]);
            low = std::min(low, slope);
            high = std::max(high, slope);
            if (low < least_slope || high > alike * low)
                break;
            if (last + 1 - first > count) {
                begin = first;
                count = last + 1 - first;
            }
        }
    }
    if (count < 3)
        return std::nullopt;
    double x_mean = 0, y_mean = 0, xx = 0, xy = 0;
    for (std::size_t i = begin; i < begin + count; ++i) {
        x_mean += x[i] / static_cast<double>(count);
        y_mean += y[i] / static_cast<double>(count);
    }
    for (std::size_t i = begin; i < begin + count; ++i) {
        xx += (x[i] - x_mean) * (x[i] - x_mean);
        xy += (x[i] - x_mean) * (y[i] - y_mean);
    }
    return FittedOrder{xy / xx, count};
}

std::vector<CurveOrder> curve_orders(const SceneChart &chart) {
    std::vector<CurveOrder> orders;
    if (!chart.convergence)
        return orders;
    std::vector<std::pair<std::string, std::vector<std::pair<double, double>>>> curves;
    for (const ChartRun &run : chart.runs) {
        const std::string name = curve_name(chart, run);
        if (curves.empty() || curves.back().first != name)
            curves.emplace_back(name, std::vector<std::pair<double, double>>());
        curves.back().second.emplace_back(run.resolved.settings.dt, run.error);
    }
    for (const auto &[name, points] : curves) {
        const auto usable = std::ranges::count_if(points, [](const auto &point) {
            return point.second > 0 && std::isfinite(point.second);
        });
        const auto fitted = fitted_order(points);
        orders.push_back({name, fitted,
                          fitted       ? ""
                          : usable < 3 ? "fewer than three errors above 0"
                                       : "the error does not fall steadily"});
    }
    return orders;
}

std::string order_text(const CurveOrder &order) {
    if (!order.fitted)
        return "no order";
    char text[32];
    std::snprintf(text, sizeof text, "order %.2f", order.fitted->slope);
    return text;
}

} // namespace plumb
