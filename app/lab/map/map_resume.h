// What is left of a map that was interrupted, to go on from.
#pragma once

#include "app/lab/map/stability_map.h"

#include <istream>
#include <string>
#include <vector>

namespace plumb {

// Of all that decides what is in a row of the table, but for the row's own method and place: the
// scene's text, the axes' names and scales, the options, the program. Rows of another are of no
// use.
[[nodiscard]] std::string map_fingerprint(const SceneText &scene, const MapAxis &x,
                                          const MapAxis &y, const MapOptions &options);

// The columns by which rows of maps with these axes are told apart.
[[nodiscard]] std::vector<std::string> map_key_columns(const StabilityMap &map);

// The rows of a table of write_map_csv that have this fingerprint.
[[nodiscard]] KnownRows read_map_csv(std::istream &in, const std::string &fingerprint);

} // namespace plumb
