// Which runs make up a chart.
#pragma once

#include "app/lab/chart/chart.h"

#include <vector>

namespace plumb {

struct PlannedRun {
    RunOptions options;
    ResolvedRun resolved;
    int threads = 1;
    SweepPoint point;
    const OtherEngine *engine = nullptr; // runs it; null: ours
};

// Ordered by method, then engine, and within each by precision, threads and point; no duplicates.
// Adds to `left_out` why methods are missing.
[[nodiscard]] std::vector<PlannedRun> plan_chart(const SceneDesc &scene,
                                                 const ChartOptions &options,
                                                 const std::vector<SweepAxis> &sweep,
                                                 std::vector<std::string> &left_out);

} // namespace plumb
