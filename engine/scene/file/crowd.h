// Scenes whose bodies are too many in one place to be run. Not for users of the engine.
#pragma once

#include "engine/scene/file/warnings.h"

#include <optional>

namespace plumb {

// Of a scene without other errors: an error at the body with which the planes are more than
// max_scene_planes (scene_limits.h), or the pairs of bodies that are near each other in the first
// step more than max_scene_pairs.
std::optional<SceneMessage> too_crowded(const SceneDesc &scene, const ScenePositions &positions);

} // namespace plumb
