// A scene file as text, so that its numbers can be changed in place.
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
    std::vector<ChangedNumber> changed{}; // applied in this order over the text's numbers
};

// Reads a scene's text and prints its diagnostics; nullopt if it has errors. Reads once, as the
// file may be a pipe.
[[nodiscard]] std::optional<SceneText> read_scene(const std::filesystem::path &path,
                                                  std::ostream &err);

// Replaces the file's text, and says so. Throws std::invalid_argument if the file has changed since
// it was read or cannot be written to.
void write_back(const SceneText &scene, const std::string &text, std::ostream &err);

} // namespace plumb
