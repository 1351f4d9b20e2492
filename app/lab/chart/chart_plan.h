// Which runs a chart is made of.
#pragma once

#include "app/lab/chart/chart.h"

#include <vector>

namespace plumb {

struct PlannedRun {
    RunOptions options;
    ResolvedRun resolved;
    int threads = 1;
    SweepPoint point;
    const OtherEngine *engine = nullptr; // that runs it; null: ours
};

// Method by method, then engine by engine, and of each: precision by precision, threads by threads,
// point by point; none twice. Notes in `left_out` why a method is not among them.
[[nodiscard]] std::vector<PlannedRun> plan_chart(const SceneDesc &scene,
                                                 const ChartOptions &options,
                                                 const std::vector<SweepAxis> &sweep,
                                                 std::vector<std::string> &left_out);

} // namespace plumb
