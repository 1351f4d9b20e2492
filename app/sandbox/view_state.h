// What is shown, and from where: all that is not the world itself.
#pragma once

#include "app/render/camera.h"
#include "engine/scene/probe.h"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

namespace plumb {

// One of the places by which a probe can be moved.
struct ProbeHandle {
    std::size_t probe = 0;
    std::size_t handle = 0;
    friend bool operator==(const ProbeHandle &, const ProbeHandle &) = default;
};

struct ViewState {
    Camera camera;
    std::optional<std::size_t> selected;
    std::optional<std::size_t> hovered;
    std::optional<ProbeHandle> hovered_handle;
    std::optional<ProbePoint> pointed_at; // of a picking probe's shapes, by the pointer's ray
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
