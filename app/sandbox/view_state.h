// What is shown, and from where: all that is not the world itself.
#pragma once

#include "app/render/camera.h"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

namespace plumb {

struct ViewState {
    Camera camera;
    std::optional<std::size_t> selected;
    std::optional<std::size_t> hovered;
    bool contacts = false;
    bool joints = false;
    bool wireframe = false;
    bool bounds = false;
    bool velocities = false;
    bool panels = true;
    bool diagnostics = true;
    bool help = false;
    std::string search;                   // in the list of scenes
    bool focus_search = false;            // the search box takes the keyboard in the next frame
    std::filesystem::path scene_in_sight; // to which the list of scenes was last scrolled
};

} // namespace plumb
