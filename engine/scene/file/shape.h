// Shapes of a scene file: those of bodies and those of probes. Not for users of the engine.
#pragma once

#include "engine/scene/file/shape_files.h"
#include "engine/scene/file/table.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace plumb::scene_file {

// The keys that the sizes of any kind of shape are said with.
const std::vector<std::string_view> &body_shape_keys();
const std::vector<std::string_view> &probe_shape_keys();

// Reads the fields of a shape's kind from its table, whose other keys may be those of other kinds,
// and then says so. `precision` is what the scene runs in: a hull must be solid in it. False,
// having reported it, when the shape cannot be used; it is then one without null pointers.
bool read_shape_fields(Report &report, ShapeFiles &files, Precision precision, const Table &table,
                       ShapeDesc &shape);
bool read_shape_fields(Report &report, ShapeFiles &files, Precision precision, const Table &table,
                       ProbeShape &shape);

// Which of the kinds the table's `shape` names, in an array of tables; empty, having reported it,
// when it names none or `node` is no table.
std::optional<std::size_t> read_shape_kind(Report &report, const toml::node &node,
                                           std::string_view array, const std::string &of,
                                           Words kinds);

// As read_rotation; a plane may have a `normal` instead.
glm::dquat read_shape_rotation(Report &report, const Table &table, bool is_plane);

// How many there may be, in words.
std::string range_text(std::size_t min, std::size_t max, const std::string &what);

} // namespace plumb::scene_file
