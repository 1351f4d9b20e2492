// Reads write_chart_csv's tables back, to resume or merge charts.
#pragma once

#include "app/lab/chart/chart.h"

#include <istream>
#include <string>
#include <vector>

namespace plumb {

// Fingerprint of the scene, the options and the sweep, but not the shard.
[[nodiscard]] std::string chart_fingerprint(const SceneDesc &scene, const ChartOptions &options);

// The columns that identify a row, within one chart or across charts.
[[nodiscard]] std::vector<std::string> chart_key_columns();

// The table's finished runs with this fingerprint; none if the table cannot be read.
[[nodiscard]] KnownRuns read_known_runs(std::istream &in, const SceneDesc &scene,
                                        const std::string &fingerprint);

// The table's scene name; empty if it is not a chart's table.
[[nodiscard]] std::string scene_of_chart(const std::string &table);

// Merges shards, in any order; rows may repeat. Throws std::invalid_argument naming a table that
// does not match the scene as it is now, or that is not from the first table's chart: same
// settings, same commit.
struct NamedTable {
    std::string name; // for messages
    std::string text;
};
[[nodiscard]] SceneChart merged_chart(const SceneDesc &scene,
                                      const std::vector<NamedTable> &tables);

} // namespace plumb
