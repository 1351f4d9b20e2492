// Names given in a scene file's tables. Not for users of the engine.
#pragma once

#include "engine/scene/file/table.h"

#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace plumb::scene_file {

// The names of one kind of table, and where they were given.
class Names {
  public:
    // False, with an error reported, when the name is taken.
    bool add(Report &report, const FilePosition &at, const std::string &kind,
             const std::string &name);
    std::string suggestion(const std::string &name) const; // did_you_mean, among those added

  private:
    std::map<std::string, std::size_t> lines_; // by name
};

// "[[body]] "crate"", or "[[body]]" when there is no usable name.
std::string title_of(std::string_view kind, const toml::table &table);

// The table's own name; empty, with an error reported, when there is no usable one.
std::optional<std::string> read_name(Report &report, const Table &table, const std::string &kind,
                                     Names &names);

} // namespace plumb::scene_file
