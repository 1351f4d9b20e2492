// Files that a scene's shapes are read from. Not for users of the engine.
#pragma once

#include "engine/scene/shape_desc.h"

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>

namespace plumb::scene_file {

class Table;

// Reads each file once.
class ShapeFiles {
  public:
    // Files are looked up in `folder`.
    explicit ShapeFiles(std::filesystem::path folder = {}) : folder_(std::move(folder)) {}

    // The file's triangles, scaled; null, with an error reported, when it is unusable.
    std::shared_ptr<const MeshData> load(const Table &table, const ShapeFile &file);

  private:
    std::shared_ptr<const MeshData> read(const Table &table, const ShapeFile &file) const;

    std::filesystem::path folder_;
    std::map<std::pair<std::string, double>, std::shared_ptr<const MeshData>> loaded_;
};

} // namespace plumb::scene_file
