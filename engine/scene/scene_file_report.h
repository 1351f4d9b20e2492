// What is said about a scene file while it is read. Not for users of the engine.
#pragma once

#include "engine/scene/scene_file.h"
#include "engine/scene/scene_file_warnings.h"

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
    void error(const FilePosition &at, std::string what, std::string suggestion = {}) {
        messages_.push_back({SceneMessage::Severity::error, at.line, at.column, std::move(what),
                             std::move(suggestion)});
        ++error_count_;
    }
    void warning(SceneMessage message) { messages_.push_back(std::move(message)); }

    std::size_t error_count() const { return error_count_; }

    std::vector<SceneMessage> in_file_order() {
        std::stable_sort(messages_.begin(), messages_.end(),
                         [](const SceneMessage &a, const SceneMessage &b) {
                             return a.line != b.line ? a.line < b.line : a.column < b.column;
                         });
        return std::move(messages_);
    }

  private:
    std::vector<SceneMessage> messages_;
    std::size_t error_count_ = 0;
};

} // namespace plumb::scene_file
