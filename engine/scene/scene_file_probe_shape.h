// The shapes of a probe of a scene file. Not for users of the engine.
#pragma once

#include "engine/scene/scene_file_table.h"

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace plumb::scene_file {

// How many there may be, in words.
std::string range_text(std::size_t min, std::size_t max, const std::string &what);

class ProbeShapeReader {
  public:
    // Files of meshes are looked for in the folder.
    ProbeShapeReader(Report &report, std::filesystem::path folder)
        : report_(report), folder_(std::move(folder)) {}

    // One of an array of shapes of these kinds. `probe` is what it may have a parent in; parts of
    // shapes have none.
    std::optional<ProbeShapeDesc> read(const toml::node &node, std::string_view array,
                                       const std::string &of, Words kinds, const ProbeDesc *probe);

  private:
    void read_parts(const Table &table, ProbeShapeDesc &shape);
    void read_mesh(const Table &table, ProbeShapeDesc &shape);
    void read_mesh_file(const Table &table, ProbeShapeDesc &shape);

    Report &report_;
    std::filesystem::path folder_;
    std::map<std::string, std::shared_ptr<const ObjMesh>> mesh_files_; // null: with an error
};

} // namespace plumb::scene_file
