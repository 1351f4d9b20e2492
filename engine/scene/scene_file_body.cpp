#include "engine/scene/scene_file_number.h"
#include "engine/scene/scene_file_reading.h"

namespace plumb::scene_file {

namespace {

void add_body(Reading &reading, BodyDesc body, const FilePosition &at) {
    reading.scene.bodies.push_back(std::move(body));
    reading.positions.bodies.push_back(at);
}

bool read_shape(const Table &table, ShapeDesc &read) {
    static constexpr std::array<std::string_view, 4> shapes{"sphere", "box", "capsule", "plane"};
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
        read = SphereDesc{radius.value_or(1)};
        return radius.has_value();
    }
    case 1: {
        table.refuse({"radius", "half_height"}, "a box", "its size is half_extents");
        if (!table.require("half_extents", "half_extents = [x, y, z] in metres"))
            return false;
        const std::optional<glm::dvec3> half = table.vector("half_extents", positive);
        read = BoxDesc{half.value_or(glm::dvec3(1))};
        return half.has_value();
    }
    case 2: {
        table.refuse({"half_extents"}, "a capsule", "its size is half_height and radius");
        const bool has_height =
            table.require("half_height", "half_height = metres, without the round ends");
        const bool has_radius = table.require("radius", "radius = metres");
        const std::optional<double> height = table.number("half_height", positive);
        const std::optional<double> radius = table.number("radius", positive);
        read = CapsuleDesc{height.value_or(1), radius.value_or(1)};
        return has_height && has_radius && height && radius;
    }
    default:
        table.refuse({"radius", "half_extents", "half_height"}, "a plane",
                     "it is infinite: the solid below y = 0 of its frame");
        read = PlaneDesc{};
        return true;
    }
}

void read_kind(const Table &table, BodyDesc &body) {
    static constexpr std::array<std::string_view, 3> kinds{"static", "kinematic", "dynamic"};
    const bool is_plane = has_plane(body);
    body.kind = is_plane ? BodyKind::fixed : BodyKind::dynamic;
    const std::optional<std::size_t> kind = table.choice("kind", kinds);
    if (!kind)
        return;
    body.kind = static_cast<BodyKind>(*kind);
    if (is_plane && body.kind == BodyKind::dynamic)
        table.error("kind", "a plane cannot be dynamic",
                    R"(kind = "static", which is a plane's default, or "kinematic")");
}

void read_mass(Reading &reading, const Table &table, BodyDesc &body, bool has_shape) {
    double density = MaterialDesc{}.density;
    if (const std::optional<std::string> material = table.string("material")) {
        body.material = *material;
        if (const auto found = reading.densities.find(*material); found != reading.densities.end())
            density = found->second;
        else
            table.error("material", "there is no material " + in_quotes(*material),
                        reading.materials.suggestion(*material));
    }
    if (has_plane(body)) {
        table.refuse({"mass", "density"}, "a plane", "it is infinite and never moves by itself");
        return;
    }
    const std::string_view key = table.one_of({"mass", "density"}, false, "");
    const std::optional<double> value = key.empty() ? std::nullopt : table.number(key, positive);
    if (key == "mass") {
        body.mass = value;
        return;
    }
    if (!key.empty() && !value)
        return;
    body.density = value;
    const double mass = value.value_or(density) * volume(body.colliders.front().shape);
    if (has_shape && !(mass >= positive.min && mass <= positive.max))
        table.error(key.empty() ? "shape" : key,
                    "density times volume makes a mass of " + shortest(mass) + " kg",
                    "it must be " + std::string(positive.text) + "; give a mass");
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
    if (body.kind != BodyKind::fixed)
        return;
    const std::string suggestion = R"(kind = "kinematic" moves as told, "dynamic" by forces)";
    if (body.velocity != glm::dvec3(0))
        reading.report.error(table.key_position("velocity"), "a static body has no velocity",
                             suggestion);
    if (body.angular_velocity != glm::dvec3(0))
        reading.report.error(table.key_position(key), "a static body has no " + std::string(key),
                             suggestion);
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
        !has_room_for(reading, repeat_count(*repeat), max_scene_bodies, reading.scene.bodies.size(),
                      "bodies", table.position("repeat")))
        return;
    // A sequence of its own for each body, so that adding one leaves the others where they are.
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
    const Table table(reading.report, source, title_of("body", source), keys);
    BodyDesc body;
    const std::optional<std::string> name =
        read_name(reading.report, table, "body", reading.bodies);
    body.name = name.value_or("");
    const bool has_shape = read_shape(table, body.colliders.emplace_back().shape);
    read_kind(table, body);
    read_mass(reading, table, body, has_shape);
    body.position = table.vector("position", moderate).value_or(body.position);
    body.orientation = read_rotation(reading.report, table);
    read_velocity(reading, table, body);
    body.colour = table.colour("color");

    if (table.has("repeat")) {
        repeat_body(reading, table, body, has_shape);
    } else if (has_room_for(reading, 1, max_scene_bodies, reading.scene.bodies.size(), "bodies",
                            table.position())) {
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
    // A repeat that failed would have made it, perhaps.
    const std::size_t underscore = name->rfind('_');
    if (underscore != std::string::npos) {
        const auto group = reading.groups.find(name->substr(0, underscore));
        if (group != reading.groups.end() && !group->second.is_complete)
            return std::nullopt;
    }
    // Looking through all names is slow in a large scene; after so many one gets the idea.
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
