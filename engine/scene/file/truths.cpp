#include "engine/scene/file/truths.h"

#include "engine/scene/file/lines.h"
#include "engine/scene/file/number.h"
#include "engine/scene/file/reading.h"
#include "engine/scene/file/text.h"
#include "engine/scene/scene_file.h"

#include <algorithm>
#include <stdexcept>

namespace plumb {

namespace {

using namespace scene_file;

constexpr std::string_view expect_layout =
    "write [[expect]] as a table, with each key and its value on a line of its own";

const toml::table &expect_of(const toml::table &root, const std::string &name) {
    if (const toml::array *all = root["expect"].as_array())
        for (const toml::node &each : *all)
            if (const toml::table *table = each.as_table())
                if (const auto *own = table->get_as<std::string>("name"); own && own->get() == name)
                    return *table;
    throw std::invalid_argument("there is no [[expect]] " + in_quotes(name));
}

} // namespace

std::string with_truths(std::string_view text, const std::string &path,
                        std::span<const WrittenTruth> truths) {
    std::vector<SceneMessage> messages;
    const std::optional<toml::table> root = parse_toml(text, path, messages);
    SceneFileResult should_be = parse_scene(text, path);
    if (!root || !should_be.ok())
        throw std::invalid_argument("the scene has errors");
    Lines lines(text, expect_layout);
    for (const WrittenTruth &truth : truths) {
        const toml::table &table = expect_of(*root, truth.expect);
        const bool is_curve = truth.values.size() > 1;
        const double value = is_curve ? 0 : truth.values.at(0);
        for (const auto &[key, text_of_value] :
             {std::pair{"equals", is_curve ? array_of(truth.values) : shortest(value)},
              {"estimate", shortest(truth.estimate)}}) {
            const auto at = table.find(key);
            if (at == table.end())
                throw std::invalid_argument("[[expect]] " + in_quotes(truth.expect) + " has no " +
                                            key);
            lines.set_value(line_of(at->first.source()), key, text_of_value);
        }
        const auto expect =
            std::ranges::find(should_be.scene.expects, truth.expect, &ExpectDesc::name);
        expect->value = value;
        expect->curve = is_curve ? truth.values : std::vector<double>();
        expect->estimate = truth.estimate;
    }
    std::string changed = lines.text();
    const SceneFileResult now = parse_scene(changed, path);
    if (!now.ok() || write_scene(now.scene) != write_scene(should_be.scene))
        throw std::invalid_argument(std::string(expect_layout));
    return changed;
}

} // namespace plumb
