// Where the program's data lies, and which scenes there are.
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
// installed share/plumb beside the program, else the source tree that it was built from. Throws
// std::runtime_error, naming all places tried, when there is none.
std::filesystem::path find_data_dir();

// All scene files below a folder, by subject and name.
std::vector<SceneEntry> find_scenes(const std::filesystem::path &scene_dir);

// A scene as a person names it: a path to a file, else a name in the catalogue ("pendulum" or
// "joints/pendulum"). Throws std::invalid_argument, with the nearest names, when there is neither.
std::filesystem::path resolve_scene(const std::string &name, const std::vector<SceneEntry> &scenes);

} // namespace plumb
