// The cost of building and refitting trees, from a thousand leaves to a million.
#pragma once

#include "app/lab/chart/chart_layout.h"
#include "app/lab/timing.h"

#include <ostream>
#include <string>
#include <vector>

namespace plumb {

struct TreeCost {
    std::string work; // "static BVH, build"
    std::size_t leaves = 0;
    std::vector<double> timings; // s
};

// Boxes sized so that each touches a few others.
[[nodiscard]] std::vector<TreeCost> time_trees(std::size_t largest, const TimingOptions &options);

void print(std::ostream &out, const std::vector<TreeCost> &costs);
void write_tree_csv(std::ostream &out, const std::vector<TreeCost> &costs);
[[nodiscard]] ChartContent tree_chart(const std::vector<TreeCost> &costs,
                                      const std::string &command);

} // namespace plumb
