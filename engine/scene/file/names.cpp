#include "engine/scene/file/names.h"

#include "engine/scene/file/spelling.h"

namespace plumb::scene_file {

bool Names::add(Report &report, const FilePosition &at, const std::string &kind,
                const std::string &name) {
    const auto [entry, is_new] = lines_.try_emplace(name, at.line);
    if (!is_new)
        report.error(at,
                     "another " + kind + " is already named " + in_quotes(name) + ", at line " +
                         std::to_string(entry->second),
                     "each " + kind + " needs a name of its own");
    return is_new;
}

std::string Names::suggestion(const std::string &name) const {
    std::vector<std::string_view> all;
    for (const auto &[known, line] : lines_)
        all.push_back(known);
    return did_you_mean(name, all);
}

std::string title_of(std::string_view kind, const toml::table &table) {
    std::string title = "[[" + std::string(kind) + "]]";
    if (const auto *name = table.get_as<std::string>("name"))
        title += " " + in_quotes(name->get());
    return title;
}

std::optional<std::string> read_name(Report &report, const Table &table, const std::string &kind,
                                     Names &names) {
    if (!table.require("name", "each " + kind + " needs a name of its own"))
        return std::nullopt;
    std::optional<std::string> name = table.string("name");
    if (!name)
        return std::nullopt;
    if (name->find_first_not_of(" \t\r\n") == std::string::npos) {
        table.error("name", "the name is empty", "each " + kind + " needs a name of its own");
        return std::nullopt;
    }
    if ((kind == "body" || kind == "particle" || kind == "cloth") && *name == "world") {
        table.error("name", "\"world\" cannot be the name of a " + kind,
                    "it stands for the world in joints and springs");
        return std::nullopt;
    }
    names.add(report, table.position("name"), kind, *name);
    return name;
}

} // namespace plumb::scene_file
