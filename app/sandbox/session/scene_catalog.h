// Where the program's data is, and which scenes there are.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace plumb {

struct SceneEntry {
    std::filesystem::path path;
    std::string subject; // the folder below `scenes`
    std::string name;    // the file's stem
    std::string title;
};

// The folder that holds `shaders` and `scenes`: PLUMB_DATA from the environment if set, else the
// installed share/plumb next to the program, else the source tree it was built from. If there is
// none, throws std::runtime_error naming all places tried.
std::filesystem::path find_data_dir();

// All scene files below a folder, sorted by subject and name.
std::vector<SceneEntry> find_scenes(const std::filesystem::path &scene_dir);

// Resolves a scene given as a path to a file, else as a name in the catalogue ("pendulum" or
// "joints/pendulum"), else a subject ("joints": the folder). If there is none, throws
// std::invalid_argument with the nearest names.
std::filesystem::path resolve_scene(const std::string &name, const std::vector<SceneEntry> &scenes);

} // namespace plumb
