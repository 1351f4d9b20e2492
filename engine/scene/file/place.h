// Points in a scene file: [x, y, z], or [x, y] for flat shapes. Not for users of the engine.
#pragma once

#include "engine/scene/file/table.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace plumb::scene_file {

// Two numbers in the xy plane when flat, else three.
std::optional<glm::dvec3> place(const Table &table, const toml::node &node, const std::string &name,
                                bool flat, const Bounds &bounds);
std::optional<glm::dvec3> place(const Table &table, std::string_view key, bool flat,
                                const Bounds &bounds);

// The valid points of an array.
std::vector<glm::dvec3> places(const Table &table, std::string_view key, bool flat);

} // namespace plumb::scene_file
