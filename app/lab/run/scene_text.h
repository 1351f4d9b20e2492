// A scene file as text, which its numbers are changed in.
#pragma once

#include <filesystem>
#include <optional>
#include <ostream>
#include <string>

namespace plumb {

struct SceneText {
    std::filesystem::path path;
    std::string text;
};

// The text of a scene without errors; what there is to say about it is printed. It is read once,
// for it may come through a pipe.
[[nodiscard]] std::optional<SceneText> read_scene(const std::filesystem::path &path,
                                                  std::ostream &err);

} // namespace plumb
