#include "tests/bench/trees.h"

#include "app/lab/csv.h"
#include "engine/space/bvh.h"
#include "engine/space/dynamic_tree.h"
#include "engine/space/orthtree.h"
#include "tests/bench/inputs.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

namespace plumb {

namespace {

std::vector<Aabb> boxes(std::size_t count) {
    Random random(count);
    const double side = 1.5 * std::cbrt(static_cast<double>(count));
    std::vector<Aabb> result;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3 center = inputs::vector(random, side),
                   half = 0.1f + glm::abs(inputs::vector(random, 0.9));
        result.push_back({center - half, center + half});
    }
    return result;
}

std::vector<Aabb> moved(std::vector<Aabb> boxes) {
    Random random(5);
    for (Aabb &box : boxes) {
        const Vec3 by = inputs::vector(random, 0.2);
        box = {box.min + by, box.max + by};
    }
    return boxes;
}

} // namespace

std::vector<TreeCost> time_trees(std::size_t largest, const TimingOptions &options) {
    std::vector<TreeCost> costs;
    std::vector<std::function<std::uint64_t()>> works;
    const auto add = [&](const char *work, std::size_t leaves,
                         std::function<std::uint64_t()> function) {
        costs.push_back({work, leaves, {}});
        works.push_back(std::move(function));
    };
    for (std::size_t leaves = 1000; leaves <= largest; leaves *= 10) {
        const auto at = std::make_shared<const std::vector<Aabb>>(boxes(leaves));
        const auto later = std::make_shared<const std::vector<Aabb>>(moved(*at));
        const auto bvh = std::make_shared<Bvh>(*at);
        add("static BVH, build", leaves, [at] { return Bvh(*at).nodes().size(); });
        add("static BVH, refit", leaves, [bvh, later] {
            bvh->refit(*later);
            return bvh->nodes().size();
        });
        add("dynamic tree, insert all", leaves, [at] {
            DynamicTree tree(0);
            for (std::size_t i = 0; i < at->size(); ++i)
                tree.insert((*at)[i], static_cast<std::uint32_t>(i));
            return static_cast<std::uint64_t>(tree.height());
        });
        add("octree, insert all", leaves, [at] {
            Aabb world;
            for (const Aabb &box : *at) {
                world.min = glm::min(world.min, box.min);
                world.max = glm::max(world.max, box.max);
            }
            Octree tree(world, 8, 8);
            for (std::size_t i = 0; i < at->size(); ++i)
                tree.insert((*at)[i], static_cast<std::uint32_t>(i));
            return tree.size();
        });
    }
    const std::vector<std::vector<double>> times = time_interleaved(works, options);
    for (std::size_t i = 0; i < costs.size(); ++i)
        costs[i].timings = times[i];
    return costs;
}

void print(std::ostream &out, const std::vector<TreeCost> &costs) {
    char line[120];
    for (const TreeCost &cost : costs) {
        std::snprintf(line, sizeof line, "%-28s %9zu leaves %12.3f ms %9.1f ns per leaf\n",
                      cost.work.c_str(), cost.leaves, 1e3 * median(cost.timings),
                      1e9 * median(cost.timings) / static_cast<double>(cost.leaves));
        out << line;
    }
}

void write_tree_csv(std::ostream &out, const std::vector<TreeCost> &costs) {
    CsvWriter csv(out);
    csv.cell("work").cell("leaves").cell("s").cell("ns_per_leaf").end_row();
    for (const TreeCost &cost : costs) {
        const double seconds = median(cost.timings);
        csv.cell(cost.work)
            .cell(static_cast<std::uint64_t>(cost.leaves))
            .cell(seconds)
            .cell(1e9 * seconds / static_cast<double>(cost.leaves));
        csv.end_row();
    }
}

ChartContent tree_chart(const std::vector<TreeCost> &costs, const std::string &command) {
    ChartContent chart;
    chart.title = "Trees: build and refit";
    chart.subtitle = "A flat line is work in proportion to the number of leaves";
    chart.cost_title = "leaves";
    chart.cost_unit = "1";
    chart.error_title = "CPU time per leaf";
    chart.error_unit = "s";
    for (const TreeCost &cost : costs) {
        if (cost.timings.empty())
            continue;
        const auto same = std::find_if(chart.series.begin(), chart.series.end(),
                                       [&](const ChartSeries &s) { return s.name == cost.work; });
        const auto series = static_cast<std::size_t>(same - chart.series.begin());
        if (same == chart.series.end())
            chart.series.push_back({cost.work, series, {{}}});
        ChartMark mark;
        mark.cost = mark.cost_low = mark.cost_high = static_cast<double>(cost.leaves);
        mark.error = median(cost.timings) / static_cast<double>(cost.leaves);
        mark.series = series;
        chart.series[series].lines.front().push_back(chart.marks.size());
        chart.marks.push_back(mark);
    }
    chart.footer.push_back(command);
    return chart;
}

} // namespace plumb
