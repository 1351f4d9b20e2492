#include "engine/scene/file/reading.h"
#include "engine/scene/file/spelling.h"
#include "engine/scene/shape_kinds.h"

namespace plumb::scene_file {

namespace {

std::string shape_suggestion() {
    const std::vector<std::string_view> &names = kind_names<ShapeDesc>();
    std::string text = "shape = ";
    for (std::size_t i = 0; i < names.size(); ++i)
        text += (i == 0 ? "" : i + 1 < names.size() ? ", " : " or ") + in_quotes(names[i]);
    return text;
}

void read_filter(const Table &table, ColliderDesc &collider) {
    collider.filter.layer = static_cast<int>(table.integer("layer", 0, max_layers - 1).value_or(0));
    if (const toml::node *node = table.node("ignores")) {
        const toml::array *layers = node->as_array();
        if (!layers)
            table.wrong_type(*node, "ignores", "an array of layers, from 0 to 31");
        for (std::size_t i = 0; layers && i < layers->size(); ++i)
            if (const auto layer = table.integer(
                    *layers->get(i), "ignores[" + std::to_string(i) + "]", 0, max_layers - 1))
                collider.filter.ignores |= 1U << static_cast<unsigned>(*layer);
    }
    collider.sensor = table.boolean("sensor").value_or(false);
}

// Reads one of several shapes. False, with an error reported, when it is unusable.
bool read_part(Reading &reading, const toml::node &node, const std::string &of, BodyDesc &body) {
    const std::optional<std::size_t> kind =
        read_shape_kind(reading.report, node, "shapes", of, kind_names<ShapeDesc>());
    if (!kind)
        return false;
    ColliderDesc &collider = body.colliders.emplace_back();
    collider.shape = shape_of_kind<ShapeDesc>(*kind);
    const KindInfo &info = kind_info(collider.shape);
    static const std::vector<std::string_view> keys = [] {
        std::vector<std::string_view> all{"shape"};
        all.insert(all.end(), body_shape_keys().begin(), body_shape_keys().end());
        all.insert(all.end(), {"position", "rotation_deg", "axis", "angle_deg", "orientation",
                               "normal", "material", "density", "layer", "ignores", "sensor"});
        return all;
    }();
    const Table table(reading.report, *node.as_table(),
                      "the " + std::string(info.name) + " of " + of, keys);
    const bool is_good = read_shape_fields(reading.report, reading.files,
                                           reading.scene.world.precision, table, collider.shape);
    collider.position = table.vector("position", moderate).value_or(collider.position);
    collider.orientation = read_shape_rotation(reading.report, table,
                                               std::holds_alternative<PlaneDesc>(collider.shape));
    collider.material = read_material_name(reading, table);
    if (info.moves == Moves::by_forces)
        collider.density = table.number("density", positive);
    else
        table.refuse({"density"}, std::string(info.with_article), "it has no mass");
    read_filter(table, collider);
    return is_good;
}

} // namespace

std::string read_material_name(Reading &reading, const Table &table) {
    const std::optional<std::string> name = table.string("material");
    if (name && !reading.densities.contains(*name))
        table.error("material", "there is no material " + in_quotes(*name),
                    reading.materials.suggestion(*name));
    return name.value_or("");
}

bool read_colliders(Reading &reading, const Table &table, BodyDesc &body) {
    if (!table.has("shapes")) {
        ColliderDesc &collider = body.colliders.emplace_back();
        read_filter(table, collider);
        if (!table.require("shape", shape_suggestion()))
            return false;
        const std::optional<std::size_t> kind = table.choice("shape", kind_names<ShapeDesc>());
        if (!kind)
            return false;
        collider.shape = shape_of_kind<ShapeDesc>(*kind);
        return read_shape_fields(reading.report, reading.files, reading.scene.world.precision,
                                 table, collider.shape);
    }
    for (const std::string_view key : body_shape_keys())
        table.refuse({key}, "a body with several shapes", "each of them has its own");
    table.refuse({"shape", "normal", "layer", "ignores", "sensor"}, "a body with several shapes",
                 "each of them has its own");
    const toml::array *shapes = table.node("shapes")->as_array();
    if (!shapes || shapes->empty() || shapes->size() > max_body_shapes) {
        table.error("shapes",
                    table.title() + " has " +
                        (shapes ? std::to_string(shapes->size()) + " shapes" : "no shapes"),
                    "it takes an array of " + range_text(1, max_body_shapes, "shapes"));
        body.colliders.emplace_back();
        return false;
    }
    bool is_good = true;
    for (const toml::node &node : *shapes)
        is_good = read_part(reading, node, table.title(), body) && is_good;
    if (body.colliders.empty())
        body.colliders.emplace_back();
    return is_good;
}

} // namespace plumb::scene_file
