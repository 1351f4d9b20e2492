#include "engine/scene/file/probe.h"

#include "engine/scene/file/names.h"
#include "engine/scene/file/number.h"
#include "engine/scene/file/place.h"
#include "engine/scene/file/shape.h"
#include "engine/scene/file/spelling.h"
#include "engine/scene/probe.h"
#include "engine/scene/probe_size.h"
#include "engine/scene/scene_limits.h"
#include "engine/scene/shape_kinds.h"

#include <algorithm>

namespace plumb {

namespace {

using namespace scene_file;

constexpr std::array<std::string_view, 3> tree_names{"quadtree", "octree", "bvh"};

class ProbeReader {
  public:
    ProbeReader(Report &report, Precision precision, ShapeFiles &files)
        : report_(report), precision_(precision), files_(files) {}

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
        if (!has_room_for(table, probe) || report_.error_count() != errors)
            return;
        if (const ProbeAnswer found = answer(probe, precision_); !found.refusal.empty())
            report_.error(table.position(), table.title() + " has no answer: " + found.refusal,
                          "ask something that the geometry can answer");
        probes_.push_back(std::move(probe));
    }

    std::vector<ProbeDesc> take() { return std::move(probes_); }

  private:
    // All probes of a scene share their limits.
    bool has_room_for(const Table &table, const ProbeDesc &probe) {
        const ProbeSize size = size_of(probe);
        bool fits = true;
        const auto add = [&](std::size_t &total, std::size_t more, std::size_t limit,
                             const char *what) {
            if (total <= limit && total + more > limit)
                table.error("name",
                            "with " + table.title() + " the scene's probes have " +
                                std::to_string(total + more) + " " + what,
                            "all probes of a scene have at most " + std::to_string(limit));
            total += more;
            fits = fits && total <= limit;
        };
        add(total_.shapes, size.shapes, max_scene_probe_shapes, "shapes");
        add(total_.triangles, size.triangles, max_scene_probe_triangles, "triangles");
        add(total_.scattered, size.scattered, max_scene_probe_items, "scattered items");
        add(total_.questions, size.questions, max_scene_probe_questions,
            "pairs to query (a shape and a point, or two shapes)");
        return fits;
    }

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
            table.wrong_type(*node, "shapes", R"(an array: [{ shape = "sphere", ... }, ...])");
        const std::size_t count = array ? array->size() : 0;
        if (count < info.shapes.min || count > info.shapes.max) {
            table.error("shapes",
                        table.title() + " has " + std::to_string(count) +
                            (count == 1 ? " shape" : " shapes"),
                        asked + " takes " + range_text(info.shapes.min, info.shapes.max, "shapes"));
            return;
        }
        for (std::size_t i = 0; i < count; ++i)
            read_shape(*array->get(i), table.title(), probe);
    }

    void read_shape(const toml::node &node, const std::string &of, ProbeDesc &probe) {
        const std::optional<std::size_t> kind =
            read_shape_kind(report_, node, "shapes", of, kind_names<ProbeShape>());
        if (!kind)
            return;
        ProbeShapeDesc placed;
        placed.shape = shape_of_kind<ProbeShape>(*kind);
        const KindInfo &info = kind_info(placed.shape);
        const bool is_turned = info.placing == Placing::position_and_rotation;
        const bool is_plane = std::holds_alternative<PlaneDesc>(placed.shape);
        const bool has_parent = probe.question == ProbeQuestion::models;
        std::vector<std::string_view> keys{"shape"};
        keys.insert(keys.end(), probe_shape_keys().begin(), probe_shape_keys().end());
        if (info.placing != Placing::by_its_points)
            keys.emplace_back("position");
        if (is_turned)
            keys.insert(keys.end(), {"rotation_deg", "axis", "angle_deg", "orientation", "normal"});
        if (has_parent)
            keys.insert(keys.end(), {"name", "parent"});
        const toml::table &source = *node.as_table();
        const Table table(report_, source, "the " + std::string(info.name) + " of " + of, keys);
        read_shape_fields(report_, files_, precision_, table, placed.shape);
        placed.position =
            place(table, "position", info.is_flat, moderate).value_or(placed.position);
        if (is_turned)
            placed.orientation = read_shape_rotation(report_, table, is_plane);
        if (has_parent)
            read_parent(table, probe, placed);
        probe.shapes.push_back(std::move(placed));
    }

    static void read_parent(const Table &table, const ProbeDesc &probe, ProbeShapeDesc &shape) {
        shape.name = table.string("name").value_or("");
        shape.parent = table.string("parent").value_or("");
        const auto is_named = [&](const std::string &name) {
            return std::ranges::find(probe.shapes, name, &ProbeShapeDesc::name) !=
                   probe.shapes.end();
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
                            (probe.points.size() == 1 ? " valid point" : " valid points"),
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
                table.error(key, "segment has " + std::to_string(ends.size()) + " valid ends",
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
            const bool is_mesh = probe.shapes.size() == 1 &&
                                 std::holds_alternative<MeshDesc>(probe.shapes.front().shape);
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
    ShapeFiles &files_;
    Names names_;
    ProbeSize total_;
    std::vector<ProbeDesc> probes_;
};

} // namespace

std::vector<ProbeDesc> read_probes(Report &report, const Table &top, Precision precision,
                                   ShapeFiles &files) {
    ProbeReader reader(report, precision, files);
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
