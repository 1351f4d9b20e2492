#include "engine/scene/scene_file_probe.h"

#include "engine/scene/probe.h"
#include "engine/scene/scene_file_table.h"

#include <fstream>
#include <memory>

#include <glm/geometric.hpp>
#define GLM_ENABLE_EXPERIMENTAL // for glm::rotation, the shortest turn between two directions
#include <glm/gtx/quaternion.hpp>

namespace plumb {

namespace {

using namespace scene_file;
using Kind = ProbeShapeKind;

constexpr std::array<std::string_view, 4> mesh_models{"ball", "torus", "knot", "bowl"};
constexpr std::array<std::string_view, 3> tree_names{"quadtree", "octree", "bvh"};
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

// Two numbers in the xy plane, else three.
std::optional<glm::dvec3> place(const Table &table, const toml::node &node, const std::string &name,
                                bool flat, const Bounds &bounds) {
    if (flat) {
        const auto n = table.numbers<2>(node, name, bounds);
        return n ? std::optional(glm::dvec3((*n)[0], (*n)[1], 0)) : std::nullopt;
    }
    const auto n = table.numbers<3>(node, name, bounds);
    return n ? std::optional(glm::dvec3((*n)[0], (*n)[1], (*n)[2])) : std::nullopt;
}
std::optional<glm::dvec3> place(const Table &table, std::string_view key, bool flat,
                                const Bounds &bounds) {
    const toml::node *node = table.node(key);
    return node ? place(table, *node, std::string(key), flat, bounds) : std::nullopt;
}

std::vector<glm::dvec3> places(const Table &table, std::string_view key, bool flat) {
    std::vector<glm::dvec3> all;
    const toml::node *node = table.node(key);
    if (!node)
        return all;
    const toml::array *array = node->as_array();
    if (!array) {
        table.wrong_type(*node, std::string(key), "an array of points");
        return all;
    }
    for (std::size_t i = 0; i < array->size(); ++i)
        if (const auto point =
                place(table, *array->get(i), std::string(key) + "[" + std::to_string(i) + "]", flat,
                      moderate))
            all.push_back(*point);
    return all;
}

std::string range_text(std::size_t min, std::size_t max, const std::string &what) {
    if (min == max)
        return min == 0 ? "no " + what : "exactly " + std::to_string(min) + " " + what;
    return std::to_string(min) + " to " + std::to_string(max) + " " + what;
}

class ProbeReader {
  public:
    ProbeReader(Report &report, Precision precision, std::filesystem::path folder)
        : report_(report), precision_(precision), folder_(std::move(folder)) {}

    void read(const toml::table &source) {
        static constexpr std::array<std::string_view, 17> keys{
            "name",    "ask",    "shapes",  "points",    "point", "ray",
            "segment", "camera", "scatter", "tree",      "level", "margin",
            "motion",  "scale",  "expect",  "tolerance", "source"};
        const std::size_t errors = report_.error_count();
        const Table table(report_, source, title_of("probe", source), keys);
        ProbeDesc probe;
        probe.name = read_name(report_, table, "probe", names_).value_or("");
        std::vector<std::string_view> questions;
        for (const ProbeQuestionInfo &info : probe_questions())
            questions.push_back(info.name);
        if (!table.require("ask", "what is asked? " + did_you_mean("", questions)))
            return;
        const std::optional<std::size_t> chosen = table.choice("ask", questions);
        if (!chosen)
            return;
        probe.question = static_cast<ProbeQuestion>(*chosen);
        const ProbeQuestionInfo &info = probe_question(probe.question);
        const std::string asked = "ask = " + in_quotes(info.name);
        refuse_what_is_not_asked(table, info, asked);
        read_tree(table, info, probe);
        read_shapes(table, info, asked, probe);
        const bool flat = is_flat(probe);
        read_points(table, info, asked, flat, probe);
        read_ray(table, info, flat, probe);
        read_camera(table, info, probe);
        read_scatter(table, info, flat, probe);
        if (info.does_take("margin"))
            probe.margin = table.number("margin", not_negative).value_or(probe.margin);
        if (info.does_take("motion") &&
            table.require("motion", "motion = [x, y, z] of the first shape, metres"))
            probe.motion = place(table, "motion", false, moderate).value_or(glm::dvec3(0, 1, 0));
        if (info.does_take("scale"))
            probe.scale = table.vector("scale", moderate).value_or(probe.scale);
        read_expects(table, info, asked, probe);
        if (report_.error_count() != errors)
            return;
        if (const ProbeAnswer found = answer(probe, precision_); !found.refusal.empty())
            report_.error(table.position(), table.title() + " has no answer: " + found.refusal,
                          "ask something that the geometry can answer");
        probes_.push_back(std::move(probe));
    }

    std::vector<ProbeDesc> take() { return std::move(probes_); }

  private:
    void refuse_what_is_not_asked(const Table &table, const ProbeQuestionInfo &info,
                                  const std::string &asked) {
        const std::string suggestion = "it is about " + std::string(info.about);
        if (info.shapes.max == 0)
            table.refuse({"shapes"}, asked, suggestion);
        if (info.points.max == 0)
            table.refuse({"points", "point"}, asked, suggestion);
        for (const char *key :
             {"ray", "segment", "camera", "scatter", "tree", "level", "margin", "motion", "scale"})
            if (!info.does_take(key))
                table.refuse({key}, asked, suggestion);
    }

    static void read_tree(const Table &table, const ProbeQuestionInfo &info, ProbeDesc &probe) {
        if (!info.does_take("tree"))
            return;
        if (table.require("tree", R"(tree = "quadtree", "octree" or "bvh")"))
            if (const auto chosen = table.choice("tree", tree_names))
                probe.tree = static_cast<ProbeTree>(*chosen);
        probe.level = static_cast<int>(table.integer("level", -1, 64).value_or(-1));
    }

    void read_shapes(const Table &table, const ProbeQuestionInfo &info, const std::string &asked,
                     ProbeDesc &probe) {
        if (info.shapes.max == 0)
            return;
        const toml::node *node = table.node("shapes");
        const toml::array *array = node ? node->as_array() : nullptr;
        if (node && !array)
            table.wrong_type(*node, "shapes", R"(an array: [{ kind = "sphere", ... }, ...])");
        const std::size_t count = array ? array->size() : 0;
        if (count < info.shapes.min || count > info.shapes.max) {
            table.error("shapes",
                        table.title() + " has " + std::to_string(count) +
                            (count == 1 ? " shape" : " shapes"),
                        asked + " takes " + range_text(info.shapes.min, info.shapes.max, "shapes"));
            return;
        }
        for (std::size_t i = 0; i < count; ++i)
            if (auto shape = read_shape(*array->get(i), "shapes", table.title(),
                                        probe_shape_names(), &probe))
                probe.shapes.push_back(std::move(*shape));
    }

    // One of an array of shapes of these kinds. `probe` is what it may have a parent in; parts of
    // shapes have none.
    std::optional<ProbeShapeDesc> read_shape(const toml::node &node, std::string_view array,
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

    void read_parts(const Table &table, ProbeShapeDesc &shape) {
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
            if (auto part = read_shape(node, "parts", table.title(), part_names, nullptr))
                shape.parts.push_back(std::move(*part));
    }

    void read_mesh(const Table &table, ProbeShapeDesc &shape) {
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

    void read_mesh_file(const Table &table, ProbeShapeDesc &shape) {
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
            mesh = load_mesh(table, name);
        shape.file_mesh = mesh;
    }

    // Null, with an error, when it cannot be used.
    std::shared_ptr<const ObjMesh> load_mesh(const Table &table,
                                             const std::filesystem::path &name) {
        const std::filesystem::path path = folder_ / name;
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
            shape.half_extents =
                place(table, "half_extents", flat, positive).value_or(glm::dvec3(1));
        if (has_key("points") && table.require("points", "points = [[x, y, z], ...]")) {
            shape.points = places(table, "points", flat);
            const std::size_t min = shape.kind == Kind::segment || shape.kind == Kind::flat_segment
                                        ? 2
                                    : shape.kind == Kind::triangle ? 3
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

    static void read_parent(const Table &table, const ProbeDesc &probe, ProbeShapeDesc &shape) {
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

    void read_points(const Table &table, const ProbeQuestionInfo &info, const std::string &asked,
                     bool flat, ProbeDesc &probe) {
        if (info.points.max == 0)
            return;
        const std::string_view key = table.one_of({"point", "points"}, false, "");
        if (key == "point") {
            if (const auto point = place(table, key, flat, moderate))
                probe.points.push_back(*point);
        } else if (key == "points") {
            probe.points = places(table, key, flat);
        }
        if (probe.points.size() < info.points.min || probe.points.size() > info.points.max)
            table.error(key.empty() ? "points" : key,
                        table.title() + " has " + std::to_string(probe.points.size()) +
                            (probe.points.size() == 1 ? " good point" : " good points"),
                        asked + " takes " + range_text(info.points.min, info.points.max, "points"));
    }

    void read_ray(const Table &table, const ProbeQuestionInfo &info, bool flat, ProbeDesc &probe) {
        if (!info.does_take("ray"))
            return;
        const bool needed = probe.question != ProbeQuestion::tree;
        const std::string_view key = table.one_of(
            {"ray", "segment"}, needed,
            "ray = { origin = [x, y, z], direction = [x, y, z] }, or segment = [a, b]");
        if (key.empty())
            return;
        ProbeRayDesc ray;
        if (key == "segment") {
            const std::vector<glm::dvec3> ends = places(table, key, flat);
            if (ends.size() != 2) {
                table.error(key, "segment has " + std::to_string(ends.size()) + " good ends",
                            "it has two: segment = [[x, y, z], [x, y, z]]");
                return;
            }
            ray.origin = ends[0];
            ray.end = ends[1];
        } else {
            const toml::table *source =
                table_at(report_, table, key, "ray = { origin = [...], direction = [...] }");
            if (!source)
                return;
            static constexpr std::array<std::string_view, 3> keys{"origin", "direction", "max_t"};
            const Table sub(report_, *source, "ray of " + table.title(), keys);
            if (sub.require("origin", "origin = [x, y, z]"))
                ray.origin = place(sub, "origin", flat, moderate).value_or(ray.origin);
            if (sub.require("direction", "direction = [x, y, z], of any length but zero"))
                ray.direction = place(sub, "direction", flat, moderate).value_or(ray.direction);
            ray.max_t = sub.number("max_t", not_negative);
        }
        if (ray.direction == glm::dvec3(0))
            table.error(key, std::string(key) + " has no direction",
                        "a direction of any length but zero");
        probe.ray = ray;
    }

    void read_camera(const Table &table, const ProbeQuestionInfo &info, ProbeDesc &probe) {
        if (!info.does_take("camera") ||
            !table.require("camera", "camera = { eye = [x, y, z], target = [x, y, z] }"))
            return;
        const toml::table *source =
            table_at(report_, table, "camera", "camera = { eye = [...], target = [...] }");
        if (!source)
            return;
        static constexpr std::array<std::string_view, 9> keys{
            "eye", "target", "fov", "fov_deg", "height", "aspect", "near", "far", "pixel"};
        static constexpr Bounds view{1, 170, "a number from 1 to 170"};
        const Table sub(report_, *source, "camera of " + table.title(), keys);
        ProbeCameraDesc camera;
        if (sub.require("eye", "eye = [x, y, z]"))
            camera.eye = sub.vector("eye", moderate).value_or(camera.eye);
        if (sub.require("target", "target = [x, y, z]"))
            camera.target = sub.vector("target", moderate).value_or(camera.target);
        if (camera.eye == camera.target)
            sub.error("target", "the camera looks at its own eye", "eye and target must differ");
        camera.fov = sub.angle("fov", view).value_or(camera.fov);
        camera.height = sub.number("height", positive);
        camera.aspect = sub.number("aspect", positive).value_or(camera.aspect);
        camera.near = sub.number("near", positive).value_or(camera.near);
        camera.far = sub.number("far", positive).value_or(camera.far);
        if (!(camera.near < camera.far))
            sub.error("far",
                      "far is " + shortest(camera.far) + " and near " + shortest(camera.near),
                      "far must lie beyond near");
        if (probe.question == ProbeQuestion::pick) {
            if (sub.require("pixel", "pixel = [x, y] from the top left of a picture 100 high"))
                if (const auto pixel = sub.numbers<2>("pixel", moderate))
                    camera.pixel = glm::dvec2((*pixel)[0], (*pixel)[1]);
        } else {
            sub.refuse({"pixel"}, "a camera that picks nothing", R"(ask = "pick" has one)");
        }
        probe.camera = camera;
    }

    void read_scatter(const Table &table, const ProbeQuestionInfo &info, bool flat,
                      ProbeDesc &probe) {
        if (!info.does_take("scatter"))
            return;
        if (!table.has("scatter")) {
            const bool is_mesh =
                probe.shapes.size() == 1 && probe.shapes.front().kind == Kind::mesh;
            if (probe.question == ProbeQuestion::enclose && probe.points.empty())
                table.error("points", table.title() + " has neither points nor a scatter",
                            "points = [[x, y], ...]");
            else if (probe.question != ProbeQuestion::enclose && !is_mesh)
                table.require("scatter", "scatter = { count = 100, half_extents = [x, y, z] }");
            return;
        }
        const toml::table *source =
            table_at(report_, table, "scatter", "scatter = { count = 100, half_extents = [...] }");
        if (!source)
            return;
        static constexpr std::array<std::string_view, 5> keys{"count", "center", "half_extents",
                                                              "size", "seed"};
        const Table sub(report_, *source, "scatter of " + table.title(), keys);
        ProbeScatterDesc scatter;
        if (sub.require("count", "how many, a whole number"))
            scatter.count = static_cast<int>(sub.integer("count", 1, max_probe_items).value_or(1));
        scatter.center = place(sub, "center", flat, moderate).value_or(scatter.center);
        if (sub.require("half_extents", "half_extents = [x, y, z] of the region"))
            scatter.half_extents =
                place(sub, "half_extents", flat, positive).value_or(scatter.half_extents);
        if (flat)
            scatter.half_extents.z = 0;
        scatter.size = sub.number("size", positive).value_or(scatter.size);
        scatter.seed = sub.natural("seed").value_or(scatter.seed);
        probe.scatter = scatter;
    }

    void read_expects(const Table &table, const ProbeQuestionInfo &info, const std::string &asked,
                      ProbeDesc &probe) {
        const toml::table *source = table_at(report_, table, "expect", "expect = { hit = true }");
        if (!source) {
            table.refuse({"tolerance", "source"}, "a probe that expects nothing",
                         "expect = { ... } says what");
            return;
        }
        for (const auto &[key, node] : *source) {
            const auto found = std::find(info.values.begin(), info.values.end(), key.str());
            if (found == info.values.end()) {
                report_.error(position_of(key.source()),
                              asked + " has no value " + in_quotes(key.str()),
                              did_you_mean(key.str(), info.values));
                continue;
            }
            if (const auto *flag = node.as_boolean())
                probe.expects.push_back({std::string(*found), flag->get() ? 1.0 : 0.0});
            else if (const auto number = table.number(node, std::string(*found), finite))
                probe.expects.push_back({std::string(*found), *number});
        }
        probe.tolerance = table.number("tolerance", not_negative).value_or(0);
        if (table.require("source", "where do the numbers come from?")) {
            probe.source = table.string("source").value_or("?");
            if (probe.source.find_first_not_of(" \t\r\n") == std::string::npos)
                table.error("source", "the source is empty", "where do the numbers come from?");
        }
    }

    Report &report_;
    Precision precision_;
    std::filesystem::path folder_;
    std::map<std::string, std::shared_ptr<const ObjMesh>> mesh_files_; // null: with an error
    Names names_;
    std::vector<ProbeDesc> probes_;
};

} // namespace

std::vector<ProbeDesc> read_probes(Report &report, const Table &top, Precision precision,
                                   const std::filesystem::path &folder) {
    ProbeReader reader(report, precision, folder);
    std::size_t count = 0;
    for_each(report, top, "probe", [&](const toml::table &table) {
        if (++count <= max_scene_probes)
            reader.read(table);
        else if (count == max_scene_probes + 1)
            report.error(position_of(table), "too many probes",
                         "a scene holds at most " + std::to_string(max_scene_probes));
    });
    return reader.take();
}

} // namespace plumb
