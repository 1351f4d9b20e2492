#include "engine/scene/file/lines.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace plumb::scene_file {

Lines::Lines(std::string_view text, std::string_view layout)
    : layout_(layout), end_(text.find("\r\n") == std::string_view::npos ? "\n" : "\r\n") {
    while (!text.empty()) {
        const std::size_t length = std::min(text.find('\n'), text.size() - 1) + 1;
        lines_.emplace_back(text.substr(0, length));
        text.remove_prefix(length);
    }
}

std::string Lines::take(std::size_t i) {
    return std::exchange(lines_.at(i), {});
}

void Lines::add_after(std::size_t i, std::string_view text) {
    std::string &line = lines_.at(i);
    if (!line.empty() && line.back() != '\n')
        line += end_;
    line += with_ends(text);
}

void Lines::add_before(std::size_t i, std::string_view text) {
    lines_.at(i) = with_ends(text) + lines_.at(i);
}

void Lines::set_value(std::size_t i, std::string_view key, std::string_view value) {
    std::string &line = lines_.at(i);
    std::size_t at = line.find_first_not_of(" \t");
    if (at == std::string::npos || !std::string_view(line).substr(at).starts_with(key))
        throw std::invalid_argument(layout_);
    at = line.find('=', at + key.size());
    at = at == std::string::npos ? at : line.find_first_not_of(" \t", at + 1);
    if (at == std::string::npos)
        throw std::invalid_argument(layout_);
    if (line[at] == '[')
        join_array(i, at);
    const bool quoted = line[at] == '"' || line[at] == '\'';
    const std::size_t last = line[at] == '[' ? line.find(']', at)
                             : quoted        ? line.find(line[at], at + 1)
                                             : line.find_first_of(" \t#\r\n", at) - 1;
    line.replace(at, std::min(last, line.size() - 1) + 1 - at, with_ends(value));
}

// Joins an array that spans several lines, dropping everything between its brackets.
void Lines::join_array(std::size_t i, std::size_t at) {
    std::string &line = lines_[i];
    const auto closing = [](std::string_view text) {
        const std::size_t bracket = text.find(']');
        return bracket < text.find('#') ? bracket : std::string_view::npos;
    };
    if (closing(std::string_view(line).substr(at)) != std::string_view::npos)
        return;
    for (std::size_t next = i + 1; next < lines_.size(); ++next) {
        const std::string text = take(next);
        if (const std::size_t bracket = closing(text); bracket != std::string::npos) {
            line.replace(at + 1, std::string::npos, text.substr(bracket));
            return;
        }
    }
}

std::string Lines::text() const {
    std::string all;
    for (const std::string &line : lines_)
        all += line;
    return all;
}

std::string Lines::with_ends(std::string_view text) const {
    std::string all;
    for (const char c : text)
        all += c == '\n' ? end_ : std::string(1, c);
    return all;
}

} // namespace plumb::scene_file
