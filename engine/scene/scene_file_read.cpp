#include "engine/scene/expect.h"
#include "engine/scene/repeat.h"
#include "engine/scene/scene_file.h"
#include "engine/scene/scene_file_probe.h"
#include "engine/scene/scene_file_table.h"
#include "engine/scene/shape_desc.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <initializer_list>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <sstream>

#include <glm/geometric.hpp>

namespace plumb {

namespace {

using namespace scene_file;

class SceneReader {
  public:
    SceneReader(const toml::table &root, const std::vector<std::string> &known_methods)
        : root_(root), known_methods_(known_methods.begin(), known_methods.end()) {}

    SceneFileResult read(const std::filesystem::path &path) {
        static constexpr std::array<std::string_view, 11> keys{
            "title", "description", "world", "methods", "camera", "material",
            "body",  "joint",       "probe", "expect",  "state"};
        scene_.name = path.stem().string();
        const Table top(report_, root_, "the top level of a scene", keys);
        scene_.title = top.string("title").value_or("");
        scene_.description = top.string("description").value_or("");
        if (const toml::table *table = table_at(report_, top, "world"))
            read_world(*table);
        if (const toml::table *table = table_at(report_, top, "methods"))
            read_methods(*table);
        if (const toml::table *table = table_at(report_, top, "camera"))
            read_camera(*table);
        for_each(report_, top, "material",
                 [this](const toml::table &table) { read_material(table); });
        for_each(report_, top, "body", [this](const toml::table &table) { read_body(table); });
        for_each(report_, top, "joint", [this](const toml::table &table) { read_joint(table); });
        for_each(report_, top, "expect", [this](const toml::table &table) { read_expect(table); });
        scene_.probes = read_probes(report_, top, scene_.world.precision, path.parent_path());
        if (const toml::table *table = table_at(report_, top, "state"))
            read_state(*table);

        if (report_.error_count() == 0)
            for (SceneMessage &warning : scene_warnings(scene_, positions_))
                report_.add(std::move(warning));
        return {std::move(scene_), report_.in_file_order()};
    }

  private:
    // ---- world, methods, camera ----

    void read_world(const toml::table &source) {
        static constexpr std::array<std::string_view, 7> keys{
            "gravity", "dt", "method", "substeps", "iterations", "precision", "seed"};
        const Table table(report_, source, "[world]", keys);
        WorldDesc &world = scene_.world;
        world.gravity = table.vector("gravity", moderate).value_or(world.gravity);
        read_dt(table);
        if (const std::optional<std::string> method = table.string("method")) {
            check_method(*method, table.position("method"));
            world.method = *method;
        }
        world.settings = read_settings(table);
        static constexpr std::array<std::string_view, 2> precisions{"float", "double"};
        if (const std::optional<std::size_t> precision = table.choice("precision", precisions))
            world.precision = *precision == 0 ? Precision::single : Precision::dual;
        world.seed = table.natural("seed").value_or(world.seed);
        positions_.dt = table.position("dt");
    }

    void read_dt(const Table &table) {
        static constexpr Bounds step{1 / huge, 1,
                                     "a number of seconds from 1e-9 to 1, or a "
                                     "fraction in quotes such as \"1/60\""};
        const toml::node *node = table.node("dt");
        if (!node)
            return;
        if (const auto *text = node->as_string()) {
            const std::optional<double> value = parse_fraction(text->get());
            if (!value || !(*value >= step.min && *value <= step.max))
                table.error("dt", "dt is " + in_quotes(text->get()),
                            "it must be " + std::string(step.text));
            else
                scene_.world.dt = *value;
            return;
        }
        scene_.world.dt = table.number("dt", step).value_or(scene_.world.dt);
    }

    // "a/b" with plain numbers.
    static std::optional<double> parse_fraction(std::string_view text) {
        const auto strip = [](std::string_view part) {
            while (!part.empty() && part.front() == ' ')
                part.remove_prefix(1);
            while (!part.empty() && part.back() == ' ')
                part.remove_suffix(1);
            return part;
        };
        const auto parse = [](std::string_view part) -> std::optional<double> {
            double value = 0;
            const auto [end, failure] =
                std::from_chars(part.data(), part.data() + part.size(), value);
            const bool all = failure == std::errc{} && end == part.data() + part.size();
            return all ? std::optional(value) : std::nullopt;
        };
        const std::size_t slash = text.find('/');
        if (slash == std::string_view::npos)
            return std::nullopt;
        const std::optional<double> above = parse(strip(text.substr(0, slash)));
        const std::optional<double> below = parse(strip(text.substr(slash + 1)));
        return above && below ? std::optional(*above / *below) : std::nullopt;
    }

    void check_method(const std::string &method, const FilePosition &at) {
        if (!known_methods_.empty() &&
            std::find(known_methods_.begin(), known_methods_.end(), method) == known_methods_.end())
            report_.error(at, "there is no method " + in_quotes(method),
                          did_you_mean(method, known_methods_));
    }

    static MethodSettings read_settings(const Table &table) {
        MethodSettings settings;
        settings.substeps =
            static_cast<int>(table.integer("substeps", 0, max_scene_substeps).value_or(0));
        settings.iterations =
            static_cast<int>(table.integer("iterations", 0, max_scene_substeps).value_or(0));
        return settings;
    }

    void read_methods(const toml::table &source) {
        static constexpr std::array<std::string_view, 2> keys{"substeps", "iterations"};
        for (const auto &[key, value] : source) {
            const std::string name(key.str());
            check_method(name, position_of(key.source()));
            const toml::table *settings = value.as_table();
            if (!settings) {
                report_.error(position_of(key.source()),
                              name + " is " + std::string(type_name(value)),
                              "it must be a table: [methods." + name + "]");
                continue;
            }
            scene_.world.other_methods[name] =
                read_settings(Table(report_, *settings, "[methods." + name + "]", keys));
        }
    }

    void read_camera(const toml::table &source) {
        static constexpr std::array<std::string_view, 8> keys{
            "target", "distance", "yaw_deg", "yaw", "pitch_deg", "pitch", "fov_deg", "fov"};
        static constexpr Bounds upright{-90, 90, "a number from -90 to 90"};
        static constexpr Bounds view{1, 170, "a number from 1 to 170"};
        const Table table(report_, source, "[camera]", keys);
        CameraDesc &camera = scene_.camera;
        camera.target = table.vector("target", moderate).value_or(camera.target);
        camera.distance = table.number("distance", positive).value_or(camera.distance);
        camera.yaw = table.angle("yaw", moderate).value_or(camera.yaw);
        camera.pitch = table.angle("pitch", upright).value_or(camera.pitch);
        camera.fov = table.angle("fov", view).value_or(camera.fov);
    }

    // ---- materials ----

    void read_material(const toml::table &source) {
        static constexpr std::array<std::string_view, 5> keys{"name", "density", "friction",
                                                              "restitution", "color"};
        const Table table(report_, source, title_of("material", source), keys);
        MaterialDesc material;
        material.name = read_name(report_, table, "material", materials_).value_or("");
        material.density = table.number("density", positive).value_or(material.density);
        material.friction = table.number("friction", not_negative).value_or(material.friction);
        material.restitution = table.number("restitution", fraction).value_or(material.restitution);
        material.colour = table.colour("color");
        if (!material.name.empty())
            densities_[material.name] = material.density;
        scene_.materials.push_back(std::move(material));
    }

    // ---- bodies ----

    void read_body(const toml::table &source) {
        static constexpr std::array<std::string_view, 19> keys{"name",
                                                               "kind",
                                                               "shape",
                                                               "radius",
                                                               "half_extents",
                                                               "half_height",
                                                               "material",
                                                               "mass",
                                                               "density",
                                                               "position",
                                                               "rotation_deg",
                                                               "axis",
                                                               "angle_deg",
                                                               "orientation",
                                                               "velocity",
                                                               "angular_velocity",
                                                               "angular_velocity_deg",
                                                               "color",
                                                               "repeat"};
        const Table table(report_, source, title_of("body", source), keys);
        BodyDesc body;
        const std::optional<std::string> name = read_name(report_, table, "body", bodies_);
        body.name = name.value_or("");
        const bool has_shape = read_shape(table, body);
        read_kind(table, body);
        read_mass(table, body, has_shape);
        body.position = table.vector("position", moderate).value_or(body.position);
        body.orientation = read_rotation(report_, table);
        read_velocity(table, body);
        body.colour = table.colour("color");

        if (table.has("repeat")) {
            repeat_body(table, body, has_shape);
        } else if (has_room_for(1, max_scene_bodies, scene_.bodies.size(), "bodies",
                                table.position())) {
            if (name)
                bodies_by_name_[*name] = scene_.bodies.size();
            add_body(std::move(body), table.position());
        }
    }

    void add_body(BodyDesc body, const FilePosition &at) {
        scene_.bodies.push_back(std::move(body));
        positions_.bodies.push_back(at);
    }

    bool has_room_for(std::size_t count, std::size_t limit, std::size_t present, const char *what,
                      const FilePosition &at) {
        if (count <= limit && present <= limit - count)
            return true;
        if (!said_too_many_)
            report_.error(at,
                          "too many " + std::string(what) + ": " + std::to_string(present) +
                              " before this, and " + std::to_string(count) + " here",
                          "a scene holds at most " + std::to_string(limit));
        said_too_many_ = true;
        return false;
    }

    bool read_shape(const Table &table, BodyDesc &body) {
        static constexpr std::array<std::string_view, 4> shapes{"sphere", "box", "capsule",
                                                                "plane"};
        if (!table.require("shape", R"(shape = "sphere", "box", "capsule" or "plane")"))
            return false;
        const std::optional<std::size_t> shape = table.choice("shape", shapes);
        if (!shape)
            return false;
        switch (*shape) {
        case 0: {
            table.refuse({"half_extents", "half_height"}, "a sphere", "its size is its radius");
            if (!table.require("radius", "radius = metres"))
                return false;
            const std::optional<double> radius = table.number("radius", positive);
            body.shape = SphereDesc{radius.value_or(1)};
            return radius.has_value();
        }
        case 1: {
            table.refuse({"radius", "half_height"}, "a box", "its size is half_extents");
            if (!table.require("half_extents", "half_extents = [x, y, z] in metres"))
                return false;
            const std::optional<glm::dvec3> half = table.vector("half_extents", positive);
            body.shape = BoxDesc{half.value_or(glm::dvec3(1))};
            return half.has_value();
        }
        case 2: {
            table.refuse({"half_extents"}, "a capsule", "its size is half_height and radius");
            const bool has_height =
                table.require("half_height", "half_height = metres, without the round ends");
            const bool has_radius = table.require("radius", "radius = metres");
            const std::optional<double> height = table.number("half_height", positive);
            const std::optional<double> radius = table.number("radius", positive);
            body.shape = CapsuleDesc{height.value_or(1), radius.value_or(1)};
            return has_height && has_radius && height && radius;
        }
        default:
            table.refuse({"radius", "half_extents", "half_height"}, "a plane",
                         "it is infinite: the solid below y = 0 of its frame");
            body.shape = PlaneDesc{};
            return true;
        }
    }

    void read_kind(const Table &table, BodyDesc &body) {
        static constexpr std::array<std::string_view, 3> kinds{"static", "kinematic", "dynamic"};
        const bool is_plane = std::holds_alternative<PlaneDesc>(body.shape);
        body.kind = is_plane ? BodyKind::fixed : BodyKind::dynamic;
        const std::optional<std::size_t> kind = table.choice("kind", kinds);
        if (!kind)
            return;
        body.kind = static_cast<BodyKind>(*kind);
        if (is_plane && body.kind == BodyKind::dynamic)
            table.error("kind", "a plane cannot be dynamic",
                        R"(kind = "static", which is a plane's default, or "kinematic")");
    }

    void read_mass(const Table &table, BodyDesc &body, bool has_shape) {
        double density = MaterialDesc{}.density;
        if (const std::optional<std::string> material = table.string("material")) {
            body.material = *material;
            if (const auto found = densities_.find(*material); found != densities_.end())
                density = found->second;
            else
                table.error("material", "there is no material " + in_quotes(*material),
                            materials_.suggestion(*material));
        }
        if (std::holds_alternative<PlaneDesc>(body.shape)) {
            table.refuse({"mass", "density"}, "a plane",
                         "it is infinite and never moves by itself");
            return;
        }
        const std::string_view key = table.one_of({"mass", "density"}, false, "");
        const std::optional<double> value =
            key.empty() ? std::nullopt : table.number(key, positive);
        if (key == "mass") {
            body.mass = value;
            return;
        }
        if (!key.empty() && !value)
            return;
        const double mass = value.value_or(density) * volume(body.shape);
        if (value)
            body.mass = mass;
        if (has_shape && !(mass >= positive.min && mass <= positive.max))
            table.error(key.empty() ? "shape" : key,
                        "density times volume makes a mass of " + shortest(mass) + " kg",
                        "it must be " + std::string(positive.text) + "; give a mass");
    }

    void read_velocity(const Table &table, BodyDesc &body) {
        const std::optional<glm::dvec3> velocity = table.vector("velocity", moderate);
        const std::string_view key =
            table.one_of({"angular_velocity", "angular_velocity_deg"}, false, "");
        std::optional<glm::dvec3> angular;
        if (!key.empty())
            angular = table.vector(key, moderate);
        if (angular && key == "angular_velocity_deg")
            angular = *angular * degree;
        body.velocity = velocity.value_or(body.velocity);
        body.angular_velocity = angular.value_or(body.angular_velocity);
        if (body.kind != BodyKind::fixed)
            return;
        const std::string suggestion = R"(kind = "kinematic" moves as told, "dynamic" by forces)";
        if (body.velocity != glm::dvec3(0))
            report_.error(table.key_position("velocity"), "a static body has no velocity",
                          suggestion);
        if (body.angular_velocity != glm::dvec3(0))
            report_.error(table.key_position(key), "a static body has no " + std::string(key),
                          suggestion);
    }

    // ---- repeats of bodies ----

    void repeat_body(const Table &table, const BodyDesc &body, bool has_shape) {
        Group &group = groups_[body.name];
        group = {scene_.bodies.size(), 0, false};
        const toml::table *source =
            table_at(report_, table, "repeat", R"(repeat = { kind = "stack", count = 10 })");
        if (!source)
            return;
        const std::size_t errors = report_.error_count();
        const std::optional<Repeat> repeat = read_repeat(*source, table.title(), body, has_shape);
        if (!repeat || report_.error_count() != errors ||
            !has_room_for(repeat_count(*repeat), max_scene_bodies, scene_.bodies.size(), "bodies",
                          table.position("repeat")))
            return;
        // A sequence of its own for each body, so that adding one leaves the others where they are.
        Random random(scene_.world.seed ^ name_hash(body.name));
        const std::vector<Placement> placed = placements(*repeat, body.position, random);
        if (placed.size() < repeat_count(*repeat)) {
            table.error("repeat",
                        "only " + std::to_string(placed.size()) + " of " +
                            std::to_string(repeat_count(*repeat)) +
                            " bodies found a place at least min_distance from the others",
                        "fewer bodies, a smaller min_distance or larger half_extents");
            return;
        }
        if (body.name.empty())
            return; // that is reported already
        for (std::size_t i = 0; i < placed.size(); ++i) {
            BodyDesc copy = body;
            copy.name += "_" + std::to_string(i);
            copy.position = placed[i].position;
            if (placed[i].turn != glm::dquat(1, 0, 0, 0)) {
                copy.orientation = placed[i].turn * body.orientation;
                copy.velocity = placed[i].turn * body.velocity;
                copy.angular_velocity = placed[i].turn * body.angular_velocity;
            }
            if (!bodies_.add(report_, table.position("name"), "body", copy.name))
                return;
            bodies_by_name_[copy.name] = scene_.bodies.size();
            add_body(std::move(copy), table.position());
        }
        group.count = placed.size();
        group.is_complete = true;
    }

    // FNV-1a, 64 bits.
    static std::uint64_t name_hash(std::string_view name) {
        std::uint64_t hash = 0xCBF29CE484222325ULL;
        for (const char c : name)
            hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001B3ULL;
        return hash;
    }

    std::optional<Repeat> read_repeat(const toml::table &source, const std::string &title,
                                      const BodyDesc &body, bool has_shape) {
        static constexpr std::array<std::string_view, 6> kinds{"grid",    "stack", "line",
                                                               "pyramid", "ring",  "scatter"};
        static constexpr std::array<std::string_view, 3> grid_keys{"kind", "count", "spacing"};
        static constexpr std::array<std::string_view, 4> stack_keys{"kind", "count", "spacing",
                                                                    "turn_deg"};
        static constexpr std::array<std::string_view, 3> line_keys{"kind", "count", "step"};
        static constexpr std::array<std::string_view, 4> pyramid_keys{"kind", "base", "spacing",
                                                                      "square"};
        static constexpr std::array<std::string_view, 4> ring_keys{"kind", "count", "radius",
                                                                   "facing"};
        static constexpr std::array<std::string_view, 5> scatter_keys{
            "kind", "count", "half_extents", "min_distance", "random_rotation"};
        static constexpr std::array<Words, 6> keys{grid_keys,    stack_keys, line_keys,
                                                   pyramid_keys, ring_keys,  scatter_keys};
        std::string name = "repeat of " + title;
        // Which keys are right depends on the kind, so that is looked up first.
        const auto *kind_node = source.get_as<std::string>("kind");
        const auto found =
            kind_node ? std::find(kinds.begin(), kinds.end(), kind_node->get()) : kinds.end();
        if (found == kinds.end()) {
            report_.error(
                source.contains("kind") ? position_of(*source.get("kind")) : position_of(source),
                kind_node ? "unknown kind " + in_quotes(kind_node->get()) + " of repeat"
                          : name + " has no kind",
                kind_node ? did_you_mean(kind_node->get(), kinds)
                          : R"(kind = "grid", "stack", "line", "pyramid", "ring" or "scatter")");
            return std::nullopt;
        }
        const auto kind = static_cast<std::size_t>(found - kinds.begin());
        const Table table(report_, source, "the " + std::string(kinds[kind]) + " " + name,
                          keys[kind]);
        constexpr std::int64_t most = max_scene_bodies;
        const auto count = [&](std::string_view key) -> int {
            return table.require(key, "how many, a whole number")
                       ? static_cast<int>(table.integer(key, 1, most).value_or(1))
                       : 1;
        };
        switch (kind) {
        case 0: {
            GridRepeat grid;
            if (table.require("count", "count = [nx, ny, nz]"))
                grid.count = read_counts(table, most);
            if (table.require("spacing", "spacing = [x, y, z] in metres"))
                grid.spacing = table.vector("spacing", positive).value_or(grid.spacing);
            return grid;
        }
        case 1: {
            StackRepeat stack{count("count"), 0, 0};
            if (std::holds_alternative<PlaneDesc>(body.shape) && !table.has("spacing"))
                table.require("spacing", "a plane has no height to take it from");
            else if (has_shape)
                stack.spacing = 2 * half_bounds(body.shape, body.orientation).y;
            stack.spacing = table.number("spacing", positive).value_or(stack.spacing);
            stack.turn = table.number("turn_deg", moderate).value_or(0) * degree;
            return stack;
        }
        case 2: {
            LineRepeat line{count("count"), {}};
            if (table.require("step", "step = [x, y, z] in metres, from one to the next"))
                line.step = table.vector("step", moderate).value_or(line.step);
            return line;
        }
        case 3: {
            PyramidRepeat pyramid{count("base"), {}, table.boolean("square").value_or(false)};
            if (table.require("spacing", "spacing = [sideways, up] in metres"))
                if (const auto spacing = table.numbers<2>("spacing", positive))
                    pyramid.spacing = {(*spacing)[0], (*spacing)[1]};
            return pyramid;
        }
        case 4: {
            RingRepeat ring{count("count"), 1, table.boolean("facing").value_or(false)};
            if (table.require("radius", "radius = metres"))
                ring.radius = table.number("radius", positive).value_or(ring.radius);
            return ring;
        }
        default: {
            ScatterRepeat scatter;
            scatter.count = count("count");
            scatter.random_rotation = table.boolean("random_rotation").value_or(false);
            scatter.min_distance = table.number("min_distance", positive).value_or(0);
            if (table.require("half_extents", "half_extents = [x, y, z] in metres of the region"))
                scatter.half_extents =
                    table.vector("half_extents", not_negative).value_or(scatter.half_extents);
            return scatter;
        }
        }
    }

    glm::ivec3 read_counts(const Table &table, std::int64_t most) {
        const toml::node &node = *table.node("count");
        const toml::array *array = node.as_array();
        if (!array || array->size() != 3) {
            table.error("count",
                        array ? "count has " + std::to_string(array->size()) + " elements"
                              : "count is " + std::string(type_name(node)),
                        "it must be an array of 3 whole numbers");
            return glm::ivec3(1);
        }
        glm::ivec3 counts{1};
        for (int i = 0; i < 3; ++i)
            counts[i] = static_cast<int>(table
                                             .integer(*array->get(static_cast<std::size_t>(i)),
                                                      "count[" + std::to_string(i) + "]", 1, most)
                                             .value_or(1));
        return counts;
    }

    // ---- joints ----

    // The body of that name; empty, having reported it, when there is none.
    std::optional<std::size_t> find_body(const Table &table, std::string_view key) {
        const std::optional<std::string> name = table.string(key);
        if (!name)
            return std::nullopt;
        if (const auto found = bodies_by_name_.find(*name); found != bodies_by_name_.end())
            return found->second;
        if (const auto group = groups_.find(*name); group != groups_.end()) {
            if (group->second.is_complete)
                table.error(key, "the body " + in_quotes(*name) + " is repeated, so there are many",
                            "name one of " + *name + "_0 to " + *name + "_" +
                                std::to_string(group->second.count - 1));
            return std::nullopt;
        }
        // A repeat that failed would have made it, perhaps.
        const std::size_t underscore = name->rfind('_');
        if (underscore != std::string::npos) {
            const auto group = groups_.find(name->substr(0, underscore));
            if (group != groups_.end() && !group->second.is_complete)
                return std::nullopt;
        }
        // Looking through all names is slow in a large scene; after so many one gets the idea.
        constexpr int suggested = 100;
        table.error(key, "there is no body " + in_quotes(*name),
                    ++missing_bodies_ <= suggested ? bodies_.suggestion(*name) : "");
        return std::nullopt;
    }

    struct JointEnd {
        std::optional<std::size_t> body; // none: the world
        std::optional<glm::dvec3> anchor_local;
    };

    void read_joint(const toml::table &source) {
        static constexpr std::array<std::string_view, 13> keys{"name",
                                                               "type",
                                                               "body_a",
                                                               "body_b",
                                                               "anchor",
                                                               "anchor_a",
                                                               "anchor_b",
                                                               "anchor_a_local",
                                                               "anchor_b_local",
                                                               "length",
                                                               "collide_connected",
                                                               "impulse",
                                                               "chain"};
        static constexpr std::array<std::string_view, 2> types{"ball", "distance"};
        const Table table(report_, source, title_of("joint", source), keys);
        const std::size_t errors = report_.error_count();
        JointDesc joint;
        joint.name = read_name(report_, table, "joint", joints_).value_or("");
        if (table.require("type", R"(type = "ball" or "distance")"))
            joint.type = table.choice("type", types).value_or(0) == 0 ? JointType::ball
                                                                      : JointType::distance;
        joint.collide_connected = table.boolean("collide_connected").value_or(false);
        joint.impulse = table.vector("impulse", finite).value_or(joint.impulse);
        if (joint.type == JointType::ball && table.has("type"))
            table.refuse({"length"}, "a ball joint", R"(type = "distance" has a length)");
        const std::optional<double> length = table.number("length", positive);
        if (table.has("chain")) {
            read_chain(table, joint, length, errors);
            return;
        }

        JointEnd a;
        JointEnd b;
        for (const auto &[end, body_key] : {std::pair(&a, "body_a"), std::pair(&b, "body_b")})
            if (const auto *name = source.get_as<std::string>(body_key);
                table.has(body_key) && !(name && name->get() == "world"))
                end->body = find_body(table, body_key);
        const bool is_world_a = is_world(table, "body_a");
        const bool is_world_b = is_world(table, "body_b");
        if (is_world_a && is_world_b)
            report_.error(table.position(), table.title() + " joins the world to itself",
                          "give body_a or body_b the name of a body");
        else if (a.body && b.body && *a.body == *b.body)
            table.error("body_b", table.title() + " joins a body to itself",
                        "body_a and body_b must differ");
        const std::optional<glm::dvec3> common = table.vector("anchor", moderate);
        read_anchor(table, "anchor_a", is_world_a, joint.type, common, a);
        read_anchor(table, "anchor_b", is_world_b, joint.type, common, b);
        if (report_.error_count() != errors ||
            !has_room_for(1, max_scene_joints, scene_.joints.size(), "joints", table.position()))
            return;
        add_joint(table, joint, a, b, length);
    }

    static bool is_world(const Table &table, std::string_view key) {
        const toml::node *node = table.node(key);
        return node == nullptr || (node->is_string() && node->as_string()->get() == "world");
    }

    glm::dvec3 to_local(const std::optional<std::size_t> &index, const glm::dvec3 &world) const {
        if (!index)
            return world;
        const BodyDesc &body = scene_.bodies[*index];
        return glm::conjugate(body.orientation) * (world - body.position);
    }

    glm::dvec3 to_world(const std::optional<std::size_t> &index, const glm::dvec3 &local) const {
        if (!index)
            return local;
        const BodyDesc &body = scene_.bodies[*index];
        return body.position + body.orientation * local;
    }

    // `key` is anchor_a or anchor_b; `common` is the point that stands for both.
    void read_anchor(const Table &table, const std::string &key, bool is_world, JointType type,
                     const std::optional<glm::dvec3> &common, JointEnd &end) {
        const std::string local_key = key + "_local";
        const std::string_view chosen = table.one_of({"anchor", key, local_key}, false, "");
        if (chosen.empty()) {
            const bool has_any = table.has("anchor") || table.has(key) || table.has(local_key);
            if (has_any)
                return;
            if (type == JointType::ball || is_world)
                report_.error(table.position(), table.title() + " has no " + key,
                              "anchor = [x, y, z] is one point of the world for both bodies, " +
                                  key + " one for this body, " + local_key + " one in its frame");
            else
                end.anchor_local = glm::dvec3(0);
            return;
        }
        const std::optional<glm::dvec3> point =
            chosen == "anchor" ? common : table.vector(chosen, moderate);
        if (point)
            end.anchor_local = chosen == local_key ? *point : to_local(end.body, *point);
    }

    // One joint between each of a repeated body's copies and the next.
    void read_chain(const Table &table, const JointDesc &joint, std::optional<double> length,
                    std::size_t errors) {
        table.refuse({"body_a", "body_b", "anchor", "anchor_a", "anchor_b"}, "a chain",
                     "its bodies are the copies of a repeated one, its anchors in their frames: "
                     "anchor_a_local, anchor_b_local");
        if (table.has("anchor_a_local") != table.has("anchor_b_local"))
            table.error(
                table.has("anchor_a_local") ? "anchor_a_local" : "anchor_b_local",
                table.title() + " has only one of anchor_a_local and anchor_b_local",
                "give both, or neither: then a ball joint sits halfway between the centres, "
                "and a distance joint holds the centres");
        const std::optional<glm::dvec3> anchor_a = table.vector("anchor_a_local", moderate);
        const std::optional<glm::dvec3> anchor_b = table.vector("anchor_b_local", moderate);
        const std::optional<std::string> chain = table.string("chain");
        if (!chain)
            return;
        const auto group = groups_.find(*chain);
        if (group == groups_.end()) {
            const bool is_single = bodies_by_name_.contains(*chain);
            table.error("chain",
                        is_single ? "the body " + in_quotes(*chain) + " is not repeated"
                                  : "there is no body " + in_quotes(*chain),
                        is_single ? "a chain runs through the copies of a body with repeat"
                                  : bodies_.suggestion(*chain));
            return;
        }
        if (!group->second.is_complete)
            return; // its mistakes are reported already
        const auto [first, count, is_complete] = group->second;
        static_cast<void>(is_complete);
        if (count < 2) {
            table.error("chain", "there is only one " + in_quotes(*chain),
                        "a chain needs two bodies at least");
            return;
        }
        if (report_.error_count() != errors ||
            !has_room_for(count - 1, max_scene_joints, scene_.joints.size(), "joints",
                          table.position()))
            return;
        for (std::size_t i = 0; i + 1 < count; ++i) {
            JointDesc copy = joint;
            copy.name += "_" + std::to_string(i);
            if (!joints_.add(report_, table.position("name"), "joint", copy.name))
                return;
            JointEnd a{first + i, anchor_a};
            JointEnd b{first + i + 1, anchor_b};
            if (!anchor_a) {
                const glm::dvec3 middle =
                    0.5 * (to_world(a.body, {0, 0, 0}) + to_world(b.body, {0, 0, 0}));
                const bool is_ball = joint.type == JointType::ball;
                a.anchor_local = is_ball ? to_local(a.body, middle) : glm::dvec3(0);
                b.anchor_local = is_ball ? to_local(b.body, middle) : glm::dvec3(0);
            }
            if (!add_joint(table, copy, a, b, length))
                return;
        }
    }

    bool add_joint(const Table &table, JointDesc joint, const JointEnd &a, const JointEnd &b,
                   std::optional<double> length) {
        if (a.body)
            joint.body_a = scene_.bodies[*a.body].name;
        if (b.body)
            joint.body_b = scene_.bodies[*b.body].name;
        joint.anchor_a_local = a.anchor_local.value_or(glm::dvec3(0));
        joint.anchor_b_local = b.anchor_local.value_or(glm::dvec3(0));
        if (joint.type == JointType::distance) {
            joint.length = length.value_or(glm::distance(to_world(a.body, joint.anchor_a_local),
                                                         to_world(b.body, joint.anchor_b_local)));
            if (!(joint.length >= positive.min && joint.length <= positive.max)) {
                report_.error(table.position(),
                              "the anchors of " + table.title() + " are " + shortest(joint.length) +
                                  " m apart, which cannot be its length",
                              "give a length of its own: " + std::string(positive.text));
                return false;
            }
        }
        scene_.joints.push_back(std::move(joint));
        positions_.joints.push_back(table.position());
        return true;
    }

    // ---- expects ----

    void read_expect(const toml::table &source) {
        static constexpr std::array<std::string_view, 12> keys{
            "name", "quantity", "body",    "reduce",   "level",     "from",
            "to",   "equals",   "at_most", "at_least", "tolerance", "source"};
        static constexpr std::array<std::string_view, 3> relations{"equals", "at_most", "at_least"};
        const Table table(report_, source, title_of("expect", source), keys);
        ExpectDesc expect;
        expect.line = table.position().line;
        expect.name = read_name(report_, table, "expect", expects_).value_or("");
        read_quantity(table, expect);
        read_reduction(table, expect);

        expect.from = table.number("from", not_negative).value_or(0);
        if (table.require("to", "to = seconds, the end of the window and of the run")) {
            const std::optional<double> to = table.number("to", not_negative);
            expect.to = to.value_or(expect.from);
            if (to && *to == 0)
                table.error("to", "the window ends at 0 s", "to must be later than the start");
            else if (to && expect.from > *to)
                table.error(table.has("from") ? "from" : "to",
                            "the window from " + shortest(expect.from) + " to " + shortest(*to) +
                                " s is empty",
                            "from must not be after to");
        }

        const std::string_view relation =
            table.one_of({"equals", "at_most", "at_least"}, true, "what must the number be?");
        if (!relation.empty()) {
            expect.relation = static_cast<ExpectDesc::Relation>(
                std::find(relations.begin(), relations.end(), relation) - relations.begin());
            expect.value = table.number(relation, finite).value_or(0);
            if (relation == "equals") {
                if (table.require("tolerance", "how far the truth may be missed, in the "
                                               "quantity's unit"))
                    expect.tolerance = table.number("tolerance", above_zero).value_or(1);
            } else {
                table.refuse({"tolerance"}, "a bound", "put it into the bound itself");
            }
        }
        if (table.require("source", "where does the number come from?")) {
            expect.source = table.string("source").value_or("?");
            if (expect.source.find_first_not_of(" \t\r\n") == std::string::npos)
                table.error("source", "the source is empty", "where does the number come from?");
        }
        scene_.expects.push_back(std::move(expect));
    }

    void read_quantity(const Table &table, ExpectDesc &expect) {
        if (!table.require("quantity", "which quantity of the motion?"))
            return;
        std::vector<std::string_view> names;
        for (const QuantityInfo &quantity : quantities())
            names.push_back(quantity.name);
        const std::optional<std::size_t> chosen = table.choice("quantity", names);
        if (!chosen)
            return;
        expect.quantity = names[*chosen];
        if (!quantities()[*chosen].needs_body) {
            table.refuse({"body"}, expect.quantity, "it is of the whole scene");
            return;
        }
        if (table.require("body", expect.quantity + " is of one body: which?"))
            if (const std::optional<std::size_t> body = find_body(table, "body"))
                expect.body = scene_.bodies[*body].name;
    }

    void read_reduction(const Table &table, ExpectDesc &expect) {
        std::vector<std::string_view> names;
        for (const ReductionInfo &reduction : reductions())
            names.push_back(reduction.name);
        if (const std::optional<std::size_t> chosen = table.choice("reduce", names))
            expect.reduce = names[*chosen];
        else if (table.has("reduce"))
            return;
        expect.level = table.number("level", finite);
        if (!find_reduction(expect.reduce)->uses_level)
            table.refuse({"level"}, "reduce = " + in_quotes(expect.reduce),
                         "period and crossings have one");
    }

    // ---- state ----

    void read_state(const toml::table &source) {
        static constexpr std::array<std::string_view, 2> keys{"step", "contact"};
        const Table table(report_, source, "[state]", keys);
        scene_.step_count = table.natural("step").value_or(0);
        for_each(
            report_, table, "contact",
            [this](const toml::table &contact) { read_contact(contact); }, "state.contact");
    }

    void read_contact(const toml::table &source) {
        static constexpr std::array<std::string_view, 4> keys{"body_a", "body_b", "features",
                                                              "impulses"};
        const Table table(report_, source, "[[state.contact]]", keys);
        ContactStateDesc contact;
        for (const auto &[key, name] :
             {std::pair("body_a", &contact.body_a), std::pair("body_b", &contact.body_b)})
            if (table.require(key, "the name of a body"))
                if (const std::optional<std::size_t> body = find_body(table, key))
                    *name = scene_.bodies[*body].name;
        if (!contact.body_a.empty() && contact.body_a == contact.body_b)
            table.error("body_b", "a body is in contact with itself",
                        "body_a and body_b must differ");
        const toml::array *features = array_at(table, "features");
        const toml::array *impulses = array_at(table, "impulses");
        if (!features || !impulses)
            return;
        if (features->size() != impulses->size()) {
            table.error("impulses",
                        "there are " + std::to_string(features->size()) + " features and " +
                            std::to_string(impulses->size()) + " impulses",
                        "there must be as many of one as of the other");
            return;
        }
        for (std::size_t i = 0; i < features->size(); ++i) {
            const std::string index = "[" + std::to_string(i) + "]";
            const std::optional<std::int64_t> feature =
                table.integer(*features->get(i), "features" + index, 0,
                              std::numeric_limits<std::uint32_t>::max());
            const auto impulse = table.numbers<3>(*impulses->get(i), "impulses" + index, finite);
            if (feature && impulse)
                contact.points.push_back({static_cast<std::uint32_t>(*feature),
                                          {(*impulse)[0], (*impulse)[1], (*impulse)[2]}});
        }
        scene_.contacts.push_back(std::move(contact));
    }

    const toml::array *array_at(const Table &table, std::string_view key) {
        if (!table.require(key, "an array, one element for each contact point"))
            return nullptr;
        const toml::node *node = table.node(key);
        if (!node->as_array())
            table.wrong_type(*node, std::string(key), "an array");
        return node->as_array();
    }

    // The copies of a repeated body: their indices, one after the other.
    struct Group {
        std::size_t first = 0;
        std::size_t count = 0;
        bool is_complete = false; // not when the repeat had errors
    };

    const toml::table &root_;
    std::vector<std::string_view> known_methods_;
    Report report_;
    SceneDesc scene_;
    ScenePositions positions_;
    Names materials_;
    Names bodies_;
    Names joints_;
    Names expects_;
    std::map<std::string, double> densities_;
    std::map<std::string, std::size_t> bodies_by_name_;
    std::map<std::string, Group> groups_;
    int missing_bodies_ = 0;
    bool said_too_many_ = false;
};

// The end of the file, as toml++ counts it, lies a little behind its last character.
FilePosition inside(std::string_view text, FilePosition at) {
    std::size_t line = 1;
    std::size_t start = 0;
    while (line < at.line) {
        const std::size_t newline = text.find('\n', start);
        if (newline == std::string_view::npos)
            break;
        start = newline + 1;
        ++line;
    }
    const std::string_view rest = text.substr(start);
    const std::string_view content = rest.substr(0, std::min(rest.size(), rest.find('\n')));
    // Columns count characters: the bytes 10xxxxxx continue one.
    const auto characters =
        static_cast<std::size_t>(std::count_if(content.begin(), content.end(), [](char c) {
            return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
        }));
    return {line, line < at.line ? characters + 1 : std::min(at.column, characters + 1)};
}

} // namespace

bool SceneFileResult::ok() const {
    return std::none_of(messages.begin(), messages.end(), [](const SceneMessage &message) {
        return message.severity == SceneMessage::Severity::error;
    });
}

SceneFileResult parse_scene(std::string_view text, const std::string &path,
                            const std::vector<std::string> &known_methods) {
    const toml::parse_result parsed = toml::parse(text, std::string_view(path));
    if (!parsed) {
        const FilePosition at = inside(text, position_of(parsed.error().source()));
        SceneFileResult result;
        result.messages.push_back({SceneMessage::Severity::error, at.line, at.column,
                                   std::string(parsed.error().description()),
                                   "see https://toml.io for how TOML is written"});
        return result;
    }
    return SceneReader(parsed.table(), known_methods).read(path);
}

SceneFileResult load_scene(const std::filesystem::path &path,
                           const std::vector<std::string> &known_methods) {
    // A directory opens, but cannot be read.
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    if (!file || file.bad() || std::filesystem::is_directory(path)) {
        SceneFileResult result;
        result.messages.push_back({SceneMessage::Severity::error, 0, 0, "the file cannot be read",
                                   "check that it exists and that you may read it"});
        return result;
    }
    return parse_scene(text.str(), path.string(), known_methods);
}

std::string format_message(const std::string &path, const SceneMessage &message) {
    std::string text = path + ":";
    if (message.line > 0)
        text += std::to_string(message.line) + ":" + std::to_string(message.column) + ":";
    text += message.severity == SceneMessage::Severity::error ? " error: " : " warning: ";
    text += message.what;
    if (!message.suggestion.empty())
        text += "; " + message.suggestion;
    return text;
}

} // namespace plumb
