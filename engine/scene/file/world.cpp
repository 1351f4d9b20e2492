#include "engine/scene/file/reading.h"
#include "engine/scene/file/spelling.h"

#include <algorithm>
#include <stdexcept>

namespace plumb::scene_file {

namespace {

// Empty, with an error reported, unless it is a number in the row's range. Fractions are quoted:
// "1/60".
std::optional<double> read_number(const Table &table, const SettingRow &row) {
    const std::string wanted = range_text(row) + ", or a fraction in quotes such as \"1/60\"";
    const toml::node *node = table.node(row.name);
    const auto *text = node ? node->as_string() : nullptr;
    if (!text)
        return table.number(row.name, {row.min, row.max, wanted});
    try {
        const double value = parse_number(text->get());
        if (value >= row.min && value <= row.max)
            return value;
    } catch (const std::invalid_argument &) { // reported below
    }
    table.error(row.name, std::string(row.name) + " is " + in_quotes(text->get()),
                "it must be " + wanted);
    return std::nullopt;
}

void read_setting(const Table &table, const SettingRow &row, GivenSettings &given) {
    if (const auto *vector = std::get_if<glm::dvec3 StepSettings::*>(&row.member)) {
        if (const std::optional value = table.vector(row.name, {row.min, row.max, range_text(row)}))
            given.give(*vector, *value);
    } else if (const auto *whole = std::get_if<int StepSettings::*>(&row.member)) {
        if (const std::optional value = table.integer(row.name, static_cast<std::int64_t>(row.min),
                                                      static_cast<std::int64_t>(row.max)))
            given.give(*whole, static_cast<int>(*value));
    } else if (const std::optional value = read_number(table, row)) {
        given.give(std::get<double StepSettings::*>(row.member), *value);
    }
}

// The names of the settings, the world's only if `of_world`, and `others`.
std::vector<std::string_view> keys_with(bool of_world, Words others) {
    std::vector<std::string_view> keys;
    for (const SettingRow &row : setting_rows)
        if (of_world || row.group != SettingGroup::world)
            keys.push_back(row.name);
    keys.insert(keys.end(), others.begin(), others.end());
    return keys;
}

GivenSettings read_settings(const Table &table) {
    GivenSettings given;
    for (const SettingRow &row : setting_rows)
        if (table.has(row.name))
            read_setting(table, row, given);
    return given;
}

void check_method(Reading &reading, const std::string &method, const FilePosition &at) {
    if (!reading.known_methods.empty() &&
        std::find(reading.known_methods.begin(), reading.known_methods.end(), method) ==
            reading.known_methods.end())
        reading.report.error(at, "there is no method " + in_quotes(method),
                             did_you_mean(method, reading.known_methods));
}

} // namespace

GivenSettings read_settings(Report &report, const toml::table &source, const std::string &title) {
    return read_settings(Table(report, source, title, keys_with(true, {})));
}

void read_world(Reading &reading, const toml::table &source) {
    static constexpr std::array<std::string_view, 3> others{"method", "precision", "seed"};
    const Table table(reading.report, source, "[world]", keys_with(true, others));
    WorldDesc &world = reading.scene.world;
    if (const std::optional<std::string> method = table.string("method")) {
        check_method(reading, *method, table.position("method"));
        world.method = *method;
    }
    world.settings = read_settings(table);
    static constexpr std::array<std::string_view, 2> precisions{"float", "double"};
    if (const std::optional<std::size_t> precision = table.choice("precision", precisions))
        world.precision = *precision == 0 ? Precision::f32 : Precision::f64;
    world.seed = table.natural("seed").value_or(world.seed);
    reading.positions.dt = table.position("dt");
}

void read_methods(Reading &reading, const toml::table &source) {
    for (const auto &[key, value] : source) {
        const std::string name(key.str());
        check_method(reading, name, position_of(key.source()));
        const toml::table *settings = value.as_table();
        if (!settings) {
            reading.report.error(position_of(key.source()),
                                 name + " is " + std::string(type_name(value)),
                                 "it must be a table: [methods." + name + "]");
            continue;
        }
        const Table table(reading.report, *settings, "[methods." + name + "]",
                          keys_with(false, {}));
        if (name == reading.scene.world.method)
            reading.report.error(position_of(key.source()),
                                 name + " is the scene's own method, whose settings are in [world]",
                                 "move them there");
        reading.scene.world.other_methods[name] = read_settings(table);
    }
}

void read_camera(Reading &reading, const toml::table &source) {
    static constexpr std::array<std::string_view, 8> keys{
        "target", "distance", "yaw_deg", "yaw", "pitch_deg", "pitch", "fov_deg", "fov"};
    static constexpr Bounds upright{-90, 90, "a number from -90 to 90"};
    static constexpr Bounds view{1, 170, "a number from 1 to 170"};
    const Table table(reading.report, source, "[camera]", keys);
    CameraDesc &camera = reading.scene.camera;
    camera.target = table.vector("target", moderate).value_or(camera.target);
    camera.distance = table.number("distance", positive).value_or(camera.distance);
    camera.yaw = table.angle("yaw", moderate).value_or(camera.yaw);
    camera.pitch = table.angle("pitch", upright).value_or(camera.pitch);
    camera.fov = table.angle("fov", view).value_or(camera.fov);
}

} // namespace plumb::scene_file
