#include "engine/scene/cloth.h"
#include "engine/scene/file/number.h"
#include "engine/scene/file/particle.h"
#include "engine/scene/scene_limits.h"

#include <glm/geometric.hpp>

namespace plumb::scene_file {

namespace {

// Describes the first zero-length edge, or else the first vertex used by no triangle.
std::optional<std::string> flaw_of(const MeshData &mesh) {
    std::vector<bool> is_used(mesh.vertices.size());
    for (const std::array<std::uint32_t, 3> &corners : mesh.triangles)
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t a = corners[i];
            const std::uint32_t b = corners[(i + 1) % 3];
            is_used[a] = true;
            if (!(glm::distance(mesh.vertices[a], mesh.vertices[b]) >= positive.min))
                return "its edge from vertex " + std::to_string(a) + " to vertex " +
                       std::to_string(b) + " has no length";
        }
    const auto unused = std::ranges::find(is_used, false);
    if (unused != is_used.end())
        return "its vertex " + std::to_string(unused - is_used.begin()) +
               " is not a corner of any triangle";
    return std::nullopt;
}

// False, with an error reported, when the mesh is unusable.
bool read_mesh(Reading &reading, const Table &table, ClothDesc &cloth) {
    table.refuse({"cells", "size", "shear"}, "a cloth from a file",
                 "its particles and springs are the file's vertices and edges");
    const std::optional<std::string> name = table.string("file");
    if (!name)
        return false;
    const std::filesystem::path path(*name);
    if (name->empty() || path.filename() != path || path == "." || path == "..") {
        table.error("file", in_quotes(*name) + " is not the name of a file beside the scene",
                    R"(file = "name.obj", without folders)");
        return false;
    }
    cloth.file = {*name, table.number("scale", positive).value_or(1)};
    cloth.mesh = reading.files.load(table, cloth.file);
    if (!cloth.mesh)
        return false;
    const std::optional<std::string> flaw = flaw_of(*cloth.mesh);
    if (flaw)
        table.error("file", in_quotes(*name) + " cannot be a cloth: " + *flaw,
                    "each vertex must be a corner of a triangle, and each edge must have a length");
    return !flaw;
}

bool read_grid(const Table &table, ClothDesc &cloth) {
    table.refuse({"scale"}, "a grid", "its size sets its dimensions");
    bool is_read = true;
    if (const toml::node *node = table.node("cells")) {
        const toml::array *counts = node->as_array();
        is_read = counts != nullptr && counts->size() == 2;
        if (!is_read)
            table.error("cells",
                        counts ? "cells has " + std::to_string(counts->size()) + " elements"
                               : "cells is " + std::string(type_name(*node)),
                        "it must be [nx, nz], the cells along x and z");
        for (std::size_t i = 0; is_read && i < 2; ++i) {
            const std::optional<std::int64_t> count = table.integer(
                *counts->get(i), "cells[" + std::to_string(i) + "]", 1, max_cloth_cells);
            if (!count)
                return false;
            cloth.cells[i] = static_cast<int>(*count);
        }
    }
    if (const auto size = table.numbers<2>("size", positive))
        cloth.size = {(*size)[0], (*size)[1]};
    return is_read;
}

// One element of an array of pins; empty, with an error reported, when there is no such particle.
std::optional<std::uint32_t> read_pin(const Table &table, const ClothDesc &cloth,
                                      const toml::node &node, const std::string &name) {
    const auto whole = [&](const toml::node &value, const std::string &of, std::size_t count) {
        return table.integer(value, of, 0, static_cast<std::int64_t>(count) - 1);
    };
    if (cloth.mesh) {
        const std::optional<std::int64_t> vertex = whole(node, name, particle_count(cloth));
        return vertex ? std::optional(static_cast<std::uint32_t>(*vertex)) : std::nullopt;
    }
    const toml::array *pair = node.as_array();
    if (pair == nullptr || pair->size() != 2) {
        table.wrong_type(node, name, "a pair [i, j], the i-th particle along x of the j-th row");
        return std::nullopt;
    }
    const auto columns = static_cast<std::size_t>(cloth.cells[0]) + 1;
    const auto rows = static_cast<std::size_t>(cloth.cells[1]) + 1;
    const std::optional<std::int64_t> i = whole(*pair->get(0), name + "[0]", columns);
    const std::optional<std::int64_t> j = whole(*pair->get(1), name + "[1]", rows);
    if (!i || !j)
        return std::nullopt;
    return static_cast<std::uint32_t>(static_cast<std::size_t>(*j) * columns +
                                      static_cast<std::size_t>(*i));
}

// The pins of a grid that a word stands for.
std::vector<std::uint32_t> pins_called(std::size_t word, const ClothDesc &cloth) {
    const int nx = cloth.cells[0];
    const int nz = cloth.cells[1];
    std::vector<std::uint32_t> pins;
    for (int j = 0; j <= nz; ++j)
        for (int i = 0; i <= nx; ++i) {
            const bool at_x = i == 0 || i == nx;
            const bool at_z = j == 0 || j == nz;
            const bool is_pinned = word == 0 ? at_x && at_z : word == 1 ? j == 0 : at_x || at_z;
            if (is_pinned)
                pins.push_back(static_cast<std::uint32_t>(j * (nx + 1) + i));
        }
    return pins;
}

void read_pins(const Table &table, ClothDesc &cloth) {
    const toml::node *node = table.node("pins");
    if (node == nullptr)
        return;
    if (node->is_string() && !cloth.mesh) {
        static constexpr std::array<std::string_view, 3> words{"corners", "edge", "border"};
        if (const std::optional<std::size_t> word = table.choice("pins", words))
            cloth.pins = pins_called(*word, cloth);
        return;
    }
    const toml::array *array = node->as_array();
    if (array == nullptr) {
        table.wrong_type(*node, "pins",
                         cloth.mesh ? "an array of vertices, from 0"
                                    : R"("corners", "edge", "border" or an array of pairs [i, j])");
        return;
    }
    for (std::size_t i = 0; i < array->size(); ++i)
        if (const std::optional<std::uint32_t> pin =
                read_pin(table, cloth, *array->get(i), "pins[" + std::to_string(i) + "]"))
            cloth.pins.push_back(*pin);
    std::ranges::sort(cloth.pins);
    cloth.pins.erase(std::unique(cloth.pins.begin(), cloth.pins.end()), cloth.pins.end());
}

// The array at `key`; null, with an error reported, unless it has `count` elements.
const toml::array *vectors_at(const Table &table, std::string_view key, std::size_t count) {
    const toml::array *array = table.node(key)->as_array();
    if (array != nullptr && array->size() == count)
        return array;
    table.error(key,
                array ? std::string(key) + " has " + std::to_string(array->size()) + " elements"
                      : std::string(key) + " is " + std::string(type_name(*table.node(key))),
                "it must be an array of " + std::to_string(count) +
                    " vectors, one for each particle");
    return nullptr;
}

void read_state_of(const Table &table, ClothDesc &cloth, std::size_t springs) {
    if (const toml::node *node = table.node("torn")) {
        const toml::array *array = node->as_array();
        if (array == nullptr)
            table.wrong_type(*node, "torn", "an array of springs, from 0");
        for (std::size_t i = 0; array != nullptr && i < array->size(); ++i)
            if (const std::optional<std::int64_t> spring =
                    table.integer(*array->get(i), "torn[" + std::to_string(i) + "]", 0,
                                  static_cast<std::int64_t>(springs) - 1))
                cloth.torn.push_back(static_cast<std::uint32_t>(*spring));
        std::ranges::sort(cloth.torn);
    }
    if (table.has("positions") != table.has("velocities"))
        table.error(table.has("positions") ? "positions" : "velocities",
                    table.title() + " has only one of positions and velocities",
                    "give both, for all its particles");
    if (!table.has("positions") || !table.has("velocities"))
        return;
    const std::size_t count = particle_count(cloth);
    const toml::array *positions = vectors_at(table, "positions", count);
    const toml::array *velocities = vectors_at(table, "velocities", count);
    if (positions == nullptr || velocities == nullptr)
        return;
    for (std::size_t i = 0; i < count; ++i) {
        const std::string index = "[" + std::to_string(i) + "]";
        const auto position = table.numbers<3>(*positions->get(i), "positions" + index, moderate);
        const auto velocity = table.numbers<3>(*velocities->get(i), "velocities" + index, moderate);
        if (!position || !velocity)
            return;
        cloth.particles.push_back({{(*position)[0], (*position)[1], (*position)[2]},
                                   {(*velocity)[0], (*velocity)[1], (*velocity)[2]}});
    }
}

// How many springs cloth_parts makes for a grid.
std::size_t grid_springs(const ClothDesc &cloth) {
    const auto nx = static_cast<std::size_t>(cloth.cells[0]);
    const auto nz = static_cast<std::size_t>(cloth.cells[1]);
    const std::size_t sides = nx * (nz + 1) + nz * (nx + 1);
    const std::size_t bends = (nx - 1) * (nz + 1) + (nz - 1) * (nx + 1);
    return sides + 2 * nx * nz + bends;
}

} // namespace

void read_cloth(Reading &reading, const toml::table &source) {
    static const std::vector<std::string_view> keys = [] {
        std::vector<std::string_view> all;
        for (const std::string_view key : key_names(cloth_keys()))
            if (key != "rotation")
                all.push_back(key);
        all.insert(all.end(), {"rotation_deg", "axis", "angle_deg", "orientation", "scale",
                               "velocities", "torn"});
        return all;
    }();
    const Table table(reading.report, source, title_of("cloth", source), keys);
    ClothDesc cloth;
    cloth.name = read_end_name(reading, table, "cloth", reading.cloths);
    read_members(table, cloth_keys(), cloth);
    cloth.orientation = read_rotation(reading.report, table);
    cloth.material = read_material_name(reading, table);
    cloth.colour = table.colour("color");
    const bool is_made =
        table.has("file") ? read_mesh(reading, table, cloth) : read_grid(table, cloth);
    if (!is_made)
        return;
    const std::size_t count = particle_count(cloth);
    const std::string_view at = cloth.mesh ? "file" : "cells";
    if (!has_room_for(reading, count, max_scene_particles, reading.particle_count, "particles",
                      table.position(at)))
        return;
    const std::size_t springs =
        cloth.mesh ? cloth_parts(cloth).springs.size() : grid_springs(cloth);
    if (!has_room_for(reading, springs, max_scene_springs, reading.spring_count, "springs",
                      table.position(at)))
        return;
    reading.particle_count += count;
    reading.spring_count += springs;
    if (const double each = cloth.mass / static_cast<double>(count); each < positive.min)
        table.error("mass",
                    "each of its " + std::to_string(count) + " particles has a mass of " +
                        shortest(each) + " kg",
                    "it must be " + std::string(positive.text));
    read_pins(table, cloth);
    read_state_of(table, cloth, springs);
    reading.cloths_by_name.try_emplace(cloth.name, reading.scene.cloths.size());
    reading.scene.cloths.push_back(std::move(cloth));
    reading.positions.cloths.push_back(table.position());
}

} // namespace plumb::scene_file
