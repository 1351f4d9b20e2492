// Reads the shapes of bodies and probes in a scene file. Not for users of the engine.
#pragma once

#include "engine/scene/file/shape_files.h"
#include "engine/scene/file/table.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace plumb::scene_file {

// The field keys of all shape kinds.
const std::vector<std::string_view> &body_shape_keys();
const std::vector<std::string_view> &probe_shape_keys();

// Reads the fields of a shape's kind from its table, and reports keys of other kinds. `precision`
// is the scene's: a hull must be solid in it. False, with an error reported, when the shape is
// unusable; even then it has no null pointers.
bool read_shape_fields(Report &report, ShapeFiles &files, Precision precision, const Table &table,
                       ShapeDesc &shape);
bool read_shape_fields(Report &report, ShapeFiles &files, Precision precision, const Table &table,
                       ProbeShape &shape);

// The index of the kind named by the table's `shape`, in an array of tables; empty, with an error
// reported, when it names none or `node` is not a table.
std::optional<std::size_t> read_shape_kind(Report &report, const toml::node &node,
                                           std::string_view array, const std::string &of,
                                           Words kinds);

// Like read_rotation; a plane may have a `normal` instead.
glm::dquat read_shape_rotation(Report &report, const Table &table, bool is_plane);

// The allowed count in words.
std::string range_text(std::size_t min, std::size_t max, const std::string &what);

} // namespace plumb::scene_file
