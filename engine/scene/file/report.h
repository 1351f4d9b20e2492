// Messages collected while reading a scene file. Not for users of the engine.
#pragma once

#include "engine/scene/file/warnings.h"
#include "engine/scene/scene_file.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace plumb::scene_file {

inline std::string in_quotes(std::string_view name) {
    return '"' + std::string(name) + '"';
}

class Report {
  public:
    // If there are too many errors, the first in file order are kept.
    void error(const FilePosition &at, std::string what, std::string suggestion = {}) {
        messages_.push_back({SceneMessage::Severity::error, at.line, at.column, std::move(what),
                             std::move(suggestion)});
        ++error_count_;
        if (messages_.size() >= 2 * max_listed_mistakes)
            keep_first();
    }
    void warning(SceneMessage message) { messages_.push_back(std::move(message)); }

    std::size_t error_count() const { return error_count_; }

    // If some were dropped, the last message says how many.
    std::vector<SceneMessage> in_file_order() {
        keep_first();
        if (error_count_ > max_listed_mistakes)
            messages_.push_back(
                {SceneMessage::Severity::error, 0, 0,
                 "... and " + std::to_string(error_count_ - max_listed_mistakes) + " more", ""});
        return std::move(messages_);
    }

  private:
    void keep_first() {
        std::stable_sort(messages_.begin(), messages_.end(),
                         [](const SceneMessage &a, const SceneMessage &b) {
                             return a.line != b.line ? a.line < b.line : a.column < b.column;
                         });
        if (error_count_ > 0 && messages_.size() > max_listed_mistakes)
            messages_.resize(max_listed_mistakes);
    }

    std::vector<SceneMessage> messages_;
    std::size_t error_count_ = 0;
};

} // namespace plumb::scene_file
