// Recordings as files: a scene, [recording] with the hashes, and [[command]]s.
#include "engine/scene/recording.h"
#include "engine/scene/file/reading.h"
#include "engine/scene/file/spelling.h"
#include "engine/scene/file/text.h"
#include "engine/scene/joint_type.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <type_traits>
#include <utility>
#include <variant>

namespace plumb {

namespace {

using namespace scene_file;

template <std::size_t... index> constexpr auto names_of(std::index_sequence<index...>) {
    return std::array{std::variant_alternative_t<index, Command>::name...};
}
constexpr auto command_names = names_of(std::make_index_sequence<std::variant_size_v<Command>>());

// ---- reading

// Reads the fields of one [[command]].
struct Fields {
    Reading &reading;
    const Table &table;
    std::vector<std::string_view> used{"step", "do"};
    bool complete = true;

    template <typename Field> void operator()(std::string_view key, Field &field) {
        used.push_back(key);
        const std::size_t errors = reading.report.error_count();
        if (table.require(key, "every \"" + table.string("do").value_or("") + "\" needs one"))
            read(key, field);
        complete = complete && reading.report.error_count() == errors;
    }
    template <typename Field> void operator()(std::string_view key, Field &field, OrDefault) {
        if (table.has(key))
            return (*this)(key, field);
        used.push_back(key);
    }

    void read(std::string_view key, std::string &field) { field = table.string(key).value_or(""); }
    void read(std::string_view key, double &field) {
        field = table.number(key, finite).value_or(field);
    }
    void read(std::string_view key, glm::dvec3 &field) {
        field = table.vector(key, moderate).value_or(field);
    }
    void read(std::string_view key, glm::dquat &field) {
        field = table.unit_quaternion(key).value_or(field);
    }
    void read(std::string_view key, GivenSettings &field) {
        if (const toml::table *source = table_at(reading.report, table, key))
            field = read_settings(reading.report, *source, "[command.settings]");
    }
    // Like [[body]]. Bodies of the scene may be gone by then, and their names free again.
    void read(std::string_view key, BodyDesc &field) {
        const toml::table *source = table_at(reading.report, table, key);
        if (!source)
            return;
        Reading own;
        own.scene.materials = reading.scene.materials;
        own.materials = reading.materials;
        own.densities = reading.densities;
        std::swap(own.report, reading.report);
        std::swap(own.files, reading.files);
        read_body(own, *source);
        std::swap(own.report, reading.report);
        std::swap(own.files, reading.files);
        if (own.scene.bodies.size() == 1)
            field = own.scene.bodies.front();
        else if (reading.report.error_count() == 0)
            table.error(key, "a command adds one body", "write one [[command]] for each");
    }
    // Like [[joint]], but that its anchors and frames are the bodies' own: where these will be is
    // not known here, nor which there are.
    void read(std::string_view key, JointDesc &field) {
        const toml::table *source = table_at(reading.report, table, key);
        if (!source)
            return;
        const std::size_t errors = reading.report.error_count();
        for (const auto &[name, value] : *source)
            for (const std::string_view refused :
                 {"anchor", "anchor_a", "anchor_b", "axis", "chain"})
                if (name.str() == refused)
                    reading.report.error(position_of(value),
                                         "a command's joint takes no " + std::string(refused),
                                         "it takes anchor_a_local, anchor_b_local, frame_a_local "
                                         "and frame_b_local");
        const auto *type = source->get_as<std::string>("type");
        if (type != nullptr && type->get() == joint_type(JointType::distance).name &&
            !source->contains("length") && !source->contains("max_length"))
            reading.report.error(position_of(*type), "a command's distance joint needs a length",
                                 "length = metres, or max_length");
        if (reading.report.error_count() != errors)
            return;
        Reading own;
        for (const char *end : {"body_a", "body_b"})
            if (const auto *body = source->get_as<std::string>(end);
                body != nullptr && body->get() != "world") {
                own.bodies_by_name.try_emplace(body->get(), own.scene.bodies.size());
                own.scene.bodies.emplace_back().name = body->get();
            }
        std::swap(own.report, reading.report);
        read_joint(own, *source);
        std::swap(own.report, reading.report);
        if (own.scene.joints.size() == 1)
            field = own.scene.joints.front();
    }
};

template <std::size_t index = 0>
std::optional<Command> read_fields(Fields &fields, std::size_t which) {
    if constexpr (index < std::variant_size_v<Command>) {
        if (which != index)
            return read_fields<index + 1>(fields, which);
        std::variant_alternative_t<index, Command> command;
        command.each_field(command, fields);
        return command;
    } else {
        return std::nullopt;
    }
}

// The keys of all commands.
std::vector<std::string_view> command_keys() {
    std::vector<std::string_view> keys{"step", "do"};
    const auto collect = [&](auto... commands) {
        (commands.each_field(commands, [&](std::string_view key, const auto &,
                                           OrDefault = {}) { keys.push_back(key); }),
         ...);
    };
    [&]<std::size_t... index>(std::index_sequence<index...>) {
        collect(std::variant_alternative_t<index, Command>{}...);
    }
    (std::make_index_sequence<std::variant_size_v<Command>>());
    return keys;
}

void read_command(Reading &reading, const toml::table &source, Recording &recording) {
    static const std::vector<std::string_view> keys = command_keys();
    const Table table(reading.report, source, "[[command]]", keys);
    const std::size_t errors = reading.report.error_count();
    RecordedCommand command;
    command.line = table.position().line;
    if (table.require("step", "how many steps had been taken"))
        command.step = table.natural("step").value_or(0);
    const std::uint64_t earliest =
        recording.commands.empty() ? recording.first_step() : recording.commands.back().step;
    if (reading.report.error_count() == errors &&
        (command.step < earliest || command.step > recording.last_step()))
        table.error("step", "there is no step " + std::to_string(command.step) + " here",
                    "commands must be in order, here from " + std::to_string(earliest) + " to " +
                        std::to_string(recording.last_step()));
    if (!table.require("do",
                       "what is done, such as \"" + std::string(command_names.front()) + "\""))
        return;
    const std::optional<std::size_t> which = table.choice("do", command_names);
    if (!which)
        return;
    Fields fields{reading, table};
    std::optional<Command> read = read_fields(fields, *which);
    for (const auto &[key, value] : source)
        if (std::ranges::find(fields.used, key.str()) == fields.used.end() &&
            std::ranges::find(keys, key.str()) != keys.end())
            table.refuse({key.str()}, "\"" + std::string(command_names[*which]) + "\"",
                         "it has no meaning here");
    if (reading.report.error_count() != errors)
        return;
    command.command = std::move(*read);
    recording.commands.push_back(std::move(command));
}

void read_hashes(Reading &reading, const toml::table &source, Recording &recording) {
    static constexpr std::array<std::string_view, 1> keys{"hashes"};
    const Table table(reading.report, source, "[recording]", keys);
    const std::string wanted = "the hash of the state at the start and after each step";
    if (!table.require("hashes", wanted))
        return;
    const toml::array *hashes = table.node("hashes")->as_array();
    if (!hashes || hashes->empty()) {
        table.error("hashes", hashes ? "hashes is empty" : "hashes is not an array", wanted);
        return;
    }
    for (const toml::node &node : *hashes) {
        const auto *text = node.as_string();
        std::uint64_t hash = 0;
        const char *begin = text ? text->get().data() : nullptr;
        const char *end = text ? begin + text->get().size() : nullptr;
        const bool is_hash =
            text && text->get().size() == 16 && std::from_chars(begin, end, hash, 16).ptr == end;
        if (!is_hash)
            reading.report.error(position_of(node),
                                 "hashes holds " +
                                     (text ? in_quotes(text->get()) : std::string(type_name(node))),
                                 "a hash is 16 hexadecimal digits in quotes");
        recording.hashes.push_back(hash);
    }
}

// ---- writing

struct PartLines {
    std::string text;
    std::string tables; // these must follow all values

    void operator()(std::string_view key, const std::string &field) { line(key, string(field)); }
    void operator()(std::string_view key, double field, OrDefault = {}) {
        line(key, shortest(field));
    }
    void operator()(std::string_view key, const glm::dvec3 &field) { line(key, array3(field)); }
    void operator()(std::string_view key, const glm::dquat &field) { line(key, rotation(field)); }
    void operator()(std::string_view key, const GivenSettings &field) {
        table(key, settings_text(field));
    }
    void operator()(std::string_view key, const BodyDesc &field) { table(key, body_text(field)); }
    void operator()(std::string_view key, const JointDesc &field) { table(key, joint_text(field)); }

    void line(std::string_view key, const std::string &value) {
        text += std::string(key) + " = " + value + "\n";
    }
    void table(std::string_view key, const std::string &lines) {
        tables += "[command." + std::string(key) + "]\n" + lines;
    }
};

} // namespace

RecordingResult parse_recording(std::string_view text, const std::string &path) {
    RecordingResult result;
    const std::optional<toml::table> root = parse_toml(text, path, result.messages);
    if (!root)
        return result;
    static const std::vector<std::string_view> keys = [] {
        std::vector<std::string_view> all(scene_keys.begin(), scene_keys.end());
        all.insert(all.end(), {"recording", "command"});
        return all;
    }();
    Reading reading(path, {});
    const Table top(reading.report, *root, "the top level of a recording", keys);
    read_scene(reading, top);
    Recording &recording = result.recording;
    recording.scene.step_count = reading.scene.step_count;
    if (const toml::table *table = table_at(reading.report, top, "recording"))
        read_hashes(reading, *table, recording);
    else if (!top.has("recording"))
        reading.report.error({1, 1}, "this is not a recording: it has no [recording]",
                             "`plumb run --record FILE` makes one");
    if (!recording.hashes.empty())
        for_each(reading.report, top, "command",
                 [&](const toml::table &table) { read_command(reading, table, recording); });
    recording.scene = std::move(reading.scene);
    result.messages = reading.report.in_file_order();
    return result;
}

RecordingResult load_recording(const std::filesystem::path &path) {
    RecordingResult result;
    const std::optional<std::string> text = read_file(path, result.messages);
    return text ? parse_recording(*text, path.string()) : result;
}

std::string write_recording(const Recording &recording) {
    std::string text = "# A recording. To check that it replays identically: plumb replay FILE\n" +
                       write_scene(recording.scene) + "\n[recording]\nhashes = [\n";
    for (const std::uint64_t hash : recording.hashes)
        text += "    \"" + hash_text(hash) + "\",\n";
    text += "]\n";
    for (const RecordedCommand &command : recording.commands) {
        text += "\n[[command]]\nstep = " + std::to_string(command.step) + "\n";
        std::visit(
            [&](const auto &what) {
                text += "do = \"" + std::string(what.name) + "\"\n";
                PartLines lines;
                what.each_field(what, lines);
                text += lines.text + lines.tables;
            },
            command.command);
    }
    return text;
}

} // namespace plumb
