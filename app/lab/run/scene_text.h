// A scene file as text, which its numbers are changed in.
#pragma once

#include "engine/scene/file/change.h"

#include <filesystem>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

namespace plumb {

struct SceneText {
    std::filesystem::path path;
    std::string text;
    std::vector<ChangedNumber> changed{}; // in this order, in place of the text's
};

// The text of a scene without errors; what there is to say about it is printed. It is read once,
// for it may come through a pipe.
[[nodiscard]] std::optional<SceneText> read_scene(const std::filesystem::path &path,
                                                  std::ostream &err);

} // namespace plumb
