// What write_chart_csv wrote, read again: to go on from, and to merge.
#pragma once

#include "app/lab/chart/chart.h"

#include <istream>
#include <string>
#include <vector>

namespace plumb {

// See Fingerprint: of the scene, the options and what is swept; the shard is not in it.
[[nodiscard]] std::string chart_fingerprint(const SceneDesc &scene, const ChartOptions &options);

// The columns by which rows of the same chart, or of any, are told apart.
[[nodiscard]] std::vector<std::string> chart_key_columns();

// Those finished runs of a table that have this fingerprint; none of a table that is not to be
// understood.
[[nodiscard]] KnownRuns read_known_runs(std::istream &in, const SceneDesc &scene,
                                        const std::string &fingerprint);

// The name of the scene that a table is of; empty when it is no chart's.
[[nodiscard]] std::string scene_of_chart(const std::string &table);

// The chart whose shards these tables are, in any order; rows may come twice. Throws
// std::invalid_argument that says which table is not one of this scene, as it is now, or not of the
// same chart as the first: one with the same settings, by the same commit.
struct NamedTable {
    std::string name; // for messages
    std::string text;
};
[[nodiscard]] SceneChart merged_chart(const SceneDesc &scene,
                                      const std::vector<NamedTable> &tables);

} // namespace plumb
