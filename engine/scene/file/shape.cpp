#include "engine/scene/file/shape.h"

#include "engine/scene/file/place.h"
#include "engine/scene/file/spelling.h"
#include "engine/scene/obj_file.h"
#include "engine/scene/real/hull_measures.h"
#include "engine/scene/real/solid_shape.h"
#include "engine/scene/shape_fields.h"
#include "engine/scene/shape_models.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#define GLM_ENABLE_EXPERIMENTAL // for glm::rotation, the shortest turn between two directions
#include <glm/gtx/quaternion.hpp>

namespace plumb {

// The header above declares the f32 version; this is its f64 twin, compiled from the same source.
namespace f64 {
HullMeasures measure_hull(std::span<const glm::dvec3>);
}

namespace scene_file {

namespace {

using Points = std::shared_ptr<const std::vector<glm::dvec3>>;

template <typename Shape, std::size_t... i>
std::vector<std::string_view> all_keys(std::index_sequence<i...>) {
    std::vector<std::string_view> keys;
    for (const std::vector<std::string> *of_kind :
         {&fields_of<std::variant_alternative_t<i, Shape>>().keys()...})
        for (const std::string &key : *of_kind)
            if (std::find(keys.begin(), keys.end(), key) == keys.end())
                keys.push_back(key);
    return keys;
}

template <typename Shape> const std::vector<std::string_view> &all_keys() {
    static const std::vector<std::string_view> keys =
        all_keys<Shape>(std::make_index_sequence<std::variant_size_v<Shape>>());
    return keys;
}

// A visitor that reads a kind's fields.
class FieldReader {
  public:
    FieldReader(Report &report, const Table &table, bool is_flat)
        : report_(report), table_(table), is_flat_(is_flat) {}

    void length(std::string_view key, double &value, std::string_view suggestion = {}) {
        keys_.push_back(key);
        if (table_.require(key, suggestion.empty() ? std::string(key) + " = metres"
                                                   : std::string(suggestion)))
            value = table_.number(key, positive).value_or(1);
    }
    void size(std::string_view key, glm::dvec3 &value) {
        keys_.push_back(key);
        if (table_.require(key, std::string(key) + (is_flat_ ? " = [x, y]" : " = [x, y, z]") +
                                    " in metres"))
            value = place(table_, key, is_flat_, positive).value_or(glm::dvec3(1));
    }
    void turn(std::string_view key, double &value) {
        keys_.push_back(key);
        turn_key_ = std::string(key) + "_deg";
        value = table_.angle(key, moderate).value_or(0);
    }
    template <std::size_t count>
    void corners(std::string_view key, std::array<glm::dvec3, count> &value) {
        const std::vector<glm::dvec3> read = points(key, count, count);
        if (read.size() == count)
            std::copy(read.begin(), read.end(), value.begin());
    }
    // Left null on error, such as too few or too many points.
    void cloud(std::string_view key, Points &value) {
        const std::size_t errors = report_.error_count();
        std::vector<glm::dvec3> read = points(key, 4, max_shape_points);
        if (report_.error_count() == errors)
            value = std::make_shared<const std::vector<glm::dvec3>>(std::move(read));
    }
    template <typename... Ways> void either(std::string_view suggestion, const Ways &...ways) {
        suggestion_ = suggestion;
        way_ = table_.one_of({ways.key...}, true, std::string(suggestion));
        has_way_ = !way_.empty();
        (run(ways), ...);
    }
    // A name that must not be opened is left empty.
    void file(ShapeFile &value) {
        keys_.insert(keys_.end(), {"file", "scale"});
        value.name = table_.string("file").value_or("");
        value.scale = table_.number("scale", positive).value_or(value.scale);
        // Only beside the scene: a scene from elsewhere then cannot read the user's files, and a
        // saved scene can take its files along.
        const std::filesystem::path name(value.name);
        if (table_.node("file")->is_string() &&
            (name.empty() || name.filename() != name || name == "." || name == "..")) {
            table_.error("file",
                         in_quotes(value.name) + " is not the name of a file beside the scene",
                         R"(file = "name.obj", without folders)");
            value.name.clear();
        }
    }
    template <typename Word, std::size_t count>
    void word(std::string_view key, Word &value, const std::array<std::string_view, count> &names,
              bool) {
        keys_.push_back(key);
        if (const auto chosen = table_.choice(key, names))
            value = static_cast<Word>(*chosen);
    }
    void whole(std::string_view key, int &value, int min, int max) {
        keys_.push_back(key);
        value = static_cast<int>(table_.integer(key, min, max).value_or(value));
    }
    void surface(std::string_view vertices, std::string_view triangles,
                 std::shared_ptr<const MeshData> &value) {
        MeshData mesh;
        mesh.vertices = points(vertices, 3, 3 * max_mesh_triangles);
        keys_.push_back(triangles);
        if (table_.require(triangles, std::string(triangles) +
                                          " = [[0, 1, 2], ...]: vertices, counted from 0"))
            mesh.triangles = triples(triangles, mesh.vertices.size());
        value = std::make_shared<const MeshData>(std::move(mesh));
    }
    void heights(std::string_view key, HeightFieldDesc &field);
    void parts(std::string_view key, std::vector<FlatPartDesc> &value);

    // Reports each of these keys that is present but was not read.
    void refuse_others(const KindInfo &info, Words all, std::span<const std::string> own) const {
        for (const std::string_view key : all) {
            const bool is_of_rotation =
                key == "angle_deg" && info.placing == Placing::position_and_rotation;
            if (!table_.has(key) || key == turn_key_ || is_of_rotation ||
                std::find(keys_.begin(), keys_.end(), key) != keys_.end())
                continue;
            if (std::find(own.begin(), own.end(), key) == own.end())
                table_.refuse({key}, std::string(info.with_article), std::string(info.size));
            else if (has_way_)
                table_.refuse({key}, std::string(info.with_article) + " with " + std::string(way_),
                              "it has one of " + std::string(suggestion_));
        }
    }

  private:
    template <typename AnyWay> void run(const AnyWay &way) const {
        if (way.key == way_)
            way.fields();
    }
    std::vector<glm::dvec3> points(std::string_view key, std::size_t min, std::size_t max) {
        keys_.push_back(key);
        if (!table_.require(key, std::string(key) + " = [[x, y, z], ...]"))
            return {};
        std::vector<glm::dvec3> all = places(table_, key, is_flat_);
        if (all.size() < min || all.size() > max)
            table_.error(key,
                         table_.title() + " has " + std::to_string(all.size()) + " valid " +
                             std::string(key),
                         "it takes " + range_text(min, max, std::string(key)));
        return all;
    }
    std::vector<std::array<std::uint32_t, 3>> triples(std::string_view key, std::size_t vertices);

    Report &report_;
    const Table &table_;
    bool is_flat_;
    std::vector<std::string_view> keys_; // that were read
    std::string turn_key_;
    std::string_view suggestion_;
    std::string_view way_;
    bool has_way_ = false;
};

std::vector<std::array<std::uint32_t, 3>> FieldReader::triples(std::string_view key,
                                                               std::size_t vertices) {
    std::vector<std::array<std::uint32_t, 3>> all;
    const toml::array *array = table_.node(key)->as_array();
    if (!array || array->empty() || array->size() > max_mesh_triangles) {
        table_.error(key,
                     table_.title() + " has " +
                         (array ? std::to_string(array->size()) : std::string("no")) + " triangles",
                     "it takes an array of " + range_text(1, max_mesh_triangles, "triangles"));
        return all;
    }
    const auto last = static_cast<std::int64_t>(std::max<std::size_t>(vertices, 1)) - 1;
    for (std::size_t i = 0; i < array->size(); ++i) {
        const std::string name = std::string(key) + "[" + std::to_string(i) + "]";
        const toml::array *corners = array->get(i)->as_array();
        if (!corners || corners->size() != 3) {
            table_.wrong_type(*array->get(i), name, "an array of 3 whole numbers");
            continue;
        }
        auto &triangle = all.emplace_back();
        for (std::size_t corner = 0; corner < 3; ++corner)
            triangle[corner] = static_cast<std::uint32_t>(
                table_
                    .integer(*corners->get(corner), name + "[" + std::to_string(corner) + "]", 0,
                             last)
                    .value_or(0));
    }
    return all;
}

void FieldReader::heights(std::string_view key, HeightFieldDesc &field) {
    keys_.push_back(key);
    std::vector<double> all;
    std::size_t columns = 0;
    const toml::array *rows = table_.node(key)->as_array();
    const std::string wanted =
        "it takes two or more rows of two or more heights, all of the same length, at most " +
        std::to_string(max_height_samples) + " heights";
    if (!rows || rows->size() < 2) {
        table_.error(key, table_.title() + " has no rows of heights", wanted);
        return;
    }
    for (std::size_t row = 0; row < rows->size(); ++row) {
        const std::string name = std::string(key) + "[" + std::to_string(row) + "]";
        const toml::array *heights = rows->get(row)->as_array();
        columns = heights && row == 0 ? heights->size() : columns;
        if (!heights || columns < 2 || heights->size() != columns ||
            columns * rows->size() > max_height_samples) {
            report_.error(position_of(*rows->get(row)),
                          name + " has " +
                              std::to_string(heights ? heights->size() : std::size_t(0)) +
                              " heights",
                          wanted);
            return;
        }
        for (std::size_t column = 0; column < columns; ++column)
            all.push_back(table_
                              .number(*heights->get(column),
                                      name + "[" + std::to_string(column) + "]", moderate)
                              .value_or(0));
    }
    field.rows = static_cast<int>(rows->size());
    field.columns = static_cast<int>(columns);
    field.heights = std::make_shared<const std::vector<double>>(std::move(all));
}

void FieldReader::parts(std::string_view key, std::vector<FlatPartDesc> &value) {
    keys_.push_back(key);
    if (!table_.require(key, std::string(key) + R"( = [{ shape = "circle", ... }, ...])"))
        return;
    const toml::array *array = table_.node(key)->as_array();
    if (!array || array->empty() || array->size() > max_probe_shapes) {
        table_.error(key,
                     table_.title() + " has " +
                         (array ? std::to_string(array->size()) + " parts" : "no parts"),
                     "it takes an array of " + range_text(1, max_probe_shapes, "parts"));
        return;
    }
    for (const toml::node &node : *array) {
        FlatPartDesc part;
        const std::optional<std::size_t> kind =
            read_shape_kind(report_, node, key, table_.title(), kind_names<FlatPartShape>());
        if (!kind)
            continue;
        part.shape = shape_of_kind<FlatPartShape>(*kind);
        std::vector<std::string_view> keys = all_keys<FlatPartShape>();
        keys.insert(keys.end(), {"shape", "position"});
        const Table table(
            report_, *node.as_table(),
            "the " + std::string(kind_info(part.shape).name) + " of " + table_.title(), keys);
        part.position = place(table, "position", true, moderate).value_or(part.position);
        std::visit(
            [&]<typename Shape>(Shape &shape) {
                FieldReader reader(report_, table, true);
                Kind<Shape>::fields(shape, reader);
                reader.refuse_others(Kind<Shape>::info, all_keys<FlatPartShape>(),
                                     fields_of<Shape>().keys());
            },
            part.shape);
        value.push_back(std::move(part));
    }
}

// Computes what is derived from the fields.
class Completion {
  public:
    Completion(ShapeFiles &files, Precision precision, const Table &table)
        : files_(files), precision_(precision), table_(table) {}

    // Nothing for most shapes.
    template <typename Shape> void operator()(Shape &) const {}

    void operator()(HullDesc &hull) const {
        if (hull.file && !hull.file->name.empty())
            if (const std::shared_ptr<const MeshData> mesh = files_.load(table_, *hull.file))
                hull.points = Points(mesh, &mesh->vertices);
        if (!hull.points) {
            hull.points = std::make_shared<const std::vector<glm::dvec3>>();
            return;
        }
        const bool is_solid = precision_ == Precision::f64
                                  ? f64::measure_hull(*hull.points).is_solid
                                  : f32::measure_hull(*hull.points).is_solid;
        if (!is_solid)
            table_.error(hull.file ? "file" : "points",
                         "these " + std::to_string(hull.points->size()) +
                             " points have no solid hull",
                         "it takes four that are not coplanar");
    }
    void operator()(MeshDesc &mesh) const {
        if (const auto *file = std::get_if<ShapeFile>(&mesh.source); file && !file->name.empty())
            mesh.data = files_.load(table_, *file);
        else if (const auto *model = std::get_if<MeshModel>(&mesh.source))
            mesh.data = std::make_shared<const MeshData>(make_mesh(*model));
        if (!mesh.data)
            mesh.data = std::make_shared<const MeshData>();
        for (const glm::dvec3 &vertex : mesh.data->vertices)
            if (const glm::dvec3 reach = glm::abs(vertex);
                std::max({reach.x, reach.y, reach.z}) > max_obj_coordinate) {
                table_.error(std::holds_alternative<ShapeFile>(mesh.source) ? "scale" : "vertices",
                             table_.title() + " reaches beyond " + shortest(max_obj_coordinate) +
                                 " m",
                             "make it smaller");
                return;
            }
        if (mesh.sides == MeshSides::solid && !encloses_space(*mesh.data))
            table_.error("sides", table_.title() + " encloses no space, so it cannot be solid",
                         "close it, with its triangles counter-clockwise seen from outside; or "
                         "sides = \"both\"");
    }
    void operator()(HeightFieldDesc &field) const {
        if (field.hills) {
            if (sample_count(*field.hills) <= static_cast<double>(max_height_samples))
                make_heights(field);
            else
                table_.error("half_extents",
                             table_.title() + " would have " +
                                 shortest(sample_count(*field.hills)) + " heights",
                             "at most " + std::to_string(max_height_samples));
        }
        if (!field.heights) {
            field.rows = field.columns = 2;
            field.heights = std::make_shared<const std::vector<double>>(4, 0.0);
        }
    }

  private:
    ShapeFiles &files_;
    Precision precision_;
    const Table &table_;
};

template <typename Shape>
bool read_fields(Report &report, ShapeFiles &files, Precision precision, const Table &table,
                 Shape &shape) {
    const std::size_t errors = report.error_count();
    std::visit(
        [&]<typename S>(S &of_kind) {
            FieldReader reader(report, table, Kind<S>::info.is_flat);
            Kind<S>::fields(of_kind, reader);
            reader.refuse_others(Kind<S>::info, all_keys<Shape>(), fields_of<S>().keys());
            Completion(files, precision, table)(of_kind);
        },
        shape);
    return report.error_count() == errors;
}

} // namespace

std::string range_text(std::size_t min, std::size_t max, const std::string &what) {
    if (min == max)
        return min == 0 ? "no " + what : "exactly " + std::to_string(min) + " " + what;
    return std::to_string(min) + " to " + std::to_string(max) + " " + what;
}

const std::vector<std::string_view> &body_shape_keys() {
    return all_keys<ShapeDesc>();
}
const std::vector<std::string_view> &probe_shape_keys() {
    return all_keys<ProbeShape>();
}

bool read_shape_fields(Report &report, ShapeFiles &files, Precision precision, const Table &table,
                       ShapeDesc &shape) {
    return read_fields(report, files, precision, table, shape);
}
bool read_shape_fields(Report &report, ShapeFiles &files, Precision precision, const Table &table,
                       ProbeShape &shape) {
    return read_fields(report, files, precision, table, shape);
}

std::optional<std::size_t> read_shape_kind(Report &report, const toml::node &node,
                                           std::string_view array, const std::string &of,
                                           Words kinds) {
    if (!node.is_table()) {
        report.error(position_of(node),
                     std::string(array) + " holds " + std::string(type_name(node)),
                     "write { shape = " + in_quotes(kinds.front()) + ", radius = 1 }");
        return std::nullopt;
    }
    const toml::table &source = *node.as_table();
    const auto *word = source.get_as<std::string>("shape");
    const auto found = word ? std::find(kinds.begin(), kinds.end(), word->get()) : kinds.end();
    if (found != kinds.end())
        return static_cast<std::size_t>(found - kinds.begin());
    report.error(source.contains("shape") ? position_of(*source.get("shape")) : position_of(source),
                 word ? "unknown shape " + in_quotes(word->get())
                      : "one of the " + std::string(array) + " of " + of + " has no shape",
                 did_you_mean(word ? word->get() : "", kinds));
    return std::nullopt;
}

glm::dquat read_shape_rotation(Report &report, const Table &table, bool is_plane) {
    const glm::dquat turned = read_rotation(report, table);
    if (!is_plane)
        table.refuse({"normal"}, "a shape other than a plane", "it has a rotation");
    else if (table.one_of({"normal", "rotation_deg", "axis", "orientation"}, false, "") == "normal")
        if (const std::optional<glm::dvec3> normal = table.unit_vector("normal"))
            return glm::rotation(glm::dvec3(0, 1, 0), *normal);
    return turned;
}

} // namespace scene_file

} // namespace plumb
