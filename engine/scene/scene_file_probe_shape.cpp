#include "engine/scene/scene_file_probe_shape.h"

#include "engine/scene/scene_file_place.h"
#include "engine/scene/scene_file_spelling.h"

#include <algorithm>
#include <fstream>

#define GLM_ENABLE_EXPERIMENTAL // for glm::rotation, the shortest turn between two directions
#include <glm/gtx/quaternion.hpp>

namespace plumb::scene_file {

namespace {

using Kind = ProbeShapeKind;

constexpr std::array<std::string_view, 4> mesh_models{"ball", "torus", "knot", "bowl"};
constexpr std::array<std::string_view, 3> part_names{"circle", "rectangle", "oriented_rectangle"};

// The keys of a shape of that kind, besides `kind`.
std::vector<std::string_view> shape_keys(Kind kind) {
    switch (kind) {
    case Kind::sphere:
    case Kind::circle:
        return {"position", "radius"};
    case Kind::aabb:
    case Kind::rectangle:
        return {"position", "half_extents"};
    case Kind::oriented_rectangle:
        return {"position", "half_extents", "angle", "angle_deg"};
    case Kind::box:
        return {"position", "half_extents", "rotation_deg", "axis", "angle_deg", "orientation"};
    case Kind::capsule:
    case Kind::cylinder:
        return {"position", "half_height", "radius",     "rotation_deg",
                "axis",     "angle_deg",   "orientation"};
    case Kind::plane:
        return {"position", "normal", "rotation_deg", "axis", "angle_deg", "orientation"};
    case Kind::segment:
    case Kind::flat_segment:
    case Kind::triangle:
        return {"points"};
    case Kind::hull:
        return {"position", "points", "rotation_deg", "axis", "angle_deg", "orientation"};
    case Kind::mesh:
        return {"position", "model",        "half_extents", "detail",    "file",
                "scale",    "rotation_deg", "axis",         "angle_deg", "orientation"};
    case Kind::height_field:
        return {"position", "half_extents", "detail"};
    case Kind::compound:
        return {"position", "parts"};
    }
    return {};
}

// Null, with an error, when it cannot be used.
std::shared_ptr<const ObjMesh> load_mesh(const Table &table, const std::filesystem::path &folder,
                                         const std::filesystem::path &name) {
    const std::filesystem::path path = folder / name;
    std::error_code ignored;
    std::ifstream file;
    if (std::filesystem::is_regular_file(path, ignored))
        file.open(path, std::ios::binary);
    if (!file.is_open()) {
        table.error("file", "cannot read " + in_quotes(name.string()),
                    "it must be a file beside the scene");
        return nullptr;
    }
    ObjResult read = read_obj(file, name.string());
    const std::size_t count = read.mesh.triangles.size();
    if (!read.ok()) {
        table.error("file", read.error);
    } else if (count > max_probe_mesh_triangles) {
        table.error("file",
                    in_quotes(name.string()) + " has " + std::to_string(count) + " triangles",
                    "a probe takes at most " + std::to_string(max_probe_mesh_triangles));
    } else {
        return std::make_shared<const ObjMesh>(std::move(read.mesh));
    }
    return nullptr;
}

template <typename HasKey>
void read_sizes(const Table &table, const HasKey &has_key, ProbeShapeDesc &shape) {
    const bool flat = is_flat(shape.kind);
    if (has_key("radius") && table.require("radius", "radius = metres"))
        shape.radius = table.number("radius", positive).value_or(1);
    if (has_key("half_height") && table.require("half_height", "half_height = metres"))
        shape.half_height = table.number("half_height", positive).value_or(1);
    if (has_key("half_extents") &&
        table.require("half_extents", flat ? "half_extents = [x, y] in metres"
                                           : "half_extents = [x, y, z] in metres"))
        shape.half_extents = place(table, "half_extents", flat, positive).value_or(glm::dvec3(1));
    if (has_key("points") && table.require("points", "points = [[x, y, z], ...]")) {
        shape.points = places(table, "points", flat);
        const std::size_t min = shape.kind == Kind::segment || shape.kind == Kind::flat_segment ? 2
                                : shape.kind == Kind::triangle                                  ? 3
                                                                                                : 4;
        const std::size_t max = shape.kind == Kind::hull ? max_probe_points : min;
        if (shape.points.size() < min || shape.points.size() > max)
            table.error("points",
                        table.title() + " has " + std::to_string(shape.points.size()) +
                            " good points",
                        "it takes " + range_text(min, max, "points"));
    }
    if (has_key("detail"))
        shape.detail = static_cast<int>(table.integer("detail", 3, 64).value_or(shape.detail));
}

void read_parent(const Table &table, const ProbeDesc &probe, ProbeShapeDesc &shape) {
    shape.name = table.string("name").value_or("");
    shape.parent = table.string("parent").value_or("");
    const auto is_named = [&](const std::string &name) {
        return std::any_of(probe.shapes.begin(), probe.shapes.end(),
                           [&](const ProbeShapeDesc &other) { return other.name == name; });
    };
    if (!shape.name.empty() && is_named(shape.name))
        table.error("name", "another shape is named " + in_quotes(shape.name),
                    "give it a name of its own");
    if (!shape.parent.empty() && !is_named(shape.parent))
        table.error("parent", "there is no shape " + in_quotes(shape.parent) + " before this",
                    "parents come before their children");
}

} // namespace

std::string range_text(std::size_t min, std::size_t max, const std::string &what) {
    if (min == max)
        return min == 0 ? "no " + what : "exactly " + std::to_string(min) + " " + what;
    return std::to_string(min) + " to " + std::to_string(max) + " " + what;
}

std::optional<ProbeShapeDesc> ProbeShapeReader::read(const toml::node &node, std::string_view array,
                                                     const std::string &of, Words kinds,
                                                     const ProbeDesc *probe) {
    if (!node.is_table()) {
        report_.error(position_of(node),
                      std::string(array) + " holds " + std::string(type_name(node)),
                      "write { kind = " + in_quotes(kinds.front()) + ", radius = 1 }");
        return std::nullopt;
    }
    const toml::table &source = *node.as_table();
    const auto *word = source.get_as<std::string>("kind");
    const auto found = word ? std::find(kinds.begin(), kinds.end(), word->get()) : kinds.end();
    if (found == kinds.end()) {
        report_.error(source.contains("kind") ? position_of(*source.get("kind"))
                                              : position_of(source),
                      word ? "unknown kind " + in_quotes(word->get()) + " of shape"
                           : "a shape of " + of + " has no kind",
                      did_you_mean(word ? word->get() : "", kinds));
        return std::nullopt;
    }
    ProbeShapeDesc shape;
    const std::vector<std::string_view> all = probe_shape_names();
    shape.kind = static_cast<Kind>(std::find(all.begin(), all.end(), *found) - all.begin());
    std::vector<std::string_view> keys = shape_keys(shape.kind);
    const bool has_parent = probe != nullptr && probe->question == ProbeQuestion::models;
    if (has_parent)
        keys.insert(keys.end(), {"name", "parent"});
    const auto has_key = [&](std::string_view key) {
        return std::find(keys.begin(), keys.end(), key) != keys.end();
    };
    keys.emplace_back("kind");
    const Table table(report_, source, "the " + std::string(*found) + " of " + of, keys);
    const bool flat = is_flat(shape.kind);
    shape.position = place(table, "position", flat, moderate).value_or(shape.position);
    if (shape.kind == Kind::mesh)
        read_mesh(table, shape);
    else
        read_sizes(table, has_key, shape);
    if (shape.kind == Kind::compound)
        read_parts(table, shape);
    if (has_key("orientation"))
        shape.orientation = read_rotation(report_, table);
    if (shape.kind == Kind::oriented_rectangle)
        shape.angle = table.angle("angle", moderate).value_or(0);
    if (has_key("normal") &&
        table.one_of({"normal", "rotation_deg", "axis", "orientation"}, false, "") == "normal")
        if (const std::optional<glm::dvec3> normal = table.unit_vector("normal"))
            shape.orientation = glm::rotation(glm::dvec3(0, 1, 0), *normal);
    if (has_parent)
        read_parent(table, *probe, shape);
    return shape;
}

void ProbeShapeReader::read_parts(const Table &table, ProbeShapeDesc &shape) {
    if (!table.require("parts", R"(parts = [{ kind = "circle", ... }, ...])"))
        return;
    const toml::array *array = table.node("parts")->as_array();
    if (!array || array->empty() || array->size() > max_probe_shapes) {
        table.error("parts",
                    table.title() + " has " +
                        (array ? std::to_string(array->size()) + " parts" : "no parts"),
                    "it takes an array of " + range_text(1, max_probe_shapes, "parts"));
        return;
    }
    for (const toml::node &node : *array)
        if (auto part = read(node, "parts", table.title(), part_names, nullptr))
            shape.parts.push_back(std::move(*part));
}

void ProbeShapeReader::read_mesh(const Table &table, ProbeShapeDesc &shape) {
    const std::string_view key =
        table.one_of({"model", "file"}, true,
                     R"(model = "ball", "torus", "knot" or "bowl", or file = "name.obj")");
    if (key == "file") {
        table.refuse({"half_extents", "detail"}, "a mesh from a file",
                     "it is as large and as fine as in the file, times its scale");
        shape.scale = table.number("scale", positive).value_or(shape.scale);
        read_mesh_file(table, shape);
    } else if (key == "model") {
        table.refuse({"scale"}, "a mesh without a file", "its half_extents say its size");
        if (const auto model = table.choice("model", mesh_models))
            shape.model = mesh_models[*model];
        if (table.require("half_extents", "half_extents = [x, y, z] in metres"))
            shape.half_extents =
                place(table, "half_extents", false, positive).value_or(shape.half_extents);
        shape.detail = static_cast<int>(table.integer("detail", 3, 64).value_or(shape.detail));
    }
}

void ProbeShapeReader::read_mesh_file(const Table &table, ProbeShapeDesc &shape) {
    shape.file = table.string("file").value_or("");
    if (!table.node("file")->is_string())
        return;
    const std::filesystem::path name(shape.file);
    // Beside the scene and nowhere else: so a scene from elsewhere reads nothing of one's own,
    // and a saved one can take its meshes along.
    if (name.empty() || name.filename() != name || name == "." || name == "..") {
        table.error("file", in_quotes(shape.file) + " is no name of a file beside the scene",
                    R"(file = "name.obj", without folders)");
        return;
    }
    std::shared_ptr<const ObjMesh> &mesh = mesh_files_[shape.file];
    if (!mesh)
        mesh = load_mesh(table, folder_, name);
    shape.file_mesh = mesh;
}

} // namespace plumb::scene_file
