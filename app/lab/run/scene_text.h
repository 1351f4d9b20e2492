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

// Puts another text in its place, and says so. Throws std::invalid_argument when the file is no
// longer as it was read, or none that can be written to.
void write_back(const SceneText &scene, const std::string &text, std::ostream &err);

} // namespace plumb
