#include "engine/scene/file/number.h"
#include "engine/scene/file/reading.h"
#include "engine/scene/file/spelling.h"
#include "engine/scene/scene_limits.h"
#include "engine/scene/shape_kinds.h"
#include "engine/scene/triangle_count.h"

#include <algorithm>

namespace plumb::scene_file {

namespace {

void add_body(Reading &reading, BodyDesc body, const FilePosition &at) {
    reading.scene.bodies.push_back(std::move(body));
    reading.positions.bodies.push_back(at);
}

// The least movable kind among the body's shapes; the first of equals.
const KindInfo &least_movable(const BodyDesc &body) {
    const KindInfo *least = &kind_info(body.colliders.front().shape);
    for (const ColliderDesc &collider : body.colliders)
        if (const KindInfo &info = kind_info(collider.shape); info.moves > least->moves)
            least = &info;
    return *least;
}

void read_kind(const Table &table, BodyDesc &body) {
    static constexpr std::array<std::string_view, 3> kinds{"static", "kinematic", "dynamic"};
    const KindInfo &info = least_movable(body);
    body.kind = info.moves == Moves::by_forces ? BodyKind::dynamic : BodyKind::static_body;
    const std::optional<std::size_t> kind = table.choice("kind", kinds);
    if (!kind)
        return;
    body.kind = static_cast<BodyKind>(*kind);
    const bool can = body.kind == BodyKind::static_body || info.moves == Moves::by_forces ||
                     (body.kind == BodyKind::kinematic && info.moves == Moves::as_told);
    const std::string name(info.with_article);
    if (!can)
        table.error("kind", name + " cannot be " + std::string(kinds[*kind]),
                    "kind = \"static\", which is " + name + "'s default" +
                        (info.moves == Moves::as_told ? ", or \"kinematic\"" : ""));
}

// Moments of inertia about three axes; none may exceed the sum of the other two.
void read_inertia(const Table &table, BodyDesc &body) {
    body.inertia = table.vector("inertia", positive);
    if (!body.inertia)
        return;
    const glm::dvec3 &i = *body.inertia;
    const double most = std::max({i.x, i.y, i.z});
    if (most > (i.x + i.y + i.z - most) * (1 + 1e-9))
        table.error("inertia", "impossible moments of inertia",
                    "none may exceed the sum of the other two");
}

void read_pace(Reading &reading, const Table &table, BodyDesc &body) {
    const toml::table *source = table_at(reading.report, table, "pace");
    if (source == nullptr)
        return;
    static constexpr std::array<std::string_view, 4> keys{"substeps", "wanted", "rested", "struck"};
    const Table sub(reading.report, *source, "pace of " + table.title(), keys);
    for (const auto &[key, number] :
         {std::pair("substeps", &body.pace.substeps), std::pair("wanted", &body.pace.wanted),
          std::pair("rested", &body.pace.rested), std::pair("struck", &body.pace.struck)}) {
        constexpr std::uint64_t most = std::numeric_limits<std::uint16_t>::max();
        const std::uint64_t given = sub.natural(key).value_or(0);
        if (given > most)
            sub.error(key, std::string(key) + " is " + std::to_string(given),
                      "it must be a whole number from 0 to " + std::to_string(most));
        *number = static_cast<int>(std::min(given, most));
    }
}

void read_mass(Reading &reading, const Table &table, BodyDesc &body, bool has_shape) {
    body.material = read_material_name(reading, table);
    if (const KindInfo &info = least_movable(body); info.moves != Moves::by_forces) {
        table.refuse({"mass", "density", "center_of_mass", "inertia", "mass_pose"},
                     std::string(info.with_article),
                     info.moves == Moves::never ? "it never moves"
                                                : "it is infinite and never moves under forces");
        return;
    }
    const std::string_view key = table.one_of({"mass", "density"}, false, "");
    const std::optional<double> value = key.empty() ? std::nullopt : table.number(key, positive);
    (key == "mass" ? body.mass : body.density) = value;
    body.center_of_mass = table.vector("center_of_mass", moderate);
    read_inertia(table, body);
    if (const toml::table *source = table_at(reading.report, table, "mass_pose")) {
        static constexpr std::array<std::string_view, 2> keys{"position", "orientation"};
        const Table sub(reading.report, *source, "mass_pose of " + table.title(), keys);
        MassPoseDesc pose;
        pose.position = sub.vector("position", moderate).value_or(pose.position);
        pose.orientation = sub.unit_quaternion("orientation").value_or(pose.orientation);
        body.mass_pose = pose;
    }
    if (!has_shape || body.mass || (!key.empty() && !value) || body.kind != BodyKind::dynamic)
        return;
    const double mass = mass_of(reading.scene, body);
    if (!(mass >= positive.min && mass <= positive.max))
        table.error(!key.empty()          ? key
                    : table.has("shapes") ? "shapes"
                                          : "shape",
                    "density times volume gives a mass of " + shortest(mass) + " kg",
                    "it must be " + std::string(positive.text) + "; give a mass");
}

void read_freedom(const Table &table, BodyDesc &body) {
    if (const toml::node *node = table.node("locked")) {
        const toml::array *names = node->as_array();
        if (!names)
            table.wrong_type(*node, "locked", R"(an array: ["z", "rotation_x", ...])");
        for (std::size_t i = 0; names && i < names->size(); ++i) {
            const auto *name = names->get(i)->as_string();
            const auto found =
                name ? std::find(locked_names.begin(), locked_names.end(), name->get())
                     : locked_names.end();
            if (found == locked_names.end())
                table.error("locked",
                            name ? "unknown axis " + in_quotes(name->get())
                                 : "locked holds " + std::string(type_name(*names->get(i))),
                            did_you_mean(name ? name->get() : "", locked_names));
            else
                body.locked[static_cast<std::size_t>(found - locked_names.begin())] = true;
        }
    }
    body.gravity_scale = table.number("gravity_scale", moderate).value_or(body.gravity_scale);
    body.linear_damping = table.number("linear_damping", not_negative).value_or(0);
    body.angular_damping = table.number("angular_damping", not_negative).value_or(0);
}

void read_velocity(Reading &reading, const Table &table, BodyDesc &body) {
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
    if (body.kind != BodyKind::static_body)
        return;
    const std::string suggestion =
        R"(kind = "kinematic" moves at its velocity, "dynamic" under forces)";
    if (body.velocity != glm::dvec3(0))
        reading.report.error(table.key_position("velocity"), "a static body has no velocity",
                             suggestion);
    if (body.angular_velocity != glm::dvec3(0))
        reading.report.error(table.key_position(key), "a static body has no " + std::string(key),
                             suggestion);
}

// A force on what forces do not move would do nothing.
void read_loads(const Table &table, BodyDesc &body) {
    const auto read = [&](std::string_view key, glm::dvec3 &load) {
        load = table.vector(key, moderate).value_or(load);
        if (load != glm::dvec3(0) && body.kind != BodyKind::dynamic)
            table.error(key, "only a dynamic body has a " + std::string(key),
                        R"(kind = "dynamic" moves under forces)");
    };
    read("force", body.force);
    read("torque", body.torque);
}

// Room for `count` copies of the body.
bool has_room_for(Reading &reading, const BodyDesc &body, std::size_t count,
                  const FilePosition &at) {
    std::size_t triangles = 0;
    for (const ColliderDesc &collider : body.colliders)
        triangles +=
            std::visit([](const auto &shape) { return triangle_count(shape); }, collider.shape);
    triangles *= count;
    if (!has_room_for(reading, count, max_scene_bodies, reading.scene.bodies.size(), "bodies",
                      at) ||
        !has_room_for(reading, triangles, max_scene_triangles, reading.triangles,
                      "surface triangles", at))
        return false;
    reading.triangles += triangles;
    return true;
}

// FNV-1a, 64 bits.
std::uint64_t name_hash(std::string_view name) {
    std::uint64_t hash = 0xCBF29CE484222325ULL;
    for (const char c : name)
        hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001B3ULL;
    return hash;
}

void repeat_body(Reading &reading, const Table &table, const BodyDesc &body, bool has_shape) {
    BodyGroup &group = reading.groups[body.name];
    group = {reading.scene.bodies.size(), 0, false};
    const toml::table *source =
        table_at(reading.report, table, "repeat", R"(repeat = { kind = "stack", count = 10 })");
    if (!source)
        return;
    const std::size_t errors = reading.report.error_count();
    const std::optional<Repeat> repeat =
        read_repeat(reading.report, *source, table.title(), body, has_shape);
    if (!repeat || reading.report.error_count() != errors ||
        !has_room_for(reading, body, repeat_count(*repeat), table.position("repeat")))
        return;
    // Each body gets its own random sequence, so that adding one leaves the others where they are.
    Random random(reading.scene.world.seed ^ name_hash(body.name));
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
        return; // already reported
    for (std::size_t i = 0; i < placed.size(); ++i) {
        BodyDesc copy = body;
        copy.name += "_" + std::to_string(i);
        copy.position = placed[i].position;
        if (placed[i].turn != glm::dquat(1, 0, 0, 0)) {
            copy.orientation = placed[i].turn * body.orientation;
            copy.velocity = placed[i].turn * body.velocity;
            copy.angular_velocity = placed[i].turn * body.angular_velocity;
            copy.force = placed[i].turn * body.force;
            copy.torque = placed[i].turn * body.torque;
        }
        if (!reading.bodies.add(reading.report, table.position("name"), "body", copy.name))
            return;
        reading.bodies_by_name[copy.name] = reading.scene.bodies.size();
        add_body(reading, std::move(copy), table.position());
    }
    group.count = placed.size();
    group.is_complete = true;
}

} // namespace

void read_material(Reading &reading, const toml::table &source) {
    static constexpr std::array<std::string_view, 5> keys{"name", "density", "friction",
                                                          "restitution", "color"};
    const Table table(reading.report, source, title_of("material", source), keys);
    MaterialDesc material;
    material.name = read_name(reading.report, table, "material", reading.materials).value_or("");
    material.density = table.number("density", positive).value_or(material.density);
    material.friction = table.number("friction", not_negative).value_or(material.friction);
    material.restitution = table.number("restitution", fraction).value_or(material.restitution);
    material.colour = table.colour("color");
    if (!material.name.empty())
        reading.densities[material.name] = material.density;
    reading.scene.materials.push_back(std::move(material));
}

void read_body(Reading &reading, const toml::table &source) {
    static const std::vector<std::string_view> keys = [] {
        std::vector<std::string_view> all{"name", "kind", "shape", "shapes"};
        all.insert(all.end(), body_shape_keys().begin(), body_shape_keys().end());
        all.insert(all.end(), {"material",
                               "mass",
                               "density",
                               "center_of_mass",
                               "inertia",
                               "layer",
                               "ignores",
                               "sensor",
                               "position",
                               "rotation_deg",
                               "axis",
                               "angle_deg",
                               "orientation",
                               "normal",
                               "velocity",
                               "angular_velocity",
                               "angular_velocity_deg",
                               "locked",
                               "gravity_scale",
                               "force",
                               "torque",
                               "linear_damping",
                               "angular_damping",
                               "color",
                               "repeat",
                               "mass_pose",
                               "pace"});
        return all;
    }();
    const Table table(reading.report, source, title_of("body", source), keys);
    BodyDesc body;
    const std::optional<std::string> name =
        read_name(reading.report, table, "body", reading.bodies);
    body.name = name.value_or("");
    const bool has_shape = read_colliders(reading, table, body);
    read_kind(table, body);
    read_mass(reading, table, body, has_shape);
    read_pace(reading, table, body);
    body.position = table.vector("position", moderate).value_or(body.position);
    body.orientation =
        table.has("shapes")
            ? read_rotation(reading.report, table)
            : read_shape_rotation(reading.report, table,
                                  std::holds_alternative<PlaneDesc>(body.colliders.front().shape));
    read_velocity(reading, table, body);
    read_freedom(table, body);
    read_loads(table, body);
    body.colour = table.colour("color");

    if (table.has("repeat")) {
        repeat_body(reading, table, body, has_shape);
    } else if (has_room_for(reading, body, 1, table.position())) {
        if (name)
            reading.bodies_by_name[*name] = reading.scene.bodies.size();
        add_body(reading, std::move(body), table.position());
    }
}

std::optional<std::size_t> find_body(Reading &reading, const Table &table, std::string_view key) {
    const std::optional<std::string> name = table.string(key);
    if (!name)
        return std::nullopt;
    if (const auto found = reading.bodies_by_name.find(*name);
        found != reading.bodies_by_name.end())
        return found->second;
    if (const auto group = reading.groups.find(*name); group != reading.groups.end()) {
        if (group->second.is_complete)
            table.error(key, "the body " + in_quotes(*name) + " is repeated, so there are many",
                        "name one of " + *name + "_0 to " + *name + "_" +
                            std::to_string(group->second.count - 1));
        return std::nullopt;
    }
    // It may be a copy from a repeat that failed.
    const std::size_t underscore = name->rfind('_');
    if (underscore != std::string::npos) {
        const auto group = reading.groups.find(name->substr(0, underscore));
        if (group != reading.groups.end() && !group->second.is_complete)
            return std::nullopt;
    }
    // Searching all names is slow in a large scene, so only the first errors get a suggestion.
    constexpr int suggested = 100;
    table.error(key, "there is no body " + in_quotes(*name),
                ++reading.missing_bodies <= suggested ? reading.bodies.suggestion(*name) : "");
    return std::nullopt;
}

bool has_room_for(Reading &reading, std::size_t count, std::size_t limit, std::size_t present,
                  const char *what, const FilePosition &at) {
    if (count <= limit && present <= limit - count)
        return true;
    if (!reading.said_too_many)
        reading.report.error(at,
                             "too many " + std::string(what) + ": " + std::to_string(present) +
                                 " before this, and " + std::to_string(count) + " here",
                             "a scene holds at most " + std::to_string(limit));
    reading.said_too_many = true;
    return false;
}

} // namespace plumb::scene_file
