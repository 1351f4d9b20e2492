// Scene files for the lab's commands.
#pragma once

#include "engine/scene/scene_desc.h"

#include <filesystem>
#include <iostream>
#include <vector>

namespace plumb {

struct LoadedScenes {
    std::vector<SceneDesc> scenes; // those without errors, in the order given
    bool all_fine = true;
};

// Prints the diagnostics of each file. A folder stands for all scene files below it, in path order.
[[nodiscard]] LoadedScenes load_scenes(const std::vector<std::filesystem::path> &paths,
                                       std::ostream &err);

} // namespace plumb
