// Resuming an interrupted map.
#pragma once

#include "app/lab/map/stability_map.h"

#include <istream>
#include <string>
#include <vector>

namespace plumb {

// Fingerprint of everything that decides a table row's contents except the row's own method and
// place: the scene's text, the axes' names and scales, the ends of those that vary the scene, the
// options, the program. Rows with another
// fingerprint are useless.
[[nodiscard]] std::string map_fingerprint(const SceneText &scene, const MapAxis &x,
                                          const MapAxis &y, const MapOptions &options);

// The columns that identify a row of a map with these axes.
[[nodiscard]] std::vector<std::string> map_key_columns(const StabilityMap &map);

// The rows of a write_map_csv table that have this fingerprint.
[[nodiscard]] KnownRows read_map_csv(std::istream &in, const std::string &fingerprint);

} // namespace plumb
