#include "engine/scene/file/settings.h"

#include "engine/scene/file/lines.h"
#include "engine/scene/file/reading.h"
#include "engine/scene/file/text.h"
#include "engine/scene/scene_file.h"

#include <algorithm>
#include <set>
#include <stdexcept>
#include <utility>
#include <vector>

namespace plumb {

namespace {

using namespace scene_file;

constexpr std::string_view own_lines = "write [world] and [methods.NAME] as tables, with each key "
                                       "and its value on a line of its own";

// The value as written in a file.
std::string value_text(const SettingRow &row, const StepSettings &settings) {
    const std::string text = setting_text(row, settings);
    return text.find('/') == std::string::npos ? text : in_quotes(text);
}

bool same_value(const SettingRow &row, const StepSettings &a, const StepSettings &b) {
    return setting_text(row, a) == setting_text(row, b);
}

class Change {
  public:
    Change(std::string_view text, const std::string &path) : lines_(text, own_lines) {
        std::vector<SceneMessage> messages;
        std::optional<toml::table> root = parse_toml(text, path, messages);
        if (!root)
            throw std::invalid_argument("the scene has errors");
        root_ = std::move(*root);
        if (const toml::table *world = root_["world"].as_table()) {
            if (world->is_inline())
                throw std::invalid_argument(std::string(own_lines));
            last_of_world_ = line_of(world->source());
            for (const auto &[key, value] : *world)
                *last_of_world_ =
                    std::max<std::size_t>(*last_of_world_, value.source().end.line - 1);
        }
    }

    // Sets a key of [world].
    void set(std::string_view key, const std::string &value) {
        const toml::table *world = root_["world"].as_table();
        if (world != nullptr && world->contains(key) && !moved_keys_.contains(key))
            lines_.set_value(line_of(world->find(key)->first.source()), key, value);
        else
            added_ += std::string(key) + " = " + value + "\n";
    }

    void move_to_methods(const std::string &method) {
        const toml::table *world = root_["world"].as_table();
        std::string moved;
        for (const SettingRow &row : setting_rows)
            if (world != nullptr && row.group != SettingGroup::world && world->contains(row.name)) {
                moved += taken(world->find(row.name)->first.source(), row.name);
                moved_keys_.insert(row.name);
            }
        if (!moved.empty())
            moved_ = "\n[methods." + method + "]\n" + moved;
    }

    void remove_method(std::string_view method) {
        const toml::table *table = root_["methods"][method].as_table();
        if (table == nullptr)
            return;
        if (table->is_inline())
            throw std::invalid_argument(std::string(own_lines));
        const std::size_t header = line_of(table->source());
        std::size_t last = header;
        taken(table->source(), "[");
        for (const auto &[key, value] : *table) {
            last = std::max(last, line_of(key.source()));
            taken(key.source(), key.str());
        }
        take_comments(header, last);
    }

    std::string text() {
        const std::string added = added_ + moved_;
        const std::string table = "[world]\n" + added + "\n";
        if (added.empty())
            return lines_.text();
        if (last_of_world_)
            lines_.add_after(*last_of_world_, added);
        else if (const std::size_t first = first_table(); first < lines_.size())
            lines_.add_before(first, table);
        else
            lines_.add_after(lines_.size() - 1, "\n" + table);
        return lines_.text();
    }

  private:
    std::string taken(const toml::source_region &region, std::string_view begins) {
        std::string line = lines_.take(line_of(region));
        const std::size_t at = line.find_first_not_of(" \t");
        if (at == std::string::npos || !std::string_view(line).substr(at).starts_with(begins))
            throw std::invalid_argument(std::string(own_lines));
        std::erase(line, '\r'); // the file's line ending is put back later
        if (line.back() != '\n')
            line += '\n';
        return line;
    }

    // Removes a table's lines, the comments above it and one of the blank lines around it.
    void take_comments(std::size_t header, std::size_t last) {
        const auto is_blank = [&](std::size_t i) {
            return lines_.line(i).find_first_not_of(" \t\r\n") == std::string_view::npos;
        };
        for (std::size_t i = header; i <= last; ++i)
            lines_.take(i);
        while (header > 0 && lines_.line(header - 1).starts_with("#"))
            lines_.take(--header);
        if (header > 0 && is_blank(header - 1) && (last + 1 == lines_.size() || is_blank(last + 1)))
            lines_.take(header - 1);
    }

    // The line of the first table, or of the comment right above it.
    std::size_t first_table() const {
        std::size_t first = lines_.size();
        for (const auto &[key, value] : root_) {
            const toml::array *array = value.as_array();
            const toml::node *table = value.as_table();
            if (array != nullptr && array->is_array_of_tables())
                table = array->get(0);
            else if (table == nullptr || value.as_table()->is_inline())
                continue;
            first = std::min<std::size_t>(first, line_of(table->source()));
        }
        while (first > 0 && first < lines_.size() && lines_.line(first - 1).starts_with("#"))
            --first;
        return first;
    }

    Lines lines_;
    toml::table root_;
    std::optional<std::size_t> last_of_world_; // line
    std::string added_, moved_;
    std::set<std::string_view> moved_keys_;
};

SceneDesc parsed(std::string_view text, const std::string &path) {
    SceneFileResult result = parse_scene(text, path);
    if (!result.ok())
        throw std::invalid_argument("the scene has errors");
    return std::move(result.scene);
}

// Whether the text gives the same scene with the intended run.
bool is_right(const std::string &text, const std::string &path, const SceneDesc &before,
              const ResolvedRun &run) {
    SceneFileResult result = parse_scene(text, path);
    if (!result.ok())
        return false;
    const ResolvedRun now = resolve_run(result.scene, {});
    for (const SettingRow &row : setting_rows)
        if (row.name != "gravity" && !same_value(row, now.settings, run.settings))
            return false;
    result.scene.world.method = before.world.method;
    result.scene.world.settings = before.world.settings;
    result.scene.world.other_methods = before.world.other_methods;
    result.scene.world.precision = before.world.precision;
    return now.method == run.method && now.precision == run.precision &&
           write_scene(result.scene) == write_scene(before);
}

} // namespace

std::string with_run(std::string_view text, const std::string &path, const ResolvedRun &run) {
    const SceneDesc before = parsed(text, path);
    const bool other_method = before.world.method != run.method->name;
    Change change(text, path);
    if (other_method) {
        change.set("method", in_quotes(run.method->name));
        change.move_to_methods(before.world.method);
        change.remove_method(run.method->name);
    }
    // The scene's settings for this method if nothing were added.
    WorldDesc world = before.world;
    world.other_methods.erase(std::string(run.method->name));
    const StepSettings given = settings_of(world, *run.method);
    for (const SettingRow &row : setting_rows)
        if (!is_vector(row) && !same_value(row, given, run.settings))
            change.set(row.name, value_text(row, run.settings));
    if (before.world.precision != run.precision)
        change.set("precision", run.precision == Precision::f64 ? "\"double\"" : "\"float\"");
    std::string changed = change.text();
    if (!is_right(changed, path, before, run))
        throw std::invalid_argument(std::string(own_lines));
    return changed;
}

} // namespace plumb
