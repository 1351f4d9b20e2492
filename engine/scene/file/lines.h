// A scene file as its lines, to change some of them and keep the rest byte for byte.
#pragma once

#include "engine/scene/file/table.h" // toml++

#include <string>
#include <string_view>
#include <vector>

namespace plumb::scene_file {

// Lines keep their index: removed ones are empty, and what is added stands in one with what it
// follows.
class Lines {
  public:
    // `layout` is what set_value throws where a line is not laid out as it needs: it says how.
    Lines(std::string_view text, std::string_view layout);

    std::size_t size() const { return lines_.size(); }
    std::string_view line(std::size_t i) const { return lines_.at(i); }
    std::string take(std::size_t i);
    void add_after(std::size_t i, std::string_view text);
    void add_before(std::size_t i, std::string_view text);
    // Of a line "key = value # comment"; throws std::invalid_argument of any other. An array of
    // numbers may go on over the lines that follow.
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
