#include "engine/scene/scene_file_reading.h"
#include "engine/scene/scene_file_spelling.h"

#include <charconv>

namespace plumb::scene_file {

namespace {

// "a/b" with plain numbers.
std::optional<double> parse_fraction(std::string_view text) {
    const auto strip = [](std::string_view part) {
        while (!part.empty() && part.front() == ' ')
            part.remove_prefix(1);
        while (!part.empty() && part.back() == ' ')
            part.remove_suffix(1);
        return part;
    };
    const auto parse = [](std::string_view part) -> std::optional<double> {
        double value = 0;
        const auto [end, failure] = std::from_chars(part.data(), part.data() + part.size(), value);
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

void read_dt(Reading &reading, const Table &table) {
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
            reading.scene.world.dt = *value;
        return;
    }
    reading.scene.world.dt = table.number("dt", step).value_or(reading.scene.world.dt);
}

void check_method(Reading &reading, const std::string &method, const FilePosition &at) {
    if (!reading.known_methods.empty() &&
        std::find(reading.known_methods.begin(), reading.known_methods.end(), method) ==
            reading.known_methods.end())
        reading.report.error(at, "there is no method " + in_quotes(method),
                             did_you_mean(method, reading.known_methods));
}

MethodSettings read_settings(const Table &table) {
    MethodSettings settings;
    settings.substeps =
        static_cast<int>(table.integer("substeps", 0, max_scene_substeps).value_or(0));
    settings.iterations =
        static_cast<int>(table.integer("iterations", 0, max_scene_substeps).value_or(0));
    return settings;
}

} // namespace

void read_world(Reading &reading, const toml::table &source) {
    static constexpr std::array<std::string_view, 7> keys{
        "gravity", "dt", "method", "substeps", "iterations", "precision", "seed"};
    const Table table(reading.report, source, "[world]", keys);
    WorldDesc &world = reading.scene.world;
    world.gravity = table.vector("gravity", moderate).value_or(world.gravity);
    read_dt(reading, table);
    if (const std::optional<std::string> method = table.string("method")) {
        check_method(reading, *method, table.position("method"));
        world.method = *method;
    }
    world.settings = read_settings(table);
    static constexpr std::array<std::string_view, 2> precisions{"float", "double"};
    if (const std::optional<std::size_t> precision = table.choice("precision", precisions))
        world.precision = *precision == 0 ? Precision::single : Precision::dual;
    world.seed = table.natural("seed").value_or(world.seed);
    reading.positions.dt = table.position("dt");
}

void read_methods(Reading &reading, const toml::table &source) {
    static constexpr std::array<std::string_view, 2> keys{"substeps", "iterations"};
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
        reading.scene.world.other_methods[name] =
            read_settings(Table(reading.report, *settings, "[methods." + name + "]", keys));
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
