// Short names for the numbers of a scene that a map is often over.
#pragma once

#include "app/lab/map/map_axis.h"
#include "engine/scene/scene_desc.h"

#include <span>
#include <string>
#include <string_view>

namespace plumb {

struct AxisName {
    std::string_view name;    // "mass_ratio"
    std::string_view meaning; // what it is of a scene, a phrase
};

[[nodiscard]] std::span<const AxisName> axis_names();

// Turns an axis's name, unless it is a setting or a path, into the numbers of this scene that it
// means: one of axis_names(), or a bare last key such as "radius" that the file has only once. The
// scene is what the text says. Throws std::invalid_argument, with the scene's paths, if there is no
// such number, or if it could be any of several.
[[nodiscard]] MapAxis named_axis(MapAxis axis, std::string_view scene_text, const SceneDesc &scene);

} // namespace plumb
