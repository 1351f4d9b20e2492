// The files that shapes of a scene file are read from. Not for users of the engine.
#pragma once

#include "engine/scene/shape_desc.h"

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>

namespace plumb::scene_file {

class Table;

// Each is read once.
class ShapeFiles {
  public:
    // They are looked for in the folder.
    explicit ShapeFiles(std::filesystem::path folder = {}) : folder_(std::move(folder)) {}

    // Its triangles with the numbers scaled; null, having reported it, when it cannot be used.
    std::shared_ptr<const MeshData> load(const Table &table, const ShapeFile &file);

  private:
    std::shared_ptr<const MeshData> read(const Table &table, const ShapeFile &file) const;

    std::filesystem::path folder_;
    std::map<std::pair<std::string, double>, std::shared_ptr<const MeshData>> loaded_;
};

} // namespace plumb::scene_file
