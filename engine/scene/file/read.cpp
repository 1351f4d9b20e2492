#include "engine/scene/file/crowd.h"
#include "engine/scene/file/probe.h"
#include "engine/scene/file/reading.h"
#include "engine/scene/scene_file.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <optional>
#include <regex>
#include <string>
#include <system_error>
#include <utility>

namespace plumb {

namespace {

using namespace scene_file;

// Clamps a position to the text: toml++ places the end of the file slightly past its last
// character.
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
    // Columns count characters: bytes 10xxxxxx are continuations.
    const auto characters =
        static_cast<std::size_t>(std::count_if(content.begin(), content.end(), [](char c) {
            return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
        }));
    return {line, line < at.line ? characters + 1 : std::min(at.column, characters + 1)};
}

std::string_view line_at(std::string_view text, std::size_t line) {
    for (; line > 1 && text.find('\n') != std::string_view::npos; --line)
        text.remove_prefix(text.find('\n') + 1);
    return text.substr(0, text.find('\n'));
}

// What to do about a mistake in a line's TOML, for the likeliest of them.
std::string what_is_right(std::string_view line, std::string_view mistake) {
    static const std::regex fraction(R"(=\s*(-?[0-9.]+\s*/\s*[0-9.]+))");
    const std::string_view code = line.substr(0, line.find('#'));
    std::match_results<std::string_view::const_iterator> found;
    if (std::regex_search(code.begin(), code.end(), found, fraction))
        return "put a fraction in quotes: \"" + found.str(1) + '"';
    if (std::ranges::count(code, '"') % 2 == 1 && mistake.find("string") != std::string_view::npos)
        return "close the quotes at the end of the string";
    return "see https://toml.io for the syntax";
}

SceneMessage error(std::size_t line, std::size_t column, std::string what, std::string suggestion) {
    return {SceneMessage::Severity::error, line, column, std::move(what), std::move(suggestion)};
}

} // namespace

namespace scene_file {

void read_scene(Reading &reading, const Table &top) {
    SceneDesc &scene = reading.scene;
    scene.title = top.string("title").value_or("");
    scene.description = top.string("description").value_or("");
    const auto read_one = [&](std::string_view key, auto read) {
        if (const toml::table *table = table_at(reading.report, top, key))
            read(reading, *table);
    };
    const auto read_each = [&](std::string_view key, auto read) {
        for_each(reading.report, top, key, [&](const toml::table &table) { read(reading, table); });
    };
    read_one("world", read_world);
    read_one("methods", read_methods);
    read_one("camera", read_camera);
    read_each("material", read_material);
    read_each("body", read_body);
    read_each("joint", read_joint);
    read_each("attractor", read_attractor);
    read_each("particle", read_particle);
    read_each("cloth", read_cloth);
    read_each("spring", read_spring);
    read_each("expect", read_expect);
    scene.probes = read_probes(reading.report, top, scene.world.precision, reading.files);
    read_one("state", read_state);

    if (reading.report.error_count() == 0)
        if (const std::optional<SceneMessage> crowd = too_crowded(scene, reading.positions))
            reading.report.error({crowd->line, crowd->column}, crowd->what, crowd->suggestion);
}

std::optional<toml::table> parse_toml(std::string_view text, const std::string &path,
                                      std::vector<SceneMessage> &messages) {
    toml::parse_result parsed = toml::parse(text, std::string_view(path));
    if (parsed)
        return std::move(parsed).table();
    const FilePosition at = inside(text, position_of(parsed.error().source()));
    std::string what(parsed.error().description());
    std::string right = what_is_right(line_at(text, at.line), what);
    messages.push_back(error(at.line, at.column, std::move(what), std::move(right)));
    return std::nullopt;
}

std::optional<std::string> read_file(const std::filesystem::path &path,
                                     std::vector<SceneMessage> &messages) {
    std::ifstream file(path, std::ios::binary);
    std::string text;
    std::array<char, 1U << 16U> block;
    while (file && text.size() <= max_scene_file_bytes) {
        file.read(block.data(), block.size());
        text.append(block.data(), static_cast<std::size_t>(file.gcount()));
    }
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored)) { // it opens, but cannot be read
        messages.push_back(
            error(0, 0, "this is a folder, not a scene file", "give one of the files in it"));
        return std::nullopt;
    }
    if (!file.is_open() || file.bad()) {
        messages.push_back(
            error(0, 0, "the file cannot be read", "check that it exists and is readable"));
        return std::nullopt;
    }
    if (text.size() > max_scene_file_bytes) {
        messages.push_back(error(0, 0, "the file is too large",
                                 "a scene file has at most " +
                                     std::to_string(max_scene_file_bytes >> 20U) +
                                     " MiB; `repeat` makes many bodies from a few lines"));
        return std::nullopt;
    }
    return text;
}

} // namespace scene_file

bool SceneFileResult::ok() const {
    return std::none_of(messages.begin(), messages.end(), [](const SceneMessage &message) {
        return message.severity == SceneMessage::Severity::error;
    });
}

SceneFileResult parse_scene(std::string_view text, const std::string &path,
                            const std::vector<std::string> &known_methods) {
    SceneFileResult result;
    const std::optional<toml::table> root = parse_toml(text, path, result.messages);
    if (!root)
        return result;
    Reading reading(path, known_methods);
    read_scene(reading, Table(reading.report, *root, "the top level of a scene", scene_keys));
    if (reading.report.error_count() == 0)
        for (SceneMessage &warning : scene_warnings(reading.scene, reading.positions))
            reading.report.warning(std::move(warning));
    return {std::move(reading.scene), reading.report.in_file_order()};
}

SceneFileResult load_scene(const std::filesystem::path &path,
                           const std::vector<std::string> &known_methods) {
    SceneFileResult result;
    const std::optional<std::string> text = read_file(path, result.messages);
    if (!text)
        return result;
    result = parse_scene(*text, path.string(), known_methods);
    const SceneDesc &scene = result.scene;
    if (result.ok() && scene.bodies.empty() && scene.probes.empty() && scene.particles.empty() &&
        scene.cloths.empty())
        result.messages = {
            error(1, 1, "the scene is empty: it has no body, no particle, no cloth and no probe",
                  "add a [[body]], a [[particle]], a [[cloth]] or a [[probe]]")};
    return result;
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
