// The probes of a scene file.
#pragma once

#include "engine/scene/scene_desc.h"

#include <vector>

namespace plumb {

namespace scene_file {
class Report;
class ShapeFiles;
class Table;
} // namespace scene_file

// Reports every error, including probes that the geometry refuses to answer in that precision.
std::vector<ProbeDesc> read_probes(scene_file::Report &report, const scene_file::Table &top,
                                   Precision precision, scene_file::ShapeFiles &files);

} // namespace plumb
