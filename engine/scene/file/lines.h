// A scene file as lines, to edit some of them and keep the rest byte for byte.
#pragma once

#include "engine/scene/file/table.h" // toml++

#include <string>
#include <string_view>
#include <vector>

namespace plumb::scene_file {

// Lines keep their index: removed lines become empty, and added text joins the line it follows (or
// precedes).
class Lines {
  public:
    // `layout` is the message set_value throws for a line not laid out as required; it says how to.
    Lines(std::string_view text, std::string_view layout);

    std::size_t size() const { return lines_.size(); }
    std::string_view line(std::size_t i) const { return lines_.at(i); }
    std::string take(std::size_t i);
    void add_after(std::size_t i, std::string_view text);
    void add_before(std::size_t i, std::string_view text);
    // For a line "key = value # comment"; throws std::invalid_argument for any other. An array of
    // numbers may span several lines.
    void set_value(std::size_t i, std::string_view key, std::string_view value);
    std::string text() const;

  private:
    void join_array(std::size_t i, std::size_t at);
    std::string with_ends(std::string_view text) const;

    std::string layout_;
    std::string end_; // of each line
    std::vector<std::string> lines_;
};

// From 0.
inline std::size_t line_of(const toml::source_region &region) {
    return region.begin.line - 1;
}

} // namespace plumb::scene_file
