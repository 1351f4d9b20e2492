#include "engine/scene/file/shape_files.h"

#include "engine/scene/file/table.h"
#include "engine/scene/obj_file.h"
#include "engine/scene/shape_kinds.h"

#include <fstream>
#include <system_error>

namespace plumb::scene_file {

std::shared_ptr<const MeshData> ShapeFiles::load(const Table &table, const ShapeFile &file) {
    std::shared_ptr<const MeshData> &mesh = loaded_[{file.name, file.scale}];
    if (!mesh)
        mesh = read(table, file);
    return mesh;
}

std::shared_ptr<const MeshData> ShapeFiles::read(const Table &table, const ShapeFile &from) const {
    const std::filesystem::path path = folder_ / from.name;
    std::error_code ignored;
    std::ifstream file;
    if (std::filesystem::is_regular_file(path, ignored))
        file.open(path, std::ios::binary);
    if (!file.is_open()) {
        table.error("file", "cannot read " + in_quotes(from.name),
                    "it must be a file beside the scene");
        return nullptr;
    }
    ObjResult found = read_obj(file, from.name);
    const std::size_t count = found.mesh.triangles.size();
    if (!found.ok()) {
        table.error("file", found.error);
        return nullptr;
    }
    if (count > max_mesh_triangles) {
        table.error("file", in_quotes(from.name) + " has " + std::to_string(count) + " triangles",
                    "a scene takes at most " + std::to_string(max_mesh_triangles));
        return nullptr;
    }
    for (glm::dvec3 &vertex : found.mesh.vertices)
        vertex *= from.scale;
    return std::make_shared<const MeshData>(
        MeshData{std::move(found.mesh.vertices), std::move(found.mesh.triangles)});
}

} // namespace plumb::scene_file
